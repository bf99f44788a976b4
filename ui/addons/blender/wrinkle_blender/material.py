# SPDX-License-Identifier: MIT
"""Materials from sets of maps: the node group "Wrinkle", the pictures, the settings of Cycles.

Materials and pictures are found by name and path at each use; no reference to Blender's data is kept."""
import os

import bpy

from . import compat, mapset
from .program import WrinkleError

GROUP = "Wrinkle"
_VERSION = 1  # of the node group; another one is built anew


# ---- the node group ----


def _new(tree, kind, x, y, **values):
    node = tree.nodes.new(kind)
    node.location = x, y
    for name, value in values.items():
        setattr(node, name, value)
    return node


def _math(tree, operation, x, y, *inputs):
    """A Math node; an input is a number, or a socket to link."""
    node = _new(tree, "ShaderNodeMath", x, y, operation=operation)
    for socket, value in zip(node.inputs, inputs):
        if isinstance(value, (int, float)):
            socket.default_value = value
        else:
            tree.links.new(value, socket)
    return node.outputs[0]


_INPUTS = (  # name, kind, default, smallest, largest
    ("Height", "NodeSocketFloat", 0.0, None, None),
    ("Normal Map", "NodeSocketColor", (0.5, 0.5, 1.0, 1.0), None, None),
    ("Strength", "NodeSocketFloat", 1.0, 0.0, 10.0),
    ("Scale", "NodeSocketFloat", 1.0, None, None),
    ("Midlevel", "NodeSocketFloat", 0.0, None, None),
    ("Green Down", "NodeSocketFloat", 0.0, 0.0, 1.0),
)


def _fill_group(tree):
    compat.clear_sockets(tree)
    for name, kind, value, low, high in _INPUTS:
        socket = compat.add_socket(tree, name, kind)
        socket.default_value = value
        if low is not None:
            socket.min_value, socket.max_value = low, high
    for name in ("Normal", "Bump", "Displacement"):
        compat.add_socket(tree, name, "NodeSocketVector", output=True)
    given = _new(tree, "NodeGroupInput", -900, 0).outputs
    result = _new(tree, "NodeGroupOutput", 500, 0).inputs
    link = tree.links.new

    # Normal map: Blender's green is up. Green down is turned round: g + down * (1 - 2 g).
    split = _new(tree, "ShaderNodeSeparateColor", -650, 250)
    link(given["Normal Map"], split.inputs[0])
    turned = _math(tree, "MULTIPLY_ADD", -450, 150, split.outputs[1], -2.0, 1.0)
    green = _math(tree, "MULTIPLY_ADD", -250, 150, turned, given["Green Down"], split.outputs[1])
    joined = _new(tree, "ShaderNodeCombineColor", -50, 250)
    for socket, value in zip(joined.inputs, (split.outputs[0], green, split.outputs[2])):
        link(value, socket)
    normal = _new(tree, "ShaderNodeNormalMap", 150, 250, space="TANGENT")
    link(given["Strength"], normal.inputs["Strength"])
    link(joined.outputs[0], normal.inputs["Color"])
    link(normal.outputs[0], result["Normal"])

    # Heights: Scale is in metres, so both nodes work in world space.
    scale = _math(tree, "MULTIPLY", -250, -150, given["Scale"], given["Strength"])
    bump = _new(tree, "ShaderNodeBump", 150, 0)
    bump.inputs["Strength"].default_value = 1.0
    link(scale, bump.inputs["Distance"])
    link(given["Height"], bump.inputs["Height"])
    link(bump.outputs[0], result["Bump"])
    moved = _new(tree, "ShaderNodeDisplacement", 150, -250, space="WORLD")
    link(given["Height"], moved.inputs["Height"])
    link(given["Midlevel"], moved.inputs["Midlevel"])
    link(scale, moved.inputs["Scale"])
    link(moved.outputs[0], result["Displacement"])


def group():
    """The node group, shared by all materials; built if it is missing or of another version."""
    for tree in bpy.data.node_groups:
        if tree.bl_idname == "ShaderNodeTree" and tree.get("wrinkle") == _VERSION and not tree.library:
            return tree
    tree = bpy.data.node_groups.new(GROUP, "ShaderNodeTree")
    _fill_group(tree)
    tree["wrinkle"] = _VERSION
    return tree


# ---- pictures ----


def _absolute(image):
    return os.path.normpath(bpy.path.abspath(image.filepath, library=image.library))


def _data_picture(path, colour=False):
    """The picture of a file, loaded once, as data and not as colours."""
    path = os.path.normpath(os.path.abspath(path))
    image = next((i for i in bpy.data.images if i.source == "FILE" and _absolute(i) == path), None)
    if image is None:
        try:
            image = bpy.data.images.load(path)
        except RuntimeError as why:
            raise WrinkleError("%s: cannot be read (%s)" % (path, str(why).strip())) from None
    else:
        image.reload()
    image.colorspace_settings.name = "sRGB" if colour else "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    if not image.has_data and image.size[0] == 0:
        raise WrinkleError("%s: Blender cannot read it" % path)
    return image


# ---- materials ----

_NODES = {  # role: (label of the node, place)
    "height": ("Heights", (-600, -150)),
    "normal": ("Normals", (-600, 150)),
    "baked": ("Normals", (-600, 150)),
    "colour": ("Colour", (-600, 450)),
    "roughness": ("Roughness of a distant view", (-600, -750)),
    "occlusion": ("Ambient occlusion", (-600, -450)),
}


