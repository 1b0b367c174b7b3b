#include "render_scene.h"

#include "choose_grid.h"
#include "frame_pattern.h"
#include "render_settings.h"
#include "scene_file.h"
#include "standard_streams.h"
#include "vdb_input.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/render/density_to_image.h>

#include <nlohmann/json.hpp>

#include <map>
#include <utility>

namespace bandvox::app {
namespace {

const Range kPart{.low = 0, .high = 1};
const Range kLength{.low = 0, .high = 1e30};
const std::vector<std::string> kModes{"surface", "volume"};

// Settings of an object, on the command line for each of several between slashes.
const std::vector<std::string> kObjectNames{
    "grid",        "mode",         "iso",        "color",       "colors",     "roughness",
    "reflectance", "transparency", "refraction", "tint-length", "extinction", "anisotropy",
    "emission",    "temperature",  "glow",       "scale",       "rotate",     "translate"};

// Those of them that are names, which may hold a slash themselves.
bool isGridName(const std::string& option) {
    return option == "grid" || option == "colors" || option == "temperature";
}

// Options that say what a scene file says of lights.
const std::vector<std::string> kLightNames{
    "light",   "light-at",    "light-color",      "light-size",
    "ambient", "environment", "environment-turn", "environment-visible"};

const std::vector<std::string> kEnvironmentNames{"color", "file", "turn", "visible"};

ObjectRequest readObject(const OptionValues& values, const std::string& file) {
    ObjectRequest request;
    request.file = file;
    request.grid = values.text("grid");
    request.colors = values.text("colors");
    request.temperatures = values.text("temperature");
    Placement& placement = request.placement;
    placement.scale = values.number("scale", {.low = 0, .high = 1e30, .lowOpen = true}, 1);
    placement.rotate = values.vector("rotate", kAnyPlace).value_or(placement.rotate);
    placement.translate = values.vector("translate", kAnyPlace).value_or(placement.translate);
    SceneObject& object = request.object;
    object.kind = static_cast<SceneObject::Kind>(values.choice("mode", kModes, 0));
    if (values.has("iso")) object.iso = values.number("iso", {}, 0);
    const bool isVolume = object.kind == SceneObject::Kind::Volume;
    Material& material = object.material;
    Medium& medium = object.medium;
    if (isVolume) {
        medium.color = values.vector("color", kPart).value_or(medium.color);
    } else {
        material.color = values.vector("color", kAnyColor).value_or(material.color);
    }
    material.roughness = values.number("roughness", kPart, material.roughness);
    material.reflectance = values.number("reflectance", kPart, material.reflectance);
    material.transparency = values.number("transparency", kPart, material.transparency);
    material.refractiveIndex =
        values.number("refraction", {.low = 1, .high = 4}, material.refractiveIndex);
    material.tintLength = values.number("tint-length", kLength, material.tintLength);
    medium.extinction =
        values.number("extinction", {.low = 0, .high = 1e30, .lowOpen = true}, medium.extinction);
    medium.anisotropy =
        values.number("anisotropy", {.low = -0.999, .high = 0.999}, medium.anisotropy);
    medium.emission = values.vector("emission", kAnyColor).value_or(medium.emission);
    medium.glow = values.number("glow", kLength, medium.glow);
    return request;
}

// The values between slashes, one for each of `count` inputs. In names of grids a slash or a
// backslash after a backslash is a part of the name; for a single input all of the text is.
std::vector<std::string> splitValues(const std::string& name, const std::string& text,
                                     std::size_t count) {
    std::vector<std::string> parts;
    if (isGridName(name) && count == 1) return {text};
    if (!isGridName(name)) {
        for (const std::string_view part : split(text, '/')) parts.emplace_back(part);
        return parts;
    }
    parts.emplace_back();
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool isEscape =
            text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '/' || text[i + 1] == '\\');
        if (text[i] == '/') {
            parts.emplace_back();
        } else {
            parts.back() += text[isEscape ? ++i : i];
        }
    }
    return parts;
}

