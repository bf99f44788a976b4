#!/usr/bin/env python3
"""stone.py - writes stone.ply, a hewn stone, and stone-cube.obj, the cube around it with (u,v) in three by two cells."""
import math
import random
import struct

FINE, COARSE = 32, 4
SIDES = [((0, 0, 1), (1, 0, 0), (0, 1, 0)), ((1, 0, 0), (0, 0, -1), (0, 1, 0)), ((0, 0, -1), (-1, 0, 0), (0, 1, 0)),
         ((-1, 0, 0), (0, 0, 1), (0, 1, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, -1)), ((0, -1, 0), (1, 0, 0), (0, 0, 1))]
chance = random.Random(7)
planes = []  # chips: unit normal and distance from the middle
for _ in range(60):
    n = [chance.gauss(0, 1) for _ in range(3)]
    length = math.sqrt(sum(x * x for x in n))
    n = [x / length for x in n]
    reach = sum(abs(x) for x in n)  # of the cube's corner
    planes.append((n, 0.86 + 0.62 * (reach - 1) * chance.uniform(0.85, 1.1)))
waves = [([chance.gauss(0, 7) for _ in range(3)], chance.uniform(0, 6.3)) for _ in range(24)]


def grid(count):
    """Points on the cube, each once, and quads of (point, side, i, j)."""
    points, faces = {}, []
    for side, (out, right, up) in enumerate(SIDES):
        def corner(i, j):
            a, b = 2 * i / count - 1, 2 * j / count - 1
            p = tuple(round(o + a * r + b * u, 9) for o, r, u in zip(out, right, up))
            return points.setdefault(p, len(points)), side, i, j
        faces += [[corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
                  for i in range(count) for j in range(count)]
    return list(points), faces


def hewn(p):
    near = sum(max(0, sum(a * b for a, b in zip(n, p)) / d) ** 80 for n, d in planes)  # rounds the edges a little
    far = (near + 0.93 ** -80) ** (-1 / 80)
    q = [x * far for x in p]
    rough = sum(math.sin(sum(a * b for a, b in zip(w, q)) + s) for w, s in waves) / len(waves)
    return [x * (1 + 0.03 * rough) for x in q]


points, faces = grid(FINE)
with open("stone.ply", "wb") as out:
    out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(faces)}\nproperty list uchar ushort vertex_indices\nend_header\n".encode())
    for p in points:
        out.write(struct.pack("<3f", *hewn(p)))
    for f in faces:
        out.write(struct.pack("<B4H", 4, *(c[0] for c in f)))

points, faces = grid(COARSE)
with open("stone-cube.obj", "w") as out:
    out.write("# a cube, written by stone.py\n")
    out.writelines("v %g %g %g\n" % p for p in points)
    places = {}
    for f in faces:
        for c in f:
            places.setdefault(c[1:], len(places) + 1)
    for side, i, j in places:
        u = (side % 3 + 0.04 + 0.92 * i / COARSE) / 3
        v = (side // 3 + 0.04 + 0.92 * j / COARSE) / 2
        out.write("vt %.6f %.6f\n" % (u, v))
    for f in faces:
        out.write("f %s\n" % " ".join(f"{c[0] + 1}/{places[c[1:]]}" for c in f))
