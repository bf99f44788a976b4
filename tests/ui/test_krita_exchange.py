"""The Krita plugin's files and command lines, with the program and without Krita.

    test_krita_exchange.py PROGRAM PLUGIN-FOLDER"""
import importlib.util
import os
import random
import struct
import sys
import tempfile
import unittest

PROGRAM, PLUGIN = os.path.abspath(sys.argv[1]), sys.argv[2]
spec = importlib.util.spec_from_file_location("exchange", os.path.join(PLUGIN, "exchange.py"))
exchange = importlib.util.module_from_spec(spec)
spec.loader.exec_module(exchange)
WIDTH, HEIGHT = 37, 23
CODES = {"U8": "B", "U16": "H", "F32": "f"}
WHITE = {"U8": 255, "U16": 65535, "F32": 1.0}


def layer(model, depth, pixels):
    """pixels: (red, green, blue, alpha) or (grey, alpha), packed as Krita does: blue first where codes are integers."""
    def order(pixel):
        if model == "RGBA" and depth != "F32":
            return pixel[2], pixel[1], pixel[0], pixel[3]
        return pixel
    packed = b"".join(struct.pack(f"={len(p)}{CODES[depth]}", *order(p)) for p in pixels)
    return exchange.Layer(WIDTH, HEIGHT, model, depth, packed)


def unpack(model, depth, data):
    return list(struct.iter_unpack(f"={2 if model == 'GRAYA' else 4}{CODES[depth]}", data))


class Exchange(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.random = random.Random(19)

    def there_and_back(self, sent):
        exchange.write_heights(self.folder, sent)
        exchange.make_document(PROGRAM, self.folder)
        exchange.export_heights(PROGRAM, self.folder, sent.depth)
        return exchange.read_heights(self.folder, sent)

    def greys(self, depth):
        if depth == "F32":
            return [struct.unpack("f", struct.pack("f", self.random.uniform(-3, 7)))[0] for _ in range(WIDTH * HEIGHT)]
        return [self.random.randint(0, WHITE[depth]) for _ in range(WIDTH * HEIGHT)]

    def test_every_value_comes_back(self):
        for depth in ("U8", "F32"):
            with self.subTest(depth=depth):
                sent = layer("GRAYA", depth, [(g, WHITE[depth]) for g in self.greys(depth)])
                self.assertEqual(self.there_and_back(sent), sent.pixels)

    def test_grey_colours_are_one_channel(self):
        greys = self.greys("U16")
        exchange.write_heights(self.folder, layer("RGBA", "U16", [(g, g, g, 65535) for g in greys]))
        with open(os.path.join(self.folder, "layer.raw"), "rb") as file:
            self.assertEqual(file.read(), struct.pack(f"={len(greys)}H", *greys))

    def test_colours_become_luma_and_transparency_height_zero(self):
        colours = [tuple(self.random.randint(0, 65535) for _ in range(4)) for _ in range(WIDTH * HEIGHT)]
        back = unpack("RGBA", "U16", self.there_and_back(layer("RGBA", "U16", colours)))
        for (r, g, b, a), found in zip(colours, back):
            luma = (0.2126 * r + 0.7152 * g + 0.0722 * b) * a / 65535
            self.assertEqual(found, (found[0],) * 3 + (65535,))
            self.assertLessEqual(abs(found[0] - luma), 1.5) # a rounding of each product, and of the sum

    def test_normals_of_a_ramp(self):
        """One that rises to the right by 1/2 of white over the width, between the seams."""
        ramp = [(round(65535 * x / (2 * WIDTH)), 65535) for _ in range(HEIGHT) for x in range(WIDTH)]
        sent = layer("GRAYA", "U16", ramp)
        exchange.write_heights(self.folder, sent)
        exchange.export_normals(PROGRAM, self.folder, sent, "normal+y", 0.3)
        blue, green, red, alpha = unpack("RGBA", "U16", exchange.read_normals(self.folder, sent))[11 * WIDTH + 18]
        length = (0.15 ** 2 + 1) ** 0.5
        for found, expected in ((red, -0.15 / length), (green, 0), (blue, 1 / length)):
            self.assertAlmostEqual(found / 65535 * 2 - 1, expected, delta=1e-3) # codes of the ramp are whole
        self.assertEqual(alpha, 65535)

    def program(self, text):
        path = os.path.join(self.folder, "program")
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + text)
        os.chmod(path, 0o755)
        return path

    def refused(self, words, action, *arguments):
        with self.assertRaises(exchange.WrinkleError) as caught:
            action(*arguments)
        self.assertIn(words, str(caught.exception))

    def test_errors_are_sentences(self):
        exchange.check_version(PROGRAM)
        self.refused("No such file", exchange.check_version, "/no/such/wrinkle")
        self.refused("version 0.0.9; this plugin needs 0.1.0", exchange.check_version, self.program("echo wrinkle 0.0.9"))
        self.refused("another program", exchange.check_version, self.program("echo GIMP 2.10"))
        self.refused("disk is full", exchange.make_document, self.program("echo disk is full >&2; exit 1"), self.folder)
        self.refused("CMYKA U8", exchange.write_heights, self.folder, exchange.Layer(1, 1, "CMYKA", "U8", b"12345"))

    def test_a_resized_table_is_refused(self):
        sent = layer("GRAYA", "U8", [(7, 255)] * (WIDTH * HEIGHT))
        exchange.write_heights(self.folder, sent)
        os.rename(os.path.join(self.folder, "layer.raw.json"), os.path.join(self.folder, "returned.r16.json"))
        self.refused("Resize the table", exchange.read_heights, self.folder, sent._replace(width=36))


unittest.main(argv=sys.argv[:1])
