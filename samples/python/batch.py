"""A hundred knurled cells: every pair of ten counts and ten depths, as normal maps and a table of their steepest slopes.

    python3 batch.py [FOLDER] [SIDE]
"""
import csv
import pathlib
import sys

import numpy as np
import wrinkle

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "cells")
side = int(sys.argv[2]) if len(sys.argv) > 2 else 256
folder.mkdir(exist_ok=True)
doc = wrinkle.Document(side, side)
with open(folder / "cells.csv", "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["file", "across", "height", "steepest degrees"])
    for across in range(4, 14):
        for height in np.linspace(0.1, 1, 10):
            doc.fill(0)
            doc.pattern("knurl", across=across, height=height)
            name = f"knurl-{across}-{height:.1f}.png"
            doc.export("normal+y", folder / name)
            slope = np.hypot(doc.slopes[..., 0], doc.slopes[..., 1]).max()
            table.writerow([name, across, f"{height:.1f}", f"{np.degrees(np.arctan(slope)):.2f}"])
