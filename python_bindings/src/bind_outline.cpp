// Free-form surfaces and volumes as drawings of lines.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "camera_arguments.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"
#include "iso_argument.h"
#include "patches_object.h"
#include "paths.h"
#include "solid_density.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/outline/patches_to_outline.h>
#include <bandvox/outline/volumes_to_outline.h>
#include <bandvox/outline/write_outline.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

#include <choose_grid.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>
#include <words.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace bandvox::python {

namespace py = pybind11;

namespace {

const std::vector<std::string>& lineKinds() {
    static const std::vector<std::string> names{"contour",      "boundary", "crease",
                                                "intersection", "isophote", "suggestive"};
    return names;
}

struct DrawingObject {
    Outline outline;
    StrokeOptions stroke;
};

/// A line of a drawing, and the drawing's name for its object.
struct DrawnPath {
    OutlinePath path;
    std::string object;
};

/// A region of a drawing, and the drawing's name for its object.
struct DrawnRegion {
    OutlineFill fill;
    std::string object;
};

void saveDrawing(const DrawingObject& drawing, const std::filesystem::path& path) {
    const py::gil_scoped_release unlocked;
    AtomicFile file(path);
    writeOutline(file, drawing.outline, drawing.stroke);
    file.commit();
}

std::string svgOf(const DrawingObject& drawing) {
    const std::string pattern =
        (std::filesystem::temp_directory_path() / "bandvox-drawing-XXXXXX").string();
    std::vector<char> name(pattern.c_str(), pattern.c_str() + pattern.size() + 1);
    if (::mkdtemp(name.data()) == nullptr) {
        throw Error(ErrorKind::Runtime, "cannot make a folder '" + pattern + "'");
    }
    const std::filesystem::path folder = name.data();
    // Whatever happens, the folder goes.
    const std::shared_ptr<void> removal(nullptr, [&folder](void*) {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    });
    saveDrawing(drawing, folder / "drawing.svg");
    std::ifstream stream(folder / "drawing.svg", std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Colours and lengths go into a style sheet, and must not end it.
void requireStyle(const std::string& text, const char* what) {
    const bool isPlain = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string("#(),.% -").find(c) != std::string::npos;
    });
    if (isPlain) return;
    throw Error(ErrorKind::Usage, std::string(what) + " is '" + text +
                                      "'; expected a value as in CSS: letters, digits and #(),.%-");
}

void requireLength(double length, const char* what) {
    if (length > 0 && length <= 1e5) return;
    throw Error(ErrorKind::Usage, std::string(what) + " is " + std::to_string(length) +
                                      "; expected millimetres above 0");
}

StrokeOptions checked(const StrokeOptions& stroke) {
    requireLength(stroke.width, "stroke");
    requireLength(stroke.hiddenWidth, "hidden_stroke");
    requireStyle(stroke.color, "stroke_color");
    requireStyle(stroke.hiddenColor, "hidden_color");
    requireStyle(stroke.dash, "dash");
    requireValid(stroke);
    return stroke;
}

/// Arguments that some drawings have no use for; nothing was given where there is no value.
struct OptionalArguments {
    std::optional<double> creaseAngle, hiddenWidth, suggestive, shade, voxelSize, cutoff, order;
    std::optional<int> resolution;
    std::optional<std::string> hiddenColor, dash;
    std::optional<std::array<double, 3>> light;
    std::optional<std::vector<double>> tones;
    std::optional<std::vector<std::string>> fillColors;
};

/// An argument that changes nothing is taken for a mistake.
void requireUsed(bool isGiven, bool isUsed, const char* message) {
    if (isGiven && !isUsed) throw Error(ErrorKind::Usage, message);
}

void requireUsed(const OptionalArguments& given, const OutlineOptions& options,
                 const std::vector<bool>& kinds) {
    const auto isKept = [&](OutlineKind kind) { return kinds[static_cast<std::size_t>(kind)]; };
    requireUsed(given.hiddenWidth || given.hiddenColor || given.dash, options.hidden,
                "hidden_stroke, hidden_color and dash are for hidden lines; expected hidden=True");
    requireUsed(given.creaseAngle.has_value(), isKept(OutlineKind::Crease),
                "crease_angle is for creases; expected 'crease' among the kinds");
    requireUsed(!options.isophotes.empty(), isKept(OutlineKind::Isophote),
                "isophotes are lines of a kind; expected 'isophote' among the kinds");
    requireUsed(given.suggestive.has_value(), isKept(OutlineKind::Suggestive),
                "suggestive contours are lines of a kind; expected 'suggestive' among the kinds");
    const bool isToon = options.fill == OutlineFillKind::Toon;
    requireUsed(given.tones || given.shade, isToon,
                "tones and shade are for a toon fill; expected fill='toon'");
    requireUsed(given.fillColors.has_value(), options.fill != OutlineFillKind::None,
                "fill_colors are for fills; expected fill='flat' or 'toon'");
    requireUsed(given.light.has_value(), isToon || !options.isophotes.empty(),
                "light is for isophotes and toon fills; expected isophotes or fill='toon'");
}

/// Width and height in millimetres of a page with a name, as in "A4-landscape".
std::array<double, 2> namedPage(const std::string& name) {
    const std::map<std::string, std::array<double, 2>> sizes{
        {"a3", {297, 420}}, {"a4", {210, 297}}, {"a5", {148, 210}}, {"letter", {215.9, 279.4}}};
    std::string lower = app::lowerCase(name);
    const std::string turned = "-landscape";
    const bool isTurned = lower.ends_with(turned);
    if (isTurned) lower.resize(lower.size() - turned.size());
    const auto found = sizes.find(lower);
    if (found == sizes.end()) {
        throw Error(ErrorKind::Usage, "page is '" + name +
                                          "'; expected width and height in millimetres, or 'A3', "
                                          "'A4', 'A5' or 'letter', also with '-landscape'");
    }
    std::array<double, 2> size = found->second;
    if (isTurned) std::swap(size[0], size[1]);
    return size;
}

void setPage(OutlineOptions& options, const py::object& asked,
             const std::optional<double>& margin) {
    std::array<double, 2> page{};
    if (py::isinstance<py::str>(asked)) {
        page = namedPage(asked.cast<std::string>());
    } else {
        const std::string expected = "two numbers, width and height in millimetres";
        const py::array numbers = numericArray(asked, "page", expected);
        if (numbers.ndim() != 1 || numbers.size() != 2) {
            throw Error(ErrorKind::Usage,
                        "page: found " + described(numbers) + "; expected " + expected);
        }
        page = asked.cast<std::array<double, 2>>();
    }
    requireLength(page[0], "page");
    requireLength(page[1], "page");
    options.width = page[0];
    options.height = page[1];
    const double shorter = std::min(page[0], page[1]);
    options.margin = margin.value_or(std::min(options.margin, 0.05 * shorter));
    if (options.margin >= 0 && options.margin < 0.5 * shorter) return;
    throw Error(ErrorKind::Usage, "margin is " + std::to_string(options.margin) +
                                      "; expected 0 or more, and less than half the page");
}

/// What is drawn: files are read later, without the interpreter.
struct DrawnSources {
    PatchModel patches;
    std::vector<OutlineVolume> volumes;
    std::vector<std::filesystem::path> patchFiles, volumeFiles, solidFiles;
    std::optional<std::string> grid;  // of the files of volumes
    DensityOptions density;           // of the solids
    IsoArgument iso;                  // of the volumes and solids
    std::vector<std::string> warnings;

