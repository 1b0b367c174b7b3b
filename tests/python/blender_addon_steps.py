"""What blender_addon_test.py has done within Blender: the arguments after -- are the add-on's .zip file, the engine
(`package`, or the path of the command), a folder with files, and the .json file for what was found."""

import json
import math
import pathlib
import sys

import bmesh
import bpy
import mathutils
import numpy as np

ARCHIVE, ENGINE, FOLDER, RESULT = sys.argv[sys.argv.index("--") + 1:]
FOLDER = pathlib.Path(FOLDER)


def set_up():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_install(filepath=ARCHIVE)
    bpy.ops.preferences.addon_enable(module="bandvox_volumes")
    preferences = bpy.context.preferences.addons["bandvox_volumes"].preferences
    preferences.use_package = ENGINE == "package"
    preferences.command = "" if ENGINE == "package" else ENGINE
    return sorted(name for name in dir(bpy.ops.bandvox) if not name.startswith("_"))


def box(thing):
    bpy.context.view_layer.update()
    corners = np.array([thing.matrix_world @ mathutils.Vector(one) for one in thing.bound_box])
    return [corners.min(0).tolist(), corners.max(0).tolist()]


def measured(thing):
    """Volume and box of a mesh object in the world, as its modifiers leave it."""
    bpy.context.view_layer.update()
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bmesh.new()
    mesh.from_mesh(evaluated.to_mesh())
    mesh.transform(thing.matrix_world)
    points = np.array([vertex.co for vertex in mesh.verts])
    found = {"volume": mesh.calc_volume(signed=True), "low": points.min(0).tolist(), "high": points.max(0).tolist(),
             "open edges": sum(not edge.is_manifold for edge in mesh.edges)}
    mesh.free()
    return found


def kept(volume):
    return {"type": volume.type, "box": box(volume), "path": bpy.path.abspath(volume.data.filepath),
            "materials": len(volume.data.materials),
            **{key: volume.data[key] for key in volume.data.keys()
               if key.startswith("bandvox_") and key != "bandvox_voxel_sizes"}}


