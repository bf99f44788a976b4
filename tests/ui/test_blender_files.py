"""The Blender add-on without Blender: reading of sets, the watcher's thread, command lines of the real program.
Environment: WRINKLE, the program; ADDON, the add-on's folder. Files are made in the current folder."""
import json
import math
import os
import py_compile
import struct
import subprocess
import sys
import threading
import time
import types
import unittest
import zlib

ADDON, WRINKLE = os.environ["ADDON"], os.environ["WRINKLE"]
package = types.ModuleType("wrinkle_blender")  # without its __init__, as Blender's modules are missing
package.__path__ = [ADDON]
sys.modules["wrinkle_blender"] = package
from wrinkle_blender import mapset, program, watch  # noqa: E402
from wrinkle_blender.program import WrinkleError  # noqa: E402

CELL = """table 37x22
dab 0.3,0.6 radius=9 strength=0.7
dab 0.7,0.3 radius=6 strength=-0.3
bump height=0.05
cell 240,130 mm=on height=4
"""


def write(name, text, mode="w"):
    with open(name, mode) as file:
        file.write(text)
    return name


def replace(name, text):
    os.rename(write(name + ".new", text), name)


def folder(name):
    os.makedirs(name)
    return name


def read(name, mode="r"):
    with open(name, mode) as file:
        return file.read()


def fake(name, text):
    write(name, "#!/bin/sh\n" + text)
    os.chmod(name, 0o755)
    return os.path.abspath(name)


def png_codes(path):
    """The codes of a grey PNG of 16 bits, decoded here: rows of numbers."""
    data, at, packed = read(path, "rb"), 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack_from(">IIBB", data, at + 8)
            assert (bits, colour) == (16, 0)
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + length]
        at += 12 + length
    raw, stride, rows, before = zlib.decompress(packed), 2 * width, [], bytes(2 * width)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (row[i - 2], before[i], before[i - 2]) if i > 1 else (0, before[i], 0)
            paeth = min((left, up, corner), key=lambda p: abs(left + up - corner - p))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        before = bytes(row)
        rows.append(struct.unpack(">%dH" % width, before))
    return rows


class Events:
    """A watcher whose news are collected."""

    def __init__(self, where, child=None):
        self.names, self.closed, self.news = set(), None, threading.Event()
        self.watcher = watch.Watcher(where, self.news.set, child)

    def wait(self, done):
        end = time.monotonic() + 60
        while not done(self) and time.monotonic() < end:
            self.news.wait(1)
            self.news.clear()
            names, closed = self.watcher.take()
            self.names |= names
            self.closed = self.closed or closed
        return done(self)


class Sources(unittest.TestCase):
    def test_every_file_compiles(self):
        for name in os.listdir(ADDON):
            if name.endswith(".py"):
                py_compile.compile(os.path.join(ADDON, name), cfile="compiled", doraise=True)