// The settings of object i of `count`, of which the options give one for all or one for each.
OptionValues partOf(const CommandLine& line, std::size_t i, std::size_t count) {
    OptionValues part(line.title());
    for (const std::string& name : kObjectNames) {
        const auto given = line.text(name);
        if (!given) continue;
        const std::vector<std::string> parts = splitValues(name, *given, count);
        if (parts.size() != 1 && parts.size() != count) {
            line.fail(name,
                      "one value, or one for each of the " +
                          formatCount(static_cast<std::int64_t>(count), "input", "inputs") +
                          " with slashes between them" +
                          (isGridName(name) ? ", and a backslash before a slash in a name" : ""));
        }
        part.set(name, parts[parts.size() == 1 ? 0 : i]);
    }
    return part;
}

std::shared_ptr<const EnvironmentMap> readMap(const OptionValues& values, const char* file,
                                              const char* turn) {
    const auto path = values.text(file);
    if (!path) return nullptr;
    return readEnvironmentMap(*path, values.number(turn, {.low = -360, .high = 360}, 0));
}

// The lamp and the light from around that options give.
void readLights(const CommandLine& line, SceneRequest& request) {
    const RenderOptions standard;
    Environment& environment = request.environment;
    environment.map = readMap(line, "environment", "environment-turn");
    environment.visible = line.has("environment-visible");
    const double ambient = line.number("ambient", kPart, environment.map ? 1.0 : standard.ambient);
    environment.color = openvdb::Vec3d(ambient);

    // An environment has lamps of its own.
    const bool isAskedFor = line.has("light") || line.has("light-at") || line.has("light-color");
    if (environment.map && !isAskedFor) return;
    Light light;
    light.place = line.vector("light", kAnyPlace).value_or(standard.light);
    const auto place = line.vector("light-at", kAnyPlace);
    const bool hasBoth = place && line.has("light");
    if (hasBoth && line.isAsked("light") == line.isAsked("light-at")) {
        line.fail("light-at", "either this or --light, which is given too");
    }
    if (place && !(hasBoth && line.isAsked("light"))) {
        light = {Light::Kind::Point, *place, false};
    }
    const double rest = environment.map ? 1 : 1 - ambient;
    light.color = line.vector("light-color", kAnyColor).value_or(openvdb::Vec3d(rest));
    light.size = line.number("light-size", kLength, 0);
    request.lights = {light};
}

Light readLight(const OptionValues& values) {
    Light light;
    const auto direction = values.vector("direction", kAnyPlace);
    const auto position = values.vector("position", kAnyPlace);
    if (direction.has_value() == position.has_value()) {
        throw Error(ErrorKind::Input,
                    values.title() + ": expected either a direction or a position");
    }
    light.kind = position ? Light::Kind::Point : Light::Kind::Directional;
    light.place = position ? *position : *direction;
    light.followsCamera = values.choice("space", {"world", "camera"}, 0) == 1;
    light.color = values.vector("color", kAnyColor).value_or(light.color);
    light.size = values.number("size", kLength, light.size);
    return light;
}

