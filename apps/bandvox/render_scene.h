#pragma once

#include "command_line.h"
#include "command_run.h"
#include "option_table.h"

#include <bandvox/render/placement.h>
#include <bandvox/render/scene.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bandvox::app {

/// A grid of a file that is to be seen, and how.
struct ObjectRequest {
    std::string file;   ///< may hold a pattern for the number of a frame
    std::string place;  ///< in a scene file, for errors; empty if there is none
    std::optional<std::string> grid;
    std::optional<std::string> colors;        ///< name of the grid of colours; "none" for none
    std::optional<std::string> temperatures;  ///< name of the grid of temperatures; the same
    Placement placement;
    SceneObject object;  ///< without its grids
};

/// A scene as the user describes it.
struct SceneRequest {
    std::vector<ObjectRequest> objects;
    std::vector<Light> lights;
    Environment environment;
    OptionValues picture;  ///< settings of picture and camera, those of a scene file included
    std::string file;      ///< the scene file; empty if there is none
    std::map<std::string, std::string> places;  ///< of those settings in it, as camera.eye
};

/// The options of `render` that are about what is seen.
std::vector<OptionEntry> sceneEntries();

/// Reads what is to be seen: the command's arguments and options, or the scene file that is its
/// only argument. `pictureNames`: settings that a scene file may give for the picture.
/// Throws Error(ErrorKind::Usage), Error(ErrorKind::Input) for a scene file that cannot be used.
SceneRequest readScene(const CommandLine& line, const std::vector<std::string>& pictureNames);

/// Reads the grids; says and counts what was found. Of files whose names have a pattern, those of a
/// frame. Throws Error(ErrorKind::Input).
Scene loadScene(CommandRun& run, const SceneRequest& request, int frame);

}  // namespace bandvox::app
