#!/usr/bin/env python3
"""Drops files on a window of an X11 display, as a file manager does (protocol XDND, version 5).

    tests/viewer/drop.py WINDOW FILE...

WINDOW is the number of a window. The exit status is 0 once the window has taken the files, and 1 if
it refuses them or does not answer within a minute. Needs libX11, which windows need anyway.
"""

import ctypes
import select
import sys
import time
from pathlib import Path

PATIENCE = 60
VERSION = 5
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33
PROP_MODE_REPLACE = 0
CURRENT_TIME = 0

X11 = ctypes.CDLL("libX11.so.6")
NUMBER, POINTER, INT = ctypes.c_ulong, ctypes.c_void_p, ctypes.c_int
HEAD = [("type", INT), ("serial", NUMBER), ("send_event", INT), ("display", POINTER)]


class ClientMessage(ctypes.Structure):
    """XClientMessageEvent of Xlib."""

    _fields_ = [*HEAD, ("window", NUMBER), ("message_type", NUMBER), ("format", INT), ("data", ctypes.c_long * 5)]


class SelectionRequest(ctypes.Structure):
    """XSelectionRequestEvent of Xlib."""

    _fields_ = [*HEAD, ("owner", NUMBER), ("requestor", NUMBER), ("selection", NUMBER), ("target", NUMBER),
                ("property", NUMBER), ("time", NUMBER)]


class SelectionNotify(ctypes.Structure):
    """XSelectionEvent of Xlib."""

    _fields_ = [*HEAD, ("requestor", NUMBER), ("selection", NUMBER), ("target", NUMBER), ("property", NUMBER),
                ("time", NUMBER)]


class Event(ctypes.Union):
    """XEvent of Xlib."""

    _fields_ = [("type", INT), ("message", ClientMessage), ("request", SelectionRequest),
                ("notify", SelectionNotify), ("pad", ctypes.c_long * 24)]


SIGNATURES = {
    "XOpenDisplay": (POINTER, [ctypes.c_char_p]),
    "XDefaultRootWindow": (NUMBER, [POINTER]),
    "XCreateSimpleWindow": (NUMBER, [POINTER, NUMBER, INT, INT, ctypes.c_uint, ctypes.c_uint, ctypes.c_uint, NUMBER, NUMBER]),
    "XInternAtom": (NUMBER, [POINTER, ctypes.c_char_p, INT]),
    "XSetSelectionOwner": (INT, [POINTER, NUMBER, NUMBER, NUMBER]),
    "XSendEvent": (INT, [POINTER, NUMBER, INT, ctypes.c_long, ctypes.POINTER(Event)]),
    "XChangeProperty": (INT, [POINTER, NUMBER, NUMBER, NUMBER, INT, INT, ctypes.c_char_p, INT]),
    "XConnectionNumber": (INT, [POINTER]),
    "XPending": (INT, [POINTER]),
    "XNextEvent": (INT, [POINTER, ctypes.POINTER(Event)]),
    "XFlush": (INT, [POINTER]),
}
for name, (result, arguments) in SIGNATURES.items():
    getattr(X11, name).restype, getattr(X11, name).argtypes = result, arguments


class Source:
    """The program that files are dragged from."""

    def __init__(self, target, files):
        self.display = X11.XOpenDisplay(None)
        if not self.display:
            raise SystemExit("there is no display")
        self.target = target
        self.uris = "".join(f"{Path(file).resolve().as_uri()}\r\n" for file in files).encode()
        self.window = X11.XCreateSimpleWindow(self.display, X11.XDefaultRootWindow(self.display), 0, 0, 1, 1, 0, 0, 0)
        self.deadline = time.monotonic() + PATIENCE
        X11.XSetSelectionOwner(self.display, self.atom("XdndSelection"), self.window, CURRENT_TIME)

    def atom(self, name):
        """Number of an atom."""
        return X11.XInternAtom(self.display, name.encode(), 0)

    def send(self, name, *data):
        """Sends a message of the protocol to the window."""
        event = Event()
        numbers = (ctypes.c_long * 5)(self.window, *data)
        event.message = ClientMessage(CLIENT_MESSAGE, 0, 1, self.display, self.target, self.atom(name), 32, numbers)
        X11.XSendEvent(self.display, self.target, 0, 0, ctypes.byref(event))
        X11.XFlush(self.display)

    def answer(self, request):
        """Hands the names of the files over."""
        uri_list = self.atom("text/uri-list")
        known = request.target == uri_list
        if known:
            X11.XChangeProperty(self.display, request.requestor, request.property, uri_list, 8, PROP_MODE_REPLACE,
                                self.uris, len(self.uris))
        event = Event()
        event.notify = SelectionNotify(SELECTION_NOTIFY, 0, 1, self.display, request.requestor, request.selection,
                                       request.target, request.property if known else 0, request.time)
        X11.XSendEvent(self.display, request.requestor, 0, 0, ctypes.byref(event))
        X11.XFlush(self.display)
        return known

    def event(self):
        """The next event."""
        while not X11.XPending(self.display):
            left = self.deadline - time.monotonic()
            if left <= 0 or not select.select([X11.XConnectionNumber(self.display)], [], [], left)[0]:
                raise SystemExit("the window does not answer")
        event = Event()
        X11.XNextEvent(self.display, ctypes.byref(event))
        return event

    def until(self, *names):
        """Answers requests until all that is named has arrived; returns the last message of each name."""
        atoms, found = {self.atom(name): name for name in names}, {}
        while set(names) - set(found):
            event = self.event()
            if event.type == SELECTION_REQUEST and self.answer(event.request):
                found["request"] = None
            elif event.type == CLIENT_MESSAGE and event.message.message_type in atoms:
                found[atoms[event.message.message_type]] = list(event.message.data)
        return found

    def drop(self):
        """Drags the files over the window and drops them."""
        self.send("XdndEnter", VERSION << 24, self.atom("text/uri-list"), 0, 0)
        self.send("XdndPosition", 0, 0, CURRENT_TIME, self.atom("XdndActionCopy"))
        status = self.until("XdndStatus", "request")["XdndStatus"]
        if not status[1] & 1:
            raise SystemExit("the window refuses the files")
        self.send("XdndDrop", 0, CURRENT_TIME, 0, 0)
        self.until("XdndFinished")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    Source(int(sys.argv[1], 0), sys.argv[2:]).drop()
