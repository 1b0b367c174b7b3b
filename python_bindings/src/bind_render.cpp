// Pictures as arrays.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "grid_object.h"
#include "scene_arguments.h"

#include <bandvox/core/error.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/render/scene_to_image.h>
#include <bandvox/render/turntable.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <memory>
#include <optional>
#include <variant>

namespace bandvox::python {

namespace py = pybind11;

namespace {

py::dict metadataOf(const Image& image) {
    py::dict metadata;
    for (const auto& [name, value] : image.metadata) {
        const auto take = [](const auto& one) -> py::object {
            if constexpr (std::is_same_v<std::decay_t<decltype(one)>, openvdb::math::Mat4d>) {
                return matrixOf(one);
            } else {
                return py::cast(one);
            }
        };
        metadata[py::cast(name)] = std::visit(take, value);
    }
    return metadata;
}

/// The picture as (height, width, 4), what was seen at its pixels, what is said of it, and where in
/// a larger one it is.
py::tuple arraysOf(Image&& image) {
    const py::ssize_t height = image.height, width = image.width;
    py::dict channels;
    channels["depth"] = ownedArray(std::move(image.depth), {height, width});
    channels["normal"] = ownedArray(std::move(image.normal), {height, width, 3});
    channels["position"] = ownedArray(std::move(image.position), {height, width, 3});
    py::object window = py::none();
    if (image.fullWidth > 0) {
        window = py::make_tuple(image.left, image.top, image.fullWidth, image.fullHeight);
    }
    return py::make_tuple(ownedArray(std::move(image.color), {height, width, 4}), channels,
                          metadataOf(image), window);
}

std::vector<float> numbersOf(const py::handle& object, const char* what,
                             std::vector<py::ssize_t> shape) {
    const auto given = numericArray(object, what, "numbers");
    const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given);
    const std::vector<py::ssize_t> found(array.shape(), array.shape() + array.ndim());
    if (found != shape) {
        throw Error(ErrorKind::Usage, std::string(what) + ": found " + described(given) +
                                          "; expected one of the picture's height and width");
    }
    return {array.data(), array.data() + array.size()};
}

void takeMetadata(const py::dict& metadata, Image& image) {
    for (const auto& [key, value] : metadata) {
        const auto name = key.cast<std::string>();
        if (py::isinstance<py::array>(value)) {
            image.metadata.emplace_back(name, mat4Of(value, name.c_str()));
        } else if (py::isinstance<py::str>(value)) {
            image.metadata.emplace_back(name, value.cast<std::string>());
        } else if (py::isinstance<py::int_>(value)) {
            image.metadata.emplace_back(name, value.cast<int>());
        } else {
            image.metadata.emplace_back(name, value.cast<double>());
        }
    }
}

void writePicture(const std::filesystem::path& path, const py::handle& color,
                  const py::object& channels, bool keepsColor, const py::object& metadata,
                  const std::optional<std::array<int, 4>>& window) {
    const std::string expected = "numbers of shape (height, width, 4)";
    const py::array pixels = numericArray(color, "image", expected);
    if (pixels.ndim() != 3 || pixels.shape(2) != 4) {
        throw Error(ErrorKind::Usage,
                    "image: found " + described(pixels) + "; expected " + expected);
    }
    Image image;
    const py::ssize_t height = pixels.shape(0), width = pixels.shape(1);
    image.height = static_cast<int>(height);
    image.width = static_cast<int>(width);
    if (window) {
        image.left = (*window)[0];
        image.top = (*window)[1];
        image.fullWidth = (*window)[2];
        image.fullHeight = (*window)[3];
    }
    image.color = numbersOf(pixels, "image", {height, width, 4});
    ImageChannels kept{keepsColor, false, false, false};
    if (!channels.is_none()) {
        const auto all = channels.cast<py::dict>();
        const auto take = [&](const char* name, std::vector<py::ssize_t> shape,
                              std::vector<float>& to) {
            if (!all.contains(name)) return false;
            to = numbersOf(all[name], name, std::move(shape));
            return true;
        };
        kept.depth = take("depth", {height, width}, image.depth);
        kept.normal = take("normal", {height, width, 3}, image.normal);
        kept.position = take("position", {height, width, 3}, image.position);
    }
    if (!metadata.is_none()) takeMetadata(metadata.cast<py::dict>(), image);
    // What is not kept has its size all the same.
    const auto count = static_cast<std::size_t>(height * width);
    if (!kept.depth) image.depth.resize(count);
    if (!kept.normal) image.normal.resize(3 * count);
    if (!kept.position) image.position.resize(3 * count);
    const py::gil_scoped_release unlocked;
    writeImage(path, image, kept);
}

/// Older shadings are there to compare them with: they draw one matt surface under one lamp.
RenderOptions plainOptions(const Scene& scene, const PictureOptions& picture, Shading shading) {
    const bool isPlain = scene.objects.size() == 1 &&
                         scene.objects[0].kind == SceneObject::Kind::Surface &&
                         scene.lights.size() == 1 && !scene.environment.map;
    if (!isPlain) {
        throw Error(ErrorKind::Usage,
                    "shading is '" + shadingNames()[static_cast<std::size_t>(shading)] +
                        "'; expected 'spectral' for anything but one surface under one lamp");
    }
    RenderOptions options;
    static_cast<PictureOptions&>(options) = picture;
    options.shading = shading;
    options.iso = scene.objects[0].iso;
    options.color = scene.objects[0].material.color;
    options.light = scene.lights[0].place;
    options.ambient = scene.environment.color[0];
    return options;
}

/// Hands pictures that are not yet done to Python. The first exception that it throws stays here.
class PreviewCalls {
  public:
    explicit PreviewCalls(py::object callback) : mCallback(std::move(callback)) {}

