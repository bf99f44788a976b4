#!/usr/bin/env python3
"""models.py - writes the stock models NAME.ply of this folder: about 2 units across, y up, quads without normals.

Texture coordinates come from box projection (src/scene/stock_model.c), so the files hold positions and faces alone."""
import math
import os
import struct

HERE = os.path.dirname(os.path.abspath(__file__))


class Mesh:
    def __init__(self):
        self.points, self.faces = [], []

    def grid(self, rows, closed):
        """Faces between neighbouring rows of points; a row of one point is a pole. Counterclockwise from outside for
        rows that go up and around the y axis from x towards -z."""
        index = []
        for row in rows:
            index.append(range(len(self.points), len(self.points) + len(row)))
            self.points += row
        around = max(len(row) for row in rows)
        for low, high in zip(index, index[1:]):
            for k in range(around if closed else around - 1):
                corners = [low[k % len(low)], low[(k + 1) % len(low)], high[(k + 1) % len(high)], high[k % len(high)]]
                corners = list(dict.fromkeys(corners))
                if len(corners) > 2:
                    self.faces.append(corners)

    def write(self, name):
        """Binary PLY: 12 bytes a point, 2 bytes a corner. Points of equal place become one."""
        place, index, kept = {}, [], []
        for p in self.points:
            key = tuple(round(x, 5) for x in p)
            if key not in place:
                place[key] = len(kept)
                kept.append(key)
            index.append(place[key])
        faces = [list(dict.fromkeys(index[i] for i in face)) for face in self.faces]
        faces = [face for face in faces if len(face) > 2]
        with open(os.path.join(HERE, name + ".ply"), "wb") as out:
            out.write((f"ply\nformat binary_little_endian 1.0\ncomment {name}, written by models.py\n"
                       f"element vertex {len(kept)}\nproperty float x\nproperty float y\nproperty float z\n"
                       f"element face {len(faces)}\nproperty list uchar ushort vertex_indices\nend_header\n").encode())
            for p in kept:
                out.write(struct.pack("<3f", *p))
            for face in faces:
                out.write(struct.pack(f"<B{len(face)}H", len(face), *face))


def lathe(mesh, profile, around, radius=lambda r, y, angle: r):
    """Turns (r, y) about the y axis, from bottom to top of the outside."""
    rows = []
    for r, y in profile:
        if r < 1e-9:
            rows.append([(0.0, y, 0.0)])
            continue
        row = []
        for k in range(around):
            angle = 2 * math.pi * k / around
            rr = radius(r, y, angle)
            row.append((rr * math.cos(angle), y, -rr * math.sin(angle)))
        rows.append(row)
    mesh.grid(rows, True)


def arc(r, y, radius, start, end, steps):
    """Points of an arc about (r, y); degrees, 0 outwards, 90 up."""
    angles = [math.radians(start + (end - start) * k / steps) for k in range(steps + 1)]
    return [(max(r + radius * math.cos(a), 0.0), y + radius * math.sin(a)) for a in angles]


def box(mesh, half, edge, fine):
    """A box of these half sides with round edges of this radius: a grid on each face, pushed out from the inner box."""
    inner = [h - edge for h in half]

    def place(direction):
        core = [min(max(d, -i), i) for d, i in zip(direction, inner)]
        away = [d - c for d, c in zip(direction, core)]
        far = math.hypot(*away) or 1.0
        return tuple(c + edge * a / far for c, a in zip(core, away))

    def ticks(axis):
        """From side to side: steps of equal angle on the edges, one span between."""
        bend = [edge * math.tan(math.radians(45 * k / fine)) for k in range(fine + 1)]
        return [-inner[axis] - b for b in reversed(bend)] + [inner[axis] + b for b in bend]

    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1, 1):
            rows = []
            for v in ticks(two):
                row = []
                for u in ticks(one) if side > 0 else reversed(ticks(one)):
                    point = [0.0, 0.0, 0.0]
                    point[axis], point[one], point[two] = side * half[axis], u, v
                    row.append(place(point))
                rows.append(row)
            mesh.grid(rows, False)


