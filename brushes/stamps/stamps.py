#!/usr/bin/python3
"""stamps.py - draws the stamps of this folder, and stamps.conf with their groups and words.

    python3 stamps.py FOLDER [NAME...]

Each stamp is a function of a Grid that returns heights from 0 (the ground) to 1; it needs numpy. Distances d
are negative inside a shape. A stamp is 256 x 256 pixels, drawn with 4 samples a pixel; heights are stored
in 12 of the 16 bits, which halves the files."""
import struct
import sys
import zlib

import numpy as np

SIDE, FINE = 256, 2
TAU = 2 * np.pi


class Grid:
    """Coordinates from -1 to 1, x to the right and y up, with radius r and angle a in radians."""

    def __init__(self):
        n = SIDE * FINE
        t = (np.arange(n) + 0.5) / n * 2 - 1
        self.set(*np.meshgrid(t, -t))

    def set(self, x, y):
        self.x, self.y = x, y
        self.r, self.a = np.hypot(x, y), np.arctan2(y, x)

    def at(self, x=0.0, y=0.0, turn=0.0, scale=1.0):
        """The grid of a copy that is moved, turned (degrees, anticlockwise) and scaled."""
        c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        u, v = (self.x - x) / scale, (self.y - y) / scale
        g = Grid.__new__(Grid)
        g.set(c * u + s * v, c * v - s * u)
        return g


# ---- shapes: signed distances ----

def circle(g, x, y, r):
    return np.hypot(g.x - x, g.y - y) - r


def box(g, w, h, corner=0.0):
    qx, qy = np.abs(g.x) - w + corner, np.abs(g.y) - h + corner
    return np.hypot(np.maximum(qx, 0), np.maximum(qy, 0)) + np.minimum(np.maximum(qx, qy), 0) - corner


def ngon(g, n, r, turn=0.0):
    """A regular polygon of inner radius r."""
    step = TAU / n
    a = np.mod(g.a + np.radians(turn) + step / 2, step) - step / 2
    return g.r * np.cos(a) - r


def polygon(g, points):
    p = np.asarray(points, float)
    best, inside = np.full(g.x.shape, 1e9), np.zeros(g.x.shape, bool)
    for (ax, ay), (bx, by) in zip(p, np.roll(p, -1, 0)):
        best = np.minimum(best, line(g, ax, ay, bx, by))
        if ay != by:
            cross = ax + (g.y - ay) * (bx - ax) / (by - ay)
            inside ^= ((ay > g.y) != (by > g.y)) & (g.x < cross)
    return np.where(inside, -best, best)


def line(g, ax, ay, bx, by):
    """The distance from a line."""
    dx, dy = bx - ax, by - ay
    t = np.clip(((g.x - ax) * dx + (g.y - ay) * dy) / max(dx * dx + dy * dy, 1e-12), 0, 1)
    return np.hypot(g.x - ax - t * dx, g.y - ay - t * dy)


def stroke(g, points, wide):
    """Distance from a path whose half width changes from point to point."""
    p, best = np.asarray(points, float), np.full(g.x.shape, 1e9)
    w = np.broadcast_to(np.asarray(wide, float), len(p))
    for (ax, ay), (bx, by), wa, wb in zip(p, p[1:], w, w[1:]):
        dx, dy = bx - ax, by - ay
        t = np.clip(((g.x - ax) * dx + (g.y - ay) * dy) / max(dx * dx + dy * dy, 1e-12), 0, 1)
        best = np.minimum(best, np.hypot(g.x - ax - t * dx, g.y - ay - t * dy) - wa - t * (wb - wa))
    return best


def curve(points, steps=12, closed=False):
    """A Catmull-Rom spline as points."""
    p = np.asarray(points, float)
    q = np.vstack([p[-1:], p, p[:2]]) if closed else np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    parts = [0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
             for a, b, c, d in zip(q, q[1:], q[2:], q[3:])]
    return np.vstack(parts) if closed else np.vstack(parts + [p[-1:]])


# ---- profiles ----

def step(a, b, x):
    t = np.clip((x - a) / (b - a), 0, 1)
    return t * t * (3 - 2 * t)


def bevel(d, width=0.03):
    """1 inside, falling to 0 at the outline over `width`, with soft corners."""
    return step(0, width, -d)


def dome(d, width):
    """A quarter circle from the outline up to the depth `width`."""
    t = np.clip(-d / width, 0, 1)
    return np.sqrt(1 - (1 - t)**2)


def bump(d, width):
    """A ridge on a line, `width` to either side."""
    return np.cos(np.clip(np.abs(d) / width, 0, 1) * np.pi) * 0.5 + 0.5


def smax(a, b, k=0.05):
    h = np.clip(0.5 + 0.5 * (a - b) / k, 0, 1)
    return b + (a - b) * h + k * h * (1 - h)


def smin(a, b, k=0.05):
    return -smax(-a, -b, k)


# ---- chance ----

def noise(g, cells, seed, octaves=1):
    """Smooth noise from -1 to 1 of `cells` cells across."""
    total, weight = 0.0, 0.0
    for o in range(octaves):
        n = int(cells * 2**o) + 4
        table = np.random.RandomState(seed * 31 + o).rand(n + 1, n + 1) * 2 - 1
        u, v = ((np.clip(c, -1.4, 1.4) + 1.5) / 3 * n for c in (g.x, g.y))
        i, j = np.floor(u).astype(int), np.floor(v).astype(int)
        s, t = (f * f * (3 - 2 * f) for f in (u - i, v - j))
        a = table[j, i] + s * (table[j, i + 1] - table[j, i])
        b = table[j + 1, i] + s * (table[j + 1, i + 1] - table[j + 1, i])
        total, weight = total + (a + t * (b - a)) * 0.5**o, weight + 0.5**o
    return total / weight * 1.5


def wobble(g, amount, cells, seed):
    """The grid with places moved by noise."""
    moved = Grid.__new__(Grid)
    moved.set(g.x + amount * noise(g, cells, seed, 2), g.y + amount * noise(g, cells, seed + 7, 2))
    return moved


def walk(seed, count, start, angle, length, bend):
    """A path of random bends; angle in degrees."""
    rng, p = np.random.RandomState(seed), [np.asarray(start, float)]
    for _ in range(count):
        a = np.radians(angle + rng.uniform(-bend, bend))
        p.append(p[-1] + length / count * np.array([np.cos(a), np.sin(a)]))
    return np.array(p)


def scattered(seed, count, inner=0.0, outer=0.8, least=0.0):
    """Places at random, none nearer than `least`."""
    rng, out = np.random.RandomState(seed), []
    for _ in range(4000):
        r, a = np.sqrt(rng.uniform(inner**2, outer**2)), rng.uniform(0, TAU)
        p = np.array([r * np.cos(a), r * np.sin(a)])
        if all(np.hypot(*(p - q)) >= least for q in out):
            out.append(p)
        if len(out) == count:
            break
    return out


def facets(g, seed, count, tilt, peak=1.0):
    """A broken stone: the lowest of planes that slope away from the middle."""
    rng, h = np.random.RandomState(seed), np.full(g.x.shape, peak)
    for k in range(count):
        a = TAU * (k + rng.uniform(-0.3, 0.3)) / count
        s = tilt * rng.uniform(0.6, 1.5)
        h = np.minimum(h, rng.uniform(0.75, 1.1) * peak + s * 0.35 - s * (g.x * np.cos(a) + g.y * np.sin(a)))
    return h


# ---- damage: most of it is carved (mode lower) ----

def chip(g):
    d = polygon(wobble(g, 0.05, 9, 3), [(-.8, .1), (-.35, .62), (.2, .5), (.78, .3), (.6, -.35), (.1, -.7), (-.5, -.5)])
    shells = 0.03 * np.sin(34 * np.hypot(g.x + .75, g.y - .7)) * bevel(d, .3)
    return bevel(d, .04) * (.35 + .65 * step(-.8, .7, .5 * g.x - .7 * g.y) + shells)


def chip_flake(g):
    w = wobble(g, .06, 8, 12)
    d = np.maximum(circle(w, 0, .25, .72), -(w.y + .55 - .1 * w.x))
    d = np.maximum(d, w.y - .7)
    rings = .045 * np.sin(30 * np.hypot(g.x * .8, g.y - 1.0))
    return bevel(d, .05) * np.clip(.95 - .75 * np.hypot(g.x * .9, (g.y - .5) * .8) + rings, .05, 1)


def chip_corner(g):
    w = wobble(g, .07, 7, 33)
    d = polygon(w, [(-.82, -.8), (-.78, .72), (-.35, .15), (.1, -.12), (.74, -.76)])
    return bevel(d, .03) * np.clip(facets(g.at(-.5, -.5), 5, 7, .55) + .06 * noise(g, 22, 4, 3), 0, 1.1)


def crack_path(g, seed, start, angle, length, wide, bend=55, forks=3):
    main = walk(seed, 16, start, angle, length, bend)
    d = stroke(g, main, np.linspace(wide, wide * .25, 17))
    rng = np.random.RandomState(seed + 1)
    for k in range(forks):
        i = int(rng.randint(2, 12))
        turn = angle + rng.choice([-1, 1]) * rng.uniform(30, 65)
        side = walk(seed + 10 + k, 8, main[i], turn, length * rng.uniform(.2, .42), bend)
        d = np.minimum(d, stroke(g, side, np.linspace(wide * .6, .001, 9)))
    return d