    bool hasVolumes() const {
        return !volumes.empty() || !volumeFiles.empty() || !solidFiles.empty();
    }
};

void addFile(const std::filesystem::path& file, DrawnSources& sources) {
    if (app::lowerCase(file.extension().string()) == ".vdb") {
        sources.volumeFiles.push_back(file);
    } else if (isShape(file.string()) || (isMeshFile(file) && !isPatchFile(file))) {
        sources.solidFiles.push_back(file);
    } else {
        sources.patchFiles.push_back(file);
    }
}

void addSource(const py::handle& source, DrawnSources& sources) {
    if (py::isinstance<PatchesObject>(source)) {
        sources.patches.append(source.cast<const PatchesObject&>().model);
    } else if (py::isinstance<FloatGridObject>(source) || py::isinstance<MaskGridObject>(source)) {
        const openvdb::FloatGrid::Ptr grid = floatGridOf(source);
        sources.volumes.push_back({grid, {}, grid->getName()});
    } else if (isPath(source)) {
        addFile(pathOf(source), sources);
    } else {
        throw Error(ErrorKind::Usage, std::string("found a ") + Py_TYPE(source.ptr())->tp_name +
                                          "; expected a file, 'shape:NAME', bandvox.Patches, a "
                                          "bandvox.Grid, or a list of such");
    }
}

void addSources(const py::object& source, const OptionalArguments& given, DrawnSources& sources) {
    if (py::isinstance<py::list>(source) || py::isinstance<py::tuple>(source)) {
        for (const py::handle part : source) addSource(part, sources);
    } else {
        addSource(source, sources);
    }
    if (sources.iso.isGiven() && !sources.hasVolumes()) {
        throw Error(ErrorKind::Usage,
                    "iso is for grids and meshes, and there is none; expected one");
    }
    if (sources.grid && sources.volumeFiles.empty()) {
        throw Error(ErrorKind::Usage, "grid is for .vdb files, and there is none; expected one");
    }
    requireUsed(given.suggestive.has_value(), sources.hasVolumes(),
                "suggestive contours are of grids and meshes, and there is none; expected one");
    requireUsed(given.resolution || given.voxelSize || given.cutoff || given.order,
                !sources.solidFiles.empty(),
                "resolution, voxel_size, cutoff and order are for mesh files and shapes, and there "
                "is none; expected one");
    requireUsed(given.voxelSize.has_value(), !given.resolution,
                "resolution and voxel_size are both the size of voxels; expected one of them");
    requireUsed(given.creaseAngle.has_value(),
                !sources.patches.patches.empty() || !sources.patchFiles.empty(),
                "crease_angle is for patches, and there are none; expected some");
}

void readSources(DrawnSources& sources, Progress& progress) {
    const auto warnings = [&sources](const std::vector<std::string>& more) {
        sources.warnings.insert(sources.warnings.end(), more.begin(), more.end());
    };
    for (const auto& file : sources.patchFiles) {
        sources.patches.append(readPatches(file, progress));
    }
    warnings(sources.patches.warnings);
    for (const auto& file : sources.volumeFiles) {
        const auto grid =
            app::chooseFloatGrid(readVdb(file, progress), sources.grid, "density", file.string());
        sources.volumes.push_back({grid, {}, file.stem().string()});
    }
    for (const auto& file : sources.solidFiles) {
        const DensityResult made = densityOfSolid(file, sources.density, progress);
        warnings(made.warnings);
        const std::string name = isShape(file.string()) ? file.string() : file.stem().string();
        sources.volumes.push_back({made.grid, {}, name});
    }
    for (auto& volume : sources.volumes) volume.iso = isoFor(sources.iso, volume.grid, progress);
}

std::shared_ptr<DrawingObject> draw(DrawnSources sources, const OutlineOptions& options,
                                    const std::vector<bool>& isKept, const StrokeOptions& stroke,
                                    int threads, const py::object& progress) {
    auto drawing = std::make_shared<DrawingObject>();
    drawing->stroke = checked(stroke);
    drawing->outline = inBackground(progress, threads, [&](Progress& watched) {
        readSources(sources, watched);
        return sources.volumes.empty()
                   ? patchesToOutline(sources.patches, options, watched)
                   : volumesToOutline(sources.volumes, sources.patches, options, watched);
    });
    auto& paths = drawing->outline.paths;
    std::erase_if(
        paths, [&](const OutlinePath& one) { return !isKept[static_cast<std::size_t>(one.kind)]; });
    if (paths.empty() && drawing->outline.fills.empty()) {
        throw Error(ErrorKind::Result,
                    "the drawing is empty: it has no lines of these kinds; expected some");
    }
    warn(sources.warnings);
    warn(drawing->outline.warnings);
    return drawing;
}

py::list pathsOf(const DrawingObject& drawing) {
    py::list paths;
    for (const OutlinePath& path : drawing.outline.paths) {
        paths.append(
            DrawnPath{path, drawing.outline.objects[static_cast<std::size_t>(path.object)]});
    }
    return paths;
}

py::array arrayOf(const std::vector<std::array<double, 2>>& points) {
    std::vector<double> numbers;
    for (const auto& point : points) numbers.insert(numbers.end(), point.begin(), point.end());
    const auto count = static_cast<py::ssize_t>(points.size());
    return ownedArray(std::move(numbers), {count, 2});
}

py::list regionsOf(const DrawingObject& drawing) {
    py::list regions;
    for (const OutlineFill& fill : drawing.outline.fills) {
        regions.append(
            DrawnRegion{fill, drawing.outline.objects[static_cast<std::size_t>(fill.object)]});
    }
    return regions;
}

py::list loopsOf(const DrawnRegion& region) {
    py::list loops;
    for (const auto& loop : region.fill.loops) loops.append(arrayOf(loop));
    return loops;
}

void bindDrawing(py::module_& module) {
    py::class_<DrawnPath>(module, "DrawnPath",
                          "A line of a Drawing: cubic Bézier curves, one after "
                          "the other.")
        .def_property_readonly(
            "kind",
            [](const DrawnPath& self) {
                return lineKinds()[static_cast<std::size_t>(self.path.kind)];
            },
            "'contour', 'boundary', 'crease', 'intersection', 'isophote' or 'suggestive'.")
        .def_readonly("object", &DrawnPath::object, "The name of the object that it belongs to.")
        .def_property_readonly(
            "hidden", [](const DrawnPath& self) { return self.path.hidden; },
            "How many surfaces are in front of it; 0: it is seen.")
        .def_property_readonly(
            "closed", [](const DrawnPath& self) { return self.path.closed; },
            "Whether its last point is the first one again.")
        .def_property_readonly(
            "points", [](const DrawnPath& self) { return arrayOf(self.path.points); },
            "(3 n + 1, 2) float64, millimetres of the page, y downward: an "
            "anchor, and for each curve two handles and the next anchor.");
    py::class_<DrawnRegion>(module, "DrawnRegion",
                            "A region of a Drawing in which one object is seen, in one tone.")
        .def_readonly("object", &DrawnRegion::object, "The name of the object.")
        .def_property_readonly(
            "tone", [](const DrawnRegion& self) { return self.fill.tone; }, "0: the darkest.")
        .def_property_readonly(
            "loops", &loopsOf,
            "Its borders, a (3 n + 1, 2) float64 each, as DrawnPath.points, closed. What an odd "
            "number of them surrounds is inside.");
    py::class_<DrawingObject, std::shared_ptr<DrawingObject>>(
        module, "Drawing", "A drawing of lines, as outline makes it. A notebook shows it.")
        .def_property_readonly(
            "page",
            [](const DrawingObject& self) {
                return py::make_tuple(self.outline.width, self.outline.height);
            },
            "Width and height, millimetres.")
        .def_property_readonly("paths", &pathsOf, "Its lines, a DrawnPath each.")
        .def_property_readonly("regions", &regionsOf,
                               "What is filled, a DrawnRegion each; they do not overlap.")
        .def("svg", &svgOf, "The text of an SVG file.")
        .def("save", &saveDrawing, py::arg("path"),
             "Writes an .svg, .pdf, .eps or .dxf file, whole or not at all.")
        .def("_repr_svg_", &svgOf)
        .def("__repr__", [](const DrawingObject& self) {
            return "<bandvox.Drawing: " + std::to_string(self.outline.paths.size()) + " paths>";
        });
}

}  // namespace