def shader_ball():
    """A ball with a groove and a recessed band, on a foot with rounded edges."""
    mesh = Mesh()
    foot = [(0, -1.3)] + arc(0.78, -1.25, 0.05, -90, 90, 6) + arc(0.62, -1.12, 0.08, 270, 180, 5)
    foot += [(0.5, -1.0)] + arc(0.4, -0.9, 0.05, 0, 90, 4) + [(0, -0.85)]
    lathe(mesh, foot, 64)
    ball = arc(0, 0, 1, -90, -9, 22) + [(0.97, -0.14)] + arc(0, 0, 0.93, -8, 8, 6)
    ball += [(0.97, 0.14)] + arc(0, 0, 1, 9, 90, 22)
    lathe(mesh, ball, 72)
    mesh.write("shader-ball")


def rounded_cube():
    mesh = Mesh()
    box(mesh, (0.8, 0.8, 0.8), 0.22, 6)
    mesh.write("rounded-cube")


def tile():
    mesh = Mesh()
    box(mesh, (1.0, 1.0, 0.09), 0.05, 4)
    mesh.write("tile")


def wall():
    """A free-standing piece of wall with sharp edges."""
    mesh = Mesh()
    box(mesh, (1.25, 1.0, 0.25), 0.03, 3)
    mesh.write("wall")


def coin():
    """A disc with a raised rim and a reeded edge; its faces look along z."""
    mesh = Mesh()
    half = [(0, 0.055), (0.86, 0.055)]
    half += [(0.89, 0.06), (0.905, 0.085), (0.93, 0.1), (0.97, 0.1), (0.99, 0.092), (1.0, 0.075)]
    profile = [(r, -y) for r, y in half] + [(r, y) for r, y in reversed(half)]
    lathe(mesh, profile, 240, lambda r, y, a: r - (0.012 * (1 - math.cos(120 * a)) / 2 if r > 0.999 else 0))
    mesh.points = [(x, -z, y) for x, y, z in mesh.points]
    mesh.write("coin")


def column():
    """Base, fluted shaft with a slight swelling, capital with a square slab."""
    mesh = Mesh()
    base = [(0, -1.5), (0.62, -1.5)] + arc(0.56, -1.42, 0.08, -90, 90, 8) + [(0.53, -1.34)]
    base += arc(0.56, -1.27, 0.05, 250, 110, 5) + arc(0.5, -1.16, 0.06, -90, 90, 7) + [(0.45, -1.1)]
    shaft = [(0.45 - 0.07 * t ** 1.7, -1.1 + 2.1 * t) for t in (k / 10 for k in range(11))]
    neck = arc(0.4, 1.04, 0.035, -90, 90, 6) + [(0.39, 1.075), (0.4, 1.12)]
    neck += [(0.43, 1.18), (0.49, 1.24), (0.56, 1.27), (0.56, 1.3), (0, 1.3)]
    flutes = 20

    def radius(r, y, angle):
        inside = min(max((y + 1.08) / 0.06, 0.0), 1.0) * min(max((0.98 - y) / 0.06, 0.0), 1.0)
        return r * (1 - 0.07 * inside * abs(math.sin(flutes * angle / 2)) ** 0.7)

    lathe(mesh, base + shaft[:1] + [(0.45, -1.05)] + shaft[1:-1] + [(0.383, 0.94)] + shaft[-1:] + neck, 160, radius)
    slab = Mesh()
    box(slab, (0.6, 0.08, 0.6), 0.02, 2)
    first = len(mesh.points)
    mesh.points += [(x, y + 1.37, z) for x, y, z in slab.points]
    mesh.faces += [[i + first for i in face] for face in slab.faces]
    mesh.points = [(1.1 * x, 0.8 * y, 1.1 * z) for x, y, z in mesh.points]
    mesh.write("column")