void readSceneFile(const CommandLine& line, const std::string& path,
                   const std::vector<std::string>& pictureNames, SceneRequest& request) {
    const SceneFile file(path);
    request.file = file.path();
    for (const auto& names : {kObjectNames, kLightNames}) {
        for (const std::string& name : names) {
            if (!line.has(name)) continue;
            throw Error(ErrorKind::Usage, "option --" + name +
                                              " has no place beside a scene file, which says what "
                                              "is seen and what lights it");
        }
    }
    std::vector<std::string> names = kObjectNames;
    names.emplace_back("file");
    for (const OptionValues& values : file.list("objects", names)) {
        const auto grids = values.text("file");
        if (!grids) throw Error(ErrorKind::Input, values.title() + "file is missing");
        request.objects.push_back(readObject(values, file.beside(*grids)));
        request.objects.back().place = values.title().substr(0, values.title().size() - 1);
    }
    if (request.objects.empty()) {
        throw Error(ErrorKind::Input, "'" + path + "' has no objects; expected a list of them");
    }
    readLights(line, request);
    // An environment has lamps of its own.
    const bool hasMap =
        file.has("environment") && file.group("environment", kEnvironmentNames).has("file");
    if (file.has("lights") || hasMap) {
        request.lights.clear();
        for (const OptionValues& values :
             file.list("lights", {"direction", "position", "space", "color", "size"})) {
            request.lights.push_back(readLight(values));
            try {
                requireValid(request.lights.back());
            } catch (const Error& error) {
                throw Error(ErrorKind::Input, values.title() + error.what());
            }
        }
    }
    if (file.has("environment")) {
        OptionValues values = file.group("environment", kEnvironmentNames);
        if (const auto map = values.text("file")) values.set("file", file.beside(*map));
        Environment& environment = request.environment;
        environment.map = readMap(values, "file", "turn");
        environment.visible = values.has("visible");
        environment.color =
            values.vector("color", kAnyColor).value_or(openvdb::Vec3d(environment.map ? 1.0 : 0.1));
    }
    // What the command line says comes after what the file says.
    for (const char* group : {"picture", "camera"}) {
        if (!file.has(group)) continue;
        OptionValues values = file.group(group, pictureNames);
        if (const auto camera = values.text("camera-file")) {
            values.set("camera-file", file.beside(*camera));
        }
        readPictureOptions(values);  // refuses what cannot be, by the file's name
        for (const auto& [name, value] : values.all()) {
            if (request.picture.has(name)) continue;
            request.picture.set(name, value, file.path());
            request.places[name] = std::string(group) + "." + name;
        }
    }
}

// What a file of a scene holds, read once.
using OpenFiles = std::map<std::string, openvdb::GridPtrVec>;

void loadGrids(CommandRun& run, const ObjectRequest& request, const std::string& file,
               OpenFiles& files, SceneObject& object) {
    if (!files.contains(file)) {
        requireVdb("render", file);
        const ProgressStage stage(run.progress(), "read", 0);
        files[file] = readGrids(file);
    }
    const openvdb::GridPtrVec& grids = files[file];
    const bool isVolume = object.kind == SceneObject::Kind::Volume;
    object.grid = chooseFloatGrid(grids, request.grid, "density", file);
    if (request.colors != "none") {
        object.colors = chooseColorGrid(grids, request.colors, file);
    }
    if (isVolume && request.temperatures != "none") {
        object.temperatures = findFloatGrid(grids, request.temperatures, "temperature", file);
    }
    object.name = "'" + file + "'";
    if (!request.place.empty()) object.name = request.place + " (" + object.name + ")";
    try {
        place(object, request.placement);
    } catch (const Error& error) {
        throw Error(request.place.empty() ? error.kind() : ErrorKind::Input,
                    object.name + ": " + error.what());
    }
    run.say("read     " + file + ": grid '" + object.grid->getName() + "', " +
            formatCount(static_cast<std::int64_t>(object.grid->activeVoxelCount()), "active voxel",
                        "active voxels") +
            (object.colors ? ", coloured by '" + object.colors->getName() + "'" : "") +
            (object.temperatures ? ", heated by '" + object.temperatures->getName() + "'" : ""));
}

}  // namespace

SceneRequest readScene(const CommandLine& line, const std::vector<std::string>& pictureNames) {
    SceneRequest request;
    for (const auto& [name, value] : line.all()) {
        request.picture.set(name, value, line.origin(name));
    }
    const std::vector<std::string>& inputs = line.positionals();
    if (inputs.size() == 1 && extensionOf(inputs[0]) == ".json") {
        readSceneFile(line, inputs[0], pictureNames, request);
        return request;
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (extensionOf(inputs[i]) == ".json") {
            throw Error(ErrorKind::Usage, "'" + inputs[i] +
                                              "' is a scene file, and stands beside other inputs; "
                                              "expected it to be the only one");
        }
        request.objects.push_back(readObject(partOf(line, i, inputs.size()), inputs[i]));
    }
    readLights(line, request);
    return request;
}

Scene loadScene(CommandRun& run, const SceneRequest& request, int frame) {
    Scene scene;
    scene.lights = request.lights;
    scene.environment = request.environment;
    OpenFiles files;
    for (const ObjectRequest& wanted : request.objects) {
        SceneObject object = wanted.object;
        loadGrids(run, wanted, withFrame(wanted.file, frame), files, object);
        scene.objects.push_back(std::move(object));
    }
    return scene;
}

