#include "convert_settings.h"

#include "command_run.h"
#include "convert_grid_solid.h"
#include "convert_points.h"
#include "convert_stamp.h"
#include "convert_to_mesh.h"
#include "mesh_output.h"
#include "stack_input.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/core/sha256.h>
#include <bandvox/core/version.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/resample/resample_grid.h>
#include <bandvox/source/shapes.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

namespace bandvox::app {
namespace {

const std::string kDefaultMark = " # default";
const std::string kLattice = "lattice:";

// Options of convert that do not change what is in the file. What all commands take does not
// either.
constexpr std::array kWithoutEffect{"output",        "frames", "keep-going",
                                    "skip-existing", "like",   "memory-limit"};

struct Setting {
    std::string value;
    bool isDefault = false;
};
using Settings = std::map<std::string, Setting>;

std::string shortest(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

const char* nameOf(Conversion conversion) {
    constexpr std::array kNames{"solid to volume",           "solid to mesh",
                                "volume to volume",          "volume to mesh",
                                "solid of volume to volume", "solid of volume to mesh",
                                "points to volume",          "points to mesh"};
    return kNames[static_cast<std::size_t>(conversion)];
}

bool makesVolume(Conversion conversion) {
    return conversion == Conversion::SolidToVolume || conversion == Conversion::VolumeToVolume ||
           conversion == Conversion::GridSolidToVolume || conversion == Conversion::PointsToVolume;
}

// The default of --oversample on the route that a solid takes; empty on one without samples.
std::string samplesOfRoute(const CommandLine& line) {
    const std::string route = line.textOrDefault("route").value_or("auto");
    if (route == "sampled") return std::to_string(FieldDensityOptions().oversample);
    const bool mayWind = route == "auto" || route == "winding";
    if (isShape(line.positional(0)) || !mayWind) return {};
    return std::to_string(SoupDensityOptions().rowsPerVoxel);
}

using Add = std::function<void(const std::string& name, const std::string& value)>;

void addSolidDefaults(const CommandLine& line, const Add& add) {
    const DensityOptions density;
    add("resolution", std::to_string(density.resolution));
    add("voxel-size", "");
    add("route", "auto");
    add("oversample", samplesOfRoute(line));
    add("overlap", "union");
    add("iso", shortest(density.iso));
    add("color", "false");
}

// Of the lattice that a volume is brought to, and of what is taken of it.
void addLatticeDefaults(const CommandLine& line, const Add& add) {
    for (const char* name :
         {"resolution", "voxel-size", "factor", "onto", "grid", "iso", "space"}) {
        add(name, "");
    }
    if (!isStackInput(line.positional(0))) return;
    add("background", "0");
    for (const char* name : {"channel", "series", "spacing", "origin"}) add(name, "");
}

// Of a solid, whatever it comes from, that becomes a density.
void addDensityDefaults(const CommandLine& line, const Add& add) {
    const DensityOptions density;
    add("cutoff", shortest(density.filter.cutoff));
    add("order", shortest(density.filter.order));
    add("tolerance", shortest(density.tolerance));
    add("tile", std::to_string(density.tile));
    add("clamp", "false");
    add("as", "density");
    const std::string as = line.textOrDefault("as").value_or("density");
    add("band", as == "density" ? "" : shortest(LevelSetOptions().halfWidth));
}

void addPointDefaults(const CommandLine& line, const Add& add) {
    const DensityOptions density;
    add("resolution", std::to_string(density.resolution));
    add("voxel-size", "");
    add("iso", shortest(density.iso));
    add("points", "auto");
    add("radius", "");
    addDensityDefaults(line, add);
}

void addResampleDefaults(const CommandLine& line, const Add& add) {
    const ResampleOptions resample;
    add("no-filter", "false");
    if (!line.has("no-filter")) {
        add("cutoff", shortest(resample.filter->cutoff));
        add("order", shortest(resample.filter->order));
    }
    add("tolerance", shortest(resample.tolerance));
}

// What holds where nothing is said, of the options that mean anything to a conversion. An empty
// value: that nothing is said means something of its own.
Settings defaultsOf(const CommandLine& line, Conversion conversion) {
    Settings defaults;
    const Add add = [&](const std::string& name, const std::string& value) {
        defaults[name] = {value, true};
    };
    switch (conversion) {
        case Conversion::SolidToVolume:
        case Conversion::SolidToMesh:
            addSolidDefaults(line, add);
            addDensityDefaults(line, add);
            break;
        case Conversion::GridSolidToVolume:
        case Conversion::GridSolidToMesh:
            addLatticeDefaults(line, add);
            add("threshold", "");
            addDensityDefaults(line, add);
            break;
        case Conversion::PointsToVolume:
        case Conversion::PointsToMesh:
            addPointDefaults(line, add);
            break;
        case Conversion::VolumeToVolume:
            addLatticeDefaults(line, add);
            addResampleDefaults(line, add);
            break;
        case Conversion::VolumeToMesh:
            for (const char* name : {"grid", "iso", "space"}) add(name, "");
            add("color", "false");
            break;
    }
    if (makesVolume(conversion)) {
        add("half", "false");
        add("compression", "blosc");
        add("lod", "0");
    } else {
        add("adaptivity", shortest(MeshOptions().adaptivity));
    }
    return defaults;
}

// A number as it is written shortest, so that 0.10 and 1e-1 are the same; anything else as it is.
std::string canonical(const OptionEntry& option, const std::string& text) {
    for (const char* word : {"NAME", "FILE", "KIND"}) {
        if (option.argument == word) return printable(text);
    }
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && at == end ? shortest(number) : printable(text);
}

// The digest of where the voxels of a file's first grid lie.
std::string latticeOf(const openvdb::GridPtrVec& grids, const std::string& name) {
    if (grids.empty()) throw Error(ErrorKind::Input, "'" + name + "' has no grids, so no lattice");
    std::ostringstream text(std::ios::binary);
    grids.front()->transform().write(text);
    constexpr std::size_t kDigits = 16;
    return kLattice + sha256(text.str()).substr(0, kDigits);
}

Settings settingsFor(const CommandLine& line, Conversion conversion) {
    const Settings defaults = defaultsOf(line, conversion);
    Settings settings;
    for (const OptionEntry& option : line.table().options) {
        const std::string& name = option.name;
        if (std::find(kWithoutEffect.begin(), kWithoutEffect.end(), name) != kWithoutEffect.end()) {
            continue;
        }
        const auto standard = defaults.find(name);
        if (option.argument.empty()) {
            if (line.has(name) || standard != defaults.end()) {
                settings[name] = {line.has(name) ? "true" : "false", false};
            }
        } else if (line.has(name)) {
            const std::string value = *line.text(name);
            settings[name] = {
                name == "onto" ? latticeOf(readGrids(value), value) : canonical(option, value),
                false};
        } else if (standard != defaults.end() && !line.decides(name)) {
            const std::string value = line.textOrDefault(name).value_or(standard->second.value);
            if (!value.empty()) settings[name] = {canonical(option, value), true};
        }
    }
    return settings;
}

std::string headOf(Conversion conversion) {
    std::string head = "# ";
    head += nameOf(conversion);
    head += " by bandvox ";
    return head + version();
}

Settings parseSettings(const std::string& text, std::string& head) {
    Settings settings;
    std::istringstream lines(text);
    std::getline(lines, head);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) continue;
        Setting setting{line.substr(equals + 1), false};
        if (setting.value.ends_with(kDefaultMark)) {
            setting.value.resize(setting.value.size() - kDefaultMark.size());
            setting.isDefault = true;
        }
        settings[line.substr(0, equals)] = setting;
    }
    return settings;
}

std::string shownValue(const Settings& settings, const std::string& name) {
    const auto found = settings.find(name);
    return found == settings.end() ? "not given" : found->second.value;
}

// The lattice of the file that was told by its digest is that of the file itself.
std::string likedLattice(const openvdb::GridPtrVec& grids, const std::string& file,
                         const Setting& setting) {
    if (latticeOf(grids, file) == setting.value) return file;
    throw Error(ErrorKind::Input, "the first grid of '" + file +
                                      "' does not have the lattice that its settings tell of; "
                                      "expected --onto to say which");
}

}  // namespace

