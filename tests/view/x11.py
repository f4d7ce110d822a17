# SPDX-License-Identifier: Apache-2.0
"""libX11, for tests that speak with vmview's window as other programs do."""
import ctypes
from ctypes import c_char_p, c_int, c_uint, c_ulong, c_void_p


class Connection:
    """To a display, with a window of its own. Close it."""

    def __init__(self, display_name):
        self.x = x = ctypes.CDLL("libX11.so.6")
        x.XOpenDisplay.restype = c_void_p
        x.XOpenDisplay.argtypes = [c_char_p]
        x.XDefaultRootWindow.restype = c_ulong
        x.XDefaultRootWindow.argtypes = [c_void_p]
        x.XCreateSimpleWindow.restype = c_ulong
        x.XCreateSimpleWindow.argtypes = [c_void_p, c_ulong] + [c_int] * 4 + [c_uint, c_ulong, c_ulong]
        x.XInternAtom.restype = c_ulong
        x.XInternAtom.argtypes = [c_void_p, c_char_p, c_int]
        x.XCloseDisplay.argtypes = [c_void_p]
        self.display = x.XOpenDisplay(display_name.encode())
        self.window = x.XCreateSimpleWindow(self.display, x.XDefaultRootWindow(self.display), 0, 0, 1, 1, 0, 0, 0)

    def atom(self, name):
        return self.x.XInternAtom(self.display, name.encode(), 0)

    def close(self):
        self.x.XCloseDisplay(self.display)
