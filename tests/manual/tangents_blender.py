"""blender -b -P tangents_blender.py -- LISTING: our frames beside those of Blender's mesh.calc_tangents, which is the MikkTSpace
code itself. LISTING: what tangents_dump prints. Prints one line: corners that were compared, those whose sign differs,
those whose tangents are over 0.05 and over 1 degree apart, and the median and 99th percentile of that angle."""
import math
import sys

import bpy

corners = [list(map(float, line.split())) for line in open(sys.argv[-1])]
count = len(corners)
mesh = bpy.data.meshes.new("m")
# One vertex a place: corners about it with one normal then keep one normal in Blender too, and their frames are averaged.
places = {}
at = [places.setdefault(tuple(c[0:3]), len(places)) for c in corners]
mesh.from_pydata(list(places), [], [at[i:i + 3] for i in range(0, count, 3)])
layer = mesh.uv_layers.new(name="uv")
for i, c in enumerate(corners):
    layer.data[i].uv = c[6:8]
mesh.use_auto_smooth = True
for face in mesh.polygons:
    face.use_smooth = True
mesh.normals_split_custom_set([c[3:6] for c in corners])
mesh.calc_tangents(uvmap="uv")

angles, signs, left_out = [], 0, 0
for i, c in enumerate(corners):
    loop = mesh.loops[i]
    near = sum(a * b for a, b in zip(loop.normal, c[3:6]))
    # Blender keeps normals in 16 bits, and turns those that lean over their face.
    if near < math.cos(math.radians(0.05)):
        left_out += 1
        continue
    t = c[8:11]
    cross = math.dist([0, 0, 0], [t[(k + 1) % 3] * loop.tangent[(k + 2) % 3] - t[(k + 2) % 3] * loop.tangent[(k + 1) % 3] for k in range(3)])
    angles.append(math.degrees(math.atan2(cross, sum(a * b for a, b in zip(t, loop.tangent)))))
    signs += (loop.bitangent_sign < 0) != (c[11] < 0)
angles.sort()
size = len(angles)
print("compared %d of %d signs %d over_0.05 %d over_1 %d median %.2g p99 %.2g" % (
    size, count, signs, sum(a > 0.05 for a in angles), sum(a > 1 for a in angles),
    angles[size // 2], angles[size * 99 // 100]) if size else "compared 0 of %d" % count)
