"""The add-on in Blender: installed from ZIP, with the program WRINKLE, in the current folder. An exception fails.

Known answers do not come from Wrinkle's files: F(u,v) = sin(2 pi u) cos(4 pi v) / 2 on a cell of 0.3 m x 0.2 m, F = 1 being 12 mm high."""
import math
import os
import signal
import subprocess
import threading
import time

import bpy

WRINKLE, ZIP = os.environ["WRINKLE"], os.environ["ZIP"]
WIDE, TALL, HIGH = 0.3, 0.2, 0.012
WAVE = "table %dx%d\nformula %s\nbump height=0.1 scheme=bspline-fit\ncell 300,200 mm=on height=12\n"
FORMULA = "fourier terms=1,2,0.5,-90,0"


def write(name, text):
    with open(name + ".new", "w") as file:
        file.write(text)
    os.rename(name + ".new", name)
    return os.path.abspath(name)


def folder(name):
    os.makedirs(name)
    return os.path.abspath(name)


def wrinkle(script):
    subprocess.run([WRINKLE, "run", write("run.wrinkle", script)], check=True, capture_output=True)


def fails(operator, sentence, **values):
    try:
        operator(**values)
    except RuntimeError as why:
        assert sentence in str(why), "%s: it says %r" % (sentence, str(why))
        return
    raise AssertionError("no error: " + sentence)


