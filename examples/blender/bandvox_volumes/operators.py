"""What can be done from Blender's menus; each can be undone, and its settings changed afterwards."""

import contextlib
import os

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import scene
from .engine import Engine, EngineError, Lattice


class BandvoxPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: StringProperty(
        name="Command", subtype="FILE_PATH",
        description="The program bandvox, where it is not on PATH")
    use_package: BoolProperty(
        name="Use the Python package", default=True,
        description="Work within Blender where its Python has the package bandvox; otherwise by the command")

    def draw(self, context):
        self.layout.prop(self, "command")
        self.layout.prop(self, "use_package")


@contextlib.contextmanager
def _engine(operator, context):
    """An engine by the preferences, whose progress Blender shows, and whose warnings it reports."""
    addon = context.preferences.addons.get(__package__)
    settings = {"command": addon.preferences.command, "use_package": addon.preferences.use_package} if addon else {}
    manager = context.window_manager
    manager.progress_begin(0, 1)
    try:
        engine = Engine(progress=manager.progress_update, **settings)
        yield engine
        for warning in engine.warnings:
            operator.report({"WARNING"}, warning)
    finally:
        manager.progress_end()


class Reporting:
    """An operator whose `work` may raise EngineError, which is reported, and then nothing has been done."""

    def execute(self, context):
        try:
            with _engine(self, context) as engine:
                self.report({"INFO"}, self.work(context, engine))
        except EngineError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _as_typed(number):
    """What Blender keeps as a float of 32 bits, without the digits that this has made up."""
    return float(f"{number:.6g}")


class LatticeSettings:
    size: EnumProperty(
        name="Size by",
        items=[("RESOLUTION", "Resolution", "Voxels along the longest side"),
               ("VOXEL_SIZE", "Voxel size", "World units")])
    resolution: IntProperty(
        name="Resolution", default=128, min=1, soft_max=1024,
        description="Voxels along the longest side of the object's box")
    voxel_size: FloatProperty(
        name="Voxel size", default=0.05, min=1e-6, precision=4, unit="LENGTH",
        description="Side of a voxel, world units")
    cutoff: FloatProperty(
        name="Cutoff", default=0.16, min=0.01, max=0.5, precision=3,
        description="Cutoff of the filter, cycles per voxel; the smaller, the smoother")
    order: FloatProperty(
        name="Order", default=2.0, min=1.0, max=64.0,
        description="Order of the filter: 2 never rings, more keeps more detail and overshoots at flat faces")
    folder: StringProperty(
        name="Folder", subtype="DIR_PATH",
        description="Where the .vdb file goes; empty is 'volumes' beside the .blend file, or the temporary folder "
                    "as long as that is not saved")

    def lattice(self):
        voxel_size = _as_typed(self.voxel_size) if self.size == "VOXEL_SIZE" else 0.0
        return Lattice(self.resolution, voxel_size, _as_typed(self.cutoff), _as_typed(self.order))

    def draw_lattice(self, layout):
        layout.use_property_split = True
        layout.prop(self, "size")
        layout.prop(self, "resolution" if self.size == "RESOLUTION" else "voxel_size")
        for name in ("cutoff", "order", "folder"):
            layout.prop(self, name)


def _told(volume):
    data = volume.data
    text = f"'{volume.name}': voxels of {data['bandvox_voxel_size']:.4g}"
    if data["bandvox_volume"] > 0:
        text += f", a volume of {data['bandvox_volume']:.6g}"
    return text


class BANDVOX_OT_import(Reporting, LatticeSettings, bpy.types.Operator, ImportHelper):
    """Read a mesh, points, a scan or a .vdb file as a band-limited volume"""

    bl_idname = "bandvox.import_volume"
    bl_label = "Import band-limited volume"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(
        default="*.obj;*.ply;*.stl;*.gltf;*.glb;*.bpt;*.vdb;*.xyz;*.csv;*.txt;*.npy;*.nrrd;*.nhdr;*.mha;*.mhd;*.tif",
        options={"HIDDEN"})
    volumes: EnumProperty(
        name="Volumes",
        items=[("KEEP", "As they are", "Refer to the .vdb file itself"),
               ("VALUES", "On the new voxels", "Their values, filtered for the size below"),
               ("DENSITY", "As solids", "The density of the solid that they are, on the size below")],
        description="What becomes of a .vdb file")
    up: EnumProperty(
        name="Up", items=[("Z", "Z", "The axes stay as they are"), ("Y", "Y", "Turn the object about x by 90 degrees")],
        description="What points up in the file")

    align: BoolProperty(
        name="Align", default=True,
        description="Move the object back by the half voxel that Blender shows volumes too far along x, y and z")

    def draw(self, context):
        self.draw_lattice(self.layout)
        for name in ("volumes", "up", "align"):
            self.layout.prop(self, name)

    def work(self, context, engine):
        source = self.filepath if self.filepath.startswith("shape:") else bpy.path.abspath(self.filepath)
        name = os.path.splitext(os.path.basename(source))[0].replace("shape:", "")
        path = self._file_of(engine, source, name)
        volume = scene.add_volume(context, name, path, engine.facts(path), self.up == "Y", self.align)
        scene.set_look_if_density(volume)
        return _told(volume)

    def _file_of(self, engine, source, name):
        kind = ""
        if source.lower().endswith(".vdb"):
            if self.volumes == "KEEP":
                return source
            kind = self.volumes.lower()
        path = scene.free_path(name, self.folder)
        engine.convert_file(source, path, self.lattice(), kind)
        return path


