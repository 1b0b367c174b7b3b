"""What a volume is in Blender: an object of its file, its material, its surface.

Blender's units are taken for world units. Nothing is turned unless it is asked for: Blender's z is up, and so is the
file's z.

OpenVDB has a voxel's value at the voxel's index. Blender, in Cycles as in its modifier Volume to Mesh, shows it half a
voxel further along x, y and z. So new volume objects are moved back by that, and meshes of the true surface are moved on.
"""

import math
import os
import re

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .engine import EngineError

# Optical depth of a voxel of density 1 of what looks solid: 95 % of the light ends in it.
SOLID_DEPTH = 3.0
# Optical depth of fog along the longest side of its box, as `bandvox render --mode volume` has it.
FOG_DEPTH = 10.0


def free_path(name, folder=""):
    """A path for a new .vdb file that is not there yet.

    folder: where; empty is `volumes` beside the .blend file, or Blender's temporary folder as long as that is not saved.
    """
    if not folder:
        folder = "//volumes" if bpy.data.filepath else bpy.app.tempdir
    folder = bpy.path.abspath(folder)
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise EngineError(f"{error.strerror}: '{folder}'; expected a folder for volumes") from error
    stem = re.sub(r"[^\w.-]", "_", name)
    path = os.path.join(folder, stem + ".vdb")
    number = 2
    while os.path.exists(path):
        path = os.path.join(folder, f"{stem}_{number}.vdb")
        number += 1
    return path


def add_volume(context, name, path, facts, is_y_up=False, is_aligned=True):
    """A volume object of a .vdb file, selected and active.

    facts: its grids; their voxel size, iso-value and volume become properties of the data, bandvox_*.
    is_y_up: turn the object about x, so that the file's y points up. is_aligned: move it so that Blender shows it where
    it is in the file.
    """
    main = main_grid(path, facts)
    data = bpy.data.volumes.new(name)
    data.filepath = path
    if not data.grids.load():
        message = data.grids.error_message
        bpy.data.volumes.remove(data)
        raise EngineError(f"Blender cannot read '{path}': {message}")
    data["bandvox_grid"] = main.name
    data["bandvox_voxel_size"] = min(main.voxel_size)
    data["bandvox_voxel_sizes"] = main.voxel_size
    data["bandvox_iso"] = main.iso
    data["bandvox_is_level_set"] = main.is_level_set
    data["bandvox_volume"] = main.volume
    turn = Matrix.Rotation(math.pi / 2 if is_y_up else 0, 4, "X")
    return _add_object(context, name, data, turn @ _shift_of(data).inverted() if is_aligned else turn)


def _shift_of(data):
    """By what Blender shows a volume further on than its file says, in the object's own space."""
    return Matrix.Translation(Vector(data["bandvox_voxel_sizes"]) / 2)


def main_grid(path, facts):
    """The grid that materials and surfaces are made of: `density`, else the first one of numbers."""
    if not facts:
        raise EngineError(f"'{path}' has no grid of floats; expected one, such as 'density'")
    return next((grid for grid in facts if grid.name == "density"), facts[0])


def world_mesh(context, source):
    """Points (n, 3), world units, and triangles (m, 3) of an object as its modifiers leave it."""
    evaluated = source.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        evaluated.to_mesh_clear()
    if not len(triangles):
        raise EngineError(f"'{source.name}' has no faces; expected the surface of a solid")
    matrix = np.array(evaluated.matrix_world)
    triangles = triangles.reshape(-1, 3)
    if np.linalg.det(matrix[:3, :3]) < 0:  # mirrored: what was outside would be inside
        triangles = triangles[:, ::-1]
    points = points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return points, np.ascontiguousarray(triangles)


def set_material(volume, look="SOLID", depth=1.0, color=(0.8, 0.8, 0.8), anisotropy=0.0):
    """Give a volume object a material of one Principled Volume node, which is returned.

    look: SOLID stops light within a voxel, FOG over the longest side of the box. depth: so many times as dense.
    color: linear, what it scatters; a grid `Cd` in the file is taken as well. anisotropy: -1 to 1.
    A grid `temperature`, kelvin, glows.
    """
    data = volume.data
    grid = data["bandvox_grid"]
    if data["bandvox_is_level_set"]:
        raise EngineError(f"the grid '{grid}' holds distances; expected a density")
    # Values are per unit of the object's own space, which its scale does not change.
    longest = max(np.ptp(np.array(volume.bound_box), axis=0))
    scale = SOLID_DEPTH / data["bandvox_voxel_size"] if look == "SOLID" else FOG_DEPTH / longest
    material = bpy.data.materials.new(volume.name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    shader = nodes.new("ShaderNodeVolumePrincipled")
    shader.location = (-300, 0)
    material.node_tree.links.new(shader.outputs["Volume"], output.inputs["Volume"])
    names = {one.name for one in data.grids}
    shader.inputs["Density"].default_value = depth * scale
    shader.inputs["Density Attribute"].default_value = grid
    shader.inputs["Color"].default_value = (*color, 1.0)
    shader.inputs["Color Attribute"].default_value = "Cd" if "Cd" in names else ""
    shader.inputs["Anisotropy"].default_value = anisotropy
    if "temperature" in names:
        shader.inputs["Blackbody Intensity"].default_value = 1.0
        shader.inputs["Temperature Attribute"].default_value = "temperature"
    data.materials.clear()
    data.materials.append(material)
    return shader


def set_look_if_density(volume):
    """The material of a solid for a volume that is new; a level set keeps none."""
    if not volume.data["bandvox_is_level_set"]:
        set_material(volume)


def add_modifier_surface(context, volume, iso):
    """A mesh object that Blender makes of the volume, again whenever it changes; straight between voxels."""
    surface = _add_object(context, volume.name + " surface", bpy.data.meshes.new(volume.name + " surface"),
                          volume.matrix_world)
    modifier = surface.modifiers.new("Band-limited surface", "VOLUME_TO_MESH")
    modifier.object = volume
    modifier.grid_name = volume.data["bandvox_grid"]
    modifier.threshold = iso
    modifier.use_smooth_shade = True
    return surface


def add_mesh_surface(context, volume, points, triangles):
    """A mesh object of points (n, 3), in the file's space, and triangles (m, 3), shaded smooth."""
    mesh = bpy.data.meshes.new(volume.name + " surface")
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, np.float32).ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles, np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    # Later than Blender 4.0 it follows from where the next one begins.
    if bpy.app.version < (4, 1, 0):
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), bool))
    mesh.update(calc_edges=True)
    return _add_object(context, mesh.name, mesh, volume.matrix_world @ _shift_of(volume.data))


def _add_object(context, name, data, matrix):
    """A new object there, which alone is selected, and active."""
    result = bpy.data.objects.new(name, data)
    result.matrix_world = matrix
    context.collection.objects.link(result)
    for other in context.selected_objects:
        other.select_set(False)
    result.select_set(True)
    context.view_layer.objects.active = result
    return result