def nodes(volume):
    [material] = volume.data.materials
    [shader] = [node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeVolumePrincipled"]
    [link] = material.node_tree.links
    assert link.from_node == shader and link.to_socket.name == "Volume"
    values = {name: shader.inputs[name].default_value for name in (
        "Density", "Density Attribute", "Color Attribute", "Anisotropy", "Blackbody Intensity", "Temperature Attribute")}
    return {**values, "Color": list(shader.inputs["Color"].default_value)}


def import_file(path, **settings):
    bpy.ops.bandvox.import_volume(filepath=str(path), folder=str(FOLDER / "made"), **settings)
    return bpy.context.object


def surface_of(volume, **settings):
    bpy.context.view_layer.objects.active = volume
    bpy.ops.bandvox.volume_surface(**settings)
    return measured(bpy.context.object)


def sphere():
    volume = import_file("shape:sphere", resolution=32)
    found = {"kept": kept(volume), "solid": nodes(volume)}
    bpy.ops.bandvox.volume_material(look="FOG", depth=2, color=(0.1, 0.2, 0.3), anisotropy=0.5)
    found["fog"] = nodes(volume)
    turn = mathutils.Euler((0.3, 0.2, 0.1)).to_matrix().to_4x4()
    volume.matrix_world = mathutils.Matrix.Translation((3, 2, 1)) @ turn @ mathutils.Matrix.Scale(2, 4) @ volume.matrix_world
    found["surface"] = surface_of(volume)
    found["modifier"] = surface_of(volume, method="MODIFIER")
    found["higher"] = surface_of(volume, at="VALUE", iso=0.9)
    found["whole"] = surface_of(volume, at="VOLUME")
    found["whole by modifier"] = surface_of(volume, at="VOLUME", method="MODIFIER")
    return found


def by_voxel_size():
    volume = import_file(FOLDER / "cube.obj", size="VOXEL_SIZE", voxel_size=0.125, order=4, cutoff=0.25, up="Y")
    again = import_file(FOLDER / "cube.obj", resolution=16)
    import_file(FOLDER / "open.obj", resolution=16)
    return {"kept": kept(volume), "again": kept(again), "surface": surface_of(volume)}


def mesh_object():
    """A sphere of radius 1, made 2 x 1 x 1, mirrored, turned and moved, and made finer by a modifier."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1)
    source = bpy.context.object
    source.scale, source.rotation_euler, source.location = (-2, 1, 1), (0, 0, math.pi / 2), (0, 0, 5)
    source.modifiers.new("finer", "SUBSURF").levels = 1
    source.modifiers.new("triangles", "TRIANGULATE")  # so that there is only one way to see bent quadrangles
    expected = measured(source)
    expected["volume"] = -expected["volume"]  # it is mirrored
    bpy.ops.bandvox.volume_of_mesh(resolution=48, folder=str(FOLDER / "made"))
    volume = bpy.context.object
    return {"kept": kept(volume), "expected": expected, "surface": surface_of(volume),
            "hidden": source.hide_get() and source.hide_render}


def files():
    fire = import_file(FOLDER / "fire.vdb")
    found = {"fire": nodes(fire), "fire kept": kept(fire)}
    distances = import_file(FOLDER / "distances.vdb")
    found["distances"] = kept(distances)
    found["distances' surface"] = surface_of(distances)
    bpy.context.view_layer.objects.active = distances
    found["volume of distances"] = error_of(bpy.ops.bandvox.volume_surface, at="VOLUME")
    found["material of distances"] = error_of(bpy.ops.bandvox.volume_material)
    return found


def volumes_on_new_voxels():
    """What only the command does, whatever the engine."""
    solid = import_file(FOLDER / "distances.vdb", volumes="DENSITY", resolution=32)
    found = {"solid": kept(solid), "surface": surface_of(solid)}
    found["points"] = kept(import_file(FOLDER / "points.csv", resolution=24))
    found["coarse"] = kept(import_file(FOLDER / "fire.vdb", volumes="VALUES", size="VOXEL_SIZE", voxel_size=0.2))
    return found


def error_of(operator, **settings):
    """What the operator reports as an error; nothing may have been made."""
    before = [len(bpy.data.objects), len(bpy.data.volumes), len(bpy.data.materials)]
    try:
        operator(**settings)
    except RuntimeError as error:
        assert before == [len(bpy.data.objects), len(bpy.data.volumes), len(bpy.data.materials)]
        return str(error)
    return ""


def errors():
    run = bpy.ops.bandvox.import_volume
    made = str(FOLDER / "made")
    found = {name: error_of(run, filepath=str(FOLDER / name), folder=made)
             for name in ("junk.obj", "missing.obj", "junk.vdb", "vectors.vdb")}
    found["folder"] = error_of(run, filepath="shape:sphere", folder=str(FOLDER / "cube.obj" / "below"))
    bpy.ops.mesh.primitive_plane_add()
    found["flat"] = error_of(bpy.ops.bandvox.volume_of_mesh, folder=made)
    bpy.context.object.data.clear_geometry()
    found["empty"] = error_of(bpy.ops.bandvox.volume_of_mesh, folder=made)
    preferences = bpy.context.preferences.addons["bandvox_volumes"].preferences
    before = preferences.command
    preferences.command = "/nowhere/bandvox"
    found["command"] = error_of(run, filepath="shape:sphere", folder=made)
    preferences.command = before
    return found


def seen_from_above():
    """The middle of what Cycles shows of a sphere around the origin, x and y."""
    for thing in bpy.data.objects:
        thing.hide_render = True
    import_file("shape:sphere", resolution=16)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.data.type, camera.data.ortho_scale = (0, 0, 10), "ORTHO", 3
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 16, False
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.resolution_percentage, scene.render.film_transparent = 100, True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(FOLDER / "above.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    alpha = np.array(image.pixels[:]).reshape(64, 64, -1)[..., 3]
    places = 3 * ((np.arange(64) + 0.5) / 64 - 0.5)
    return [float((alpha.sum(axis) * places).sum() / alpha.sum()) for axis in (0, 1)]


def picture():
    """Mean colour of what is not as the corner: of the left half, the volume, and of the right half, the mesh."""
    image = bpy.data.images.load(str(FOLDER / "picture.png"))
    width, height = image.size
    pixels = np.array(image.pixels[:]).reshape(height, width, -1)[..., :3]
    seen = np.abs(pixels - pixels[-1, 0]).max(2) > 0.08
    halves = [(slice(None), slice(0, width // 2)), (slice(None), slice(width // 2, None))]
    return {"size": [width, height], "seen": [float(seen[half].mean()) for half in halves],
            "colors": [pixels[half][seen[half]].mean(0).tolist() for half in halves]}


found = {"operators": set_up(), "sphere": sphere(), "voxel size": by_voxel_size(), "mesh": mesh_object(),
         "files": files(), "errors": errors(), "picture": picture(), "from above": seen_from_above(),
         "command's": volumes_on_new_voxels()}
bpy.ops.preferences.addon_disable(module="bandvox_volumes")
found["after"] = hasattr(bpy.types, "BANDVOX_OT_import")
pathlib.Path(RESULT).write_text(json.dumps(found))
