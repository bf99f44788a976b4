# SPDX-License-Identifier: MIT
"""The program `wrinkle` as a subprocess: where it is, its version, its command lines. Needs no Blender."""
import os
import shutil
import signal
import subprocess
import tempfile

MINIMUM = (0, 1, 0)  # the first version with `paint --live` and the set `blender-live`
BEYOND = (2, 0, 0)  # command lines may change there


class WrinkleError(Exception):
    """A sentence for the user: what failed, the value, the remedy."""


def find(path=""):
    """The program's path: the given one, else that of $PATH."""
    found = shutil.which(os.path.expanduser(path) if path else "wrinkle")
    if found:
        return found
    if path:
        raise WrinkleError("%s: not a program; set Wrinkle's path in the add-on's preferences" % path)
    raise WrinkleError("wrinkle was not found; install it, or set its path in the add-on's preferences")


_checked = {}  # (path, time of change): version


def version(path):
    """The program's version as three numbers. An error if it is missing, broken or of an unknown version."""
    key = (path, os.stat(path).st_mtime_ns) if os.path.exists(path) else None
    if key and key in _checked:
        return _checked[key]
    words = run([path, "--version"]).split()
    try:
        numbers = tuple(int(n) for n in words[1].split("."))
        if words[0] != "wrinkle" or len(numbers) != 3:
            raise ValueError
    except (IndexError, ValueError):
        raise WrinkleError("%s: not Wrinkle; set Wrinkle's path in the add-on's preferences" % path) from None
    if not MINIMUM <= numbers < BEYOND:
        raise WrinkleError(
            "%s: version %s; this add-on needs %s or later, before %s"
            % (path, words[1], ".".join(map(str, MINIMUM)), ".".join(map(str, BEYOND)))
        )
    _checked[key] = numbers
    return numbers


def checked(path=""):
    """The path of a program whose version fits."""
    found = find(path)
    version(found)
    return found


def last_line(text):
    """The error of a program's standard error: its last sentence that is no note."""
    lines = [line.strip() for line in text.splitlines() if line.strip() and ": note: " not in line]
    return lines[-1] if lines else ""


def ended(path, code, errors):
    """Why a program ended, as a sentence."""
    if "error while loading shared libraries" in errors or code == 127:
        return "%s: a library is missing (%s); install Wrinkle's packages again" % (path, last_line(errors))
    if code is not None and code < 0:
        return "%s was ended by signal %d (%s)" % (path, -code, signal.strsignal(-code))
    return last_line(errors) or "%s ended with status %s" % (path, code)


def run(words, folder=None):
    """Runs the program to its end and returns its output. Its own sentence becomes the error."""
    try:
        done = subprocess.run(
            words, cwd=folder, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL
        )
    except OSError as why:
        raise WrinkleError("%s: cannot be started (%s)" % (words[0], why.strerror)) from None
    if done.returncode != 0:
        raise WrinkleError(ended(words[0], done.returncode, done.stderr))
    return done.stdout


class Child:
    """A program beside Blender. Its standard error is a nameless file, not a pipe: the window with the user's work
    goes on when nobody reads it any more. ends: it ends with Blender, also when that is killed."""

    def __init__(self, words, ends=False):
        self.words = words
        setpriv = ends and shutil.which("setpriv")
        self._errors = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                [setpriv, "--pdeathsig", "TERM"] + words if setpriv else words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._errors,
                start_new_session=True,  # an interrupt of Blender's terminal does not reach it
            )
        except OSError as why:
            raise WrinkleError("%s: cannot be started (%s)" % (words[0], why.strerror)) from None
        self.pid = self._process.pid

    def handle(self):
        """A file descriptor that becomes readable when the program ends; the caller closes it."""
        return os.pidfd_open(self.pid)

    def runs(self):
        return self._process.poll() is None

    def end(self):
        self._process.terminate()
        self._process.wait()

    def close(self):
        """Releases the file; the program goes on writing to it."""
        self._errors.close()

    def reason(self):
        """Waits for the end; why it came, as a sentence."""
        code = self._process.wait()
        self._errors.seek(max(0, self._errors.seek(0, os.SEEK_END) - 8192))
        errors = self._errors.read().decode("utf-8", "replace")
        return "Wrinkle was closed" if code == 0 else ended(self.words[0], code, errors)


# ---- command lines ----

SETS = {"HEIGHTS": "blender-live", "ALL": "blender"}


def paint_line(path, document, folder, maps):
    return [path, "paint", document, "--live", folder, "--as", SETS[maps]]


def watch_line(path, document, folder, maps):
    return [path, "export", document, "--as", SETS[maps], "-o", folder, "--watch"]


def export_line(path, document, folder):
    """All maps, with a receipt of each on standard output."""
    return [path, "export", document, "--as", "blender", "-o", folder, "--json"]


def baked_line(path, document, out):
    return [path, "export", document, "--as", "normal-baked", "depth=16", "-o", out, "--json"]


def solid_line(path, document, out, error_m):
    """The displaced mesh as OBJ, in millimetres like all solids."""
    return [path, "export", document, "--as", "obj", "error=%.6g" % (1000 * error_m), "-o", out]


def quoted(text):
    """A word of a script."""
    return '"%s"' % text.replace("\\", "\\\\").replace('"', '\\"')


def mesh_script(mesh, document, side, height):
    """Commands of a new document whose object is a mesh in metres."""
    return (
        "table %dx%d\nsurface mesh file=%s unit=m\nbump mode=blinn height=%.6g\nsave %s\n"
        % (side, side, quoted(mesh), height, quoted(document))
    )


def make_document(path, script, folder):
    """Runs a script that saves a document."""
    name = os.path.join(folder, ".wrinkle_blender_%d.wrinkle" % os.getpid())
    try:
        with open(name, "w", encoding="utf-8") as file:
            file.write(script)
        run([path, "run", name], folder)
    except OSError as why:
        raise WrinkleError("%s: cannot be written (%s)" % (folder, why.strerror)) from None
    finally:
        if os.path.exists(name):
            os.remove(name)
