"""The error of each interpolation scheme against its time, for heights with known slopes, as a plot.

    python3 error_against_time.py [OUT.png] [POINTS]
"""
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import wrinkle

out = sys.argv[1] if len(sys.argv) > 1 else "error.png"
count = int(sys.argv[2]) if len(sys.argv) > 2 else 200_000
side, waves = 128, 5
u = (np.arange(side) + 0.5) / side
v = 1 - u
doc = wrinkle.Document(side, side)
doc.heights = np.outer(np.cos(2 * np.pi * 2 * v), np.sin(2 * np.pi * waves * u))
points = np.random.default_rng(1).random((count, 2))
true = 2 * np.pi * waves * np.cos(2 * np.pi * 2 * points[:, 1]) * np.cos(2 * np.pi * waves * points[:, 0])
schemes = next(a for a in wrinkle.commands["bump"]["args"] if a["name"] == "scheme")["choices"]
figure, axes = plt.subplots(figsize=(7, 5))
for scheme in schemes:
    begin = time.perf_counter()
    fu = doc.sample(points, scheme).fu
    seconds = time.perf_counter() - begin
    error = np.sqrt(np.mean((fu - true) ** 2) / np.mean(true**2))
    axes.loglog(1e9 * seconds / count, error, "o")
    axes.annotate(scheme, (1e9 * seconds / count, error), xytext=(0, 7), textcoords="offset points", ha="center")
axes.set_xlabel("time, ns per sample")
axes.set_ylabel("relative error of dF/du, root mean square")
axes.set_title(f"{waves} waves over {side} texels")
axes.margins(0.15)
axes.grid(True, which="both", alpha=0.3)
figure.tight_layout()
figure.savefig(out, dpi=120)