class BANDVOX_OT_volume_of_mesh(Reporting, LatticeSettings, bpy.types.Operator):
    """Make a band-limited volume of the solid inside the active mesh, as its modifiers and its place leave it"""

    bl_idname = "bandvox.volume_of_mesh"
    bl_label = "Volume of mesh"
    bl_options = {"REGISTER", "UNDO"}

    hide_source: BoolProperty(name="Hide the mesh", default=True, description="In the view and in renders")

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type in {"MESH", "CURVE", "SURFACE", "FONT", "META"}

    def draw(self, context):
        self.draw_lattice(self.layout)
        self.layout.prop(self, "hide_source")

    def work(self, context, engine):
        source = context.object
        points, triangles = scene.world_mesh(context, source)
        path = scene.free_path(source.name, self.folder)
        engine.convert_mesh(points, triangles, path, self.lattice())
        volume = scene.add_volume(context, source.name + " volume", path, engine.facts(path))
        scene.set_look_if_density(volume)
        if self.hide_source:
            source.hide_set(True)
            source.hide_render = True
        return _told(volume)


class VolumeOperator(Reporting):
    """One on the active object, a volume that this add-on has made."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "VOLUME" and "bandvox_grid" in context.object.data


class BANDVOX_OT_material(VolumeOperator, bpy.types.Operator):
    """Give the volume a material of one Principled Volume"""

    bl_idname = "bandvox.volume_material"
    bl_label = "Volume material"

    look: EnumProperty(
        name="Look", items=[("SOLID", "Solid", "Light ends within a voxel"),
                            ("FOG", "Fog", "Light comes through, 10 optical depths along the longest side")])
    depth: FloatProperty(name="Depth", default=1.0, min=0.0, soft_max=10.0, description="So many times as dense")
    color: FloatVectorProperty(name="Color", subtype="COLOR", size=3, min=0, max=1, default=(0.8, 0.8, 0.8),
                               description="What it scatters")
    anisotropy: FloatProperty(name="Anisotropy", min=-1, max=1, description="Back, -1, or onward, 1")

    def work(self, context, engine):
        shader = scene.set_material(context.object, self.look, self.depth, self.color, self.anisotropy)
        return f"a density of {shader.inputs['Density'].default_value:.4g} per unit"


class BANDVOX_OT_surface(VolumeOperator, bpy.types.Operator):
    """Make a mesh of the surface where the volume has its iso-value"""

    bl_idname = "bandvox.volume_surface"
    bl_label = "Surface of volume"

    method: EnumProperty(
        name="Method", items=[("BANDVOX", "Bandvox", "On the band-limited density itself; made once"),
                              ("MODIFIER", "Modifier", "By Blender, which follows the volume; less exact")])
    at: EnumProperty(
        name="At", items=[("OWN", "The volume's own iso", "As its file says, mostly 0.5"),
                          ("VOLUME", "The source's volume", "The value whose surface encloses what the source does"),
                          ("VALUE", "A value", "As below")])
    iso: FloatProperty(name="Iso", default=0.5, description="The value that is the surface, if it is chosen here")

    def work(self, context, engine):
        volume = context.object
        data = volume.data
        path, grid = bpy.path.abspath(data.filepath), data["bandvox_grid"]
        iso = {"OWN": data["bandvox_iso"], "VALUE": _as_typed(self.iso)}.get(self.at)
        if iso is None:
            iso = engine.iso_of_volume(path, grid)
        if self.method == "MODIFIER":
            surface = scene.add_modifier_surface(context, volume, iso)
            return f"'{surface.name}' at {iso:.4g}"
        points, triangles = engine.surface(path, grid, iso)
        surface = scene.add_mesh_surface(context, volume, points, triangles)
        return f"'{surface.name}' at {iso:.4g}: {len(triangles)} triangles"


class BANDVOX_MT_object(bpy.types.Menu):
    bl_idname = "BANDVOX_MT_object"
    bl_label = "Band-limited volume"

    def draw(self, context):
        for operator in (BANDVOX_OT_volume_of_mesh, BANDVOX_OT_material, BANDVOX_OT_surface):
            self.layout.operator(operator.bl_idname)


CLASSES = (BandvoxPreferences, BANDVOX_OT_import, BANDVOX_OT_volume_of_mesh, BANDVOX_OT_material, BANDVOX_OT_surface,
           BANDVOX_MT_object)
