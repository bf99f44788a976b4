# SPDX-License-Identifier: MIT
"""Meshes to Wrinkle and back, as OBJ: the one format that both programs read and write with texture coordinates,
normals and float places, in all versions, without add-ons. Axes are Blender's; lengths are metres on the way to Wrinkle, whose solids are in
millimetres."""
import os

import bpy

from . import compat, program
from .program import WrinkleError


def _metres(context):
    return context.scene.unit_settings.scale_length or 1.0


def write(context, thing, path):
    """The object as it is seen, in world space."""
    if thing is None or thing.type != "MESH":
        raise WrinkleError("no mesh is selected; select one")
    if not thing.data.uv_layers:
        raise WrinkleError("%s: the mesh has no UV map; unwrap it first" % thing.name)
    if thing.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    selected = [o for o in context.selected_objects if o != thing]
    for other in selected:
        other.select_set(False)
    thing.select_set(True)
    try:
        compat.export_obj(bpy, path, _metres(context))
    except RuntimeError as why:
        raise WrinkleError("%s: cannot be written (%s)" % (path, str(why).strip())) from None
    finally:
        for other in selected:
            other.select_set(True)
    if not os.path.exists(path) or os.path.getsize(path) == 0:
        raise WrinkleError("%s: cannot be written; check whether the disk is full" % path)


def make_document(context, path, thing, document, side, height):
    """A document in Wrinkle whose object is the mesh."""
    mesh = os.path.splitext(document)[0] + ".obj"
    write(context, thing, mesh)
    program.make_document(path, program.mesh_script(mesh, document, side, height), os.path.dirname(document))


def bring_back(context, path, document, error_m):
    """The document's mesh with its relief as a new object, which is returned."""
    out = os.path.splitext(document)[0] + "_relief.obj"
    program.run(program.solid_line(path, document, out, error_m))
    before = set(bpy.data.objects.keys())
    try:
        compat.import_obj(bpy, out, 0.001 / _metres(context))
    except RuntimeError as why:
        raise WrinkleError("%s: cannot be read (%s)" % (out, str(why).strip())) from None
    fresh = [o for o in bpy.data.objects if o.name not in before]
    if not fresh:
        raise WrinkleError("%s: contains no mesh" % out)
    compat.smooth(fresh[0].data)
    return fresh[0]
