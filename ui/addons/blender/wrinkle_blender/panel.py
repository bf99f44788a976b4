# SPDX-License-Identifier: MIT
"""The sidebar's panels, the operators behind their buttons, and the settings."""
import os
import textwrap

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import link, mapset, material, meshes, program
from .program import WrinkleError

ADDON = __package__


# ---- settings ----


class WrinklePreferences(bpy.types.AddonPreferences):
    bl_idname = ADDON

    program: StringProperty(
        name="Wrinkle", subtype="FILE_PATH", description="Path of the program wrinkle; empty: search PATH"
    )

    def draw(self, context):
        self.layout.prop(self, "program")


class WrinkleSceneSettings(bpy.types.PropertyGroup):
    document: StringProperty(
        name="Document",
        subtype="FILE_PATH",
        description="Wrinkle document: an .exr or .ora file, a script, or a height map",
    )
    folder: StringProperty(
        name="Maps",
        subtype="DIR_PATH",
        description="Folder for the maps; empty: a folder beside the document, named after it with _maps",
    )
    maps: EnumProperty(
        name="Live Maps",
        items=(
            ("HEIGHTS", "Heights", "Only the height map, for Bump and Displacement: the fastest updates"),
            ("ALL", "All", "Height, normal, ambient occlusion and roughness maps"),
        ),
    )
    side: IntProperty(name="Texels", default=1024, min=16, max=16384, description="Width and height of a new table")
    height: FloatProperty(
        name="Height", default=0.0, min=0.0, unit="LENGTH", description="Height of white; 0: 1/50 of the object's size"
    )
    error: FloatProperty(
        name="Error",
        default=0.0005,
        min=1e-6,
        unit="LENGTH",
        precision=5,
        description="Largest distance from the exact surface in Bring Back Mesh",
    )


def _rewire(self, context):
    material.wire(self.id_data)


class WrinkleMaterialSettings(bpy.types.PropertyGroup):
    use: EnumProperty(
        name="Relief",
        update=_rewire,
        items=(
            ("NORMAL", "Normal Map", "Normal map: exact shading on a flat surface"),
            ("BUMP", "Bump", "Shading from the slopes of the height map"),
            ("DISPLACEMENT", "Displacement", "Displaced surface in Cycles; needs a finely subdivided mesh"),
        ),
    )
    folder: StringProperty()
    cell: StringProperty()
    document: StringProperty()
    of_mesh: BoolProperty(
        name="Baked",
        description="Normal maps are baked for the faces of this mesh, which is the document's object",
    )


# ---- helpers ----


def _program(context):
    addon = context.preferences.addons.get(ADDON)
    return program.checked(addon.preferences.program if addon else "")


def _document(context):
    path = bpy.path.abspath(context.scene.wrinkle.document)
    if not path:
        raise WrinkleError("no document is set; choose one under Document in the panel")
    if not os.path.isfile(path):
        raise WrinkleError("%s: does not exist" % path)
    return path


def _folder(context, document=""):
    """The folder of the maps, made if it is missing."""
    path = bpy.path.abspath(context.scene.wrinkle.folder)
    if not path and not document:
        raise WrinkleError("no folder is set; choose one under Maps in the panel")
    path = link.key(path or os.path.splitext(document)[0] + "_maps")
    try:
        os.makedirs(path, exist_ok=True)
    except OSError as why:
        raise WrinkleError("%s: cannot be made (%s)" % (path, why.strerror)) from None
    return path


def _active_material(context):
    thing = context.active_object
    return thing.active_material if thing and thing.type == "MESH" else None


def _wear(context, made):
    """Gives the active mesh the material."""
    thing = context.active_object
    if not thing or thing.type != "MESH" or thing.active_material == made:
        return
    if thing.material_slots:
        thing.active_material = made
    else:
        thing.data.materials.append(made)


def _set_to_material(context, maps, document="", use=None):
    """Applies the set to the active object's material of the same maps, else to a new one."""
    old = _active_material(context)
    same = old and old.wrinkle.folder == maps.folder and old.wrinkle.cell == maps.name
    made = material.apply_set(maps, document, old if same else None)
    if use and made.wrinkle.use == "NORMAL":
        made.wrinkle.use = use
    _wear(context, made)
    return made


def _export_all(context, path, document, folder, baked=False):
    program.run(program.export_line(path, document, folder))
    name = mapset.read_set(folder, _cell(document)).name
    if baked:
        out = os.path.join(folder, name + "_normal-baked.png")
        program.run(program.baked_line(path, document, out))
    return mapset.read_set(folder, name)


def _cell(document):
    """Wrinkle's name for the maps of a document."""
    return os.path.splitext(os.path.basename(document))[0]


