"""The Python package against an installed copy: values known from formulas, errors, callbacks, types, the samples."""

import os
import pathlib
import subprocess
import sys
import threading
import unittest

import numpy as np
import wrinkle

SOURCE = pathlib.Path(os.environ["WRINKLE_SOURCE"])


def wave(width, height):
    u = (np.arange(width) + 0.5) / width
    v = 1 - (np.arange(height) + 0.5) / height
    return np.outer(np.cos(2 * np.pi * v), np.sin(2 * np.pi * 3 * u))


class Arrays(unittest.TestCase):
    def test_heights_come_back_to_the_bit(self):
        doc = wrinkle.Document(37, 53)
        given = wave(37, 53).astype(np.float32)
        doc.heights = given
        self.assertTrue(np.array_equal(doc.heights, given))
        doc.heights = np.asfortranarray(given[:, ::-1])  # negative and transposed strides
        self.assertTrue(np.array_equal(doc.heights, given[:, ::-1]))
        doc.undo(2)
        self.assertEqual(float(np.abs(doc.heights).max()), 0)
        doc.heights = wave(64, 20)
        self.assertEqual(doc.size, (64, 20))

    def test_slopes_and_normals_are_those_of_the_wave(self):
        doc = wrinkle.Document(200, 160)
        doc.heights = wave(200, 160)
        doc.bump(height=0.05, scheme="bspline-fit")
        u = (np.arange(200) + 0.5) / 200
        v = 1 - (np.arange(160) + 0.5) / 160
        p = 0.05 * 6 * np.pi * np.outer(np.cos(2 * np.pi * v), np.cos(6 * np.pi * u))
        q = -0.05 * 2 * np.pi * np.outer(np.sin(2 * np.pi * v), np.sin(6 * np.pi * u))
        self.assertLess(np.abs(doc.slopes[..., 0] - p).max(), 1e-3)
        self.assertLess(np.abs(doc.slopes[..., 1] - q).max(), 1e-3)
        n = np.stack([-p, -q, np.ones_like(p)], axis=2)
        n /= np.linalg.norm(n, axis=2, keepdims=True)
        self.assertLess(np.abs(doc.normals - n).max(), 1e-3)
        codes = doc.map("normal+y", dtype=np.uint16)
        self.assertLessEqual(np.abs(codes - 65535 * (n / 2 + 0.5)).max(), 65535 * 5e-4 + 1)

    def test_samples_at_any_shape(self):
        doc = wrinkle.Document(192, 160)
        doc.heights = wave(192, 160)
        uv = np.random.default_rng(5).random((7, 3, 2))
        got = doc.sample(uv, "bspline-fit")
        self.assertEqual(got.f.shape, (7, 3))
        true = np.cos(2 * np.pi * uv[..., 1]) * np.sin(6 * np.pi * uv[..., 0])
        self.assertLess(np.abs(got.f - true).max(), 1e-4)

    def test_pictures(self):
        doc = wrinkle.Document(64, 64)
        image, linear = doc.render(40, 30), doc.render(40, 30, dtype=np.float32)
        self.assertEqual((image.shape, linear.shape), ((30, 40, 4), (30, 40, 4)))
        self.assertTrue(((image[..., 3] == 0) == (linear[..., 3] == 0)).all())
        self.assertEqual(doc.render(8, 8, channels=3).shape, (8, 8, 3))

    def test_solid_in_memory(self):
        data = wrinkle.Document(24, 24).export_bytes("stl", "a.stl", size=50)
        self.assertEqual(len(data), 84 + 50 * int.from_bytes(data[80:84], "little"))