def _node(tree, name, kind, x, y):
    """The material's node of that name, made if it is missing."""
    node = tree.nodes.get(name)
    if node is None:
        node = _new(tree, kind, x, y)
        node.name = name
    return node


def _ends(tree):
    """The output node and the BSDF at it; both are made if they are missing."""
    output = tree.get_output_node("ALL") or _new(tree, "ShaderNodeOutputMaterial", 600, 0)
    links = output.inputs["Surface"].links
    shader = links[0].from_node if links else _new(tree, "ShaderNodeBsdfPrincipled", 200, 0)
    if not links:
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return output, shader


def wire(material):
    """Links the group as material.wrinkle.use says: normal map, bump or displacement; one of them at a time."""
    tree, use = material.node_tree, material.wrinkle.use
    relief = tree and tree.nodes.get(GROUP)
    if not relief:
        return
    heights = tree.nodes.get("Wrinkle " + _NODES["height"][0])
    if heights:  # a spline is smooth under Bump; linear interpolation has the true heights
        heights.interpolation = "Linear" if use == "DISPLACEMENT" else "Cubic"
    output, shader = _ends(tree)
    for socket in (shader.inputs.get("Normal"), output.inputs["Displacement"]):
        for old in list(socket.links if socket else ()):
            if old.from_node == relief:
                tree.links.remove(old)
    if use == "DISPLACEMENT":
        tree.links.new(relief.outputs["Displacement"], output.inputs["Displacement"])
    elif "Normal" in shader.inputs:
        tree.links.new(relief.outputs["Normal" if use == "NORMAL" else "Bump"], shader.inputs["Normal"])


def _set_values(material, maps):
    """Scale, middle and direction of green, which the files' labels state. True if something has changed."""
    scale, middle = maps.relief()
    normal = maps.get("baked") or maps.get("normal")
    # A unit of Blender's scene may be longer or shorter than a metre.
    scale /= bpy.context.scene.unit_settings.scale_length or 1.0
    wanted = {"Scale": scale, "Midlevel": middle, "Green Down": float(bool(normal and normal.green_down()))}
    sockets = material.node_tree.nodes[GROUP].inputs
    changed = False
    for name, value in wanted.items():
        if abs(sockets[name].default_value - value) > 1e-7 * max(1.0, abs(value)):
            sockets[name].default_value = value
            changed = True
    return changed


def apply_set(maps, document="", material=None):
    """The material of a set: a new one, or the given one with the set's pictures. Returns it."""
    if not (maps.get("height") or maps.get("normal") or maps.get("baked")):
        raise WrinkleError("%s: the set %s has neither heights nor normals" % (maps.folder, maps.name))
    fresh = material is None
    if fresh:
        material = bpy.data.materials.new(maps.name)
    material.use_nodes = True
    tree = material.node_tree
    output, shader = _ends(tree)
    relief = _node(tree, GROUP, "ShaderNodeGroup", -150, -100)
    relief.node_tree = group()
    relief.width = 180
    if fresh:
        shader.location, output.location = (150, 250), (500, 250)
    targets = {"height": relief.inputs["Height"], "normal": relief.inputs["Normal Map"], "baked": relief.inputs["Normal Map"]}
    if "Base Color" in shader.inputs:
        targets["colour"] = shader.inputs["Base Color"]
    for role, found in sorted(maps.maps.items(), reverse=True):  # baked normals replace those of the cell
        label, place = _NODES[role]
        node = _node(tree, "Wrinkle " + label, "ShaderNodeTexImage", *place)
        node.label, node.image = label, _data_picture(found.path, role == "colour")
        node.extension = "REPEAT"
        if role in targets:
            tree.links.new(node.outputs["Color"], targets[role])
    own = material.wrinkle
    own.folder, own.cell, own.document = maps.folder, maps.name, document or own.document
    _set_values(material, maps)
    compat.displace_and_bump(material)
    normals = maps.get("baked") or maps.get("normal")
    if own.use == "NORMAL" and not normals:
        own.use = "BUMP"
    elif own.use != "NORMAL" and not maps.get("height"):
        own.use = "NORMAL"
    wire(material)
    return material


def of_folder(folder):
    """Materials whose maps are in the folder."""
    return [m for m in bpy.data.materials if m.wrinkle.folder and os.path.normpath(m.wrinkle.folder) == folder]


def refresh(folder, names):
    """Reloads the pictures of replaced files, in place, and the values of their labels. Returns errors as a list."""
    errors = []
    changed = {os.path.join(folder, name) for name in names}
    for image in bpy.data.images:
        if image.source != "FILE" or _absolute(image) not in changed:
            continue
        try:
            mapset.read_map(_absolute(image))  # whole and readable, else the old picture stays
            image.reload()
            if not len(image.pixels):  # reads the file now, while it is whole
                raise WrinkleError("%s: Blender cannot read it" % _absolute(image))
            image.update_tag()
        except WrinkleError as why:
            errors.append(str(why))
    for material in [] if errors else of_folder(folder):
        try:
            maps = mapset.read_set(folder, material.wrinkle.cell)
            if material.node_tree and GROUP in material.node_tree.nodes:
                _set_values(material, maps)
        except WrinkleError as why:
            errors.append(str(why))
    return errors


def redraw():
    """Editors that show pictures or materials."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "NODE_EDITOR", "IMAGE_EDITOR", "PROPERTIES"}:
                area.tag_redraw()
