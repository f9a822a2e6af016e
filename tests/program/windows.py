# SPDX-License-Identifier: MIT
"""A display without a screen, and the windows on it, for tests."""

import contextlib
import ctypes
import os
import shutil
import subprocess

CLIENT_MESSAGE = 33  # of X.h


@contextlib.contextmanager
def display():
    """The name of a display of its own, as long as the tests need it."""
    reader, writer = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "1600x1200x24",
         "-nolisten", "tcp"], pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    try:
        with open(reader, encoding="ascii") as line:
            yield f":{line.readline().strip()}"
    finally:
        server.terminate()
        server.wait()


def missing():
    """What is not there of what a test of windows needs, or nothing."""
    if shutil.which("Xvfb") is None:
        return "Xvfb is not installed (package xvfb)"
    script = "import tkinter, ctypes; ctypes.CDLL('libX11.so.6')"
    ended = subprocess.run(["/usr/bin/python3", "-c", script], check=False,
                           stderr=subprocess.DEVNULL)
    return "tkinter is not installed (package python3-tk)" \
        if ended.returncode else ""


class _Message(ctypes.Structure):
    """XClientMessageEvent, as long as any XEvent."""

    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong),
                ("sent", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", ctypes.c_ulong), ("message", ctypes.c_ulong),
                ("format", ctypes.c_int), ("data", ctypes.c_long * 5),
                ("rest", ctypes.c_long * 12)]


class Windows:
    """The windows of a display by their titles."""

    def __init__(self, name):
        self.x = ctypes.CDLL("libX11.so.6")
        self.x.XOpenDisplay.restype = ctypes.c_void_p
        self.x.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x.XInternAtom.restype = ctypes.c_ulong
        self.server = ctypes.c_void_p(self.x.XOpenDisplay(name.encode()))

    def titles(self):
        """The window of each title."""
        root = ctypes.c_ulong(self.x.XDefaultRootWindow(self.server))
        inner, count = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        ignored = ctypes.c_ulong()
        self.x.XQueryTree(self.server, root, ctypes.byref(ignored),
                          ctypes.byref(ignored), ctypes.byref(inner),
                          ctypes.byref(count))
        found = {}
        for window in inner[:count.value]:
            title = ctypes.c_char_p()
            self.x.XFetchName(self.server, ctypes.c_ulong(window),
                              ctypes.byref(title))
            if title.value:
                found[title.value.decode()] = window
        return found

    def width(self, window):
        numbers = [ctypes.c_ulong(), ctypes.c_int(), ctypes.c_int(),
                   *(ctypes.c_uint() for _ in range(4))]
        self.x.XGetGeometry(self.server, ctypes.c_ulong(window),
                            *map(ctypes.byref, numbers))
        return numbers[3].value

    def close(self, window):
        """As the button of its frame does."""
        protocols, delete = (self.x.XInternAtom(self.server, name, 0) for name
                             in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
        message = _Message(CLIENT_MESSAGE, 0, 0, self.server, window,
                           protocols, 32)
        message.data[0] = delete
        self.x.XSendEvent(self.server, ctypes.c_ulong(window), 0,
                          ctypes.c_long(0), ctypes.byref(message))
        self.x.XFlush(self.server)
