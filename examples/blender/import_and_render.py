"""Imports a file as a band-limited volume, adds the mesh of its surface, and renders both side by side, without a window.

    blender -b --factory-startup --python import_and_render.py -- INPUT PICTURE.png [--resolution N] ...

INPUT: a mesh, points, a scan, a .vdb file, or a built-in shape such as shape:torus. The volume is written beside the
picture.
"""

import argparse
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bandvox_volumes  # noqa: E402  (it lies beside this file)


def parse_words():
    parser = argparse.ArgumentParser(prog="import_and_render.py")
    parser.add_argument("input")
    parser.add_argument("picture")
    parser.add_argument("--resolution", type=int, default=64, help="voxels along the longest side [%(default)s]")
    parser.add_argument("--up", choices=["Y", "Z"], default="Z", help="what points up in the file [%(default)s]")
    parser.add_argument("--size", type=int, nargs=2, default=[128, 96], help="of the picture, pixels [128 96]")
    parser.add_argument("--samples", type=int, default=32, help="per pixel [%(default)s]")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def import_both(source, folder, resolution, up):
    """The volume as a solid, and beside it the mesh of its surface."""
    bpy.ops.bandvox.import_volume(filepath=source, resolution=resolution, up=up, folder=folder)
    volume = bpy.context.object
    bpy.ops.bandvox.volume_material(look="SOLID", color=(0.75, 0.35, 0.15))
    bpy.ops.bandvox.volume_surface(method="BANDVOX")
    surface = bpy.context.object
    surface.location.x += 1.15 * volume.dimensions.x
    material = bpy.data.materials.new("surface")
    material.diffuse_color = (0.2, 0.4, 0.7, 1)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.2, 0.4, 0.7, 1)
    surface.data.materials.append(material)
    bpy.context.view_layer.update()
    return volume, surface


def add_camera_and_light(things, size):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    toward = Vector((0.25, -1, 0.6)).normalized()
    camera.rotation_euler = toward.to_track_quat("Z", "Y").to_euler()
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 3
    sun.rotation_euler = Vector((-0.5, -0.6, 0.9)).to_track_quat("Z", "Y").to_euler()
    for one in (camera, sun):
        bpy.context.collection.objects.link(one)
    scene.camera = camera
    # As near as everything fits, and a little back.
    corners = [thing.matrix_world @ Vector(corner) for thing in things for corner in thing.bound_box]
    place, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(),
                                        [number for corner in corners for number in corner])
    distance = max((place - corner).length for corner in corners)
    camera.location = place + 0.02 * distance * toward
    camera.data.clip_start, camera.data.clip_end = 0.01 * distance, 2 * distance
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.35, 0.4, 0.45, 1)
    scene.world = world


def render(path, samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.volume_bounces = 2
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main():
    words = parse_words()
    source = words.input if words.input.startswith("shape:") else os.path.abspath(words.input)
    picture = os.path.abspath(words.picture)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bandvox_volumes.register()
    things = import_both(source, os.path.dirname(picture), words.resolution, words.up)
    add_camera_and_light(things, words.size)
    render(picture, words.samples)


if __name__ == "__main__":
    main()
