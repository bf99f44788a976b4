"""A data set for learning: pictures of random reliefs under known lights, with the true heights and normals of each pixel.

    python3 normals_data_set.py [FOLDER] [COUNT] [SIDE]

Each NAME.npz has image (sRGB codes), heights, normals and light (direction towards it).
"""
import pathlib
import sys

import numpy as np
import wrinkle

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "data")
count = int(sys.argv[2]) if len(sys.argv) > 2 else 20
side = int(sys.argv[3]) if len(sys.argv) > 3 else 128
folder.mkdir(exist_ok=True)
random = np.random.default_rng(3)
doc = wrinkle.Document(side, side)
doc.surface("plane")
doc.camera("orthographic", eye=(0, 0, 5), fit=False, size=1)
doc.bump(mode="exact", height=0.1, scheme="bspline-fit")
doc.material(specular=0, ambient=0, diffuse=1, colour=(1, 1, 1))
for i in range(count):
    doc.fill(0)
    doc.noise("perlin", cells=int(random.integers(2, 9)), octaves=int(random.integers(1, 5)),
              seed=int(random.integers(1000)), amplitude=float(random.uniform(0.2, 1)))
    angle, height = random.uniform(0, 2 * np.pi), random.uniform(0.4, 1)
    light = np.array([np.cos(angle), np.sin(angle), height * 2])
    light /= np.linalg.norm(light)
    doc.light("clear")
    doc.light("directional", to=tuple(light))
    np.savez(folder / f"{i:04d}.npz", image=doc.render(side, side, channels=3), heights=doc.heights,
             normals=doc.normals, light=light)
