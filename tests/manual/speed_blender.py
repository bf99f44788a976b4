"""blender -b --factory-startup -P speed_blender.py -- SIDE LOW HIGH HEIGHT OUT: a unit sphere that h.png displaces by Cycles, cut as
finely as pixels call for: codes 0 to 1 are LOW to HIGH, times HEIGHT; of height 0 it is plain. One sample a pixel, one lamp far away,
diffuse reflection and no light that comes by other ways."""
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

WIDE, TALL = 256, 128


def sphere():
    at = lambda i, j: (math.cos(math.tau * i / WIDE) * math.sin(math.pi * j / TALL),
                       math.sin(math.tau * i / WIDE) * math.sin(math.pi * j / TALL),
                       -math.cos(math.pi * j / TALL))
    points = [at(0, 0)] + [at(i, j) for j in range(1, TALL) for i in range(WIDE)] + [at(0, TALL)]
    number = lambda i, j: 0 if j == 0 else len(points) - 1 if j == TALL else 1 + (j - 1) * WIDE + i % WIDE
    faces, places = [], []
    for j in range(TALL):
        for i in range(WIDE):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            if j == 0:
                corners.pop(0)
            if j == TALL - 1:
                corners.pop()
            faces.append([number(*c) for c in corners])
            places += [(c[0] / WIDE, c[1] / TALL) for c in corners]
    mesh = bpy.data.meshes.new("sphere")
    mesh.from_pydata(points, [], faces)
    layer = mesh.uv_layers.new(name="uv")
    for k, uv in enumerate(places):
        layer.data[k].uv = uv
    for face in mesh.polygons:
        face.use_smooth = True
    return mesh


def material(low, high, height):
    made = bpy.data.materials.new("m")
    made.use_nodes = True
    made.cycles.displacement_method = "DISPLACEMENT"
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    out, diffuse = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (0.8, 0.8, 0.8, 1)
    links.new(diffuse.outputs[0], out.inputs["Surface"])
    if height == 0:
        return made
    image, move = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeDisplacement")
    image.image = bpy.data.images.load("h.png")
    image.image.colorspace_settings.name = "Non-Color"
    move.inputs["Midlevel"].default_value = low / (low - high)
    move.inputs["Scale"].default_value = height * (high - low)
    links.new(image.outputs["Color"], move.inputs["Height"])
    links.new(move.outputs[0], out.inputs["Displacement"])
    return made


def main(side, low, high, height, out):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.feature_set = "CPU", "EXPERIMENTAL"
    scene.cycles.samples, scene.cycles.max_bounces = 1, 0
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.dicing_rate = 1
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x = scene.render.resolution_y = int(side)
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.film_transparent = True  # black behind it
    ball = bpy.data.objects.new("ball", sphere())
    ball.data.materials.append(material(float(low), float(high), float(height)))
    if float(height) != 0:
        ball.modifiers.new("cut", "SUBSURF").subdivision_type = "SIMPLE"
        ball.cycles.use_adaptive_subdivision = True
    # ours lies on its side: the pole is above, u = 0 to the right
    ball.rotation_euler = (-math.pi / 2, 0, 0)
    scene.collection.objects.link(ball)
    lamp = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    lamp.data.energy, lamp.data.angle = math.pi, 0
    lamp.rotation_euler = Vector((-0.5, 0.7, 0.6)).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(lamp)
    eye = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    eye.data.angle, eye.matrix_world = math.radians(32), Matrix.Translation((0, 0, 4))
    scene.collection.objects.link(eye)
    scene.camera = eye
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0.02, 0.02, 0.02)
    scene.view_settings.view_transform, scene.render.dither_intensity = "Standard", 0
    scene.render.filepath = os.path.join(os.getcwd(), out)
    bpy.ops.render.render(write_still=True)


main(*sys.argv[sys.argv.index("--") + 1:])
