# SPDX-License-Identifier: MIT
"""Differences between Blender 3.4 and 4.x; no other file checks the version.

Run with 3.4.1 (Debian 12). For 4.x these pages were read; nothing was run there:
  4.0  NodeTree.inputs and .outputs became NodeTree.interface: https://docs.blender.org/api/4.3/bpy.types.NodeTreeInterface.html
  4.1  CyclesMaterialSettings.displacement_method was removed, for Material.displacement_method:
       https://docs.blender.org/api/4.1/change_log.html
  4.1  Mesh.use_auto_smooth was removed: https://github.com/REDxEYE/SourceIO/issues/305
  4.4  obj_export as below: export_active_obj.py of https://github.com/varkenvarken/blenderaddons
The inputs of the Principled BSDF that 4.0 renamed are not used: "Base Color" and "Normal" kept their names."""


def add_socket(tree, name, kind, output=False):
    """A socket of a node group; its description is returned, with default_value, min_value, max_value."""
    if hasattr(tree, "interface"):
        return tree.interface.new_socket(name, in_out="OUTPUT" if output else "INPUT", socket_type=kind)
    return (tree.outputs if output else tree.inputs).new(kind, name)


def clear_sockets(tree):
    if hasattr(tree, "interface"):
        tree.interface.clear()
    else:
        tree.inputs.clear()
        tree.outputs.clear()


def displace_and_bump(material):
    """Displacement in Cycles, with bump mapping for detail finer than the faces."""
    owner = material if hasattr(material, "displacement_method") else material.cycles
    owner.displacement_method = "BOTH"


def smooth(mesh):
    """Smooth shading with the normals of the mesh."""
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = mesh.has_custom_normals
    mesh.update()


def export_obj(bpy, path, scale):
    """Writes the selected objects with Blender's axes."""
    operator = bpy.ops.wm.obj_export
    known = operator.get_rna_type().properties.keys()
    operator(
        filepath=path,
        export_selected_objects=True,
        apply_modifiers=True,
        export_uv=True,
        export_normals=True,
        export_materials=False,
        forward_axis="Y",
        up_axis="Z",
        # scaling_factor in 3.4; other versions of the same operator say global_scale
        **{"global_scale" if "global_scale" in known else "scaling_factor": scale},
    )


def import_obj(bpy, path, scale):
    """Reads a file with Blender's axes; the new objects are selected."""
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z", global_scale=scale)
