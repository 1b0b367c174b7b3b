#pragma once

#include "option_values.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::app {

/// A description of a scene in JSON: groups of settings, and lists of such groups. Settings have
/// the names and the meaning of the command's options: "color": [1, 0.5, 0] is --color 1,0.5,0, and
/// "shadows": true is --shadows.
class SceneFile {
  public:
    /// Throws Error(ErrorKind::Input) if it cannot be read, or holds anything but objects, lights,
    /// environment, picture and camera.
    explicit SceneFile(const std::string& path);
    ~SceneFile();

    std::string path() const { return mPath.string(); }

    bool has(const std::string& group) const;

    /// The settings of a group. Throws Error(ErrorKind::Input) if it has others than `names`.
    OptionValues group(const std::string& group, const std::vector<std::string>& names) const;

    /// The settings of each group of a list; nothing if there is no such list.
    std::vector<OptionValues> list(const std::string& list,
                                   const std::vector<std::string>& names) const;

    /// A file whose name is relative to the scene file's folder.
    std::string beside(const std::string& file) const;

  private:
    OptionValues read(const nlohmann::json& settings, const std::string& where,
                      const std::vector<std::string>& names) const;
    [[noreturn]] void fail(const std::string& why) const;

    std::filesystem::path mPath;
    std::unique_ptr<nlohmann::json> mJson;
};

}  // namespace bandvox::app