def groove(d, width):
    return 1 - step(-.004, width, d)


def crack(g):
    w = wobble(g, .02, 20, 5)
    return groove(crack_path(w, 4, (-.88, .22), -10, 1.8, .022, 38), .035)


def crack_branching(g):
    w = wobble(g, .02, 24, 6)
    d = crack_path(w, 21, (.1, .9), -96, 1.8, .03, 34, 7)
    return groove(np.minimum(d, crack_path(w, 52, (.05, .3), -32, .8, .018, 34, 2)), .035)


def crack_star(g):
    w, d = wobble(g, .02, 22, 8), np.full(g.x.shape, 9.0)
    rng = np.random.RandomState(17)
    for k in range(9):
        d = np.minimum(d, crack_path(w, 60 + 5 * k, (0, 0), 40 * k + rng.uniform(-14, 14), rng.uniform(.6, .9), .02, 38, 1))
    rings = groove(np.abs(g.r - .3 - .04 * noise(g, 8, 3)) + .7 * (noise(g, 7, 9) > .1), .02)
    return np.maximum(np.maximum(groove(d, .03), .6 * rings), 1 - step(.02, .16, circle(w, 0, 0, .05)))


def crack_web(g):
    p = np.array(scattered(9, 34, 0, 1.15, .24))
    w = wobble(g, .05, 10, 41)
    d = np.sort(np.stack([np.hypot(w.x - x, w.y - y) for x, y in p]), 0)
    edge = d[1] - d[0]
    return groove(edge - .012, .05) * (1 - step(.55, .92, g.r + .12 * noise(g, 6, 2)))


def dent(g):
    w = wobble(g, .03, 4, 2)
    t = np.clip(1 - (w.r / .85)**2, 0, 1)
    return t**1.6


def dent_edge(g):
    w = wobble(g.at(turn=20), .02, 5, 8)
    d = np.hypot(w.x / .85, w.y / .36)
    fold = .5 + .5 * step(-.02, .05, w.y + .06 * np.cos(3 * w.x))
    return np.clip(1 - d**2, 0, 1)**1.2 * (.55 + .45 * fold)


def dents(g):
    h = np.zeros(g.x.shape)
    rng = np.random.RandomState(7)
    for x, y in scattered(31, 15, 0, .66, .26):
        r = rng.uniform(.14, .27)
        h = np.maximum(h, rng.uniform(.6, 1) * np.clip(1 - (np.hypot(g.x - x, g.y - y) / r)**2, 0, 1)**1.3)
    return h


def bullet_hole(g):
    w = wobble(g, .03, 7, 5)
    lip = bump(w.r - .36, .17) * (.8 + .35 * noise(g, 9, 8, 2))
    slope = np.clip((.85 - w.r) / .5, 0, 1)**2 * .3
    return np.where(w.r < .36, lip, np.maximum(lip, slope)) * step(.2, .27, w.r + .02 * np.sin(7 * g.a))


def bullet_petals(g):
    n, a = 7, g.a + .25 * noise(g, 4, 6)
    leaf = np.abs(np.mod(a * n / TAU, 1) - .5) * 2
    tip = .78 - .26 * leaf**1.4
    h = step(.2, .3, g.r) * (1 - step(-.06, .03, g.r - tip)) * (1 - .5 * leaf**4)
    return h * (1.0 - .75 * step(.28, .8, g.r)) * (.9 + .1 * noise(g, 14, 3, 2))


def bullet_stone(g):
    w = wobble(g, .1, 7, 15)
    d = w.r - .62 - .12 * np.sin(5 * w.a + 1)
    spall = bevel(d, .16) * (.42 + .12 * noise(g, 18, 5, 3))
    return np.maximum(spall, 1 - step(.12, .28, w.r))


def crater(g):
    w = wobble(g, .035, 6, 4)
    wall = np.where(w.r < .55, step(.3, .55, w.r), np.clip((.92 - w.r) / .37, 0, 1)**1.7)
    peak = .5 * np.clip(1 - w.r / .16, 0, 1)**1.2
    return np.maximum(wall * (.92 + .2 * noise(g, 12, 6, 3)), peak)


def crater_rayed(g):
    rays = np.clip(.5 + .5 * np.sin(11 * g.a + 2.4 * noise(g, 5, 19)), 0, 1)**2
    throw = np.clip((.95 - g.r) / .6, 0, 1)**1.5 * (.12 + .5 * rays)
    wall = bump(g.r - .34 - .02 * noise(g, 9, 2), .13)
    terrace = .45 * bump(g.r - .22, .05)
    return np.where(g.r < .34, np.maximum(wall, terrace), np.maximum(wall, throw))


def scratches(g):
    h, rng = np.zeros(g.x.shape), np.random.RandomState(11)
    for k in range(13):
        y, a = rng.uniform(-.6, .6), np.radians(18 + rng.uniform(-9, 9))
        half, x = rng.uniform(.25, .75), rng.uniform(-.25, .25)
        p = [(x - half * np.cos(a), y * .8 - half * np.sin(a)), (x, y * .8 + rng.uniform(-.03, .03)), (x + half * np.cos(a), y * .8 + half * np.sin(a))]
        d = stroke(g, curve(p, 8), np.interp(np.linspace(0, 1, 17), [0, .3, 1], [0, rng.uniform(.006, .018), 0]))
        h = np.maximum(h, rng.uniform(.4, 1) * groove(d, .016) * (1 - step(.86, .97, g.r)))
    return h


def gouge(g):
    c = g.at(turn=24)
    wide = .15 * np.clip(1 - ((c.x + .05) / .85)**2, 0, 1)**.7 * (1 + .2 * noise(g, 9, 3)) + 1e-3
    cut = np.clip(1 - (np.abs(c.y) / wide)**2, 0, 1)**.8
    return cut * step(-.9, .2, c.x) * (.88 + .12 * np.sin(90 * c.y + 3 * noise(g, 6, 1)))


def claws(g):
    h = np.zeros(g.x.shape)
    for k, (y, long) in enumerate([(.54, .62), (.2, .82), (-.14, .85), (-.48, .66)]):
        p = curve([(-long, y + .18), (-.1, y + .02 * k), (long, y - .2)], 10)
        h = np.maximum(h, groove(stroke(wobble(g, .015, 16, 3 + k), p, np.interp(np.linspace(0, 1, len(p)), [0, .35, 1], [.004, .05, .002])), .05))
    return h


def pits(g):
    h, rng = np.zeros(g.x.shape), np.random.RandomState(23)
    for x, y in scattered(5, 60, 0, .84, .09):
        r = rng.uniform(.03, .1) * (1.1 - .5 * np.hypot(x, y))
        d = circle(wobble(g, .02, 20, 4), x, y, r)
        h = np.maximum(h, rng.uniform(.5, 1) * dome(d, r * .9))
    return h


def drip(g):
    h = np.zeros(g.x.shape)
    top = polygon(wobble(g, .03, 6, 5), [(-.85, .86), (.85, .86), (.86, .6), (.4, .5), (0, .55), (-.5, .46), (-.86, .6)])
    d = top
    for x, end, r in [(-.62, -.1, .085), (-.28, -.68, .12), (.12, .1, .07), (.42, -.42, .1), (.7, .22, .06)]:
        d = smin(d, np.minimum(stroke(g, [(x, .7), (x, end)], [r * 1.1, r * .7]), circle(g, x, end, r * 1.15)), .09)
    return dome(d + .03, .11)


def splat(g):
    rng, d = np.random.RandomState(3), g.r - .34
    for k in range(13):
        a = TAU * k / 13 + rng.uniform(-.16, .16)
        far, r = rng.uniform(.45, .78), rng.uniform(.035, .085)
        tip = far * np.array([np.cos(a), np.sin(a)])
        d = smin(d, stroke(g, [(0, 0), tip], [.12, r * .45]), .09)
        d = smin(d, circle(g, *tip, r), .06)
    for x, y in scattered(8, 9, .62, .86, .2):
        d = np.minimum(d, circle(g, x, y, rng.uniform(.02, .045)))
    return dome(d + .01, .12) * (1 - .2 * step(.1, .6, g.r))


def puddle_ring(g):
    w = wobble(g, .05, 4, 21)
    return .8 * bump(w.r - .66, .1) + .25 * (1 - step(.5, .66, w.r)) * (.6 + .4 * noise(g, 7, 2, 2)) + .55 * bump(w.r - .52, .05) * (noise(g, 4, 6) > -.2)


# ---- hardware ----

def bolt_hex(g):
    head = bevel(ngon(g, 6, .7), .1) * np.clip(1 - np.maximum(g.r - .64, 0) * 2.2, 0, 1)
    return np.maximum(.32 * bevel(circle(g, 0, 0, .94), .06), .94 * head) + .06 * bump(g.r - .34, .03)


def bolt_socket(g):
    side = .88 + .02 * np.cos(40 * g.a)
    head = bevel(g.r - side, .1)
    return head - .62 * bevel(ngon(g, 6, .4, 30), .05) - .05 * bump(g.r - .62, .04)


def screw_slot(g):
    head = dome(circle(g, 0, 0, .92), .75)
    c = g.at(turn=35)
    return head * (1 - .75 * bevel(box(c, .8, .1, .02), .05) * (g.r < .9)) * .98


