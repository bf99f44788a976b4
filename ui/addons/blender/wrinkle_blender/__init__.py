# SPDX-License-Identifier: MIT
"""Wrinkle in Blender: live link, materials from sets of maps, meshes both ways. See ui/addons/README.md."""

bl_info = {
    "name": "Wrinkle",
    "author": "The Wrinkle authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "3D View and Shader Editor > Sidebar > Wrinkle",
    "description": "Paint bumps in Wrinkle; they appear on Blender's materials",
    "category": "Material",
}


def register():
    from . import link, panel

    panel.register()
    link.register()


def unregister():
    from . import link, panel

    link.unregister()
    panel.unregister()