Conversion conversionOf(const CommandLine& line) {
    const std::string& input = line.positional(0);
    const bool toMesh = isWritableMesh(line.text("output").value_or(""));
    if (takesSolidOfGrid(line)) {
        return toMesh ? Conversion::GridSolidToMesh : Conversion::GridSolidToVolume;
    }
    if (convertsGridToMesh(line)) return Conversion::VolumeToMesh;
    if (!isShape(input) && (extensionOf(input) == ".vdb" || isStackInput(input))) {
        return Conversion::VolumeToVolume;
    }
    if (takesPoints(line)) {
        return toMesh ? Conversion::PointsToMesh : Conversion::PointsToVolume;
    }
    return toMesh ? Conversion::SolidToMesh : Conversion::SolidToVolume;
}

std::string settingsText(const CommandLine& line) {
    const Conversion conversion = conversionOf(line);
    std::string text = headOf(conversion);
    for (const auto& [name, setting] : settingsFor(line, conversion)) {
        text += '\n';
        text += name;
        text += '=';
        text += setting.value;
        if (setting.isDefault) text += kDefaultMark;
    }
    return text;
}

std::string settingsDifference(const std::string& before, const std::string& now) {
    std::string headBefore, headNow;
    const Settings old = parseSettings(before, headBefore);
    const Settings current = parseSettings(now, headNow);
    if (headBefore != headNow) {
        const auto shown = [](const std::string& head) {
            return head.starts_with("# ") ? printable(head.substr(2)) : "unknown";
        };
        return "it was made as " + shown(headBefore) + ", now it is " + shown(headNow);
    }
    Settings all = old;
    all.insert(current.begin(), current.end());
    for (const auto& [name, setting] : all) {
        const std::string was = shownValue(old, name);
        const std::string is = shownValue(current, name);
        if (was == is) continue;
        std::string words = name;
        words += " was ";
        words += was;
        words += ", is ";
        words += is;
        return printable(words);
    }
    return {};
}