def screw_cross(g):
    head = dome(circle(g, 0, 0, .92), .6)
    c = g.at(turn=12)
    d = np.minimum(box(c, .5, .1, .02), box(c, .1, .5, .02))
    d = np.minimum(d, circle(g, 0, 0, .2))
    return head - .7 * bevel(d, .09) * np.clip(1.1 - g.r, 0, 1)


def screw_star(g):
    d = g.r - .36 - .085 * np.cos(6 * g.a)
    flat = bevel(circle(g, 0, 0, .92), .22)
    return flat - .66 * bevel(d, .05) + .05 * bump(g.r - .66, .05)


def rivet(g):
    head = circle(g, 0, 0, .7)
    return .22 * bevel(circle(g, 0, 0, .92), .08) + .78 * dome(head, .7) * (head < 0)


def rivet_flush(g):
    return bevel(circle(g, 0, 0, .9), .12) * (1 - .65 * bump(g.r - .66, .07))


def rivet_hammered(g):
    w = wobble(g, .05, 5, 11)
    h = dome(circle(w, 0, 0, .86), .8)
    return np.minimum(h, facets(g, 4, 6, .9, .82)) * (.97 + .03 * noise(g, 16, 2, 2))


def washer(g):
    d = np.abs(g.r - .6) - .3
    return bevel(d, .07) * (.92 + .05 * np.sin(60 * g.r))


def nut(g):
    outer = bevel(ngon(g, 6, .74, 30), .07) * np.clip(1 - np.maximum(g.r - .7, 0) * 2.4, 0, 1)
    hole = bevel(circle(g, 0, 0, .42), .05)
    thread = .2 + .2 * (.5 + .5 * np.sin(70 * g.r + g.a))
    return np.where(hole > 0, outer * (1 - hole) + hole * .35 * thread * step(.2, .4, g.r), outer)


def teeth(g, count, inner, outer):
    """The outline of a gear wheel: radii."""
    t = np.abs(np.mod(g.a * count / TAU, 1) - .5) * 2
    return inner + (outer - inner) * (1 - step(.34, .66, t))


def gear(g):
    d = g.r - teeth(g, 14, .7, .9)
    body = bevel(d, .045)
    hub = .25 * bevel(circle(g, 0, 0, .3), .05)
    holes = np.ones(g.x.shape)
    for k in range(5):
        a = TAU * k / 5 + .3
        holes -= .7 * bevel(circle(g, .48 * np.cos(a), .48 * np.sin(a), .12), .04)
    return body * .72 * holes + hub - .9 * bevel(ngon(g, 4, .1, 45), .03)


def gear_spoked(g):
    rim = bevel(np.maximum(g.r - teeth(g, 24, .8, .92), .62 - g.r), .04)
    hub = bevel(circle(g, 0, 0, .26), .05)
    h = np.maximum(rim * .8, hub)
    for k in range(6):
        c = g.at(turn=60 * k)
        arm = np.maximum(np.abs(c.y - .12 * c.x * c.x) - .07 - .03 * (1 - c.x), np.maximum(c.x - .7, .1 - c.x))
        h = np.maximum(h, .6 * dome(arm, .09))
    return h - .85 * bevel(circle(g, 0, 0, .1), .04) - .2 * bump(g.r - .71, .04)


def keyhole(g):
    plate = bevel(np.hypot(g.x / .66, g.y / .92) - 1, .1)
    rim = .3 * bump((np.hypot(g.x / .66, g.y / .92) - .86), .06)
    hole = np.minimum(circle(g, 0, .2, .16), polygon(g, [(-.08, .2), (.08, .2), (.15, -.45), (-.15, -.45)]))
    return plate * .68 + rim - .66 * bevel(hole, .04)


def grille(g):
    frame = bevel(box(g, .92, .92, .18), .06)
    bars = np.zeros(g.x.shape)
    for k in range(7):
        c = g.at(0, -.6 + .2 * k)
        bars = np.maximum(bars, bevel(box(c, .68, .055, .055), .035))
    return frame * .85 - .8 * bars + .1 * bump(box(g, .8, .8, .1), .03)


def hatch(g):
    h = bevel(box(g, .92, .92, .2), .05) * .6 - .3 * bump(box(g, .76, .76, .12), .028)
    for x in (-.6, .6):
        for y in (-.6, .6):
            h = h + .25 * dome(circle(g, x, y, .085), .085)
    return h - .25 * bevel(box(g, .42, .2, .1), .06) + .62 * bevel(box(g, .3, .085, .085), .05)


def vent_louvre(g):
    d = np.full(g.x.shape, 9.0)
    slats = np.zeros(g.x.shape)
    for k in range(5):
        c = g.at(0, -.56 + .28 * k)
        slats = np.maximum(slats, bevel(box(c, .66, .115, .06), .03) * np.clip(.55 - c.y / .115 * .45, 0, 1))
    return bevel(box(g, .92, .92, .1), .05) * .4 + .6 * slats


def chain_link(g):
    return dome(np.abs(box(g, .42, .74, .42)) - .15, .15)


def knob(g):
    d = g.r - .88 - .02 * np.cos(36 * g.a)
    h = bevel(d, .1) * .7
    return h + .3 * bevel(circle(g, 0, 0, .62), .12) - .3 * bevel(box(g.at(0, .42), .035, .2, .03), .03)


# ---- cloth and leather ----

def thread(g, ax, ay, bx, by, r=.1):
    """One twisted thread between two places, sunk at both ends."""
    c = g.at((ax + bx) / 2, (ay + by) / 2, np.degrees(np.arctan2(by - ay, bx - ax)))
    along = np.clip(np.abs(c.x) / (np.hypot(bx - ax, by - ay) / 2 + r), 0, 1)
    w = r * np.sqrt(1 - along**4) + 1e-3
    twist = .85 + .15 * np.cos((c.x + .9 * c.y) * TAU / (r * 1.1))
    return np.sqrt(np.clip(1 - (c.y / w)**2, 0, 1)) * twist * (1 - along**3)


def stitch_cross(g):
    return np.maximum(.85 * thread(g, -.62, -.62, .62, .62, .17), thread(g, -.62, .62, .62, -.62, .17) * 1.0)


def stitch_row(g):
    h = np.zeros(g.x.shape)
    for k in range(4):
        x = -.66 + .44 * k
        h = np.maximum(h, thread(g, x - .12, -.07, x + .12, .07, .1))
    return np.maximum(h, .3 * bump(g.y, .22) * (1 - step(.7, .95, np.abs(g.x))))


def stitch_chain(g):
    h = np.zeros(g.x.shape)
    for k in range(4):
        c = g.at(-.6 + .4 * k, 0)
        d = np.abs(np.hypot((c.x + .02) / .28, c.y / (.17 + .1 * c.x)) - .82) * .2 - .055
        loop = dome(d, .055) * (.8 + .2 * np.cos(50 * (c.x + c.y)))
        h = np.maximum(h, loop * (1 - .3 * step(.0, .28, -c.x)))
    return h


def stitch_herring(g):
    h = np.zeros(g.x.shape)
    for k in range(6):
        x = -.7 + .28 * k
        h = np.maximum(h, .8 * thread(g, x - .14, -.36, x + .14, .36, .06))
        h = np.maximum(h, thread(g, x + .02, .36, x + .24, -.36, .06) * (.95 if k < 5 else 0))
    return h


def button(g):
    h = bevel(circle(g, 0, 0, .9), .14) * .72
    h = h + .28 * bump(g.r - .76, .13) - .22 * dome(circle(g, 0, 0, .55), .5)
    for k in range(4):
        a = TAU * (k + .5) / 4
        h = h - .7 * bevel(circle(g, .2 * np.cos(a), .2 * np.sin(a), .095), .05)
    return np.clip(h, 0, 1)


def button_tufted(g):
    d = box(g, .92, .92, .35)
    fold = np.abs(np.sin(2 * g.a))**.6
    pillow = dome(d, .5) * step(.08, .6, g.r) * (.5 + .5 * np.maximum(fold, step(.3, .9, g.r)))
    return np.maximum(pillow, .5 * dome(circle(g, 0, 0, .17), .16))


def zip_teeth(g):
    tape = .22 * bevel(box(g, .5, .9, .04), .06) * (.93 + .07 * np.cos(70 * g.y))
    h = tape * (1 - .5 * bump(g.x, .03))
    for k in range(17):
        c = g.at((-1) ** k * .1, -.8 + .1 * k)
        h = np.maximum(h, .95 * dome(box(c, .2, .042, .03), .042))
    return h


# ---- nature ----

def blade(g, length, wide, power=1.0):
    """A leaf from (-length, 0) to (length, 0): distance-like, negative inside."""
    t = np.clip((g.x + length) / (2 * length), 0, 1)
    w = wide * np.sin(np.pi * t**power)**.8
    return np.abs(g.y) - w + 10 * np.maximum(np.abs(g.x) - length, 0)


def veined(g, d, veins=7, length=.85, slant=1.1):
    t = (g.x - slant * np.abs(g.y)) * veins / length
    side = bump(np.mod(t, 1) - .5, .22) * step(.0, .1, np.abs(g.y))
    fall = dome(d, .28)
    return fall * (.86 - .16 * side) * (.8 + .2 * np.clip(np.abs(g.y) * 6, 0, 1)) - .1 * bump(g.y, .035) * bevel(d, .1)