class Sets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        write("clay.wrinkle", CELL)
        lines = ["maps %s %s name=clay\n" % (kind, folder(kind)) for kind in ("blender", "unreal", "substance")]
        lines += ["maps blender-live %s name=%s\n" % (folder("both") if name == "a" else "both", name) for name in "ab"]
        plain = "table 9x7\ndab 0.5,0.5 radius=2\ncell 1,1 mm=off\nbump height=0.3\nmaps blender-live %s name=plain\n" % folder("plain")
        receipts = program.run([WRINKLE, "run", write("all.wrinkle", CELL + "".join(lines) + plain), "--json"])
        write("blender.jsonl", "".join(line + "\n" for line in receipts.splitlines() if '"blender/' in line))

    def test_floats_are_metres_without_a_middle(self):
        maps = mapset.read_set("blender")
        self.assertEqual((maps.name, sorted(maps.maps)), ("clay", ["height", "normal", "occlusion", "roughness"]))
        self.assertEqual([maps.get("height").width, maps.get("height").height], [37, 22])
        scale, middle = maps.relief()
        self.assertAlmostEqual(scale, 0.004, 12)
        self.assertEqual(middle, 0)
        for have, want in zip(maps.cell_size(), (0.24, 0.13)):
            self.assertAlmostEqual(have, want, 12)
        self.assertFalse(maps.get("normal").green_down())

    def test_codes_are_the_same_metres_as_floats(self):
        """Every texel of 16-bit heights, by scale and middle, against F from `inspect`."""
        points = [(i, j) for i in range(37) for j in (3, 9, 17)]
        at = "".join("%r,%r\n" % ((i + 0.5) / 37, 1 - (j + 0.5) / 22) for i, j in points)
        done = subprocess.run([WRINKLE, "inspect", "clay.wrinkle", "--do", "bump scheme=nearest", "--at", "-", "--json"], input=at,
                              capture_output=True, text=True, check=True)
        heights = [json.loads(line)["F"] / 0.05 * 0.004 for line in done.stdout.splitlines()]
        self.assertGreater(max(heights) - min(heights), 0.003)
        for kind in ("unreal", "substance"):
            maps = mapset.read_set(kind)
            scale, middle = maps.relief()
            codes = png_codes(maps.get("height").path)
            for (i, j), want in zip(points, heights):
                self.assertAlmostEqual(scale * (codes[j][i] / 65535 - middle), want, delta=1e-7)
            self.assertTrue(maps.get("normal").green_down())

    def test_scene_units_are_metres(self):
        self.assertAlmostEqual(mapset.read_set("plain").relief()[0], 0.3, 12)

    def test_receipts_and_single_files_name_the_same_set(self):
        whole = mapset.read_set("blender")
        for path in ("blender.jsonl", "blender/clay_ao.png"):
            maps = mapset.read_set(path)
            self.assertEqual({m.path for m in maps.maps.values()}, {m.path for m in whole.maps.values()})

    def test_two_sets_in_a_folder_need_a_choice(self):
        with self.assertRaisesRegex(WrinkleError, "contains maps of a, b; choose"):
            mapset.read_set("both")
        self.assertEqual(mapset.read_set("both", "b").name, "b")

    def test_incomplete_files_are_errors(self):
        for name in ("clay_displacement.exr", "clay_normal.png"):
            data = read("blender/" + name, "rb")
            for length in [0, 1, 7, 8, 40, 300, len(data) // 2, len(data) - 1]:
                write(name, data[:length], "wb")
                with self.assertRaises(WrinkleError, msg="%s: %d bytes" % (name, length)):
                    mapset.read_map(name)
            write(name, data, "wb")
            self.assertEqual(mapset.read_map(name).width, 37)

    def test_other_files_are_errors(self):
        for path, text in (("none", "cannot be read"), (folder("empty"), "contains no maps"), (write("x.json", "{}"), "not a list from")):
            with self.assertRaisesRegex(WrinkleError, text):
                mapset.read_set(path)


class Programs(unittest.TestCase):
    def test_the_real_program_fits(self):
        self.assertEqual(program.checked(WRINKLE), WRINKLE)

    def test_wrong_programs_are_one_sentence(self):
        cases = (
            ("echo wrinkle 0.0.9", "version 0.0.9; this add-on needs 0.1.0 or later"),
            ("echo wrinkle 2.1.0", "version 2.1.0; .* before 2.0.0"),
            ("echo something else", ": not Wrinkle"),
            ("echo", ": not Wrinkle"),
            ("echo 'p: error while loading shared libraries: libSDL2.so: not there' >&2; exit 127", "a library is missing .*libSDL2"),
            ("kill -SEGV $$", "ended by signal 11"),
        )
        for number, (text, sentence) in enumerate(cases):
            with self.assertRaisesRegex(WrinkleError, sentence) as caught:
                program.checked(fake("fake%d" % number, text))
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(WrinkleError, ": not a program"):
            program.checked("/nowhere/wrinkle")

    def test_the_programs_own_sentence_is_the_error(self):
        with self.assertRaisesRegex(WrinkleError, "^wrinkle: none.wrinkle: No such file"):
            program.run([WRINKLE, "export", "none.wrinkle", "--as", "blender", "-o", "."])

    def test_window_accepts_its_line(self):
        line = program.paint_line(WRINKLE, "clay.wrinkle", "maps", "HEIGHTS") + ["--help"]
        self.assertIn("--live FOLDER", program.run(line))

    def test_mesh_goes_and_comes_back_in_metres(self):
        """A square of 3 m x 2 m whose table is 1 everywhere rises by the height of 0.25 m."""
        write("a square.obj", "v 1 1 0\nv 4 1 0\nv 4 3 0\nv 1 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n")
        here = os.path.abspath(".")
        program.make_document(WRINKLE, program.mesh_script(here + "/a square.obj", here + "/m.exr", 33, 0.25), here)
        program.run([WRINKLE, "run", write("fill.wrinkle", "open m.exr\nfill 1\nsave m.exr\n")])
        program.run(program.solid_line(WRINKLE, "m.exr", "back.obj", 0.001))
        places = [[float(n) / 1000 for n in line.split()[1:4]] for line in read("back.obj").splitlines() if line.startswith("v ")]
        for axis, (low, high) in enumerate(((1, 4), (1, 3), (0.25, 0.25))):
            self.assertAlmostEqual(min(p[axis] for p in places), low, 5)
            self.assertAlmostEqual(max(p[axis] for p in places), high, 5)
        self.assertEqual([n for n in os.listdir(".") if n.startswith(".wrinkle_blender")], [])


class Watching(unittest.TestCase):
    def test_complete_files_are_reported_and_hidden_ones_are_not(self):
        events = Events(folder("one"))
        write("one/.a.png.part", "half")
        write("one/.list.together", "list")  # a set: nothing before its end
        os.rename("one/.a.png.part", "one/a.png")
        write("one/b.png", "b")
        time.sleep(0.2)
        self.assertEqual(events.watcher.take(), (set(), None))
        os.remove("one/.list.together")
        self.assertTrue(events.wait(lambda e: e.names == {"a.png", "b.png"}), events.names)
        events.watcher.stop()

    def test_a_waiting_thread_sleeps(self):
        events = Events(folder("idle"))
        status = "/proc/self/task/%d/status" % events.watcher._thread.native_id
        count = lambda: [line for line in read(status).splitlines() if "ctxt_switches" in line]
        time.sleep(0.2)
        before = count()
        time.sleep(0.5)
        self.assertEqual(count(), before)
        events.watcher.stop()

    def test_sets_of_the_real_program_arrive_whole(self):
        write("live.wrinkle", "table 40x30\n")
        events = Events(folder("live"), program.Child(program.watch_line(WRINKLE, "live.wrinkle", "live", "ALL")))
        names = {"live_" + n for n in ("displacement.exr", "normal.png", "ao.png", "roughness.png")}
        self.assertTrue(events.wait(lambda e: e.names == names), events.names)
        events.names = set()
        replace("live.wrinkle", "table 41x30\n")
        self.assertTrue(events.wait(lambda e: e.names))
        self.assertEqual(events.names, names)
        self.assertEqual({m.width for m in mapset.read_set("live").maps.values()}, {41})
        child = events.watcher.child
        events.watcher.stop(end_child=True)
        self.assertFalse(child.runs())

    def test_full_disk_is_the_programs_sentence(self):
        write("big.wrinkle", "table 300x300\nnoise perlin cells=9 octaves=6\n")
        limit = ["/bin/sh", "-c", 'ulimit -f 8; exec "$@"', "sh"]
        events = Events(folder("full"), program.Child(limit + program.watch_line(WRINKLE, "big.wrinkle", "full", "HEIGHTS")))
        self.assertTrue(events.wait(lambda e: e.closed))
        self.assertRegex(events.closed, "big_displacement.exr: cannot be written")
        self.assertEqual(os.listdir("full"), [])
        events.watcher.stop()

    def test_ends_have_reasons(self):
        events = Events(folder("gone"))
        os.rmdir("gone")
        self.assertTrue(events.wait(lambda e: e.closed))
        self.assertRegex(events.closed, "removed or moved")
        events.watcher.stop()
        for number, (text, reason) in enumerate((("exit 0", "^Wrinkle was closed$"), ("kill -SEGV $$", "signal 11"), ("echo why >&2; exit 3", "^why$"))):
            events = Events(folder("end%d" % number), program.Child([fake("ends%d" % number, text)]))
            self.assertTrue(events.wait(lambda e: e.closed))
            self.assertRegex(events.closed, reason)
            events.watcher.stop()
        with self.assertRaisesRegex(WrinkleError, "cannot be watched"):
            watch.Watcher("nowhere", lambda: None)

    def test_end_of_the_link_leaves_the_window(self):
        child = program.Child([fake("window", "while sleep 0.1; do echo painting >&2 || exit 9; done")])
        events = Events(folder("stays"), child)
        events.watcher.stop()
        time.sleep(0.5)
        self.assertTrue(child.runs())
        child.end()
        # a program that only exports ends with Blender, also when that is killed
        text = (
            "import os, sys\nsys.path.insert(0, %r)\nimport program\npid = program.Child(['/bin/sleep', '600'], True).pid\n"
            "while open('/proc/%%d/comm' %% pid).read() != 'sleep\\n': pass\nprint(pid, flush=True)\nos.kill(os.getpid(), 9)\n" % ADDON
        )
        pid = int(subprocess.run(["/usr/bin/python3", "-c", text], capture_output=True, text=True).stdout)
        end = time.monotonic() + 60
        gone = lambda: not os.path.exists("/proc/%d" % pid) or ") Z " in read("/proc/%d/stat" % pid)
        while not gone() and time.monotonic() < end:
            time.sleep(0.05)
        self.assertTrue(gone())
        files = len(os.listdir("/proc/self/fd"))
        for _ in range(5):
            Events("stays").watcher.stop()
        self.assertEqual(len(os.listdir("/proc/self/fd")), files)


if __name__ == "__main__":
    unittest.main(verbosity=1)