    void operator()(const Image& image) {
        const py::gil_scoped_acquire locked;
        try {
            py::array_t<float> pixels({image.height, image.width, 4});
            std::copy(image.color.begin(), image.color.end(), pixels.mutable_data());
            mCallback(pixels);
        } catch (...) {
            mFailure = std::current_exception();
        }
        if (mFailure) throw Error(ErrorKind::Interrupted, "the preview has thrown");
    }

    /// To be called with the lock.
    void rethrow() const {
        if (mFailure) std::rethrow_exception(mFailure);
    }

  private:
    py::object mCallback;
    std::exception_ptr mFailure;
};

py::tuple draw(const py::dict& arguments, const py::dict& picture, int threads,
               const py::object& progress) {
    const Scene scene = sceneOf(arguments);
    PictureOptions options = pictureOptionsOf(picture);
    const auto shading = static_cast<Shading>(
        choiceOf(picture["shading"].cast<std::string>(), shadingNames(), "shading"));
    PreviewCalls calls(picture["preview"]);
    if (!picture["preview"].is_none()) {
        options.preview = [&calls](const Image& image) { calls(image); };
    }
    try {
        RenderResult result = inBackground(progress, threads, [&](Progress& watched) {
            if (shading == Shading::Spectral) return sceneToImage(scene, options, watched);
            return densityToImage(scene.objects[0].grid, plainOptions(scene, options, shading),
                                  watched);
        });
        return arraysOf(std::move(result.image));
    } catch (const Error&) {
        calls.rethrow();
        throw;
    }
}

py::object vectorOrNone(const std::optional<openvdb::Vec3d>& vector) {
    if (!vector) return py::none();
    return py::make_tuple((*vector)[0], (*vector)[1], (*vector)[2]);
}

/// The keyword arguments of each camera around a scene.
py::list camerasAround(const py::dict& arguments, const py::dict& picture, int pictures,
                       int threads, const py::object& progress) {
    const Scene scene = sceneOf(arguments);
    const PictureOptions options = pictureOptionsOf(picture);
    const std::vector<CameraOptions> cameras = inBackground(
        progress, threads,
        [&](Progress& watched) { return turntable(scene, options, pictures, watched); });
    py::list views;
    for (const CameraOptions& camera : cameras) {
        const bool isParallel = camera.projection == CameraOptions::Projection::Orthographic;
        py::dict view;
        view["camera"] = isParallel ? "orthographic" : "perspective";
        view["eye"] = vectorOrNone(camera.eye);
        view["lookat"] = vectorOrNone(camera.lookat);
        view["up"] = vectorOrNone(camera.up);
        view["from_"] = vectorOrNone(camera.from);
        view["focal"] = camera.focal;
        view["aperture"] = camera.aperture;
        view["frame"] = camera.frame;
        views.append(view);
    }
    return views;
}

}  // namespace

void bindRender(py::module_& module) {
    module.def("_render", &draw, py::arg("scene"), py::arg("picture"), py::arg("threads"),
               py::arg("progress"));
    module.def("_turntable", &camerasAround, py::arg("scene"), py::arg("picture"),
               py::arg("pictures"), py::arg("threads"), py::arg("progress"));
    module.def(
        "write_image", &writePicture, py::arg("path"), py::arg("image"),
        py::arg("channels") = py::none(), py::kw_only(), py::arg("color") = true,
        py::arg("metadata") = py::none(), py::arg("window") = py::none(),
        R"(Writes a picture, (height, width, 4) linear R G B A, to a .png (sRGB) or an .exr file.

channels: of an .exr, a dictionary with 'depth' (height, width), 'normal' and 'position' (height,
width, 3); color: False leaves the picture itself away. metadata: what the file says of itself,
text, numbers and matrices by their names. window: left, top, width and height, of a larger picture
of which this is a part, pixels.)");
}

}  // namespace bandvox::python