def leaf_oak(g):
    c = g.at(.06, 0, 40)
    t = np.clip((c.x + .78) / 1.6, 0, 1)
    lobe = .5 + .5 * np.cos(TAU * 4.2 * (t - .08 * np.abs(c.y) * 2) + np.pi)
    w = (.2 + .3 * np.sin(np.pi * t**.8)) * (.5 + .5 * lobe) * np.sin(np.pi * np.clip(t, .02, .99))**.45
    d = (np.abs(c.y) - w) * .7 + 10 * np.maximum(np.abs(c.x - .02) - .8, 0)
    stalk = stroke(c, [(-.98, .02), (-.7, 0)], .03)
    return np.maximum(veined(c, d, 3.6, .8, .75), .6 * dome(stalk, .03))


def leaf_maple(g):
    half = [(0, .92), (.1, .72), (.24, .76), (.2, .48), (.3, .36), (.46, .62), (.52, .52), (.68, .56), (.64, .42), (.92, .3), (.72, .18),
            (.78, .06), (.46, -.02), (.4, -.1), (.5, -.24), (.62, -.32), (.34, -.4), (.1, -.38), (.06, -.44)]
    d = polygon(wobble(g, .015, 12, 2), half + [(-x, y) for x, y in half[::-1]])
    veins = np.full(g.x.shape, 9.0)
    for x, y in [(0, .84), (.78, .26), (-.78, .26), (.46, -.3), (-.46, -.3)]:
        veins = np.minimum(veins, line(g, 0, -.38, x, y))
        for t in (.45, .65):
            veins = np.minimum(veins, line(g, x * t, -.38 + (y + .38) * t, x * (t + .22) + .12 * (y + .3), -.38 + (y + .38) * (t + .22) - .12 * x))
            veins = np.minimum(veins, line(g, x * t, -.38 + (y + .38) * t, x * (t + .22) - .12 * (y + .3), -.38 + (y + .38) * (t + .22) + .12 * x))
    swell = .6 + .4 * step(0, .12, veins)
    stalk = stroke(g, curve([(0, -.38), (.03, -.65), (.12, -.92)], 8), .028)
    return np.maximum(dome(d, .12) * swell - .2 * groove(veins - .008, .012) * bevel(d, .05), .55 * dome(stalk, .028))


def leaf_fern(g):
    h = np.zeros(g.x.shape)
    spine = curve([(-.15, -.9), (-.05, -.3), (.03, .3), (.2, .9)], 12)
    for k in range(13):
        t = k / 13
        i = int(4 + t * (len(spine) - 6))
        x, y = spine[i]
        lean = 75 - 10 * t - 90
        long = .5 * np.sin(np.pi * (.22 + .75 * t))**1.1 + .05
        for s in (-1, 1):
            c = g.at(x, y, lean + (18 if s > 0 else 180 - 18 + 24))
            c = c.at(long / 2, 0)
            d = blade(c, long / 2, .055 + .02 * (1 - t))
            h = np.maximum(h, dome(d, .06) * (.85 - .35 * bump(c.y, .018)))
    return np.maximum(h, dome(stroke(g, spine, np.linspace(.032, .01, len(spine))), .03))


def leaf_ginkgo(g):
    b = g.at(0, -.5)
    fan = np.abs(b.a - np.pi / 2) - 1.12
    edge = 1.18 - .1 * np.cos(9 * b.a) * .35 - .22 * bump(b.a - np.pi / 2, .12) - .06 * (b.a - np.pi / 2)**2
    d = np.maximum(b.r - edge, fan * b.r)
    ribs = .5 + .5 * np.cos(46 * b.a)
    h = bevel(d, .1) * (.45 + .4 * b.r / 1.2) * (.86 + .14 * ribs) * (1 + .08 * np.sin(6 * b.a))
    return np.maximum(h, .5 * dome(stroke(b, curve([(0, .1), (.02, -.2), (.08, -.42)], 8), [.03] * 17), .03))


def leaf_willow(g):
    h, g = np.zeros(g.x.shape), g.at(-.05, -.03, 0, .94)
    twig = curve([(-.85, -.5), (-.2, -.12), (.4, .12), (.8, .42)], 10)
    for x, y in twig[2:-1:4]:
        for s in (-1, 1):
            c = g.at(x, y, 28 + s * 48).at(.25, 0)
            h = np.maximum(h, dome(blade(c, .25, .085), .09) * (.9 - .4 * bump(c.y, .02)))
    tip = g.at(*twig[-1], 38).at(.1, 0)
    h = np.maximum(h, dome(blade(tip, .16, .06), .07) * (.9 - .4 * bump(tip.y, .02)))
    return np.maximum(h, .8 * dome(stroke(g, twig, .03), .03))


def feather(g):
    c = g.at(0, 0, 50)
    bow = .06 * np.cos(1.6 * c.x)
    y = c.y - bow + .05
    t = np.clip((c.x + .55) / 1.4, 0, 1)
    w = .27 * np.sin(np.pi * np.clip(t, 0, 1)**.62)**.7 * (c.x > -.55)
    split = .05 * (np.abs(c.x - .22 - .8 * np.abs(y)) < .02) + .05 * (np.abs(c.x + .1 - .8 * np.abs(y)) < .015)
    d = np.abs(y) - w + 3 * split * (np.abs(y) > .06)
    barbs = .5 + .5 * np.cos((c.x - .9 * np.abs(y)) * 88)
    vane = dome(d, .2) * (.58 + .16 * barbs)
    quill = stroke(c.at(0, 0), [(x, .06 * np.cos(1.6 * x) - .05) for x in np.linspace(-.95, .82, 20)], np.linspace(.035, .006, 20))
    return np.maximum(vane, dome(quill, .035))


def shell_scallop(g):
    b = g.at(0, -.62)
    a = b.a - np.pi / 2
    rib = np.abs(np.cos(a * 8.5))
    edge = 1.42 * np.cos(a * .62) + .05 * rib - .02
    d = np.maximum(b.r - edge, (np.abs(a) - 1.1) * b.r)
    h = bevel(d, .14) * (.25 + .75 * np.sin(np.clip(b.r / 1.5, 0, 1) * np.pi * .72)) * (.72 + .28 * rib) + .03 * np.sin(26 * b.r) * bevel(d, .2)
    ears = polygon(b, [(-.36, -.1), (.36, -.1), (.26, .22), (-.26, .22)])
    return np.maximum(h, .42 * bevel(ears, .06))


def shell_spiral(g):
    """A logarithmic spiral; the last whorl opens at angle pi."""
    grow, b = np.log(2.1) / TAU, g.at(.14, .04)
    lr = np.log(np.maximum(b.r, 1e-4) / .61)
    turn = (lr - grow * b.a) / (TAU * grow)
    k = np.floor(turn)
    phase = b.a + TAU * k
    ribs = .88 + .12 * np.cos(phase * 17)
    coil = np.sqrt(np.clip(1 - (2 * (turn - k) - 1)**2, 0, 1)) * ribs
    mouth = 1 - .45 * (k == -1) * step(np.pi - .5, np.pi - .04, b.a)
    return np.where((k < 0) & (b.r > .01), coil * (.35 + .65 * np.clip(b.r / .7, 0, 1)) * mouth, 0) * (1 - (k == -1) * step(np.pi - .05, np.pi, b.a))


def shell_cone(g):
    c = g.at(0, .02, 0)
    t = np.clip((.9 - c.y) / 1.75, 0, 1)
    w = .5 * t**.9 * np.sqrt(np.clip(1 - ((t - .75) / .25)**2 * (t > .75), 0, 1))
    q = np.mod(t * 7.5 + .12 * c.x / (w + .05), 1)
    whorl = .72 + .28 * np.sin(np.pi * q)**.6
    body = np.sqrt(np.clip(1 - (c.x / (w + 1e-6))**2, 0, 1)) * (np.abs(c.y) < .9)
    mouth = bevel(np.hypot((c.x - .12) / .12, (c.y + .55) / .2) - 1, .4)
    return body * (.3 + .7 * t**.6) * whorl * (1 - .55 * mouth)


def starfish(g):
    n = 5
    a = np.mod(g.a - np.pi / 2 + np.pi / n, TAU / n) - np.pi / n
    w = .3 * np.clip(1 - g.r / .92, 0, 1)**.8 + .02
    y = g.r * np.sin(a)
    d = np.maximum(np.abs(y) - w, g.r - .9)
    h = dome(d, .22) * (.55 + .45 * (1 - g.r)) + .08 * bump(y, .05) * bevel(d, .1)
    for px, py in scattered(3, 150, 0, .86, .065):
        h = h + .07 * bump(circle(g, px, py, 0), .035) * bevel(d + .03, .06)
    return h


def sand_dollar(g):
    body = dome(circle(g, 0, 0, .9), .9)
    n = 5
    a = np.mod(g.a - np.pi / 2 + np.pi / n, TAU / n) - np.pi / n
    x, y = g.r * np.cos(a), g.r * np.sin(a)
    petal = np.hypot((x - .33) / .3, y / .12)
    line_ = bump(petal - 1, .3) * (.75 + .25 * np.cos(70 * x))
    return body * .85 + .17 * line_ * (g.r < .8) - .2 * bump(g.r, .04)


