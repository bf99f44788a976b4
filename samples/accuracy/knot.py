#!/usr/bin/env python3
"""knot.py - writes knot.ply: a tube about a trefoil, 96 by 12 cells, with normals and texture coordinates."""
import math
import struct

AROUND, ACROSS, TUBE = 96, 12, 0.42


def centre(t):
    return (math.sin(t) + 2 * math.sin(2 * t), math.cos(t) - 2 * math.cos(2 * t), -1.2 * math.sin(3 * t))


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


points = []
for i in range(AROUND + 1):
    t = 2 * math.pi * (i % AROUND) / AROUND
    here, before, after = centre(t), centre(t - 1e-4), centre(t + 1e-4)
    along = unit([b - a for a, b in zip(before, after)])
    out = unit([a + b - 2 * c for a, b, c in zip(before, after, here)])  # towards the middle of its bend
    side = unit(cross(along, out))
    out = cross(side, along)
    for j in range(ACROSS + 1):
        a = 2 * math.pi * (j % ACROSS) / ACROSS
        n = [math.cos(a) * p - math.sin(a) * q for p, q in zip(out, side)]
        p = [c + TUBE * x for c, x in zip(here, n)]
        points.append((*p, *n, i / AROUND, j / ACROSS))
faces = []
for i in range(AROUND):
    for j in range(ACROSS):
        a = i * (ACROSS + 1) + j
        b = a + ACROSS + 1
        faces += [(a, b, b + 1), (a, b + 1, a + 1)]
with open("knot.ply", "wb") as out:
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "s", "t"))
    out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{names}"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
    for p in points:
        out.write(struct.pack("<8f", *p))
    for f in faces:
        out.write(struct.pack("<B3i", 3, *f))
