# SPDX-License-Identifier: MIT
"""The live link: watchers of folders (watch.py), and the reloading of what they report on Blender's main thread.

A watcher's thread sleeps in the kernel. When files came, it registers a timer that runs once: bpy.app.timers is the
only way into the main thread, whose loop calls due timers within 5 ms. While nothing comes no timer exists. Each
news registers its own timer, so that none is lost while one runs; nothing else of Blender is touched by the thread.
Links are kept by the folder's path, never by references to Blender's data, so undo and other files do not matter."""
import functools
import os
import textwrap

import bpy
from bpy.app.handlers import persistent

from . import material, program, watch
from .program import WrinkleError


class _Link:
    def __init__(self, watcher, ends, what):
        self.watcher, self.ends, self.what = watcher, ends, what


_links = {}  # folder: _Link
_said = {}  # folder: (is an error, sentence) of the last event


def _wake():
    bpy.app.timers.register(functools.partial(flush), first_interval=0.0)


def key(folder):
    return os.path.normpath(os.path.abspath(bpy.path.abspath(folder)))


def is_linked(folder):
    return key(folder) in _links


def folders():
    return list(_links)


def status(folder):
    """(is an error, sentence) for the panel; None: nothing happened yet."""
    return _said.get(key(folder))


def start(folder, words=None, ends=False, what=""):
    """Watches a folder, beside a program that is started by `words`. ends: the link's end ends the program too."""
    folder = key(folder)
    stop(folder)
    child = program.Child(words, ends) if words else None
    try:
        watcher = watch.Watcher(folder, _wake, child)
    except WrinkleError:
        if child:
            child.end()
        raise
    _links[folder] = _Link(watcher, ends, what)
    _said[folder] = (False, what)


def stop(folder):
    link = _links.pop(key(folder), None)
    if link:
        link.watcher.stop(end_child=link.ends)


def stop_all():
    for folder in folders():
        stop(folder)


def _tell(folder, text, is_error):
    _said[folder] = (is_error, text)
    if bpy.app.background:
        print("Wrinkle: " + text)
        return
    windows = bpy.context.window_manager.windows
    if is_error and windows:
        lines = textwrap.wrap(text, 80)
        # A menu: an operator's error, called from here, would be an exception instead of a report.
        with bpy.context.temp_override(window=windows[0]):
            bpy.context.window_manager.popup_menu(
                lambda menu, context: [menu.layout.label(text=line) for line in lines], title="Wrinkle", icon="ERROR"
            )


def flush():
    """Handles the watchers' news; runs on the main thread. The timer ends."""
    for folder in folders():
        link = _links[folder]
        names, closed = link.watcher.take()
        if names:
            errors = material.refresh(folder, names)
            if errors:
                _tell(folder, errors[0], True)
            else:
                _said[folder] = (False, link.what)
        if closed:
            stop(folder)
            _tell(folder, "the link has ended: " + closed, closed != "Wrinkle was closed")
        if names or closed:
            material.redraw()
    return None


@persistent
def _before_load(*_):
    """The next file has other materials. Wrinkle's window stays open: it has the user's work."""
    stop_all()
    _said.clear()


def register():
    bpy.app.handlers.load_pre.append(_before_load)


def unregister():
    bpy.app.handlers.load_pre.remove(_before_load)
    stop_all()
    _said.clear()