def petals(g, n, inner, outer, wide, turn=0.0):
    a = np.mod(g.a + turn + np.pi / n, TAU / n) - np.pi / n
    x, y = g.r * np.cos(a), g.r * np.sin(a)
    t = np.clip((x - inner) / (outer - inner), 0, 1)
    w = wide * np.sin(np.pi * np.clip(t, 0, 1)**.7 * .96 + .06)**.7
    return x, y, t, np.where((x > inner) & (x < outer), np.abs(y) - w, .3)


def flower_daisy(g):
    h = np.zeros(g.x.shape)
    for turn, level in ((.15, .5), (.0, .7)):
        x, y, t, d = petals(g, 13, .2, .9, .13, turn)
        h = np.maximum(h, level * dome(d, .1) * (.7 + .3 * np.abs(np.cos(y * 24))) * (.75 + .25 * np.sin(np.pi * t)))
    seeds = .9 + .1 * np.cos(60 * g.x) * np.cos(60 * g.y)
    return np.maximum(h, (.55 + .45 * dome(circle(g, 0, 0, .27), .27)) * seeds * (g.r < .27))


def flower_rose(g):
    h = np.zeros(g.x.shape)
    rng = np.random.RandomState(6)
    for ring, (far, size, count) in enumerate([(.52, .4, 6), (.36, .36, 5), (.2, .29, 4), (.08, .2, 3)]):
        for k in range(count):
            a = TAU * (k + .5 * ring + rng.uniform(-.1, .1)) / count
            c = g.at(far * np.cos(a), far * np.sin(a), np.degrees(a))
            d = np.hypot(c.x / size, c.y / (size * 1.15)) - 1
            rise = .12 + .2 * ring + .3 * step(-.9, .75, c.x / size) - .14 * step(.55, 1, c.x / size)
            h = np.where(d < 0, rise * step(0, .09, -d) + h * step(-.09, 0, d), h)
    return h


def flower_lily(g):
    h = np.zeros(g.x.shape)
    for turn, level in ((np.pi / 3, .6), (0, .85)):
        x, y, t, d = petals(g, 3, .03, .92, .24, turn + np.pi / 6)
        h = np.maximum(h, level * dome(d, .18) * (.85 - .3 * bump(y, .05)) * (.55 + .45 * np.sin(np.pi * (.15 + .7 * t))))
    for k in range(6):
        a = TAU * k / 6 + .2
        tip = (.34 * np.cos(a), .34 * np.sin(a))
        h = np.maximum(h, dome(stroke(g, [(0, 0), tip], .018), .018) * .95)
        h = np.maximum(h, dome(circle(g, *tip, .045), .045))
    return h


def pine_cone(g):
    h = np.zeros(g.x.shape)
    for row in range(12):
        y = -.74 + .13 * row
        half = .58 * np.sqrt(1 - ((y + .12) / .9)**2)
        size = .11 + .07 * half / .58
        count = max(2, int(half * 9)) + row % 2
        for k in range(count):
            x = half * np.sin(np.pi * ((k + .5) / count - .5) * .96)
            c = g.at(x, y)
            d = np.hypot(c.x / size, c.y / (size * .85)) - 1
            shape = .3 + .3 * (1 - (x / .75)**2) + .26 * np.clip(.5 + c.y / size * .6, 0, 1)
            scale = shape * step(0, .3, -d) + .16 * dome((np.hypot(c.x, (c.y - .04)) - .04), .04)
            h = np.where(d < 0, np.maximum(scale, h * step(-.25, 0, d)), h)
    return h


def bark_knot(g):
    w = wobble(g, .06, 5, 14)
    r = np.hypot(w.x / .72, w.y / .92)
    rings = .5 + .5 * np.cos(34 * r + 3 * noise(g, 6, 2))
    lip = bump(r - .55, .3)
    return np.clip(1 - step(.72, 1, r), 0, 1) * np.clip(.2 + .62 * lip + .2 * rings * step(.1, .4, r) - .4 * (1 - step(.1, .3, r)), 0, 1)


def tree_rings(g):
    w = wobble(g, .05, 4, 3)
    d = w.r - .86
    rings = np.abs(np.sin(33 * w.r**.85 + noise(g, 5, 5)))**.6
    split = groove(crack_path(wobble(g, .02, 14, 4), 77, (.02, .05), 25, .8, .02, 20, 0), .02)
    bark = bump(w.r - .8, .1) * (.8 + .3 * noise(g, 16, 9, 2))
    return bevel(d, .05) * (.5 + .2 * rings) * (1 - .6 * split) + .32 * bark


def pebble(g):
    w = wobble(g, .05, 3, 18)
    r = np.hypot(w.x / .9, w.y / .7)
    return np.clip(1 - r**2.4, 0, 1)**.5 * (1 + .02 * noise(g, 22, 2, 3))


def pebbles(g):
    h, rng = np.zeros(g.x.shape), np.random.RandomState(12)
    for x, y in scattered(14, 22, 0, .7, .27):
        c = g.at(x, y, rng.uniform(0, 180))
        a, b = rng.uniform(.13, .21), rng.uniform(.1, .15)
        r = np.hypot(c.x / a, c.y / b)
        h = np.maximum(h, rng.uniform(.6, 1) * np.clip(1 - r**2.5, 0, 1)**.5)
    return h


def stone_broken(g):
    w = wobble(g, .05, 9, 28)
    d = polygon(w, [(-.82, -.1), (-.5, .6), (.05, .82), (.62, .5), (.84, -.15), (.45, -.72), (-.3, -.78)])
    return bevel(d, .07) * np.clip(np.minimum(facets(g, 9, 8, .9, .95), .98) + .035 * noise(g, 24, 3, 4), .04, 1)


def crystal(g):
    h = np.zeros(g.x.shape)
    for x, y, turn, long, wide in [(-.35, -.1, 115, .5, .15), (.35, -.12, 62, .5, .16), (.02, .02, 92, .78, .2), (-.12, -.4, 140, .4, .11), (.28, -.45, 30, .42, .12), (.0, -.55, 85, .3, .12)]:
        c = g.at(x, y, turn)
        side = wide - np.abs(c.y)
        tip = (long - c.x) * .55
        roof = np.minimum(np.minimum(side * 1.6, wide * 1.05), np.minimum(tip, (c.x + long) * .9))
        h = np.maximum(h, np.clip(roof / wide, 0, 1) * (.55 + .45 * np.clip(c.x / long * .5 + .5, 0, 1)))
    return h


def scale_dragon(g):
    d = polygon(g, curve([(0, -.9), (.5, -.4), (.68, .2), (.5, .72), (0, .84), (-.5, .72), (-.68, .2), (-.5, -.4)], 6, True))
    lines = .03 * np.cos(np.hypot(g.x * .8, g.y - 1.2) * 36)
    rise = .38 * np.clip(1 - np.abs(g.x) / .62, 0, 1) + .38 * np.clip((.85 - g.y) / 1.7, 0, 1)
    return bevel(d, .07) * (.2 + rise + .14 * bump(g.x, .06) + lines)


def scale_plate(g):
    d = ngon(wobble(g, .03, 5, 3), 6, .8, 30)
    rings = np.cos(d * 44)
    return bevel(d, .12) * (.66 + .3 * np.clip(1 - g.r, 0, 1)) - .02 * rings * bevel(d + .08, .05) * step(.2, .4, g.r)


def scales_patch(g):
    h = np.zeros(g.x.shape)
    for row in range(6):
        y = .6 - .24 * row
        for k in range(-2, 3):
            x = .36 * (k + .5 * (row % 2))
            if np.hypot(x, y) > .68:
                continue
            c = g.at(x, y)
            d = np.hypot(c.x / .215, c.y / .26) - 1
            new = (.35 + .6 * np.clip(.5 - c.y / .52, 0, 1)) * bevel(d, .22) - .04 * np.cos(np.hypot(c.x, c.y - .3) * 60) * bevel(d, .4)
            h = np.where(d < 0, np.maximum(new, h * step(-.2, 0, d)), h)
    return h


def eye(g):
    arch = np.cos(np.clip(g.x / .92, -1, 1) * np.pi / 2)
    lid = np.abs(g.y) - .46 * arch**.8
    ends = 1 - step(.8, .92, np.abs(g.x))
    fold = .4 * bump(g.y - .08 - .6 * arch, .07) * ends
    ball = np.sqrt(np.clip(1 - (g.r / .6)**2, 0, 1)) + .16 * bump(g.r - .25, .05) - .5 * bevel(circle(g, 0, 0, .11), .05)
    return np.maximum(np.maximum(.75 * bump(lid, .09) * ends, fold), bevel(lid + .06, .05) * (.3 + .55 * ball))


def bone(g):
    c = g.at(turn=38)
    d = stroke(c, [(-.6, 0), (0, 0), (.6, 0)], [.15, .1, .15])
    for x in (-.7, .7):
        for y in (-.15, .15):
            d = smin(d, circle(c, x, y, .17), .08)
    return dome(d, .19) * (1 + .02 * noise(g, 20, 3, 2))