CommandLine withLikedSettings(const CommandLine& line) {
    const auto file = line.text("like");
    if (!file) return line;
    const bool isMesh = isWritableMesh(*file);
    if (isMesh && !std::filesystem::exists(*file)) {
        throw Error(ErrorKind::Input, *file + ": there is no such file");
    }
    const openvdb::GridPtrVec grids = isMesh ? openvdb::GridPtrVec() : readGrids(*file);
    const std::string text = (isMesh ? fromNotes(readMeshNotes(*file)) : stampOf(grids)).settings;
    if (text.empty()) {
        throw Error(ErrorKind::Input, "'" + *file +
                                          "' holds no settings; expected a file that bandvox "
                                          "convert has written");
    }
    std::string head;
    const Settings settings = parseSettings(text, head);
    // --as and --threshold, which are among them, can decide what the conversion is.
    CommandLine all = line;
    for (const auto& [name, setting] : settings) {
        const bool isGiven = !setting.isDefault && name != "shard" && setting.value != "false";
        if (isGiven && !line.decides(name)) {
            all.setUndecided(name, setting.value, *file);
        }
    }
    const auto isMadeAs = [&](Conversion conversion) {
        return head.starts_with(std::string("# ") + nameOf(conversion) + " by ");
    };
    const bool isSame = isMadeAs(conversionOf(all));
    const Conversion conversion = conversionOf(isSame ? all : line);
    const Settings known = defaultsOf(isSame ? all : line, conversion);
    CommandLine liked = line;
    for (const auto& [name, setting] : settings) {
        if (name == "shard") continue;  // the whole is like the part
        const OptionEntry* option = findOption(line.table(), name);
        if (option == nullptr) {
            throw Error(ErrorKind::Input, "'" + *file + "' was made with --" + name +
                                              ", which this version does not have");
        }
        if (line.decides(name) || (!isSame && !known.contains(name))) continue;
        if (setting.isDefault) {
            const auto standard = known.find(name);
            if (standard == known.end() || standard->second.value.empty()) continue;
            liked.setDefault(name, setting.value, *file);
        } else if (!option->argument.empty()) {
            const bool isLattice = name == "onto" && setting.value.starts_with(kLattice);
            liked.setUndecided(
                name, isLattice ? likedLattice(grids, *file, setting) : setting.value, *file);
        } else if (setting.value == "true") {
            liked.setUndecided(name, "", *file);
        }
    }
    return liked;
}

}  // namespace bandvox::app
