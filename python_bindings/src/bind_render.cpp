// Pictures as arrays.

#include "arrays.h"
#include "background.h"
#include "camera_arguments.h"
#include "choices.h"
#include "grid_object.h"

#include <bandvox/render/density_to_image.h>
#include <bandvox/render/scene_to_image.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

/// The picture as (height, width, 4), and what was seen at its pixels.
py::tuple arraysOf(Image&& image) {
    const py::ssize_t height = image.height, width = image.width;
    py::dict channels;
    channels["depth"] = ownedArray(std::move(image.depth), {height, width});
    channels["normal"] = ownedArray(std::move(image.normal), {height, width, 3});
    channels["position"] = ownedArray(std::move(image.position), {height, width, 3});
    return py::make_tuple(ownedArray(std::move(image.color), {height, width, 4}), channels);
}

std::vector<float> numbersOf(const py::handle& object, const char* what, py::ssize_t height,
                             py::ssize_t width, py::ssize_t depth) {
    const auto array =
        py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(object);
    if (!array) throw py::error_already_set();
    const bool fits = depth == 1
                          ? array.ndim() == 2 && array.shape(0) == height && array.shape(1) == width
                          : array.ndim() == 3 && array.shape(0) == height &&
                                array.shape(1) == width && array.shape(2) == depth;
    if (!fits) {
        throw Error(ErrorKind::Usage, std::string(what) + ": found " + described(array) +
                                          "; expected one of the picture's height and width");
    }
    return {array.data(), array.data() + array.size()};
}

void writePicture(const std::filesystem::path& path, const py::array& color,
                  const py::object& channels) {
    if (color.ndim() != 3 || color.shape(2) != 4) {
        throw Error(ErrorKind::Usage, "image: found " + described(color) +
                                          "; expected one of shape (height, width, 4)");
    }
    Image image;
    const py::ssize_t height = color.shape(0), width = color.shape(1);
    image.height = static_cast<int>(height);
    image.width = static_cast<int>(width);
    image.color = numbersOf(color, "image", height, width, 4);
    ImageChannels kept{true, false, false, false};
    if (!channels.is_none()) {
        const auto all = channels.cast<py::dict>();
        const auto take = [&](const char* name, py::ssize_t depth, std::vector<float>& to) {
            if (!all.contains(name)) return false;
            to = numbersOf(all[name], name, height, width, depth);
            return true;
        };
        kept.depth = take("depth", 1, image.depth);
        kept.normal = take("normal", 3, image.normal);
        kept.position = take("position", 3, image.position);
    }
    // What is not kept has its size all the same.
    const auto pixels = static_cast<std::size_t>(height * width);
    if (!kept.depth) image.depth.resize(pixels);
    if (!kept.normal) image.normal.resize(3 * pixels);
    if (!kept.position) image.position.resize(3 * pixels);
    const py::gil_scoped_release unlocked;
    writeImage(path, image, kept);
}

}  // namespace

void bindRender(py::module_& module) {
    module.def(
        "_render",
        [](const py::object& grid, int width, int height, int samples, const py::object& eye,
           const py::object& lookat, const py::object& up, const py::object& from,
           const std::string& camera, double focal, double aperture, double frame,
           const std::optional<double>& iso, const std::string& shading, const py::object& light,
           const py::object& color, double ambient, const py::object& background, bool shadows,
           bool allowEmpty, double tolerance, unsigned seed, int threads,
           const py::object& progress) {
            RenderOptions options;
            options.width = width;
            options.height = height;
            options.samples = samples;
            options.camera = cameraOf({eye, lookat, up, from, camera, focal, aperture, frame});
            options.iso = iso;
            options.shading = static_cast<Shading>(choiceOf(shading, shadingNames(), "shading"));
            options.light = vectorOf(light, "light");
            options.color = vectorOf(color, "color");
            options.ambient = ambient;
            options.background = optionalVectorOf(background, "background");
            options.transport.shadows = shadows;
            options.allowEmpty = allowEmpty;
            options.tolerance = tolerance;
            options.seed = seed;
            const openvdb::FloatGrid::ConstPtr density = floatGridOf(grid);
            RenderResult result = inBackground(progress, threads, [&](Progress& watched) {
                return densityToImage(density, options, watched);
            });
            return arraysOf(std::move(result.image));
        },
        py::arg("grid"), py::arg("width"), py::arg("height"), py::arg("samples"), py::arg("eye"),
        py::arg("lookat"), py::arg("up"), py::arg("from_"), py::arg("camera"), py::arg("focal"),
        py::arg("aperture"), py::arg("frame"), py::arg("iso"), py::arg("shading"), py::arg("light"),
        py::arg("color"), py::arg("ambient"), py::arg("background"), py::arg("shadows"),
        py::arg("allow_empty"), py::arg("tolerance"), py::arg("seed"), py::arg("threads"),
        py::arg("progress"));
    module.def(
        "write_image", &writePicture, py::arg("path"), py::arg("image"),
        py::arg("channels") = py::none(),
        R"(Writes a picture, (height, width, 4) linear R G B A, to a .png (sRGB) or an .exr file.

channels: of an .exr, a dictionary with 'depth' (height, width), 'normal' and 'position' (height,
width, 3).)");
}

}  // namespace bandvox::python