def coral(g):
    d = np.full(g.x.shape, 9.0)

    def branch(x, y, angle, length, wide, depth, seed):
        nonlocal d
        rng = np.random.RandomState(seed)
        p = walk(seed, 4, (x, y), angle, length, 18)
        d = smin(d, stroke(g, p, np.linspace(wide, wide * .8, 5)), .03)
        if depth:
            for k, s in enumerate((-1, 1)):
                branch(*p[-1], angle + s * rng.uniform(18, 40), length * .74, wide * .78, depth - 1, seed * 2 + k)
    branch(0, -.88, 90, .58, .085, 4, 3)
    return dome(d, .075) * (.9 + .1 * noise(g, 40, 2)) * (1 - step(.88, .97, g.r))


# ---- prints ----

def foot_bare(g):
    sole = polygon(g, curve([(-.02, -.9), (.22, -.72), (.2, -.3), (.3, .1), (.28, .36), (-.05, .42), (-.34, .26), (-.3, -.1), (-.2, -.5), (-.22, -.76)], 8, True))
    h = dome(sole, .2) * (.72 + .28 * np.abs(np.cos((g.y + .1) * 2.0)))
    for x, y, r in [(-.26, .56, .135), (-.03, .66, .085), (.13, .63, .075), (.26, .56, .066), (.36, .45, .058)]:
        h = np.maximum(h, .9 * dome(np.hypot((g.x - x), (g.y - y) * .85) - r, r))
    return h


def foot_boot(g):
    front = polygon(g, curve([(-.3, -.12), (.3, -.12), (.38, .3), (.26, .78), (0, .9), (-.26, .78), (-.36, .3)], 8, True))
    heel = polygon(g, curve([(-.26, -.34), (.26, -.34), (.27, -.7), (0, -.9), (-.27, -.7)], 8, True))
    lugs = .35 + .65 * step(-.2, .3, np.cos(g.y * 26 + 3.2 * np.abs(g.x)))
    border = step(-.09, -.05, np.minimum(front, heel))
    return np.maximum(bevel(front, .04), bevel(heel, .04)) * np.maximum(lugs, border)


def paw(g, toes, pad, claws_far=0.0):
    h = dome(pad, .2)
    for x, y, turn, a, b in toes:
        c = g.at(x, y, turn)
        h = np.maximum(h, .92 * dome((np.hypot(c.x / a, c.y / b) - 1) * min(a, b), min(a, b)))
        if claws_far:
            t = np.radians(turn + 90)
            h = np.maximum(h, .7 * dome(stroke(c, [(0, b + claws_far * .5), (0, b + claws_far)], [.035, .008]), .03))
    return h


def paw_dog(g):
    pad = polygon(g, curve([(0, -.04), (.3, -.22), (.46, -.52), (.24, -.66), (0, -.58), (-.24, -.66), (-.46, -.52), (-.3, -.22)], 8, True))
    return paw(g, [(-.2, .42, 8, .15, .22), (.2, .42, -8, .15, .22), (-.55, .08, 24, .14, .2), (.55, .08, -24, .14, .2)], pad, .13)


def paw_cat(g):
    pad = smin(smin(circle(g, 0, -.2, .26), circle(g, -.26, -.42, .17), .12), smin(circle(g, .26, -.42, .17), circle(g, 0, -.46, .16), .1), .1)
    return paw(g, [(-.19, .42, 4, .15, .19), (.2, .44, -4, .15, .19), (-.55, .13, 20, .14, .18), (.56, .15, -20, .14, .18)], pad)


def paw_bear(g):
    pad = polygon(g, curve([(-.6, .0), (0, .12), (.58, .02), (.62, -.34), (.2, -.62), (-.3, -.55), (-.66, -.3)], 8, True))
    toes = [(-.6, .24, 22, .11, .13), (-.32, .4, 8, .12, .14), (0, .45, 0, .12, .14), (.32, .41, -8, .12, .14), (.6, .26, -20, .11, .13)]
    return paw(g, toes, pad, .25)


def hoof(g):
    d = np.hypot(g.x / .72, (g.y - .05) / .82) - 1
    arch = np.maximum(d, -(np.hypot(g.x / .42, (g.y - .02) / .56) - 1))
    arch = np.maximum(arch, -(g.y + .72 - .25 * np.abs(g.x)))
    h = bevel(arch * .7, .09)
    for k in range(3):
        for s in (-1, 1):
            a = np.radians(90 + s * (38 + 34 * k))
            h = h - .55 * bevel(box(g.at(.575 * np.cos(a), .05 + .68 * np.sin(a), np.degrees(a)), .032, .06, .02), .025)
    return h


def track_bird(g):
    d = np.full(g.x.shape, 9.0)
    for turn, long in ((90, .82), (48, .74), (132, .74), (-82, .5)):
        t = np.radians(turn)
        p = [(0, -.18), (long * .55 * np.cos(t), -.18 + long * .55 * np.sin(t)), (long * np.cos(t), -.18 + long * np.sin(t))]
        d = smin(d, stroke(g, p, [.085, .06, .012]), .05)
    knots = .12 * np.cos(g.r * 22)
    return dome(d, .07) * (.88 + knots)


def tyre(g):
    y = np.mod(g.y * 4 + 1.2 * np.abs(g.x), 1)
    block = step(.1, .2, y) * (1 - step(.8, .9, y))
    groove_ = 1 - bump(np.abs(g.x) - .0, .06) - bump(np.abs(g.x) - .34, .05)
    ends = 1 - step(.78, .93, np.abs(g.y))
    return bevel(np.abs(g.x) - .66, .06) * np.clip(block * groove_, 0, 1) * ends


# ---- ornaments ----

def rosette(g):
    h = np.zeros(g.x.shape)
    for n, inner, outer, wide, turn, level in ((8, .2, .92, .3, np.pi / 8, .5), (8, .15, .8, .25, 0, .72), (8, .1, .46, .16, np.pi / 8, .9)):
        x, y, t, d = petals(g, n, inner, outer, wide, turn)
        h = np.maximum(h, level * dome(d, .16) * (.7 + .3 * np.clip(np.abs(y) * 9, 0, 1)) * (.75 + .25 * step(.3, 1, t)))
    return np.maximum(h, dome(circle(g, 0, 0, .16), .16) * 1.0)


def trefoil(g):
    d = np.full(g.x.shape, 9.0)
    for k in range(3):
        a = np.pi / 2 + TAU * k / 3
        d = np.minimum(d, circle(g, .36 * np.cos(a), .36 * np.sin(a), .3))
    frame = bump(g.r - .85, .1)
    return np.maximum(np.maximum(frame, .8 * bump(d - .05, .09)), .45 * dome(d + .05, .2) * (d < -.05))


def quatrefoil(g):
    d = np.full(g.x.shape, 9.0)
    for k in range(4):
        a = TAU * k / 4
        d = np.minimum(d, circle(g, .42 * np.cos(a), .42 * np.sin(a), .38))
    d = np.minimum(d, box(g, .42, .42))
    boss = dome(np.hypot(g.x, g.y) - .16, .16)
    leafs = petals(g, 4, .18, .62, .13)[3]
    return np.maximum(np.maximum(bump(d + .05, .1), .5 * bump(d + .2, .05)), np.maximum(.9 * boss, .7 * dome(leafs, .13)))


def acanthus(g):
    c = g.at(0, -.05)
    h = np.zeros(g.x.shape)
    for level, (y, turn, long, wide) in enumerate([(-.55, 72, .34, .12), (-.4, 58, .5, .15), (-.2, 46, .56, .16), (.05, 34, .5, .15), (.3, 20, .4, .13)]):
        for s in (-1, 1):
            m = Grid.__new__(Grid)
            m.set(c.x * s, c.y)
            b = m.at(.05, y, 90 - turn).at(long * .55, -.12 * long)
            b2 = Grid.__new__(Grid)
            b2.set(b.x, b.y - .45 * b.x**2 + .06)
            d = blade(b2, long * .62, wide)
            h = np.maximum(h, (.55 + .08 * level) * dome(d, .12) * (.82 + .18 * np.abs(np.cos(b2.y * 26))))
    top = blade(g.at(0, .42, 90), .46, .15)
    h = np.maximum(h, .95 * dome(top, .13) * (.75 + .25 * np.clip(np.abs(g.x) * 14, 0, 1)))
    stem = stroke(g, [(0, -.88), (0, .5)], [.075, .03])
    return np.maximum(h, dome(stem, .06))


def fleur_de_lis(g):
    mid = polygon(g, curve([(0, .92), (.2, .55), (.21, .25), (.09, -.12), (-.09, -.12), (-.21, .25), (-.2, .55)], 8, True))
    h = dome(mid, .16) * (.8 + .2 * np.clip(np.abs(g.x) * 12, 0, 1))
    m = Grid.__new__(Grid)
    m.set(np.abs(g.x), g.y)
    side = stroke(m, curve([(.1, -.14), (.2, .22), (.46, .5), (.72, .4), (.74, .14), (.56, .1)], 8), np.interp(np.linspace(0, 1, 41), [0, .4, .75, 1], [.05, .14, .1, .06]))
    h = np.maximum(h, .85 * dome(side, .12))
    foot = polygon(m, curve([(-.1, -.2), (.1, -.22), (.34, -.5), (.4, -.7), (.22, -.56), (.1, -.62), (0, -.88), (-.1, -.62)], 8, True))
    h = np.maximum(h, .75 * dome(foot, .1))
    return np.maximum(h, .95 * dome(box(g.at(0, -.17), .36, .075, .07), .075))