void bindOutline(py::module_& module) {
    bindDrawing(module);
    const OutlineOptions standard;
    const StrokeOptions stroke;
    module.def(
        "outline",
        [](const py::object& source, const py::object& page, const std::optional<double>& margin,
           double tolerance, const std::optional<double>& creaseAngle,
           const std::vector<std::string>& kinds, bool hidden, double width, std::string color,
           const std::optional<double>& hiddenWidth, const std::optional<std::string>& hiddenColor,
           const std::optional<std::string>& dash, const py::object& eye, const py::object& lookat,
           const py::object& up, const py::object& from, const py::object& camera,
           const py::object& cameraFile, const std::optional<double>& focal,
           const std::optional<double>& aperture, const std::optional<double>& fov,
           const std::optional<double>& frame, const std::optional<std::string>& grid,
           const py::object& iso, const std::optional<int>& resolution,
           const std::optional<double>& voxelSize, const std::optional<double>& cutoff,
           const std::optional<double>& order, const std::vector<double>& isophotes,
           const std::optional<double>& suggestive,
           const std::optional<std::array<double, 3>>& light, const std::string& fill,
           const std::optional<std::vector<double>>& tones,
           const std::optional<std::vector<std::string>>& fillColors,
           const std::optional<double>& shade, int threads, const py::object& progress) {
            const OptionalArguments given{
                creaseAngle, hiddenWidth, suggestive, shade, voxelSize, cutoff,    order,
                resolution,  hiddenColor, dash,       light, tones,     fillColors};
            OutlineOptions options;
            options.isophotes = isophotes;
            options.suggestive = suggestive;
            if (light) options.light = openvdb::Vec3d(light->data());
            if (!(options.light.length() > 0)) {
                throw Error(ErrorKind::Usage, "light: expected a direction that is not all 0");
            }
            options.fill =
                static_cast<OutlineFillKind>(choiceOf(fill, {"none", "flat", "toon"}, "fill"));
            options.tones = tones.value_or(options.tones);
            setPage(options, page, margin);
            options.tolerance = tolerance;
            options.creaseAngle = creaseAngle.value_or(options.creaseAngle);
            options.hidden = hidden;
            const CameraArguments view{eye,        lookat, up,       from, camera,
                                       cameraFile, focal,  aperture, fov,  frame};
            options.camera = cameraOf(
                view, (options.height - 2 * options.margin) / (options.width - 2 * options.margin));
            requireUsed(view, options.camera);
            std::vector<bool> isKept(lineKinds().size());
            for (const std::string& kind : kinds) {
                isKept[choiceOf(kind, lineKinds(), "kinds")] = true;
            }
            requireUsed(given, options, isKept);
            const StrokeOptions look;
            DrawnSources sources;
            sources.grid = grid;
            sources.iso = isoArgumentOf(iso);
            DensityOptions& density = sources.density;
            density.resolution = resolution.value_or(density.resolution);
            density.voxelSize = voxelSize.value_or(density.voxelSize);
            density.filter = ExponentialFilter{order.value_or(density.filter.order),
                                               cutoff.value_or(density.filter.cutoff)};
            addSources(source, given, sources);
            return draw(std::move(sources), options, isKept,
                        {width, hiddenWidth.value_or(look.hiddenWidth), std::move(color),
                         hiddenColor.value_or(look.hiddenColor), dash.value_or(look.dash),
                         fillColors.value_or(look.fillColors), shade.value_or(look.shade)},
                        threads, progress);
        },
        py::arg("source"), py::kw_only(),
        py::arg("page") = std::array<double, 2>{standard.width, standard.height},
        py::arg("margin") = py::none(), py::arg("tolerance") = standard.tolerance,
        py::arg("crease_angle") = py::none(), py::arg("kinds") = lineKinds(),
        py::arg("hidden") = true, py::arg("stroke") = stroke.width,
        py::arg("stroke_color") = stroke.color, py::arg("hidden_stroke") = py::none(),
        py::arg("hidden_color") = py::none(), py::arg("dash") = py::none(),
        py::arg("eye") = py::none(), py::arg("lookat") = py::none(), py::arg("up") = py::none(),
        py::arg("from_") = py::none(), py::arg("camera") = py::none(),
        py::arg("camera_file") = py::none(), py::arg("focal") = py::none(),
        py::arg("aperture") = py::none(), py::arg("fov") = py::none(),
        py::arg("frame") = py::none(), py::arg("grid") = py::none(), py::arg("iso") = py::none(),
        py::arg("resolution") = py::none(), py::arg("voxel_size") = py::none(),
        py::arg("cutoff") = py::none(), py::arg("order") = py::none(),
        py::arg("isophotes") = standard.isophotes, py::arg("suggestive") = py::none(),
        py::arg("light") = py::none(), py::arg("fill") = "none", py::arg("tones") = py::none(),
        py::arg("fill_colors") = py::none(), py::arg("shade") = py::none(), py::arg("threads") = 0,
        py::arg("progress") = py::none(),
        R"(Draws free-form surfaces, volumes and meshes as lines; returns a Drawing.

source: Patches, a file of them (.bpt, .obj, .step, .iges or .brep), a Grid, a .vdb file, a mesh
file, 'shape:NAME', or a list of such. grid: the name of the grid of a .vdb file, 'density' or the
only one of floats if it is None. iso: the value of grids that is the surface, as of to_mesh.
resolution, voxel_size, cutoff, order: of the density that is made of a mesh or a shape, as of
bandlimit, 256 voxels, 0.16 and 2 if they are None; fewer voxels leave small detail away. isophotes: lines where the cosine of the angle
between the normal and the direction to the light is one of these; light: along the camera's right,
up and back, (-0.4, 0.7, 0.8) if there is none. suggestive: of grids, draw suggestive contours of at
least this strength, as in 20. fill: what is between lines, 'none', 'flat', a colour for each
object, or 'toon', tones of it; tones: cosines of that angle at which they change, ascending,
(0.25, 0.7) if there are none; fill_colors: of the objects, one after the other, '#rrggbb', else '#f2d399', '#a8c8dc',
'#c9dba4', '#e3b1a6' and '#cdbfe0'; shade:
the darkest tone, as a part of the colour, 0 to 1, else 0.45. page: width and height, millimetres,
or 'A3', 'A4', 'A5' or 'letter', also with '-landscape'; margin: what stays free. tolerance: how far
lines may be from the true ones, millimetres. crease_angle: patches that meet at more, else at more
than 5, have a line between, degrees, 0 to 180. kinds: which lines are drawn. hidden: keep those
behind something. stroke: width of lines, millimetres; stroke_color: as in CSS; hidden_stroke,
hidden_color, dash: the same of those that are hidden, else 0.18 and '#808080', and '1.2 0.8',
lengths of line and gap. The camera's words are those of render. Raises UsageError for arguments that
change nothing of this drawing, ResultError if nothing is to be drawn.)");
}

}  // namespace bandvox::python
