#include "convert_stamp.h"

#include "convert_to_array.h"
#include "option_values.h"

#include <bandvox/mesh/write_mesh.h>

namespace bandvox::app {
namespace {

constexpr const char* kSettingsKey = "bandvox_settings";
constexpr const char* kInputKey = "bandvox_input";
const std::string kSettingsNote = "settings: ";
const std::string kInputNote = "input: ";

std::string textOf(const openvdb::GridBase& grid, const char* key) {
    const auto metadata = grid.getMetadata<openvdb::StringMetadata>(key);
    return metadata ? metadata->value() : std::string();
}

void addNotes(std::vector<std::string>& notes, const std::string& mark, const std::string& text) {
    if (text.empty()) return;
    for (const std::string_view line : split(text, '\n')) notes.push_back(mark + std::string(line));
}

}  // namespace

openvdb::GridCPtrVec stamped(const openvdb::GridCPtrVec& grids, const ConvertStamp& stamp) {
    openvdb::GridCPtrVec copies;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid->copyGrid());
        for (const char* key : {kSettingsKey, kInputKey}) {
            if ((*copy)[key]) copy->removeMeta(key);
        }
        copy->insertMeta(kSettingsKey, openvdb::StringMetadata(stamp.settings));
        if (!stamp.input.empty()) {
            copy->insertMeta(kInputKey, openvdb::StringMetadata(stamp.input));
        }
        copies.push_back(copy);
    }
    return copies;
}

ConvertStamp stampOf(const openvdb::GridPtrVec& grids) {
    for (const auto& grid : grids) {
        ConvertStamp stamp{textOf(*grid, kSettingsKey), textOf(*grid, kInputKey)};
        if (!stamp.settings.empty()) return stamp;
    }
    return {};
}

std::vector<std::string> toNotes(const ConvertStamp& stamp) {
    std::vector<std::string> notes;
    addNotes(notes, kSettingsNote, stamp.settings);
    addNotes(notes, kInputNote, stamp.input);
    return notes;
}

ConvertStamp fromNotes(const std::vector<std::string>& notes) {
    ConvertStamp stamp;
    const auto append = [](std::string& text, const std::string& line) {
        if (!text.empty()) text += '\n';
        text += line;
    };
    for (const std::string& note : notes) {
        if (note.starts_with(kSettingsNote)) {
            append(stamp.settings, note.substr(kSettingsNote.size()));
        } else if (note.starts_with(kInputNote)) {
            append(stamp.input, note.substr(kInputNote.size()));
        }
    }
    return stamp;
}

bool holdsStamp(const std::filesystem::path& path) {
    return isWritableMesh(path) ? holdsNotes(path) : !isArrayOutput(path.string());
}

}  // namespace bandvox::app