class _Operator:
    """An operator whose errors are one report; bl_options are set by each."""

    def execute(self, context):
        try:
            text = self.work(context)
        except WrinkleError as why:
            self.report({"ERROR"}, str(why))
            return {"CANCELLED"}
        except OSError as why:
            self.report({"ERROR"}, "%s: %s" % (why.filename or "Wrinkle", why.strerror))
            return {"CANCELLED"}
        if text:
            self.report({"INFO"}, text)
        return {"FINISHED"}


# ---- operators ----


class WRINKLE_OT_import_set(_Operator, bpy.types.Operator, ImportHelper):
    """Make a material from a set of maps: choose its folder, one of its files, or a list from `wrinkle export --json`"""

    bl_idname = "wrinkle.import_set"
    bl_label = "Import Set of Maps"
    bl_options = {"REGISTER", "UNDO"}
    filter_glob: StringProperty(default="*.png;*.exr;*.json;*.jsonl", options={"HIDDEN"})

    def work(self, context):
        maps = mapset.read_set(os.path.normpath(bpy.path.abspath(self.filepath)))
        made = _set_to_material(context, maps)
        return "%s: %s" % (made.name, ", ".join(sorted(maps.maps)))


def _first_maps(context, path, document, folder):
    """Maps for the material before the link brings its first ones."""
    kind = program.SETS[context.scene.wrinkle.maps]
    program.run([path, "export", document, "--as", kind, "-o", folder])
    maps = mapset.read_set(folder, _cell(document))
    return _set_to_material(context, maps, document, "BUMP" if context.scene.wrinkle.maps == "HEIGHTS" else None)


class WRINKLE_OT_paint(_Operator, bpy.types.Operator):
    """Open the document in Wrinkle; each stroke appears on the active object's material"""

    bl_idname = "wrinkle.paint"
    bl_label = "Paint in Wrinkle"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context):
        path, document = _program(context), _document(context)
        folder = _folder(context, document)
        _first_maps(context, path, document, folder)
        link.start(
            folder,
            program.paint_line(path, document, folder, context.scene.wrinkle.maps),
            what="Wrinkle's window",
        )


class WRINKLE_OT_follow(_Operator, bpy.types.Operator):
    """Update the active object's material each time the document is saved"""

    bl_idname = "wrinkle.follow"
    bl_label = "Follow Document"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context):
        path, document = _program(context), _document(context)
        folder = _folder(context, document)
        _first_maps(context, path, document, folder)
        link.start(
            folder,
            program.watch_line(path, document, folder, context.scene.wrinkle.maps),
            ends=True,
            what="Saved document",
        )


class WRINKLE_OT_connect(_Operator, bpy.types.Operator):
    """Update the material from a folder into which a running Wrinkle exports (File > Export maps, Live)"""

    bl_idname = "wrinkle.connect"
    bl_label = "Follow Folder"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context):
        folder = _folder(context)
        _set_to_material(context, mapset.read_set(folder))
        link.start(folder, what="Folder")


class WRINKLE_OT_unlink(_Operator, bpy.types.Operator):
    """End the live link; Wrinkle's window stays open"""

    bl_idname = "wrinkle.unlink"
    bl_label = "End Link"
    folder: StringProperty(options={"HIDDEN"})

    def work(self, context):
        link.stop(self.folder)


class WRINKLE_OT_export_all(_Operator, bpy.types.Operator):
    """Export all maps of the material's document, as last saved, including the normal map"""

    bl_idname = "wrinkle.export_all"
    bl_label = "Export All Maps"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        made = _active_material(context)
        return bool(made and made.wrinkle.document)

    def work(self, context):
        made = _active_material(context)
        own = made.wrinkle
        maps = _export_all(context, _program(context), own.document, own.folder, own.of_mesh)
        material.apply_set(maps, own.document, made)
        return "%s: %s" % (made.name, ", ".join(sorted(maps.maps)))


class WRINKLE_OT_send_mesh(_Operator, bpy.types.Operator):
    """Make a document for the active mesh, beside the .blend file, and open it in Wrinkle"""

    bl_idname = "wrinkle.send_mesh"
    bl_label = "Paint on This Mesh"
    bl_options = {"REGISTER", "UNDO"}
    filepath: StringProperty(subtype="FILE_PATH", options={"HIDDEN", "SKIP_SAVE"})
    window: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    def work(self, context):
        path, thing = _program(context), context.active_object
        own = context.scene.wrinkle
        document = self.filepath
        if not document:
            if not bpy.data.filepath:
                raise WrinkleError("the .blend file has not been saved; save it first")
            name = bpy.path.clean_name(thing.name) if thing else "mesh"
            document = os.path.join(os.path.dirname(bpy.data.filepath), name + ".exr")
        if os.path.exists(document):
            raise WrinkleError("%s: already exists; choose it as Document, or remove it" % document)
        scale = context.scene.unit_settings.scale_length or 1.0
        height = own.height * scale or 0.02 * scale * max(thing.dimensions if thing else (1.0,))
        meshes.make_document(context, path, thing, document, own.side, height)
        own.document, own.folder = document, ""
        folder = _folder(context, document)
        made = _first_maps(context, path, document, folder)
        made.wrinkle.of_mesh = True
        if self.window:
            link.start(folder, program.paint_line(path, document, folder, own.maps), what="Wrinkle's window")


