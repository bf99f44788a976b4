# SPDX-License-Identifier: MIT
"""Sets of maps on the disk: files, their roles, and the labels that Wrinkle stores in them. Needs no Blender."""
import json
import os
import re
import struct

from .program import WrinkleError

# Endings of the sets' files around the cell's name (`wrinkle help --markdown sets`).
NAMES = re.compile(
    r"^(?:T_)?(?P<cell>.+?)(?:_(?P<map>displacement|normal|normal-baked|ao|roughness|occlusionRoughnessMetallic|colour|"
    r"N|H|ORM|Normal|Height|MaskMap|height|Curvature|AmbientOcclusion|Roughness|disp|b2r|hf))?\.(?:png|exr)$"
)
ROLES = {  # by the label `wrinkle:kind`
    "height": "height",
    "displacement": "height",
    "normal+y": "normal",
    "normal-y": "normal",
    "normal-baked": "baked",
    "occlusion": "occlusion",
    "roughness": "roughness",
}


class Map:
    """One picture: path, role ("height", "normal", ...), labels without their prefix, size."""

    def __init__(self, path, labels, width, height, is_float):
        self.path, self.labels = path, labels
        self.width, self.height, self.is_float = width, height, is_float
        found = NAMES.match(os.path.basename(path))
        self.cell = found.group("cell") if found else os.path.splitext(os.path.basename(path))[0]
        self.role = ROLES.get(labels.get("kind", ""))
        if found and found.group("map") == "colour":
            self.role = "colour"

    def green_down(self):
        return self.labels.get("convention", "+Y") == "-Y"

    def numbers(self, label, default):
        try:
            return [float(n) for n in self.labels[label].split(",")]
        except (KeyError, ValueError):
            return default


class MapSet:
    """The maps of one cell, by role."""

    def __init__(self, name, folder, maps):
        self.name, self.folder, self.maps = name, folder, maps

    def get(self, role):
        return self.maps.get(role)

    def relief(self):
        """(scale, middle): metres of displacement are scale * (value of the picture - middle)."""
        heights = self.get("height")
        if not heights:
            return 0.0, 0.0
        metres = 0.001 if heights.labels.get("unit") == "mm" else 1.0
        of_one = heights.numbers("height", [1.0])[0] * metres  # length of F = 1
        low, high = heights.numbers("range", [0.0, 1.0])[:2]
        if heights.is_float or high == low:
            return of_one, 0.0
        # codes 0..1 are the heights low..high; F = 0 is the ground
        return of_one * (high - low), -low / (high - low)

    def cell_size(self):
        """Width and height of one unit of (u,v) in metres."""
        some = next(iter(self.maps.values()))
        size = some.numbers("cell", [1.0, 1.0])
        metres = 0.001 if some.labels.get("unit") == "mm" else 1.0
        return [metres * n for n in (size * 2)[:2]]


# ---- pictures ----


def _damaged(path):
    return WrinkleError("%s: incomplete or damaged; export it again from Wrinkle" % path)


def _png(path, data):
    """Labels and size of a PNG file whose chunks are all there."""
    labels, at, width, height, whole = {}, 8, 0, 0, False
    while at + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR" and length == 13:
            width, height = struct.unpack_from(">II", body)
        elif kind == b"tEXt":
            for line in body.partition(b"\0")[2].decode("latin-1").splitlines():
                name, equals, value = line.partition("=")
                if equals and name.startswith("wrinkle:"):
                    labels[name[8:]] = value
        whole = kind == b"IEND" and at + 12 + length <= len(data)
        at += 12 + length
    if not whole:
        raise _damaged(path)
    return Map(path, labels, width, height, False)


_ROWS = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32, 9: 256}  # of a block, by compression


def _exr(path, data):
    """Labels and size of a single-part EXR file of scan lines whose blocks are all there."""
    labels, window, compression, at = {}, None, 0, 8
    try:
        tiled = struct.unpack_from("<I", data, 4)[0] & 0x1200
        while data[at]:
            end = data.index(b"\0", at)
            name = data[at:end].decode("latin-1")
            at, end = end + 1, data.index(b"\0", end + 1)
            kind = data[at:end]
            (length,) = struct.unpack_from("<I", data, end + 1)
            value, at = data[end + 5 : end + 5 + length], end + 5 + length
            if name.startswith("wrinkle:") and kind == b"string":
                labels[name[8:]] = value.decode("utf-8", "replace")
            elif name == "dataWindow":
                window = struct.unpack("<4i", value)
            elif name == "compression":
                compression = value[0]
        width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
        if not tiled:
            blocks = -(-height // _ROWS[compression])
            for offset in struct.unpack_from("<%dQ" % blocks, data, at + 1):
                if offset == 0 or offset + 8 + struct.unpack_from("<I", data, offset + 4)[0] > len(data):
                    raise ValueError
    except (IndexError, KeyError, TypeError, ValueError, struct.error):
        raise _damaged(path) from None
    return Map(path, labels, width, height, True)


def read_map(path):
    """The map in a file, PNG or EXR. An error if it cannot be read or is incomplete."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as why:
        raise WrinkleError("%s: cannot be read (%s)" % (path, why.strerror)) from None
    if data[:8] == b"\x89PNG\r\n\x1a\n":
        return _png(path, data)
    if data[:4] == b"v/1\x01":
        return _exr(path, data)
    if not data or path.endswith((".png", ".exr")):
        raise _damaged(path)
    raise WrinkleError("%s: neither PNG nor EXR" % path)


# ---- sets ----


def _of_receipts(path):
    """Paths of the files in a list of receipts (`wrinkle export --json`), one object a line."""
    found, here = [], os.path.dirname(path)
    try:
        with open(path, encoding="utf-8") as file:
            for line in filter(str.strip, file):
                name = os.path.join(here, json.loads(line)["file"])  # as written from here, or moved beside the list
                found.append(name if os.path.exists(name) else os.path.join(here, os.path.basename(name)))
    except OSError as why:
        raise WrinkleError("%s: cannot be read (%s)" % (path, why.strerror)) from None
    except (ValueError, KeyError, TypeError):
        raise WrinkleError("%s: not a list from `wrinkle export --json`" % path) from None
    return found


def _pictures(folder):
    try:
        names = sorted(os.listdir(folder))
    except OSError as why:
        raise WrinkleError("%s: cannot be read (%s)" % (folder, why.strerror)) from None
    return [os.path.join(folder, n) for n in names if not n.startswith(".") and NAMES.match(n)]


def read_set(path, name=None):
    """The set in a folder, around one of its files, or in a list of receipts."""
    one = None
    if path.endswith((".json", ".jsonl")):
        paths = _of_receipts(path)
    elif os.path.isdir(path):
        paths = _pictures(path)
    else:
        one, paths = read_map(path), _pictures(os.path.dirname(path) or ".")
    if one:
        name = one.cell
    if name:
        paths = [p for p in paths if NAMES.match(os.path.basename(p)).group("cell") == name]
    maps = [m for m in map(read_map, paths) if m.role]
    cells = sorted({m.cell for m in maps})
    if not cells:
        raise WrinkleError("%s: contains no maps from Wrinkle; export a set there" % path)
    if len(cells) > 1:
        raise WrinkleError("%s: contains maps of %s; choose a file of one of them" % (path, ", ".join(cells)))
    folder = os.path.dirname(maps[0].path)
    return MapSet(cells[0], folder, {m.role: m for m in maps})
