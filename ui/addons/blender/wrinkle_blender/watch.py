# SPDX-License-Identifier: MIT
"""Notification of replaced files: a thread that is blocked in the kernel (inotify) until something happens, and a
program's end. Needs no Blender.

Wrinkle replaces a file by renaming a complete one, and a set under a list, a hidden file NAME.together, which it
removes after the last rename. So files are reported once a rename (or a writer's close) has come and no list is
left: never a half-written picture, never half a set, and no waiting for quiet."""
import ctypes
import os
import select
import struct
import threading

from .program import WrinkleError

_CLOSE_WRITE, _MOVED_TO, _CREATE, _DELETE = 0x8, 0x80, 0x100, 0x200
_DELETE_SELF, _MOVE_SELF, _IGNORED, _OVERFLOW, _ONLYDIR = 0x400, 0x800, 0x8000, 0x4000, 0x1000000
_WANTED = _CLOSE_WRITE | _MOVED_TO | _CREATE | _DELETE | _DELETE_SELF | _MOVE_SELF | _ONLYDIR
_LIST = ".together"
_IN_CLOEXEC, _IN_NONBLOCK = 0o2000000, 0o4000


def _open(folder):
    libc = ctypes.CDLL(None, use_errno=True)
    if not hasattr(libc, "inotify_init1"):
        raise WrinkleError("the live link needs Linux (inotify)")
    fd = libc.inotify_init1(_IN_CLOEXEC | _IN_NONBLOCK)
    if fd >= 0 and libc.inotify_add_watch(fd, os.fsencode(folder), _WANTED) >= 0:
        return fd
    why = os.strerror(ctypes.get_errno())
    if fd >= 0:
        os.close(fd)
    raise WrinkleError("%s: cannot be watched (%s)" % (folder, why))


class Watcher:
    """Watches a folder, and a program (program.Child) that writes there, or None.

    wake() is called on the watcher's thread after changes; take() then has them. Nothing of Blender may be
    touched there."""

    def __init__(self, folder, wake, child=None):
        self.folder, self.child = folder, child
        self._wake = wake
        self._lock = threading.Lock()
        self._changed, self._closed = set(), None
        self._stopping = False
        self._pending, self._lists = set(), set()
        self._fd = _open(folder)
        self._pipe = os.pipe()
        self._end = child.handle() if child else -1
        self._thread = threading.Thread(target=self._run, name="wrinkle", daemon=True)
        self._thread.start()

    def take(self):
        """(names of replaced files, reason of the end or None) since the last call."""
        with self._lock:
            changed, self._changed = self._changed, set()
            return changed, self._closed

    def stop(self, end_child=False):
        """Ends the thread; also the program, if asked: one that only exports, not one with the user's work."""
        self._stopping = True
        os.write(self._pipe[1], b".")
        self._thread.join()
        for fd in (self._fd, *self._pipe, self._end):
            if fd >= 0:
                os.close(fd)
        if self.child and end_child and self.child.runs():
            self.child.end()
        if self.child:
            self.child.close()

    # ---- on the thread ----

    def _run(self):
        poll = select.poll()
        poll.register(self._fd, select.POLLIN)
        poll.register(self._pipe[0], select.POLLIN)
        if self.child:
            poll.register(self._end, select.POLLIN)
        reason = None
        while reason is None and not self._stopping:
            ready = {fd for fd, _ in poll.poll()}  # sleeps until something happens
            if self._fd in ready:
                reason = self._events()
            if self._end in ready:
                reason = self.child.reason()
            self._report(reason)

    def _events(self):
        try:
            data = os.read(self._fd, 65536)
        except BlockingIOError:
            return None
        at = 0
        while at < len(data):
            _, mask, _, length = struct.unpack_from("iIII", data, at)
            name = os.fsdecode(data[at + 16 : at + 16 + length].rstrip(b"\0"))
            at += 16 + length
            if mask & (_DELETE_SELF | _MOVE_SELF | _IGNORED):
                return "%s: the folder was removed or moved" % self.folder
            if mask & _OVERFLOW:
                self._pending.update(n for n in os.listdir(self.folder) if not n.startswith("."))
            elif name.endswith(_LIST):
                (self._lists.discard if mask & _DELETE else self._lists.add)(name)
            elif mask & (_CLOSE_WRITE | _MOVED_TO) and not name.startswith("."):
                self._pending.add(name)
        return None

    def _report(self, reason):
        with self._lock:
            if not self._lists or reason:
                self._changed |= self._pending
                self._pending = set()
            self._closed = reason
            news = bool(self._changed or reason)
        if news and not self._stopping:
            self._wake()