class Commands(unittest.TestCase):
    def test_every_verb_is_a_method(self):
        for name, command in wrinkle.commands.items():
            method = getattr(wrinkle.Document, name.replace("-", "_"))
            self.assertTrue(method.__doc__, name)
            self.assertIn(command["help"].split()[0], getattr(wrinkle._verbs.Verbs, name.replace("-", "_")).__doc__)

    def test_values_become_words(self):
        doc = wrinkle.Document(64, 48)
        doc.stroke(points=np.array([[0.1, 0.2, 0.5], [0.8, 0.7, 1]]), radius=6, buildup=True)
        doc.grid(cells=(4, 3), width=2)
        doc.layer("add", "a \"b\" c", from_="noise perlin cells=5")
        doc.layer("set", 2, opacity=0.5, visible=False)
        self.assertEqual(doc.history[1:3], ["stroke points=0.1,0.2,0.5;0.8,0.7,1 radius=6 buildup=on",
                                            "grid cells=4x3 width=2"])
        layer = doc.layers[1]
        self.assertEqual((layer.name, layer.opacity, layer.visible), ("a \"b\" c", 0.5, False))
        self.assertIn("cells=5", layer.line)

    def test_groups(self):
        doc = wrinkle.Document(30, 20)
        doc.fill(0.25)
        for height in (1, 2):
            doc.layer("add")
            doc.fill(height)
        doc.layer("group", "both", of="2,3")
        doc.layer("set", "both", opacity=0.5)
        self.assertEqual([(x.group, x.depth) for x in doc.layers], [(False, 0), (False, 1), (False, 1), (True, 0)])
        self.assertTrue((doc.layer_heights(3) == 3).all())
        self.assertTrue((doc.heights == 1.75).all())

    def test_errors_are_exceptions_with_the_programs_words(self):
        doc = wrinkle.Document(16, 16)
        before = doc.hash
        for call in (lambda: doc.bump(hieght=1), lambda: doc.run("bump hieght=1")):
            with self.assertRaisesRegex(wrinkle.Error, "did you mean height="):
                call()
        with self.assertRaisesRegex(wrinkle.Error, "did you mean bricks"):
            doc.pattern("brics")
        with self.assertRaisesRegex(wrinkle.Error, "missing.exr"):
            wrinkle.open("missing.exr")
        with self.assertRaisesRegex(wrinkle.Error, "dimensions"):
            doc.heights = np.zeros((2, 2, 3))
        with self.assertRaisesRegex(wrinkle.Error, "v9"):
            wrinkle.Document(instruction_set="v9")
        self.assertEqual(doc.hash, before)

    def test_files(self):
        doc = wrinkle.Document(40, 30)
        doc.noise("perlin", cells=4)
        doc.save("a.exr")
        self.assertEqual(wrinkle.open("a.exr").hash, doc.hash)
        doc.export("height", "h.png", depth=16)
        self.assertTrue(pathlib.Path("h.png").stat().st_size > 100)
        doc.render(32, 32)


class Callbacks(unittest.TestCase):
    def test_notes(self):
        heard = []
        doc = wrinkle.Document(16, 16, note=heard.append)
        doc.heights = np.array([[np.nan, 1], [2, 3]])
        self.assertTrue(any("finite" in text for text in heard), heard)

    def test_progress_cancels_and_raises(self):
        doc = wrinkle.Document(512, 512, progress=lambda done: done < 0.3)
        before = doc.hash
        with self.assertRaises(wrinkle.Cancelled):
            doc.noise("perlin", cells=64, octaves=8)
        self.assertEqual(doc.hash, before)

        def fail(done):
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            wrinkle.Document(512, 512, progress=fail).noise("perlin", cells=64, octaves=8)

    def test_snapshot_in_a_thread(self):
        doc = wrinkle.Document(128, 96)
        doc.noise("perlin", cells=5)
        then = doc.heights
        snapshot, got = doc.snapshot(), []
        thread = threading.Thread(target=lambda: got.extend([snapshot.heights, snapshot.render(50, 50)]))
        thread.start()
        doc.fill(0)
        thread.join()
        self.assertTrue(np.array_equal(got[0], then))
        with self.assertRaises(wrinkle.Error):
            snapshot.fill(1)


class Samples(unittest.TestCase):
    def run_sample(self, name, *words):
        subprocess.run([sys.executable, SOURCE / "samples/python" / name, *words], check=True)

    def test_batch(self):
        self.run_sample("batch.py", "cells", "32")
        rows = pathlib.Path("cells/cells.csv").read_text().splitlines()
        self.assertEqual((len(rows), len(list(pathlib.Path("cells").glob("*.png")))), (101, 100))

    def test_data_set(self):
        self.run_sample("normals_data_set.py", "data", "3", "64")
        for path in pathlib.Path("data").glob("*.npz"):
            data = np.load(path)
            lambert = (data["normals"] @ data["light"]).clip(0)[4:-4, 4:-4]
            linear = ((data["image"][4:-4, 4:-4, 1] / 255 + 0.055) / 1.055) ** 2.4
            self.assertGreater(np.corrcoef(lambert.ravel(), linear.ravel())[0, 1], 0.99, path)

    def test_scipy_and_matplotlib(self):
        try:
            import matplotlib  # noqa: F401
            import scipy  # noqa: F401
        except ImportError:
            self.skipTest("scipy and matplotlib are not installed")
        self.run_sample("from_scipy.py", "leather.exr", "96")
        self.assertEqual(wrinkle.open("leather.exr").layers[1].name, "title")
        self.run_sample("error_against_time.py", "error.png", "2000")


class Types(unittest.TestCase):
    def test_types_are_those_of_the_commands(self):
        made = subprocess.run([sys.executable, "-P", SOURCE / "src/api/python/make_stub.py"], check=True, capture_output=True, text=True)
        kept = (SOURCE / "src/api/python/wrinkle/_verbs.pyi").read_text()
        self.assertEqual(made.stdout, kept, "run src/api/python/make_stub.py again")


if __name__ == "__main__":
    unittest.main()
