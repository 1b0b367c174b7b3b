#include "scene_file.h"

#include "option_table.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/error.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace bandvox::app {

namespace {

const std::vector<std::string> kGroups{"objects", "lights", "environment", "picture", "camera"};

const std::vector<std::string> kFlags{"shadows", "allow-empty", "visible"};

// A setting as an option would give it; nothing if it can be none.
std::optional<std::string> textOf(const std::string& name, const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    if (!value.is_array() || value.empty()) return std::nullopt;
    std::vector<std::string> parts;
    for (const nlohmann::json& part : value) {
        if (!part.is_number()) return std::nullopt;
        parts.push_back(part.dump());
    }
    return joined(parts, name == "res" ? "x" : ",");
}

// Told of what a parser meets, keeps the first name that an object has twice, of which JSON does
// not say which counts.
class RepeatedNames {
  public:
    bool note(nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
        using Event = nlohmann::json::parse_event_t;
        if (event == Event::object_start) {
            mNames.emplace_back();
        } else if (event == Event::object_end) {
            mNames.pop_back();
        } else if (event == Event::key) {
            const auto name = parsed.get<std::string>();
            if (!mNames.back().insert(name).second && !mRepeated) mRepeated = name;
        }
        return true;
    }

    const std::optional<std::string>& repeated() const { return mRepeated; }

  private:
    std::vector<std::set<std::string>> mNames;  // of the objects around, outermost first
    std::optional<std::string> mRepeated;
};

}  // namespace

SceneFile::SceneFile(const std::string& path)
    : mPath(path), mJson(std::make_unique<nlohmann::json>()) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail("it is a folder; expected a file");
    std::ifstream stream(path);
    if (!stream) fail("it cannot be opened for reading");
    RepeatedNames names;
    try {
        *mJson = nlohmann::json::parse(
            stream, [&names](int /*depth*/, nlohmann::json::parse_event_t event,
                             nlohmann::json& parsed) { return names.note(event, parsed); });
    } catch (const nlohmann::json::exception& error) {
        fail(std::string("it is no JSON (") + error.what() + ")");
    }
    if (names.repeated()) {
        fail("there is '" + *names.repeated() + "' twice in one object; expected it once");
    }
    if (!mJson->is_object()) fail("it holds no scene; expected { \"objects\": [ ... ] }");
    for (const auto& [name, value] : mJson->items()) {
        if (std::find(kGroups.begin(), kGroups.end(), name) == kGroups.end()) {
            fail("there is '" + name + "'; expected " + joined(kGroups, ", "));
        }
    }
}

SceneFile::~SceneFile() = default;

bool SceneFile::has(const std::string& group) const {
    return mJson->contains(group);
}

OptionValues SceneFile::group(const std::string& group,
                              const std::vector<std::string>& names) const {
    return read(mJson->at(group), group, names);
}

std::vector<OptionValues> SceneFile::list(const std::string& list,
                                          const std::vector<std::string>& names) const {
    std::vector<OptionValues> all;
    if (!has(list)) return all;
    const nlohmann::json& groups = mJson->at(list);
    if (!groups.is_array()) fail(list + " is no list; expected [ { ... }, ... ]");
    for (const nlohmann::json& settings : groups) {
        std::string where = list;
        where += '[';
        where += std::to_string(all.size());
        where += ']';
        all.push_back(read(settings, where, names));
    }
    return all;
}

OptionValues SceneFile::read(const nlohmann::json& settings, const std::string& where,
                             const std::vector<std::string>& names) const {
    if (!settings.is_object()) fail(where + " holds no settings; expected { ... }");
    std::string title = "'" + mPath.string();
    title += "': " + where + ".";
    OptionValues values(title, ErrorKind::Input);
    for (const auto& [name, value] : settings.items()) {
        if (std::find(names.begin(), names.end(), name) == names.end()) {
            const std::string nearest = nearestName(name, names);
            std::ostringstream why;
            why << where << " has '" << name << "'; ";
            if (nearest.empty()) {
                why << "expected " << joined(names, ", ");
            } else {
                why << "did you mean '" << nearest << "'?";
            }
            fail(why.str());
        }
        const bool isFlag = std::find(kFlags.begin(), kFlags.end(), name) != kFlags.end();
        if (isFlag != value.is_boolean()) {
            std::string setting = where;
            setting += "." + name;
            fail(setting +
                 (isFlag ? " is neither true nor false" : " is true or false; expected a value"));
        }
        if (isFlag) {
            if (value.get<bool>()) values.set(name, "");
            continue;
        }
        const auto text = textOf(name, value);
        if (!text) {
            std::string setting = where;
            setting += "." + name;
            fail(setting + " is neither text, a number nor a list of numbers");
        }
        values.set(name, *text);
    }
    return values;
}

std::string SceneFile::beside(const std::string& file) const {
    // The standard input lies nowhere.
    return isStandardInput(file) ? file : (mPath.parent_path() / file).string();
}

void SceneFile::fail(const std::string& why) const {
    std::string message = "'";
    message += mPath.string();
    message += "': ";
    message += why;
    throw Error(ErrorKind::Input, message);
}

}  // namespace bandvox::app
