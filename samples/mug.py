#!/usr/bin/env python3
"""mug.py - writes mug.obj: a body of revolution and a handle, each closed, in millimetres, z up."""
import math

AROUND, ALONG, ACROSS = 72, 32, 16
WALL = [(0, 0), (34, 0), (37, 1), (38.5, 4), (39, 10), (40, 50), (40, 88), (39.4, 90), (38.2, 91),
        (37, 90), (36.5, 88), (36.5, 50), (35.5, 10), (34.5, 6.5), (32, 5), (0, 5)]

points, body, handle = [], [], []
rings = []
for r, z in WALL:
    first = len(points) + 1
    if r == 0:
        points.append((0, 0, z))
        rings.append([first] * AROUND)
    else:
        points += [(r * math.cos(2 * math.pi * k / AROUND), r * math.sin(2 * math.pi * k / AROUND), z)
                   for k in range(AROUND)]
        rings.append([first + k for k in range(AROUND)])
for a, b in zip(rings, rings[1:]):
    for k in range(AROUND):
        n = (k + 1) % AROUND
        corners = list(dict.fromkeys((a[k], a[n], b[n], b[k])))
        body.append(corners)

rings = []
for i in range(ALONG + 1):  # half an ellipse from wall to wall, both ends inside of the wall
    t = math.pi * (i / ALONG - 0.5)
    x, z = 38 + 30 * math.cos(t), 47 + 30 * math.sin(t)
    rings.append([len(points) + 1 + k for k in range(ACROSS)])
    for k in range(ACROSS):
        a = 2 * math.pi * k / ACROSS
        out, side = 4.5 * math.cos(a), 7 * math.sin(a)
        points.append((x + out * math.cos(t), side, z + out * math.sin(t)))
for a, b in zip(rings, rings[1:]):
    for k in range(ACROSS):
        n = (k + 1) % ACROSS
        handle.append((a[k], a[n], b[n], b[k]))
handle += [rings[0][::-1], rings[-1]]

with open("mug.obj", "w") as out:
    out.write("# a mug, written by mug.py\n")
    out.writelines("v %.4g %.4g %.4g\n" % p for p in points)
    for name, faces in (("body", body), ("handle", handle)):
        out.write(f"g {name}\nusemtl {name}\n")
        out.writelines("f %s\n" % " ".join(map(str, f)) for f in faces)