def median(values):
    return sorted(values)[len(values) // 2]


def plane(across, down, wide=WIDE, tall=TALL):
    """A rectangle of wide x tall metres with (u,v) 0..1, as an object of its own, active."""
    points = [(wide * i / across, tall * j / down, 0) for j in range(down + 1) for i in range(across + 1)]
    row = across + 1
    faces = [(j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i) for j in range(down) for i in range(across)]
    mesh = bpy.data.meshes.new("plane")
    mesh.from_pydata(points, [], faces)
    layer = mesh.uv_layers.new(name="uv")
    for loop in mesh.loops:
        x, y, _ = points[loop.vertex_index]
        layer.data[loop.index].uv = (x / wide, y / tall)
    thing = bpy.data.objects.new("plane", mesh)
    bpy.context.scene.collection.objects.link(thing)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    return thing


def start_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    return scene


def enable():
    bpy.ops.preferences.addon_enable(module="wrinkle_blender")
    bpy.context.preferences.addons["wrinkle_blender"].preferences.program = WRINKLE


# ---- normals ----


def bake(thing, across, down):
    """Normals of the active object's material in its tangent space, rows from below."""
    tree = thing.active_material.node_tree
    image = bpy.data.images.new("baked", across, down, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.nodes.active = node
    bpy.ops.object.bake(type="NORMAL", normal_space="TANGENT", margin=0)
    pixels = list(image.pixels)
    tree.nodes.remove(node)
    bpy.data.images.remove(image)
    return [[2 * c - 1 for c in pixels[4 * i : 4 * i + 3]] for i in range(across * down)]


def angles(have, across, down):
    """Degrees between baked normals and those of the formula."""
    result = []
    for j in range(down):
        for i in range(across):
            u, v = (i + 0.5) / across, (j + 0.5) / down
            fu = math.pi * math.cos(math.tau * u) * math.cos(2 * math.tau * v)
            fv = -math.tau * math.sin(math.tau * u) * math.sin(2 * math.tau * v)
            n = (-HIGH * fu / WIDE, -HIGH * fv / TALL, 1.0)
            m = have[j * across + i]
            cross = [n[(k + 1) % 3] * m[(k + 2) % 3] - n[(k + 2) % 3] * m[(k + 1) % 3] for k in range(3)]
            result.append(math.degrees(math.atan2(math.hypot(*cross), sum(a * b for a, b in zip(n, m)))))
    return result


def check_normals():
    wrinkle(WAVE % (96, 70, FORMULA) + "".join("maps %s %s name=wave\n" % (s, folder(s)) for s in ("blender", "unreal")))
    thing = plane(1, 1)
    bpy.ops.wrinkle.import_set(filepath=os.path.abspath("blender"))
    made = thing.active_material
    assert made.name == "wave" and made.wrinkle.use == "NORMAL", made.wrinkle.use
    images = {n.image.name: n.image.colorspace_settings.name for n in made.node_tree.nodes if n.type == "TEX_IMAGE"}
    assert len(images) == 4 and set(images.values()) == {"Non-Color"}, images
    # The Bump node has forward differences of a pixel: half a pixel's change of slope is its error.
    for use, across, down, most in (("NORMAL", 45, 31, 0.1), ("BUMP", 180, 124, 0.5)):
        made.wrinkle.use = use
        off = angles(bake(thing, across, down), across, down)
        print("normals, %s: median %.4f, largest %.3f degrees" % (use, median(off), max(off)))
        assert median(off) <= most
    steep = max(angles([(0, 0, 1)] * (45 * 31), 45, 31))
    assert steep > 15, "the relief is too flat to show an error: %g degrees" % steep
    thing = plane(1, 1)
    bpy.ops.wrinkle.import_set(filepath=os.path.abspath("unreal/T_wave_N.png"))
    assert thing.active_material != made and thing.active_material.wrinkle.use == "NORMAL"
    off = angles(bake(thing, 45, 31), 45, 31)
    print("normals, green down, 8 bits: median %.4f degrees" % median(off))
    assert median(off) <= 0.35


# ---- displacement ----


def heights_seen(thing, across, down):
    """z of the displaced surface in the scene's units at the pixels over the cell, by Cycles, rows from below."""
    scene = bpy.context.scene
    tree = thing.active_material.node_tree
    place, split, light = (tree.nodes.new("ShaderNode" + n) for n in ("NewGeometry", "SeparateXYZ", "Emission"))
    tree.links.new(place.outputs["Position"], split.inputs[0])
    tree.links.new(split.outputs["Z"], light.inputs["Color"])
    tree.links.new(light.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    eye = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(eye)
    scene.camera, eye.data.type, eye.data.ortho_scale = eye, "ORTHO", WIDE
    eye.location = (WIDE / 2, TALL / 2, 1)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = across, down, 100
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = os.path.abspath("seen.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name = "Non-Color"
    assert tuple(image.size) == (across, down), tuple(image.size)
    z = list(image.pixels)[::4]
    bpy.data.images.remove(image)
    bpy.data.objects.remove(eye)
    return z


def scale_error(z, across, down):
    """Least squares factor of the seen heights on those of the formula, less 1."""
    want = [HIGH * math.sin(math.tau * (i + 0.5) / across) * math.cos(2 * math.tau * (j + 0.5) / down) / 2 for j in range(down) for i in range(across)]
    return sum(a * b for a, b in zip(z, want)) / sum(b * b for b in want) - 1, max(abs(a - b) for a, b in zip(z, want))


def check_displacement():
    for name, path, unit in (("floats", "blender", 1.0), ("16-bit codes", "unreal/T_wave_H.png", 1.0), ("floats, scene unit 1 cm", "blender", 0.01)):
        scene = start_scene()
        scene.unit_settings.scale_length = unit
        thing = plane(192, 140)
        thing.scale = (1, 1, 0.5)  # metres of the world, whatever the object's scale
        bpy.ops.wrinkle.import_set(filepath=os.path.abspath(path))
        made = thing.active_material
        made.wrinkle.use = "DISPLACEMENT"
        owner = made if hasattr(made, "displacement_method") else made.cycles
        assert owner.displacement_method == "BOTH"
        # a plane of the same numbers is a hundredth as wide in a scene of centimetres: its relief has 100 times the units
        z = [unit * h for h in heights_seen(thing, 48, 32)]
        error, worst = scale_error(z, 48, 32)
        print("displacement, %s: scale wrong by %.3f %%, heights by at most %.3g mm of 12" % (name, 100 * error, 1000 * worst))
        assert abs(error) <= 0.01 and worst <= 0.05 * HIGH


# ---- the link ----


class News:
    """Stands for Blender's main loop, which -b does not have: timers of the link are run here."""

    def __init__(self):
        from wrinkle_blender import link

        self.link, self.event = link, threading.Event()
        link._wake = self.event.set

    def wait(self, done, seconds=60):
        end = time.monotonic() + seconds
        while not done() and time.monotonic() < end:
            if self.event.wait(1):
                self.event.clear()
                self.link.flush()
        return done()


def seen(image):
    return image.pixels[0] if len(image.pixels) else None


def follow(name, side=64):
    """A plane that follows a document NAME of one height, 0.25."""
    document = write(name + ".wrinkle", "table %dx%d\nfill 0.25\n" % (side, side))
    thing = plane(1, 1)
    bpy.context.scene.wrinkle.document = document
    bpy.context.scene.wrinkle.folder = ""
    bpy.ops.wrinkle.follow("EXEC_DEFAULT", True)
    return thing, document


def check_link():
    start_scene()
    news = News()
    thing, document = follow("live", 512)
    made = thing.active_material
    assert made.wrinkle.use == "BUMP"
    image = made.node_tree.nodes["Wrinkle Heights"].image
    assert seen(image) == 0.25
    folder_of = made.wrinkle.folder
    assert news.link.is_linked(folder_of)
    assert news.event.wait(60)  # the link's own first maps
    times = []
    for step in range(1, 6):
        height = 0.25 + step / 8
        time.sleep(0.3)
        begin = time.perf_counter()
        write("live.wrinkle", "table 512x512\nfill %g\n" % height)
        assert news.wait(lambda: seen(image) == height), seen(image)
        times.append(1000 * (time.perf_counter() - begin))
    print("live link, 512 x 512, saved document to pixels: median %.0f ms, most %.0f ms" % (median(times), max(times)))
    assert thing.active_material.node_tree.nodes["Wrinkle Heights"].image == image
    assert len([i for i in bpy.data.images if "live" in i.name]) == 1, "a second picture"

    # The height of F = 1 is in the label: the group's scale follows.
    write("live.wrinkle", "table 512x512\nfill 0.5\nbump height=0.7\n")
    scale = lambda: made.node_tree.nodes["Wrinkle"].inputs["Scale"].default_value
    assert news.wait(lambda: abs(scale() - 0.7) < 1e-6), scale()

    # A file that another program wrote half: one report, the old picture stays.
    path = bpy.path.abspath(image.filepath)
    with open(path, "rb") as file:
        data = file.read()
    with open(path, "wb") as file:
        file.write(data[: len(data) // 2])
    assert news.wait(lambda: news.link.status(folder_of)[0])
    assert "incomplete or damaged" in news.link.status(folder_of)[1]
    assert seen(image) == 0.5
    write("live.wrinkle", "table 512x512\nfill 0.75\n")
    assert news.wait(lambda: seen(image) == 0.75)
    assert not news.link.status(folder_of)[0]

    # The program is killed: the link has ended, with the reason.
    child = news.link._links[folder_of].watcher.child
    os.kill(child.pid, signal.SIGKILL)
    assert news.wait(lambda: not news.link.is_linked(folder_of))
    is_error, text = news.link.status(folder_of)
    assert is_error and "signal 9" in text, text
    print("closed: " + text)


def check_folder():
    """A folder that another Wrinkle writes to, which knows nothing of Blender."""
    start_scene()
    news = News()
    maps = folder("elsewhere")
    wrinkle("table 40x30\nfill 0.5\nmaps blender elsewhere name=x\n")
    thing = plane(1, 1)
    bpy.context.scene.wrinkle.folder = maps
    bpy.ops.wrinkle.connect()
    image = thing.active_material.node_tree.nodes["Wrinkle Heights"].image
    wrinkle("table 44x30\nfill 0.75\nmaps blender elsewhere name=x\n")
    assert news.wait(lambda: seen(image) == 0.75)
    assert {n.image.size[0] for n in thing.active_material.node_tree.nodes if n.type == "TEX_IMAGE"} == {44}
    bpy.ops.wrinkle.unlink(folder=maps)
    assert not news.link.folders()


def check_undo_and_files():
    start_scene()
    news = News()
    bpy.ops.ed.undo_push(message="before")
    follow("undone")
    assert "undone" in bpy.data.materials
    (linked,) = news.link.folders()
    bpy.ops.ed.undo()
    assert "undone" not in bpy.data.materials, "undo left the material"
    write("undone.wrinkle", "table 64x64\nfill 0.5\n")
    assert news.wait(lambda: not news.link.status(linked)[0] and os.path.exists(linked), 5)
    time.sleep(1)
    news.link.flush()
    bpy.ops.ed.redo()
    assert "undone" in bpy.data.materials, "redo did not bring the material back"
    write("undone.wrinkle", "table 64x64\nfill 0.75\n")
    shown = lambda: seen(bpy.data.materials["undone"].node_tree.nodes["Wrinkle Heights"].image)
    assert news.wait(lambda: shown() == 0.75), shown()
    child = news.link._links[linked].watcher.child
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath("kept.blend"))
    start_scene()
    assert not news.link.folders() and not child.runs(), "the link outlives its file"
    write("undone.wrinkle", "table 64x64\nfill 0.25\n")
    news.link.flush()
    bpy.ops.wm.open_mainfile(filepath=os.path.abspath("kept.blend"))
    made = bpy.data.materials["undone"]
    assert made.wrinkle.folder == linked and made.wrinkle.use == "BUMP"


def check_errors():
    start_scene()
    preferences = bpy.context.preferences.addons["wrinkle_blender"].preferences
    plane(1, 1)
    document = write("wrong.wrinkle", "table 8x8\n")
    bpy.context.scene.wrinkle.document = document
    for text, sentence in (("echo wrinkle 0.0.9", ": version 0.0.9"), ("echo x: error while loading shared libraries: libz.so >&2; exit 127", "a library is missing")):
        preferences.program = write("other", "#!/bin/sh\n" + text + "\n")
        os.chmod("other", 0o755)
        for operator in (bpy.ops.wrinkle.paint, bpy.ops.wrinkle.follow, bpy.ops.wrinkle.bring_mesh):
            fails(operator, sentence)
    preferences.program = "/nowhere/wrinkle"
    fails(bpy.ops.wrinkle.paint, "/nowhere/wrinkle: not a program")
    preferences.program = WRINKLE
    bpy.context.scene.wrinkle.document = ""
    fails(bpy.ops.wrinkle.paint, "no document is set")
    bpy.context.scene.wrinkle.document = write("bad.wrinkle", "table 8x8\nnonsense\n")
    fails(bpy.ops.wrinkle.follow, 'unknown command "nonsense"')
    fails(bpy.ops.wrinkle.import_set, "contains no maps", filepath=folder("nothing"))
    os.makedirs("torn")
    with open("blender/wave_normal.png", "rb") as source, open("torn/wave_normal.png", "wb") as file:
        file.write(source.read()[:-20])
    fails(bpy.ops.wrinkle.import_set, "incomplete or damaged", filepath=os.path.abspath("torn"))
    assert not bpy.data.materials, "an error left a material"


# ---- meshes ----


def check_meshes():
    start_scene()
    bpy.ops.mesh.primitive_cube_add(size=1)
    thing = bpy.context.active_object
    thing.scale, thing.location = (2.0, 1.0, 0.5), (3, 0, 0)
    bpy.context.view_layer.update()
    own = bpy.context.scene.wrinkle
    own.side, own.height, own.error = 64, 0.05, 0.001
    bpy.ops.wrinkle.send_mesh(filepath=os.path.abspath("box.exr"), window=False)
    made = thing.active_material
    assert made.wrinkle.of_mesh and made.wrinkle.document.endswith("box.exr")
    assert abs(made.node_tree.nodes["Wrinkle"].inputs["Scale"].default_value - 0.05) < 1e-6
    fails(bpy.ops.wrinkle.send_mesh, "already exists", filepath=os.path.abspath("box.exr"), window=False)
    wrinkle("open box.exr\nfill 1\nsave box.exr\n")
    bpy.ops.wrinkle.export_all()
    assert "normal-baked" in made.node_tree.nodes["Wrinkle Normals"].image.name
    bpy.ops.wrinkle.bring_mesh()
    back = bpy.context.active_object
    assert back != thing and len(back.data.uv_layers) == 1
    corners = [back.matrix_world @ v.co for v in back.data.vertices]
    for axis, (low, high) in enumerate(((1.95, 4.05), (-0.55, 0.55), (-0.3, 0.3))):
        assert abs(min(c[axis] for c in corners) - low) < 1e-4 and abs(max(c[axis] for c in corners) - high) < 1e-4
    bpy.context.view_layer.objects.active = thing
    thing.data.uv_layers.remove(thing.data.uv_layers[0])
    fails(bpy.ops.wrinkle.send_mesh, "has no UV map", filepath=os.path.abspath("bare.exr"), window=False)


def check_again():
    """Disabled and enabled once more, with a link."""
    start_scene()
    news = News()
    follow("again")
    assert news.link.folders()
    bpy.ops.preferences.addon_disable(module="wrinkle_blender")
    assert not [t for t in threading.enumerate() if t.name == "wrinkle"], "the watcher's thread outlives the add-on"
    assert not hasattr(bpy.types.Scene, "wrinkle") and not hasattr(bpy.types, "WRINKLE_PT_view")
    enable()
    thing = plane(1, 1)
    bpy.ops.wrinkle.import_set(filepath=os.path.abspath("blender"))
    assert thing.active_material.name.startswith("wave")


bpy.ops.preferences.addon_install(filepath=ZIP)
enable()
start_scene()
for check in (check_normals, check_displacement, check_link, check_folder, check_undo_and_files, check_errors, check_meshes, check_again):
    begin = time.monotonic()
    check()
    print("%s: good, %.1f s" % (check.__name__, time.monotonic() - begin))
print("all of it ran")
