"""Run by kritarunner: layers of every colour space go through the plugin, Krita's pixels and the program."""
import os
import random
import struct
import tempfile
import traceback

from krita import Krita
from wrinkle_krita import exchange, extension

PROGRAM = os.environ["WRINKLE_PROGRAM"]
WIDTH, HEIGHT = 19, 13
CODES = {"U8": ("B", 255), "U16": ("H", 65535), "F32": ("f", 1.0)}


def check(model, depth):
    code, white = CODES[depth]
    chance = random.Random(depth)
    document = Krita.instance().createDocument(WIDTH, HEIGHT, "heights", model, depth, "", 72.0)
    node = document.topLevelNodes()[0]
    packed = b""
    for _ in range(WIDTH * HEIGHT):
        grey = chance.uniform(-2, 3) if depth == "F32" else chance.randint(0, white)
        packed += struct.pack(f"={2 if model == 'GRAYA' else 4}{code}",
                              *[grey] * (1 if model == "GRAYA" else 3), white)
    node.setPixelData(packed, 0, 0, WIDTH, HEIGHT)
    layer = exchange.Layer(WIDTH, HEIGHT, node.colorModel(), node.colorDepth(),
                           bytes(node.pixelData(0, 0, WIDTH, HEIGHT)))
    assert (layer.model, layer.depth, layer.pixels) == (model, depth, packed)
    with tempfile.TemporaryDirectory() as folder:
        exchange.write_heights(folder, layer)
        exchange.make_document(PROGRAM, folder)
        exchange.export_heights(PROGRAM, folder, depth)
        pixels = exchange.read_heights(folder, layer)
    made = node.duplicate()
    extension.add_above(document, node, made, "returned", pixels, layer)
    assert [n.name() for n in document.topLevelNodes()] == [node.name(), "returned"]
    assert bytes(document.topLevelNodes()[1].pixelData(0, 0, WIDTH, HEIGHT)) == packed
    document.close()


def __main__(_arguments):
    with open(os.environ["KRITA_RESULT"], "w", encoding="utf-8") as result:
        try:
            assert [e.objectName() for e in Krita.instance().extensions()
                    if isinstance(e, extension.WrinkleExtension)], "the extension is not registered"
            for model in ("GRAYA", "RGBA"):
                for depth in CODES:
                    check(model, depth)
                    print(model, depth, "comes back", file=result)
            print("passed", file=result)
        except Exception: # the runner would only print it
            traceback.print_exc(file=result)
