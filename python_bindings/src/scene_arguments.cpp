#include "scene_arguments.h"

#include "arrays.h"
#include "camera_arguments.h"
#include "choices.h"
#include "grid_object.h"
#include "paths.h"
#include "settings.h"

#include <bandvox/render/placement.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <limits>
#include <vector>

namespace bandvox::python {

namespace py = pybind11;

namespace {

SceneObject objectOfScene(const Settings& settings) {
    SceneObject object;
    object.kind = static_cast<SceneObject::Kind>(
        choiceOf(settings.word("mode"), {"surface", "volume"}, "mode"));
    object.grid = floatGridOf(settings.at("grid"));
    if (settings.isGiven("iso")) object.iso = settings.number("iso");
    if (settings.isGiven("colors")) {
        const py::object colors = settings.at("colors");
        if (!py::isinstance<VectorGridObject>(colors)) {
            throw Error(ErrorKind::Usage, std::string("colors: found a ") +
                                              Py_TYPE(colors.ptr())->tp_name +
                                              "; expected a bandvox.VectorGrid");
        }
        object.colors = colors.cast<VectorGridObject&>().grid;
    }
    if (settings.isGiven("temperature")) {
        object.temperatures = floatGridOf(settings.at("temperature"));
    }
    Material& material = object.material;
    Medium& medium = object.medium;
    const bool isVolume = object.kind == SceneObject::Kind::Volume;
    openvdb::Vec3d& color = isVolume ? medium.color : material.color;
    color = settings.optionalVector("color").value_or(color);
    material.roughness = settings.number("roughness");
    material.reflectance = settings.number("reflectance");
    material.transparency = settings.number("transparency");
    material.refractiveIndex = settings.number("refraction");
    material.tintLength = settings.number("tint_length");
    medium.extinction = settings.number("extinction");
    medium.anisotropy = settings.number("anisotropy");
    medium.emission = settings.vector("emission");
    medium.glow = settings.number("glow");
    place(object,
          {settings.number("scale"), settings.vector("rotate"), settings.vector("translate")});
    return object;
}

Light lightOf(const Settings& settings) {
    const auto direction = settings.optionalVector("direction");
    const auto position = settings.optionalVector("position");
    if (direction.has_value() == position.has_value()) {
        throw Error(ErrorKind::Usage,
                    "a light has a direction or a position; expected one of them");
    }
    Light light;
    light.kind = position ? Light::Kind::Point : Light::Kind::Directional;
    light.place = position ? *position : *direction;
    light.followsCamera = choiceOf(settings.word("space"), {"world", "camera"}, "space") == 1;
    light.color = settings.vector("color");
    light.size = settings.number("size");
    requireValid(light);
    return light;
}

Environment environmentOf(const Settings& settings) {
    Environment environment;
    if (settings.isGiven("file")) {
        const auto file = pathOf(settings.at("file"));
        const double turn = settings.number("turn");
        const py::gil_scoped_release unlocked;
        environment.map = readEnvironmentMap(file, turn);
    }
    environment.visible = settings.flag("visible");
    environment.color = settings.vector("color");
    return environment;
}

/// What `read` makes of each of a list of dictionaries.
template <typename Read>
auto listOf(const py::dict& arguments, const char* name, const Read& read) {
    std::vector<decltype(read(Settings(arguments)))> all;
    for (const py::handle one : arguments[name])
        all.push_back(read(Settings(one.cast<py::dict>())));
    return all;
}

TransportOptions transportOf(const Settings& settings) {
    TransportOptions transport;
    transport.shadows = settings.flag("shadows");
    transport.gather = settings.wholeNumber("gather");
    transport.gatherDistance = settings.number("gather_distance");
    transport.bounces = settings.wholeNumber("bounces");
    transport.depth = settings.wholeNumber("depth");
    return transport;
}

std::optional<double> numberIfGiven(const Settings& settings, const char* name) {
    if (!settings.isGiven(name)) return std::nullopt;
    return settings.number(name);
}

}  // namespace

Scene sceneOf(const py::dict& arguments) {
    Scene scene;
    scene.objects = listOf(arguments, "objects", objectOfScene);
    scene.lights = listOf(arguments, "lights", lightOf);
    scene.environment = environmentOf(Settings(arguments["environment"].cast<py::dict>()));
    requireValid(scene);
    return scene;
}

PictureOptions pictureOptionsOf(const py::dict& arguments) {
    const Settings settings(arguments);
    PictureOptions options;
    options.width = settings.wholeNumber("width");
    options.height = settings.wholeNumber("height");
    options.samples = settings.wholeNumber("samples");
    options.filter =
        static_cast<PixelFilter>(choiceOf(settings.word("filter"), pixelFilterNames(), "filter"));
    if (settings.isGiven("crop")) {
        try {
            const auto crop = settings.at("crop").cast<std::array<int, 4>>();
            options.crop = CropWindow{crop[0], crop[1], crop[2], crop[3]};
        } catch (const py::cast_error&) {
            throw Error(ErrorKind::Usage,
                        "crop: expected four whole numbers, left, top, right, bottom");
        }
    }
    const int seed = settings.wholeNumber("seed");
    if (seed < 0) {
        throw Error(ErrorKind::Usage, "seed is " + std::to_string(seed) + "; expected 0 or more");
    }
    options.seed = static_cast<std::uint32_t>(seed);
    options.background = settings.optionalVector("background");
    options.allowEmpty = settings.flag("allow_empty");
    options.tolerance = settings.number("read_error");
    const int megabytes = settings.wholeNumber("cache_size");
    if (megabytes < 0) {
        throw Error(ErrorKind::Usage,
                    "cache_size is " + std::to_string(megabytes) + "; expected MB, 0 or more");
    }
    options.cacheBytes = static_cast<std::size_t>(megabytes) * 1000000;
    options.transport = transportOf(settings);
    options.volumes.method = static_cast<VolumeOptions::Method>(
        choiceOf(settings.word("volume_method"), {"steps", "tracking"}, "volume_method"));
    options.volumes.step = settings.number("step");
    if (options.width < 1 || options.height < 1) requireValid(options);
    options.camera =
        cameraOf({settings.at("eye"), settings.at("lookat"), settings.at("up"),
                  settings.at("from_"), settings.at("camera"), settings.at("camera_file"),
                  numberIfGiven(settings, "focal"), numberIfGiven(settings, "aperture"),
                  numberIfGiven(settings, "fov"), numberIfGiven(settings, "frame")},
                 double(options.height) / options.width);
    requireValid(options);
    return options;
}

}  // namespace bandvox::python
