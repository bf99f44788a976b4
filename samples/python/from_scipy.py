"""Heights made by scipy: noise, filtered periodically into a leather-like grain, then a title embossed over it.

    python3 from_scipy.py [OUT.exr] [SIDE]
"""
import sys

import numpy as np
import scipy.ndimage
import wrinkle

out = sys.argv[1] if len(sys.argv) > 1 else "leather.exr"
side = int(sys.argv[2]) if len(sys.argv) > 2 else 512
noise = np.random.default_rng(7).normal(size=(side, side))
blurred = scipy.ndimage.gaussian_filter(noise, side / 100, mode="wrap")
ridges = -np.abs(blurred / blurred.std())
doc = wrinkle.Document(side, side)
doc.heights = 0.2 * scipy.ndimage.gaussian_filter(ridges, side / 400, mode="wrap")  # one step of undo
doc.layer("add", "title", from_=f'text Leather size={side / 6:.0f} height=0.5')
doc.save(out)