def celtic_knot(g):
    t = np.linspace(0, TAU, 200, endpoint=False)
    p = np.stack([.3 * np.sin(t) + .5 * np.sin(2 * t), .3 * np.cos(t) - .5 * np.cos(2 * t)], 1) * .95
    return ribbon(g, p, np.sin(3 * t), .13)


def celtic_cross_knot(g):
    t = np.linspace(0, TAU, 260, endpoint=False)
    r = .56 + .26 * np.cos(5 * t)
    p = np.stack([r * np.cos(2 * t), r * np.sin(2 * t)], 1)
    return ribbon(g, p, np.sin(5 * t), .1)


def ribbon(g, p, z, half):
    """A closed band with a groove along its middle; where it crosses itself, z decides which part is above."""
    h, n = np.zeros(g.x.shape), len(p)
    for k in range(n):
        (ax, ay), (bx, by) = p[k], p[(k + 1) % n]
        d = line(g, ax, ay, bx, by)
        lift = .62 + .38 * z[k]
        profile = bevel(d - half, .04) * (.9 - .3 * bump(d, .045))
        h = np.maximum(h, profile * (.4 + .6 * lift))
    return h


def meander(g):
    p = [(-.84, -.6), (-.84, .6), (.6, .6), (.6, -.3), (-.3, -.3), (-.3, .15), (.15, .15)]
    q = [(-.84, -.6), (.84, -.6), (.84, -.35)]
    d = np.minimum(polyline_box(g, p, .085), polyline_box(g, q, .085))
    return bevel(d, .05)


def polyline_box(g, points, half):
    """Distance from a path of level and upright lines with square ends."""
    d = np.full(g.x.shape, 9.0)
    for (ax, ay), (bx, by) in zip(points, points[1:]):
        c = g.at((ax + bx) / 2, (ay + by) / 2)
        d = np.minimum(d, box(c, abs(bx - ax) / 2 + half, abs(by - ay) / 2 + half))
    return d


def compass_star(g):
    def star(n, r, turn):
        a = np.mod(g.a + turn, TAU / n)
        a = np.where(a > TAU / n / 2, TAU / n - a, a)
        tip, valley = r, r * .3
        x, y = g.r * np.cos(a), g.r * np.sin(a)
        b = np.pi / n
        nx, ny = valley * np.sin(b), tip - valley * np.cos(b)
        k = np.hypot(nx, ny)
        return ((tip - x) * nx - y * ny) / k / (tip * nx / k)
    h = np.maximum(.7 * np.clip(star(4, .62, np.pi / 4), 0, 1), np.clip(star(4, .92, 0), 0, 1))
    ring = .42 * bump(g.r - .52, .06)
    return np.maximum(h, ring)


def sun_face(g):
    rays = g.r - .62 - .26 * np.abs(np.mod(g.a * 16 / TAU + .06 * np.sin(30 * g.r), 1) * 2 - 1)**1.0
    h = .5 * bevel(rays, .09)
    disc = circle(g, 0, 0, .56)
    h = np.where(disc < 0, .5 + .42 * dome(disc, .5), h)
    m = Grid.__new__(Grid)
    m.set(np.abs(g.x), g.y)
    h = h - .25 * bevel(np.hypot((m.x - .2) / .1, (m.y - .12) / .05) - 1, .5)
    h = h + .16 * bump(stroke(m, curve([(.06, .26), (.2, .29), (.34, .2)], 6), .0), .05)
    h = h + .2 * dome(polygon(g, [(-.03, .15), (.03, .15), (.09, -.1), (-.09, -.1)]), .06)
    return h - .25 * groove(np.abs(stroke(m, curve([(0, -.26), (.12, -.25), (.24, -.18)], 6), .0)) - .005, .04)


def medallion(g):
    rim = bump(g.r - .84, .08)
    beads = dome((np.hypot(g.r - .68, .68 * (np.mod(g.a * 32 / TAU, 1) - .5) * TAU / 32) - .055), .055)
    disc = .35 * bevel(circle(g, 0, 0, .56), .06)
    x, y, t, d = petals(g, 6, .0, .5, .16)
    flower = .35 + .5 * dome(d, .14)
    return np.maximum(np.maximum(rim, .7 * beads), np.where(d < 0, np.maximum(flower * (g.r < .56), disc), disc) + .3 * dome(circle(g, 0, 0, .12), .12))


def shield(g):
    d = polygon(g, curve([(-.7, .8), (0, .86), (.7, .8), (.7, .1), (.42, -.55), (0, -.9), (-.42, -.55), (-.7, .1)], 6, True))
    field = .55 * bevel(d, .08) + .12 * np.clip(1 - np.abs(g.x) / .7, 0, 1) * bevel(d, .2)
    cross = np.minimum(box(g.at(0, .0), .09, .9), box(g.at(0, .22), .9, .09))
    return np.maximum(field + .22 * bevel(np.maximum(cross, d + .12), .04), .95 * bump(d + .07, .07))


def volute(g):
    t = np.linspace(0, 5.2 * np.pi, 150)
    r = .62 * np.exp(-.135 * t)
    p = np.stack([r * np.cos(t + .3), r * np.sin(t + .3) + .12], 1)
    tail = curve([(.85, -.75), (.75, -.2), tuple(p[0])], 10)
    d = stroke(g, np.vstack([tail, p]), np.concatenate([np.linspace(.05, .12, len(tail)), np.linspace(.12, .02, len(p))]))
    return np.maximum(dome(d, .11), dome(circle(g, *p[-1], .1), .1))


def heart(g):
    m = Grid.__new__(Grid)
    m.set(np.abs(g.x), g.y)
    d = polygon(g, curve([(0, .42), (.3, .72), (.68, .68), (.82, .32), (.6, -.15), (0, -.82), (-.6, -.15), (-.82, .32), (-.68, .68), (-.3, .72)], 8, True))
    return dome(d, .5)


def anchor(g):
    d = np.minimum(stroke(g, [(0, .5), (0, -.72)], [.065, .085]), stroke(g, [(-.34, .36), (.34, .36)], .06))
    arc = stroke(g, [(.62 * np.cos(a), -.12 + .62 * np.sin(a)) for a in np.radians(np.linspace(195, 345, 24))], np.interp(np.linspace(0, 1, 24), [0, .5, 1], [.04, .1, .04]))
    d = smin(d, arc, .04)
    d = np.minimum(d, np.abs(circle(g, 0, .7, .14)) - .05)
    for s in (-1, 1):
        d = np.minimum(d, polygon(g, [(s * .78, -.46), (s * .66, .06), (s * .42, -.24)]))
    return dome(d, .075)


def skull(g):
    m = Grid.__new__(Grid)
    m.set(np.abs(g.x), g.y)
    head = np.hypot(m.x / .66, (m.y - .22) / .62) - 1
    jaw = box(g.at(0, -.5), .36, .34, .14)
    d = smin(head * .6, jaw, .12)
    h = dome(d, .42)
    socket = np.hypot((m.x - .27) / .19, (m.y - .08) / .18) - 1
    h = h - .62 * bevel(socket, .5) * 1.0
    h = h - .5 * bevel(polygon(m, [(-.02, -.12), (.05, -.12), (.12, -.32), (-.02, -.3)]), .05)
    h = h + .14 * bump(np.hypot((m.x - .27) / .25, (m.y - .08) / .24) - 1, .2) * (d < 0)
    tooth = bump(np.mod(g.x / .12 + .5, 1) - .5, .14) * bevel(box(g.at(0, -.62), .3, .15), .04)
    return h - .35 * tooth - .25 * bump(g.y + .62, .02) * bevel(box(g.at(0, -.62), .3, .15), .04)


# ---- plates ----

def plate(g, w=.92, h=.6, corner=.12):
    d = box(g, w, h, corner)
    return .45 * bevel(d, .05) + .2 * bump(d + .1, .035)


def plate_blank(g):
    h = plate(g)
    for x in (-.72, .72):
        c = circle(g, x, 0, .085)
        h = h + .3 * dome(c, .085) - .3 * bevel(box(g.at(x, 0, 30), .08, .016), .015)
    return h


def plate_arrow(g):
    d = polygon(g, [(-.62, -.11), (.08, -.11), (.08, -.36), (.64, 0), (.08, .36), (.08, .11), (-.62, .11)])
    return plate(g) + .45 * bevel(d, .05)


def plate_warning(g):
    d = polygon(g, [(0, .86), (.94, -.74), (-.94, -.74)]) - .02
    h = .45 * bevel(d, .06) + .3 * bump(d + .13, .05)
    return h + .5 * bevel(np.minimum(stroke(g, [(0, .26), (0, -.2)], [.085, .05]), circle(g, 0, -.44, .085)), .04)


