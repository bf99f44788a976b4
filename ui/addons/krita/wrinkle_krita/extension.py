# SPDX-License-Identifier: MIT
"""The entries in Tools > Scripts. Files and command lines are in exchange.py."""
import os
import shutil
import tempfile

from krita import Extension, Krita
from PyQt5.QtCore import QFileSystemWatcher, QProcess, Qt
from PyQt5.QtWidgets import QApplication, QFileDialog, QInputDialog, QMessageBox

from . import exchange

SETTINGS = "wrinkle"
ENTRIES = (
    ("wrinkle_edit", "Wrinkle: edit this layer", lambda e: e.edit(False)),
    ("wrinkle_edit_copy", "Wrinkle: edit, and add a layer", lambda e: e.edit(True)),
    ("wrinkle_normals", "Wrinkle: normal map of this layer (green up)", lambda e: e.normals("normal+y")),
    ("wrinkle_normals_down", "Wrinkle: normal map of this layer (green down)", lambda e: e.normals("normal-y")),
    ("wrinkle_program", "Wrinkle: choose the program...", lambda e: e.choose_program()),
)


def show_error(text):
    QMessageBox.warning(Krita.instance().activeWindow().qwindow(), "Wrinkle", text)


def guarded(action, *arguments):
    """Run an action; report its error in one message box."""
    QApplication.setOverrideCursor(Qt.WaitCursor)
    text = None
    try:
        action(*arguments)
    except exchange.WrinkleError as error:
        text = str(error)
    except OSError as error: # a full disk, no rights
        text = f"{error.filename or 'A file in ' + tempfile.gettempdir()}: {error.strerror}."
    finally:
        QApplication.restoreOverrideCursor()
    if text:
        show_error(text)
    return text is None


def find_program():
    chosen = Krita.instance().readSetting(SETTINGS, "program", "")
    program = chosen or shutil.which("wrinkle")
    if not program:
        raise exchange.WrinkleError("Wrinkle was not found in the folders of PATH. Install it, or choose the program "
                                    "with Tools > Scripts > Wrinkle: choose the program...")
    exchange.check_version(program)
    return program


def active_layer():
    """The document, its active node, and the node's pixels."""
    document = Krita.instance().activeDocument()
    node = document.activeNode() if document else None
    if not node or node.type() != "paintlayer":
        raise exchange.WrinkleError("No paint layer is active. Select one in the Layers docker; "
                                    "Layer > Convert makes one of other layers.")
    size = document.width(), document.height()
    return document, node, exchange.Layer(*size, node.colorModel(), node.colorDepth(),
                                          bytes(node.pixelData(0, 0, *size)))


def add_above(document, node, made, name, pixels, layer):
    """Give a layer its pixels and add it above a node: one step of undo.

    Krita's setPixelData has no undo of its own, and on a layer of the document it takes the last stroke's; so the
    pixels are set before the layer is added, here and when a layer is replaced."""
    made.setName(name)
    made.setPixelData(pixels, 0, 0, layer.width, layer.height)
    node.parentNode().addChildNode(made, node)
    document.setActiveNode(made)


class Exchange:
    """One layer that is open in Wrinkle, until its window closes."""

    def __init__(self, program, copy, ended):
        self.program, self.copy, self.ended = program, copy, ended
        self.document, self.node, self.layer = active_layer()
        self.folder = tempfile.TemporaryDirectory(prefix="wrinkle-krita-")
        exchange.write_heights(self.folder.name, self.layer)
        exchange.make_document(program, self.folder.name)
        self.path = os.path.join(self.folder.name, exchange.DOCUMENT)
        self.saved = self._stamp()
        # Wrinkle replaces the whole file when it saves, so the folder is watched, not the file.
        self.watcher = QFileSystemWatcher([self.folder.name])
        self.watcher.directoryChanged.connect(self._folder_changed)
        self.process = QProcess()
        self.process.finished.connect(self._finished)
        self.process.errorOccurred.connect(self._start_failed)
        self.process.start(program, exchange.paint(self.folder.name))

    def _stamp(self):
        status = os.stat(self.path)
        return status.st_ino, status.st_mtime_ns, status.st_size

    def _folder_changed(self, _path):
        try:
            stamp = self._stamp()
        except OSError:
            return
        if stamp != self.saved:
            self.saved = stamp
            guarded(self._bring_back)

    def _bring_back(self):
        if self.document not in Krita.instance().documents() or not self.node.parentNode():
            raise exchange.WrinkleError("The layer's document is closed, or the layer was removed: its heights stay in "
                                        "Wrinkle. Save them there under another name.")
        exchange.export_heights(self.program, self.folder.name, self.layer.depth)
        pixels = exchange.read_heights(self.folder.name, self.layer)
        made, name = self.node.duplicate(), self.node.name()
        add_above(self.document, self.node, made, f"{name} (Wrinkle)" if self.copy else name, pixels, self.layer)
        if not self.copy:
            self.node.remove()
        self.node, self.copy = made, False # later saves replace the copy
        self.document.refreshProjection()

    def _start_failed(self, error):
        if error == QProcess.FailedToStart:
            show_error(f"{self.program} cannot be started: {self.process.errorString()}.")
            self._end()

    def _finished(self, status, how):
        self._folder_changed(None) # a save whose notice is still on its way
        if how == QProcess.CrashExit or status != 0:
            show_error(exchange.failure(status, bytes(self.process.readAllStandardError()).decode(errors="replace")))
        self._end()

    def _end(self):
        self.watcher.directoryChanged.disconnect()
        self.folder.cleanup()
        self.ended(self)


class WrinkleExtension(Extension):
    def __init__(self, parent):
        super().__init__(parent)
        self.open = []

    def setup(self):
        pass

    def createActions(self, window):
        for name, label, run in ENTRIES:
            action = window.createAction(name, label, "tools/scripts")
            action.triggered.connect(lambda _checked=False, run=run: run(self))

    def edit(self, copy):
        guarded(lambda: self.open.append(Exchange(find_program(), copy, self.open.remove)))

    def normals(self, kind):
        height, chosen = QInputDialog.getDouble(
            Krita.instance().activeWindow().qwindow(), "Wrinkle: normal map",
            "Height of white above black, in widths of the layer:", 0.1, -100, 100, 4)
        if chosen:
            guarded(self._add_normals, kind, height)

    def _add_normals(self, kind, height):
        program = find_program()
        document, node, layer = active_layer()
        wanted = layer._replace(depth=document.colorDepth())
        with tempfile.TemporaryDirectory(prefix="wrinkle-krita-") as folder:
            exchange.write_heights(folder, layer)
            exchange.export_normals(program, folder, layer, kind, height)
            pixels = exchange.read_normals(folder, wanted)
        name = f"{node.name()} {kind}"
        if document.colorModel() == "RGBA":
            made = document.createNode(name, "paintlayer")
            add_above(document, node, made, name, pixels, layer)
            document.refreshProjection()
            return
        # A grey document has no colours: the map becomes a document of its own.
        made = Krita.instance().createDocument(layer.width, layer.height, name, "RGBA", wanted.depth, "",
                                               document.resolution())
        Krita.instance().activeWindow().addView(made)
        background = made.topLevelNodes()[0]
        background.setPixelData(pixels, 0, 0, layer.width, layer.height)
        made.refreshProjection()

    def choose_program(self):
        path, _ = QFileDialog.getOpenFileName(Krita.instance().activeWindow().qwindow(), "The program wrinkle")
        if path and guarded(exchange.check_version, path):
            Krita.instance().writeSetting(SETTINGS, "program", path)