class WRINKLE_OT_bring_mesh(_Operator, bpy.types.Operator):
    """Add the document's displaced mesh, as last saved, to the scene"""

    bl_idname = "wrinkle.bring_mesh"
    bl_label = "Bring Back Mesh"
    bl_options = {"REGISTER", "UNDO"}

    def work(self, context):
        made = meshes.bring_back(context, _program(context), _document(context), context.scene.wrinkle.error)
        return "%s: %d triangles" % (made.name, len(made.data.polygons))


# ---- panels ----


class _Panel:
    bl_region_type = "UI"
    bl_category = "Wrinkle"
    bl_label = "Wrinkle"

    def draw(self, context):
        own, made = context.scene.wrinkle, _active_material(context)
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self._draw_link(layout, own)
        box = layout.box()
        box.label(text="Material", icon="MATERIAL")
        box.operator("wrinkle.import_set", icon="IMPORT")
        if made and made.wrinkle.folder:
            column = box.column()
            column.prop(made.wrinkle, "use")
            relief = made.node_tree and made.node_tree.nodes.get(material.GROUP)
            if relief:
                for name in ("Strength", "Scale"):
                    column.prop(relief.inputs[name], "default_value", text=name)
            column.prop(made.wrinkle, "of_mesh")
            column.operator("wrinkle.export_all", icon="RENDERLAYERS")
        box = layout.box()
        box.label(text="Mesh", icon="MESH_DATA")
        column = box.column()
        column.prop(own, "side")
        column.prop(own, "height")
        column.operator("wrinkle.send_mesh", icon="EXPORT")
        column.separator()
        column.prop(own, "error")
        column.operator("wrinkle.bring_mesh", icon="IMPORT")

    def _draw_link(self, layout, own):
        box = layout.box()
        box.label(text="Live Link", icon="FILE_REFRESH")
        column = box.column()
        column.prop(own, "document")
        column.prop(own, "folder")
        column.row(align=True).prop(own, "maps", expand=True)
        column = box.column(align=True)
        column.operator("wrinkle.paint", icon="BRUSH_DATA")
        column.operator("wrinkle.follow", icon="FILE_TICK")
        column.operator("wrinkle.connect", icon="FILE_FOLDER")
        for folder in link.folders():
            row = box.row()
            is_error, said = link.status(folder)
            row.label(text="" if is_error else said, icon="ERROR" if is_error else "LINKED")
            row.operator("wrinkle.unlink", text="", icon="X").folder = folder
        where = own.folder or (os.path.splitext(own.document)[0] + "_maps" if own.document else "")
        is_error, said = where and link.status(where) or (False, "")
        if is_error or not link.is_linked(where):
            column = box.column(align=True)
            column.scale_y = 0.7
            for line in textwrap.wrap(said, 32):
                column.label(text=line)


class WRINKLE_PT_view(_Panel, bpy.types.Panel):
    bl_space_type = "VIEW_3D"


class WRINKLE_PT_nodes(_Panel, bpy.types.Panel):
    bl_space_type = "NODE_EDITOR"

    @classmethod
    def poll(cls, context):
        return context.space_data.tree_type == "ShaderNodeTree"


CLASSES = (
    WrinklePreferences,
    WrinkleSceneSettings,
    WrinkleMaterialSettings,
    WRINKLE_OT_import_set,
    WRINKLE_OT_paint,
    WRINKLE_OT_follow,
    WRINKLE_OT_connect,
    WRINKLE_OT_unlink,
    WRINKLE_OT_export_all,
    WRINKLE_OT_send_mesh,
    WRINKLE_OT_bring_mesh,
    WRINKLE_PT_view,
    WRINKLE_PT_nodes,
)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.wrinkle = PointerProperty(type=WrinkleSceneSettings)
    bpy.types.Material.wrinkle = PointerProperty(type=WrinkleMaterialSettings)


def unregister():
    del bpy.types.Material.wrinkle
    del bpy.types.Scene.wrinkle
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
