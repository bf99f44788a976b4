# SPDX-License-Identifier: MIT
"""Pixels of a layer as files of Wrinkle, and command lines of Wrinkle. Runs without Krita."""
import array
import json
import operator
import os
import re
import subprocess
import sys
from typing import NamedTuple

OLDEST = (0, 1, 0)     # version of Wrinkle
DOCUMENT = "layer.exr"  # the files of an exchange, in a folder of their own
HEIGHTS = "layer.raw"
RETURNED = "returned.r16", "returned.r32"
NORMALS = "normals.r16"

# Depth of Krita: type code of array, value of white, name in a sidecar.
DEPTHS = {"U8": ("B", 255, "u8"), "U16": ("H", 65535, "u16"), "F32": ("f", 1.0, "f32")}
# Model of Krita: the channels' places in a pixel, in the order grey or red, green, blue; alpha is last.
INTEGER_ORDER = {"GRAYA": (0,), "RGBA": (2, 1, 0)}
FLOAT_ORDER = {"GRAYA": (0,), "RGBA": (0, 1, 2)}


class WrinkleError(Exception):
    """What failed, in one sentence for the user."""


class Layer(NamedTuple):
    """The pixels of a layer, as Krita's Node.pixelData returns them."""
    width: int
    height: int
    model: str
    depth: str
    pixels: bytes


def _layout(model, depth):
    if depth not in DEPTHS or model not in INTEGER_ORDER:
        raise WrinkleError(f"The layer's colour space is {model} {depth}; expected grey or RGB with 8 or 16 bit "
                           "integers or 32 bit floats. Image > Convert Image Color Space converts it.")
    code, white, name = DEPTHS[depth]
    return code, white, name, (FLOAT_ORDER if depth == "F32" else INTEGER_ORDER)[model]


def _read_numbers(code, data):
    numbers = array.array(code)
    numbers.frombytes(data)
    return numbers


def _over_black(plane, alpha, white):
    """A half-transparent bump is half as high: transparent parts are at height 0."""
    if white == 1.0:
        return array.array(plane.typecode, map(operator.mul, plane, alpha))
    half = white // 2
    return array.array(plane.typecode, ((p * a + half) // white for p, a in zip(plane, alpha)))


def write_heights(folder, layer):
    """Write a layer as numbers that Wrinkle reads; three channels where the colours are not grey."""
    code, white, name, order = _layout(layer.model, layer.depth)
    numbers = _read_numbers(code, layer.pixels)
    across = len(order) + 1
    alpha = numbers[across - 1::across]
    planes = [numbers[place::across] for place in order]
    if all(plane == planes[0] for plane in planes):
        planes = planes[:1]
    if alpha.count(white) != len(alpha):
        planes = [_over_black(plane, alpha, white) for plane in planes]
    out = planes[0]
    if len(planes) > 1:
        out = array.array(code, bytes(len(planes) * len(alpha) * numbers.itemsize))
        for place, plane in enumerate(planes):
            out[place::len(planes)] = plane
    sidecar = {"width": layer.width, "height": layer.height, "channels": len(planes), "type": name,
               "endian": sys.byteorder}
    with open(os.path.join(folder, HEIGHTS), "wb") as file:
        out.tofile(file)
    with open(os.path.join(folder, HEIGHTS + ".json"), "w", encoding="utf-8") as file:
        json.dump(sidecar, file)


def _read_file(folder, name, layer):
    with open(os.path.join(folder, name + ".json"), encoding="utf-8") as file:
        about = json.load(file)
    if (about["width"], about["height"]) != (layer.width, layer.height):
        raise WrinkleError(f"The table in Wrinkle is now {about['width']}x{about['height']}, the layer "
                           f"{layer.width}x{layer.height}. Resize the table in Wrinkle, and save again.")
    with open(os.path.join(folder, name), "rb") as file:
        return _read_numbers("f" if name.endswith("r32") else "H", file.read())


def _pixels(planes, model, depth):
    """Krita's pixels from grey, or from red, green and blue; opaque."""
    code, white, _, order = _layout(model, depth)
    if code == "B":
        nearest = bytes((c + 128) // 257 for c in range(65536))
        planes = [array.array("B", map(nearest.__getitem__, plane)) for plane in planes]
    elif code == "f" and planes[0].typecode == "H":
        planes = [array.array("f", (c / 65535 for c in plane)) for plane in planes]
    across = len(order) + 1
    out = array.array(code, [white]) * (across * len(planes[0]))
    for channel, place in enumerate(order):
        out[place::across] = planes[channel % len(planes)]
    return out.tobytes()


def read_heights(folder, layer):
    """The pixels of the returned heights, in the layer's colour space."""
    name = RETURNED[layer.depth == "F32"]
    return _pixels([_read_file(folder, name, layer)], layer.model, layer.depth)


def read_normals(folder, layer):
    """The pixels of the normal map, RGB in the layer's depth."""
    numbers = _read_file(folder, NORMALS, layer)
    return _pixels([numbers[channel::3] for channel in range(3)], "RGBA", layer.depth)


# ---- command lines ----

def _run(program, arguments, folder=None):
    """Run Wrinkle without a window; return what it printed."""
    try:
        done = subprocess.run([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, encoding="utf-8", errors="replace", check=False)
    except OSError as error:
        raise WrinkleError(f"{program} cannot be started: {error.strerror}. Install Wrinkle, or choose the "
                           "program wrinkle.") from error
    if done.returncode != 0:
        raise WrinkleError(failure(done.returncode, done.stderr))
    return done.stdout


def failure(status, words):
    """The sentence for a run of Wrinkle that ended with an error."""
    words = words.strip() or "It printed no message."
    return f"Wrinkle ended with status {status}:\n{words}"


def check_version(program):
    printed = _run(program, ["--version"])
    found = re.match(r"wrinkle (\d+)\.(\d+)\.(\d+)", printed)
    if not found:
        raise WrinkleError(f"{program} is another program: `--version` printed \"{printed.strip()[:80]}\", "
                           "expected \"wrinkle\" and its version. Choose the program wrinkle.")
    if tuple(map(int, found.groups())) < OLDEST:
        raise WrinkleError(f"{program} is version {'.'.join(found.groups())}; this plugin needs "
                           f"{'.'.join(map(str, OLDEST))} or newer. Install a newer Wrinkle.")


def make_document(program, folder):
    """Turn the written heights into the document that the window opens and saves."""
    script = os.path.join(folder, "layer.wrinkle")
    with open(script, "w", encoding="utf-8") as file:
        file.write(f"image {HEIGHTS}\nsave {DOCUMENT}\n")
    _run(program, ["run", script], folder)


def paint(folder):
    """Arguments that open the window."""
    return ["paint", os.path.join(folder, DOCUMENT)]


def export_heights(program, folder, depth):
    """Write the saved document's heights for read_heights."""
    coding = ["depth=32"] if depth == "F32" else ["range=0,1", "depth=16"]
    _run(program, ["export", DOCUMENT, "--as", "height", *coding, f"endian={sys.byteorder}", "-o",
                   RETURNED[depth == "F32"]], folder)


def export_normals(program, folder, layer, kind, height):
    """Write the normal map of the written heights for read_normals.

    kind    normal+y: green is up; normal-y: green is down
    height  of white above black, in widths of the layer"""
    _run(program, ["export", HEIGHTS, "--do", f"bump height={height!r}", "--as", kind,
                   f"cell=1,{layer.height / layer.width!r}", "depth=16", f"endian={sys.byteorder}", "-o", NORMALS],
         folder)