std::vector<OptionEntry> sceneEntries() {
    const RenderOptions standard;
    const Material material;
    const Medium medium;
    const auto vector = [](const openvdb::Vec3d& v) {
        return formatNumber(v.x()) + "," + formatNumber(v.y()) + "," + formatNumber(v.z());
    };
    const std::string object =
        "Objects (of several inputs: one value, or one for each, as in a/b/c)";
    const std::string light = "Light";
    return {
        {"grid", 0, "NAME", "density, or the only one of floats",
         "Which grid to draw; NAME[1] is the second one of that name. Of several inputs a slash or "
         "a backslash in a name has a backslash before it.",
         object},
        {"mode",
         0,
         "KIND",
         "surface",
         "surface, or volume: fog, clouds and fire.",
         object,
         {.words = kModes}},
        {"iso", 0, "D", "as stored, else 0.5",
         "Density that is the surface; of a level set the distance, by default 0.", object},
        {"color", 0, "R,G,B", vector(standard.color) + ", volumes " + vector(medium.color),
         "Linear colour of a surface's matt ground or of its glass; of a volume, what it scatters.",
         object},
        {"colors", 0, "NAME", "Cd, if there is one",
         "Grid of colours to use instead, where it is active; none for none.", object},
        {"reflectance", 0, "F", formatNumber(material.reflectance),
         "What a coat over the matt ground reflects, seen straight on, 0 to 1.", object},
        {"roughness", 0, "A", formatNumber(material.roughness),
         "Of the coat or the glass, 0 to 1; 0 is a mirror.", object},
        {"transparency", 0, "T", formatNumber(material.transparency),
         "Part of the surface that is glass, 0 to 1.", object},
        {"refraction", 0, "N", formatNumber(material.refractiveIndex),
         "Refractive index of the glass, 1 to 4.", object},
        {"tint-length", 0, "D", "clear",
         "World units of glass after which light has taken on the colour.", object},
        {"extinction", 0, "S", "10 over the longest side",
         "Part of light that a volume of density 1 stops per world unit.", object},
        {"anisotropy", 0, "G", formatNumber(medium.anisotropy),
         "Whether a volume scatters light back, -1, or onward, 1 (Henyey-Greenstein).", object},
        {"emission", 0, "R,G,B", vector(medium.emission),
         "Linear colour in which a volume shines where nothing passes it.", object},
        {"temperature", 0, "NAME", "temperature, if there is one",
         "Grid of temperatures, kelvin, at which a volume glows; none for none.", object},
        {"glow", 0, "S", formatNumber(medium.glow), "How bright it does at 2000 K.", object},
        {"scale", 0, "S", "1", "Makes the object larger, about the world's origin.", object},
        {"rotate", 0, "X,Y,Z", "0,0,0", "Then turns it about x, y and z, degrees.", object},
        {"translate", 0, "X,Y,Z", "0,0,0", "Then moves it, world units.", object},
        {"light", 0, "X,Y,Z", vector(standard.light),
         "Direction to the lamp, along the camera's right, up and back.", light},
        {"light-at", 0, "X,Y,Z", "", "Place of a lamp, world, instead.", light},
        {"light-color", 0, "R,G,B", "what --ambient leaves of white",
         "What a white matt surface that faces the lamp looks like; of a lamp with a place, one "
         "world unit from it.",
         light},
        {"light-size", 0, "S", "0",
         "Degrees that the lamp is across, or the radius of one with a place, world units; the "
         "larger, the softer the shadows.",
         light},
        {"ambient", 0, "A", formatNumber(standard.ambient) + ", with --environment 1",
         "Light from around, 0 to 1.", light},
        {"environment",
         0,
         "FILE",
         "",
         "Image of all that is around, latitude and longitude, for the light from around; then "
         "there is no lamp unless one is asked for.",
         light,
         {.endings = {".exr", ".hdr", ".png", ".jpg"}}},
        {"environment-turn", 0, "DEG", "0", "Turn it about y.", light},
        {"environment-visible", 0, "", "", "Show it behind the objects.", light},
    };
}

}  // namespace bandvox::app
