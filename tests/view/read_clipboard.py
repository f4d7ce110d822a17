# SPDX-License-Identifier: Apache-2.0
"""The text of an X11 clipboard, through libX11."""
import ctypes
import time
from ctypes import POINTER, byref, c_int, c_long, c_ulong, c_void_p

from x11 import Connection

SELECTION_NOTIFY = 31
ANY_PROPERTY_TYPE = 0


def read_clipboard(display_name, seconds=10):
    """Returns the text, or None where the clipboard's owner gives none within some seconds."""
    connection = Connection(display_name)
    x, display, window = connection.x, connection.display, connection.window
    x.XConvertSelection.argtypes = [c_void_p] + [c_ulong] * 5
    x.XCheckTypedWindowEvent.argtypes = [c_void_p, c_ulong, c_int, c_void_p]
    x.XGetWindowProperty.argtypes = [c_void_p, c_ulong, c_ulong, c_long, c_long, c_int, c_ulong, POINTER(c_ulong),
                                     POINTER(c_int), POINTER(c_ulong), POINTER(c_ulong), POINTER(c_void_p)]
    x.XFree.argtypes = [c_void_p]
    answer = connection.atom("VMLIGHT_TEST_CLIPBOARD")
    x.XConvertSelection(display, connection.atom("CLIPBOARD"), connection.atom("UTF8_STRING"), answer, window, 0)
    event = (c_long * 24)()
    end = time.monotonic() + seconds
    while not x.XCheckTypedWindowEvent(display, window, SELECTION_NOTIFY, event):
        if time.monotonic() > end:
            connection.close()
            return None
        time.sleep(0.01)
    kind, bits, count, left, data = c_ulong(), c_int(), c_ulong(), c_ulong(), c_void_p()
    x.XGetWindowProperty(display, window, answer, 0, 1 << 16, 0, ANY_PROPERTY_TYPE, byref(kind), byref(bits),
                         byref(count), byref(left), byref(data))
    text = ctypes.string_at(data, count.value).decode() if data else None
    if data:
        x.XFree(data)
    connection.close()
    return text
