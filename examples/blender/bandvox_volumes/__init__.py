"""Band-limited volumes in Blender, by Bandvox."""

import bpy

from . import operators

bl_info = {
    "name": "Bandvox: band-limited volumes",
    "author": "Bandvox",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Band-limited volume, Object > Band-limited volume",
    "description": "Meshes, points, scans and volumes to OpenVDB volumes without aliasing, and their surfaces",
    "category": "Import-Export",
}


def _import_entry(menu, context):
    menu.layout.operator(operators.BANDVOX_OT_import.bl_idname, text="Band-limited volume")


def _object_entry(menu, context):
    menu.layout.menu(operators.BANDVOX_MT_object.bl_idname)


def register():
    for one in operators.CLASSES:
        bpy.utils.register_class(one)
    bpy.types.TOPBAR_MT_file_import.append(_import_entry)
    bpy.types.VIEW3D_MT_object.append(_object_entry)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(_object_entry)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entry)
    for one in reversed(operators.CLASSES):
        bpy.utils.unregister_class(one)
