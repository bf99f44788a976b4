"""blender -b --factory-startup -P maps_blender.py -- SIDE CASE...: our maps by Cycles, beside our own pictures. A case is
NAME,SHAPE,MAP,FILE,HEIGHT,LIGHT,OURS,SMOOTH,MOST,RMS: plane, or a sphere of those below; normal or bump; the map's file; the bump's height; x:y:z
towards the light; what the names of our pictures with and without bumps begin with; how far the pictures may be apart.
Orthographic, one sun, diffuse and nothing else, one sample in the middle of each of SIDE x SIDE pixels."""
import math
import sys

import bpy
from mathutils import Matrix, Vector

# Of a shape: quads each way, and how often the map goes round it and from pole to pole.
SPHERES = {"sphere": (512, 256, 4, 2), "ball": (256, 128, 1, 1)}


def plane():
    mesh = bpy.data.meshes.new("plane")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="uv")
    for i, uv in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]):
        layer.data[i].uv = uv
    return mesh


def sphere(wide, tall, across, down):
    """u is the longitude from +x eastwards, v the latitude from the south pole, as in ours."""
    at = lambda i, j: (math.cos(math.tau * i / wide) * math.sin(math.pi * j / tall),
                       math.sin(math.tau * i / wide) * math.sin(math.pi * j / tall),
                       -math.cos(math.pi * j / tall))
    number = lambda i, j: (j * wide + i % wide)
    mesh = bpy.data.meshes.new("sphere")
    faces = [(number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)) for j in range(1, tall - 1) for i in range(wide)]
    mesh.from_pydata([at(i, j) for j in range(tall + 1) for i in range(wide)], [], faces)
    layer = mesh.uv_layers.new(name="uv")
    k = 0
    for j in range(1, tall - 1):
        for i in range(wide):
            for (di, dj) in ((0, 0), (1, 0), (1, 1), (0, 1)):
                layer.data[k].uv = (across * (i + di) / wide, down * (j + dj) / tall)
                k += 1
    mesh.use_auto_smooth = True
    for face in mesh.polygons:
        face.use_smooth = True
    mesh.normals_split_custom_set_from_vertices([v.co.normalized() for v in mesh.vertices])
    return mesh


def look(thing, at, up):
    """Stand there and look along the thing's -z to the middle, with its y up."""
    z, middle = at.normalized(), up
    x = middle.cross(z).normalized()
    y = z.cross(x)
    thing.matrix_world = Matrix([[x[k], y[k], z[k], 0] for k in range(3)] + [[0, 0, 0, 1]])


def material(kind, path, height):
    made = bpy.data.materials.new("m")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    out, diffuse = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    links.new(diffuse.outputs[0], out.inputs[0])
    image = nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.load(path)
    image.image.colorspace_settings.name = "Non-Color"
    if kind == "normal":
        turn = nodes.new("ShaderNodeNormalMap")
        turn.uv_map = "uv"
        links.new(image.outputs["Color"], turn.inputs["Color"])
    else:
        turn = nodes.new("ShaderNodeBump")
        turn.inputs["Distance"].default_value = height
        links.new(image.outputs["Color"], turn.inputs["Height"])
    links.new(turn.outputs[0], diffuse.inputs["Normal"])
    return made


def render(shape, kind, path, height, light, out, side):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("w")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0, 0, 0, 1)
    mesh = plane() if shape == "plane" else sphere(*SPHERES[shape])
    mesh.materials.append(material(kind, path, height))
    scene.collection.objects.link(bpy.data.objects.new("o", mesh))
    sun = bpy.data.lights.new("s", "SUN")
    sun.energy, sun.angle = math.pi, 0.0
    lamp = bpy.data.objects.new("s", sun)
    scene.collection.objects.link(lamp)
    aside = Vector((0, 1, 0)) if abs(light[1]) < 0.9 * Vector(light).length else Vector((1, 0, 0))
    look(lamp, Vector(light), aside)
    camera = bpy.data.cameras.new("c")
    camera.type, camera.ortho_scale = "ORTHO", 1.0 if shape == "plane" else 2.2
    eye = bpy.data.objects.new("c", camera)
    scene.collection.objects.link(eye)
    if shape == "plane":
        eye.location = (0.5, 0.5, 3)
    else:
        eye.matrix_world = Matrix([[0, 0, 1, 5], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    scene.camera = eye
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    scene.cycles.pixel_filter_type, scene.render.filter_size = "BOX", 0.01
    scene.cycles.filter_width = 0.01
    scene.render.resolution_x = scene.render.resolution_y = side
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


# ---- beside ours ----


def read(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    return list(image.pixels)[::4]


def vectors(ours):
    """Of pictures lit along each axis, both ways."""
    x, x_down, y, y_down, z, z_down = (read("%s_%s.exr" % (ours, axis)) for axis in ("x", "-x", "y", "-y", "z", "-z"))
    return [(a - b, c - d, e - f) for a, b, c, d, e, f in zip(x, x_down, y, y_down, z, z_down)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def dimmed(n, smooth, light):
    """What Cycles makes darker of a diffuse bump (Estevez, Lecocq, Stein: A Microfacet-Based Shadowing Function to Solve the
    Bump Terminator Problem, 2019)."""
    lit = dot(n, light)
    if lit <= 0 or dot(smooth, light) <= 0:
        return 0.0
    g = dot(smooth, light) / (lit * dot(n, smooth))
    return 1.0 if g >= 1 else g + g * g - g * g * g


def compare(name, theirs, ours, smooth, light, eye, most, most_rms):
    """Cycles bends normals that would mirror the eye's ray into the surface: pixels are left out where it does, and those
    that are seen at over 70 degrees or are lit from behind."""
    light = list(Vector(light).normalized())
    sums, worst, plain_sums, plain, count = 0.0, 0.0, 0.0, 0.0, 0
    for there, here, n, s in zip(read(theirs), read(ours + "_lit.exr"), vectors(ours), vectors(smooth)):
        facing, turned = dot(s, eye), dot(n, eye)
        mirrored = [2 * turned * a - b for a, b in zip(n, eye)]
        if facing < 0.34 or turned < 0.2 or dot(mirrored, s) < 0.02 or dot(n, n) < 0.98 or dot(s, light) < 0.05:
            continue
        off = abs(there - here * dimmed(n, s, light))
        sums, worst = sums + off * off, max(worst, off)
        plain_sums, plain = plain_sums + (there - here) ** 2, max(plain, abs(there - here))
        count += 1
    rms = (sums / max(count, 1)) ** 0.5
    good = count > 1000 and worst <= most and rms <= most_rms
    print("compared %s: %d pixels, largest %.2g, rms %.2g (bounds %g, %g); as they are %.2g, %.2g: %s" % (
        name, count, worst, rms, most, most_rms, plain, (plain_sums / max(count, 1)) ** 0.5, "good" if good else "BAD"))


for case in sys.argv[sys.argv.index("--") + 2:]:
    name, shape, kind, path, height, light, ours, smooth, most, most_rms = case.split(",")
    light = [float(x) for x in light.split(":")]
    render(shape, kind, path, float(height), light, "theirs_%s.exr" % name, int(sys.argv[sys.argv.index("--") + 1]))
    compare(name, "theirs_%s.exr" % name, ours, smooth, light, (0, 0, 1) if shape == "plane" else (1, 0, 0), float(most), float(most_rms))