DIGITS = {
    '0': [[(.26 * np.sin(a), .42 * np.cos(a)) for a in np.linspace(0, TAU, 33)]],
    '1': [[(-.16, .26), (.04, .42), (.04, -.42)], [(-.16, -.42), (.24, -.42)]],
    '2': [curve([(-.25, .24), (0, .43), (.25, .22), (.12, -.06), (-.25, -.42)], 8), [(-.25, -.42), (.28, -.42)]],
    '3': [curve([(-.23, .32), (.02, .43), (.22, .24), (-.02, .03)], 8), curve([(-.02, .03), (.27, -.18), (.02, -.43), (-.26, -.3)], 8)],
    '4': [[(.1, -.42), (.1, .42), (-.28, -.16), (.28, -.16)]],
    '5': [[(.22, .42), (-.18, .42), (-.21, .06)], curve([(-.21, .06), (.06, .11), (.27, -.14), (.05, -.42), (-.25, -.33)], 8)],
    '6': [curve([(.2, .36), (-.02, .42), (-.25, .05), (-.22, -.25), (.02, -.43), (.25, -.18), (.03, .05), (-.23, -.14)], 8)],
    '7': [[(-.26, .42), (.27, .42), (-.06, -.42)]],
    '8': [[(.2 * np.sin(a), .23 + .19 * np.cos(a)) for a in np.linspace(0, TAU, 25)], [(.26 * np.sin(a), -.2 + .23 * np.cos(a)) for a in np.linspace(0, TAU, 25)]],
    '9': [curve([(-.2, -.36), (.02, -.42), (.25, -.05), (.22, .25), (-.02, .43), (-.25, .18), (-.03, -.05), (.23, .14)], 8)],
}


def digit(sign):
    def draw(g):
        c, d = g.at(scale=1.25), np.full(g.x.shape, 9.0)
        for part in DIGITS[sign]:
            d = np.minimum(d, stroke(c, part, .085))
        token = .4 * bevel(circle(g, 0, 0, .93), .06) + .25 * bump(g.r - .83, .045)
        return token + .5 * bevel(d, .055)
    return draw


# Group, then name, function, words for the search; "lower" first: to be carved.
STAMPS = [
    ("Damage", [
        ("chip", chip, "lower stone edge broken"), ("chip-flake", chip_flake, "lower stone flint shell conchoidal"),
        ("chip-corner", chip_corner, "lower stone brick broken"), ("crack", crack, "lower wall fracture"),
        ("crack-branching", crack_branching, "lower wall fracture lightning"), ("crack-star", crack_star, "lower glass impact shatter"),
        ("crack-web", crack_web, "lower glaze paint dry crackle"), ("dent", dent, "lower metal ding"),
        ("dent-crease", dent_edge, "lower metal car fold"), ("dents", dents, "lower metal hail hammered"),
        ("bullet-hole", bullet_hole, "metal shot impact"), ("bullet-petals", bullet_petals, "metal exit torn burst"),
        ("bullet-stone", bullet_stone, "lower wall shot impact"), ("crater", crater, "moon impact"),
        ("crater-rayed", crater_rayed, "moon impact ejecta"), ("scratches", scratches, "lower scuff worn"),
        ("gouge", gouge, "lower wood tool cut"), ("claws", claws, "lower monster scratch tear"),
        ("pits", pits, "lower rust corrosion pores"), ("drip", drip, "paint slime wax run"),
        ("splat", splat, "paint mud slime drop"), ("water-stain", puddle_ring, "puddle ring limescale")]),
    ("Hardware", [
        ("bolt-hex", bolt_hex, "screw metal head"), ("bolt-socket", bolt_socket, "screw allen metal"),
        ("screw-slot", screw_slot, "metal head"), ("screw-cross", screw_cross, "phillips metal head"),
        ("screw-star", screw_star, "torx metal head"), ("rivet", rivet, "metal dome"),
        ("rivet-flush", rivet_flush, "metal aircraft flat"), ("rivet-hammered", rivet_hammered, "metal forged nail"),
        ("washer", washer, "metal ring disc"), ("nut", nut, "metal thread"), ("gear", gear, "cog machine wheel"),
        ("gear-spoked", gear_spoked, "cog machine wheel clock"), ("keyhole", keyhole, "lock door"),
        ("grille", grille, "vent speaker panel"), ("hatch", hatch, "panel door handle sci-fi"),
        ("louvre", vent_louvre, "vent slats panel"), ("chain-link", chain_link, "metal ring"), ("knob", knob, "dial handle control")]),
    ("Cloth", [
        ("stitch-cross", stitch_cross, "thread sewing seam"), ("stitch-row", stitch_row, "thread sewing seam leather"),
        ("stitch-chain", stitch_chain, "thread sewing embroidery"), ("stitch-herringbone", stitch_herring, "thread sewing embroidery"),
        ("button", button, "coat shirt"), ("button-tufted", button_tufted, "sofa quilt cushion upholstery"),
        ("zip", zip_teeth, "zipper fastener"), ("knot", celtic_knot, "cord rope trefoil celtic")]),
    ("Nature", [
        ("leaf-oak", leaf_oak, "plant tree autumn"), ("leaf-maple", leaf_maple, "plant tree autumn"),
        ("leaf-fern", leaf_fern, "plant frond forest"), ("leaf-ginkgo", leaf_ginkgo, "plant tree fan"),
        ("leaf-willow", leaf_willow, "plant twig branch olive"), ("feather", feather, "bird wing quill"),
        ("shell-scallop", shell_scallop, "sea beach"), ("shell-ammonite", shell_spiral, "sea fossil spiral nautilus snail"),
        ("shell-cone", shell_cone, "sea beach snail whelk"), ("starfish", starfish, "sea beach"),
        ("sand-dollar", sand_dollar, "sea urchin beach"), ("coral", coral, "sea branch tree"),
        ("flower-daisy", flower_daisy, "plant blossom"), ("flower-rose", flower_rose, "plant blossom"),
        ("flower-lily", flower_lily, "plant blossom"), ("pine-cone", pine_cone, "plant tree"),
        ("bark-knot", bark_knot, "wood tree eye"), ("tree-rings", tree_rings, "wood stump log"),
        ("pebble", pebble, "stone beach river"), ("pebbles", pebbles, "stone gravel beach"),
        ("stone-broken", stone_broken, "rock facet rubble"), ("crystal", crystal, "gem mineral quartz"),
        ("scale-dragon", scale_dragon, "reptile keel armour"), ("scale-tortoise", scale_plate, "reptile shell plate"),
        ("scales-patch", scales_patch, "fish reptile skin"), ("eye", eye, "face creature"), ("bone", bone, "skeleton")]),
    ("Prints", [
        ("foot-bare", foot_bare, "lower footprint track human sand"), ("foot-boot", foot_boot, "lower footprint track shoe mud"),
        ("paw-dog", paw_dog, "lower track wolf footprint"), ("paw-cat", paw_cat, "lower track footprint"),
        ("paw-bear", paw_bear, "lower track claws footprint"), ("horseshoe", hoof, "lower track hoof luck"),
        ("track-bird", track_bird, "lower footprint claw"), ("tyre", tyre, "lower tread car track mud")]),
    ("Ornament", [
        ("rosette", rosette, "flower architecture"), ("trefoil", trefoil, "gothic window architecture"),
        ("quatrefoil", quatrefoil, "gothic architecture"), ("acanthus", acanthus, "leaf architecture capital"),
        ("fleur-de-lis", fleur_de_lis, "heraldry lily"), ("knot-five", celtic_cross_knot, "celtic cord star"),
        ("meander", meander, "greek key border"), ("compass-star", compass_star, "map rose"),
        ("sun", sun_face, "face rays"), ("medallion", medallion, "coin beads"), ("shield", shield, "heraldry crest"),
        ("volute", volute, "scroll spiral capital"), ("heart", heart, "love card"), ("anchor", anchor, "sea ship"),
        ("skull", skull, "death pirate bone")]),
    ("Plates", [("plate", plate_blank, "sign label screws"), ("plate-arrow", plate_arrow, "sign direction"),
                ("plate-warning", plate_warning, "sign danger triangle")] +
     [("number-" + n, digit(n), "numeral digit letter token " + word) for n, word in zip("0123456789", "zero one two three four five six seven eight nine".split())]),
]


def draw(function):
    g = Grid()
    h = np.asarray(function(g), float)
    edge = np.maximum(np.abs(g.x), np.abs(g.y))
    h = np.clip(h, 0, None) * (1 - step(.94, .985, edge))
    h = h.reshape(SIDE, FINE, SIDE, FINE).mean((1, 3))
    return np.floor(h / h.max() * 4095 + .5).astype(int) * 16


def write(path, codes):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = codes.astype(">u2").view(np.uint8).reshape(SIDE, 2 * SIDE).astype(int)
    up = np.vstack([np.zeros((1, 2 * SIDE), int), rows[:-1]])
    left = np.hstack([np.zeros((SIDE, 2), int), rows[:, :-2]])
    corner = np.hstack([np.zeros((SIDE, 2), int), up[:, :-2]])
    p = left + up - corner
    dl, du, dc = abs(p - left), abs(p - up), abs(p - corner)
    paeth = np.where((dl <= du) & (dl <= dc), left, np.where(du <= dc, up, corner))
    body = b"".join(b"\4" + row.astype(np.uint8).tobytes() for row in (rows - paeth) % 256)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 16, 0, 0, 0, 0)) +
                chunk(b"IDAT", zlib.compress(body, 9)) + chunk(b"IEND", b""))


def main(folder, names):
    conf = "# Groups of the stamps, and words for their search; lower: to be carved. Written by stamps.py.\n"
    for group, rows in STAMPS:
        conf += f"Group: {group}\n"
        for name, function, words in rows:
            conf += f"{name}: {words}\n"
            if not names or name in names:
                write(f"{folder}/{name}.png", draw(function))
    with open(f"{folder}/stamps.conf", "w", encoding="utf-8") as f:
        f.write(conf)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
