# SPDX-License-Identifier: Apache-2.0
"""Drops files on a window as a file manager does: the XDND protocol, version 5, through libX11."""
import ctypes
import time
from ctypes import POINTER, byref, c_int, c_long, c_ubyte, c_ulong, c_void_p

from x11 import Connection

SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p),
                ("window", c_ulong), ("message_type", c_ulong), ("format", c_int), ("data", c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p),
                ("owner", c_ulong), ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong),
                ("property", c_ulong), ("time", c_ulong)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p),
                ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong),
                ("time", c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", c_int), ("client", ClientMessage), ("request", SelectionRequest),
                ("notify", SelectionNotify), ("pad", c_long * 24)]


def drop_files(display_name, window, paths, seconds=10):
    """Returns whether the window took the files within some seconds."""
    connection = Connection(display_name)
    x, display, source, atom = connection.x, connection.display, connection.window, connection.atom
    x.XSetSelectionOwner.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong]
    x.XSendEvent.argtypes = [c_void_p, c_ulong, c_int, c_long, POINTER(Event)]
    x.XNextEvent.argtypes = [c_void_p, POINTER(Event)]
    x.XPending.argtypes = [c_void_p]
    x.XFlush.argtypes = [c_void_p]
    x.XChangeProperty.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, POINTER(c_ubyte), c_int]

    def send(message, *data):
        event = Event()
        event.client.type = CLIENT_MESSAGE
        event.client.window = window
        event.client.message_type = atom(message)
        event.client.format = 32
        for i, value in enumerate((source,) + data):
            event.client.data[i] = value
        x.XSendEvent(display, window, 0, 0, byref(event))

    text = "".join("file://%s\r\n" % path for path in paths).encode()
    x.XSetSelectionOwner(display, atom("XdndSelection"), source, 0)
    send("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
    send("XdndPosition", 0, (100 << 16) | 100, 0, atom("XdndActionCopy"))
    send("XdndDrop", 0, 0)
    x.XFlush(display)
    taken = False
    end = time.monotonic() + seconds
    while time.monotonic() < end and not taken:
        if not x.XPending(display):
            time.sleep(0.01)
            continue
        event = Event()
        x.XNextEvent(display, byref(event))
        # The window answers its source, which must be there until then.
        if event.type == CLIENT_MESSAGE:
            taken = event.client.message_type == atom("XdndFinished")
        if event.type != SELECTION_REQUEST:
            continue
        request = event.request
        x.XChangeProperty(display, request.requestor, request.property, request.target, 8, 0,
                          (c_ubyte * len(text)).from_buffer_copy(text), len(text))
        answer = Event()
        answer.notify.type = SELECTION_NOTIFY
        answer.notify.requestor = request.requestor
        answer.notify.selection = request.selection
        answer.notify.target = request.target
        answer.notify.property = request.property
        answer.notify.time = request.time
        x.XSendEvent(display, request.requestor, 0, 0, byref(answer))
        x.XFlush(display)
    connection.close()
    return taken