def mug():
    mesh = Mesh()
    wall_profile = [(0, -1), (0.74, -1)] + arc(0.74, -0.9, 0.1, -90, 0, 6) + [(0.86, -0.5), (0.88, 0.2), (0.88, 0.93)]
    wall_profile += arc(0.835, 0.955, 0.045, 0, 180, 8) + [(0.79, 0.2), (0.77, -0.5), (0.75, -0.72)]
    wall_profile += arc(0.62, -0.76, 0.12, 0, -90, 5) + [(0, -0.88)]
    lathe(mesh, wall_profile, 72)
    rows = []
    for i in range(29):
        t = math.pi * (i / 28 - 0.5)
        x, y = 0.83 + 0.62 * math.cos(t), 0.02 + 0.6 * math.sin(t)
        row = []
        for k in range(16):
            a = 2 * math.pi * k / 16
            out, side = 0.1 * math.cos(a), 0.15 * math.sin(a)
            row.append((x + out * math.cos(t), y + out * math.sin(t), -side))
        rows.append(row)
    mesh.grid(rows, True)
    mesh.write("mug")


def teapot():
    """Newell's patches (samples/teapot.bpt), eight by eight quads each, with a bottom; rim to rim 2 units."""
    mesh = Mesh()
    with open(os.path.join(HERE, "..", "samples", "teapot.bpt")) as text:
        numbers = [float(w) for line in text if not line.startswith("#") for w in line.split()]
    count, at, fine = int(numbers[0]), 1, 8
    for _ in range(count):
        assert numbers[at] == 3 and numbers[at + 1] == 3
        at += 2
        p = [numbers[at + 3 * k:at + 3 * k + 3] for k in range(16)]
        at += 48

        def point(u, v):
            bu = [(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u * u * (1 - u), u ** 3]
            bv = [(1 - v) ** 3, 3 * v * (1 - v) ** 2, 3 * v * v * (1 - v), v ** 3]
            x, y, z = (sum(bv[j] * bu[i] * p[4 * j + i][c] for j in range(4) for i in range(4)) for c in range(3))
            return (x * 0.5, z * 0.5 - 0.75, -y * 0.5)
        mesh.grid([[point(i / fine, j / fine) for i in range(fine + 1)] for j in range(fine + 1)], False)
    mesh.write("teapot")


def cloth(side=57, steps=700):
    """A square cloth that fell over a ball onto the floor: points, springs to neighbours and beyond, Verlet steps."""
    import numpy as np
    n = side
    u, v = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    turn = math.radians(28)
    size = 1.75
    p = np.stack([size * (u * math.cos(turn) - v * math.sin(turn)), np.full_like(u, 0.75) + 0.002 * np.sin(9 * u + 5 * v),
                  size * (u * math.sin(turn) + v * math.cos(turn))], axis=-1)
    old, rest = p.copy(), 2 * size / (n - 1)
    pairs = [((1, 0), 1.0), ((0, 1), 1.0), ((1, 1), 0.7), ((1, -1), 0.7), ((3, 0), 0.35), ((0, 3), 0.35)]
    centre, radius, floor = np.array([0.0, -0.05, 0.0]), 0.72, -0.75
    for _ in range(steps):
        new = p + 0.985 * (p - old)
        new[..., 1] -= 0.00035
        old, p = p, new
        for _ in range(14):
            for (di, dj), stiff in pairs:
                length = rest * math.hypot(di, dj)
                a = (slice(di, None), slice(max(dj, 0), n + min(dj, 0)))
                b = (slice(None, n - di), slice(max(-dj, 0), n - max(dj, 0)))
                d = p[a] - p[b]
                far = np.maximum(np.linalg.norm(d, axis=-1, keepdims=True), 1e-9)
                move = 0.25 * stiff * d * (1 - length / far)
                p[a] -= move
                p[b] += move
            d = p - centre
            far = np.linalg.norm(d, axis=-1, keepdims=True)
            inside = far < radius
            p = np.where(inside, centre + d / far * radius, p)
            old = np.where(inside, p - 0.2 * (p - old), old)
            low = p[..., 1:2] < floor
            p[..., 1:2] = np.maximum(p[..., 1:2], floor)
            old = np.where(low, p - 0.4 * (p - old), old)
    mesh = Mesh()
    mesh.grid([[tuple(float(x) for x in p[i, j]) for j in range(n)] for i in range(n)][::-1], False)
    mesh.write("cloth")


if __name__ == "__main__":
    for make in (shader_ball, rounded_cube, tile, wall, coin, column, mug, teapot, cloth):
        make()
