#include "progress_plans.h"

#include "command_run.h"
#include "convert_settings.h"
#include "convert_volume.h"

#include <string>

namespace bandvox::app {
namespace {

using Stages = std::vector<ExpectedStage>;

void append(Stages& stages, const Stages& more) {
    stages.insert(stages.end(), more.begin(), more.end());
}

// Every route of a solid ends alike; the ones before take what caps and unions leave to them.
const Stages kReadSolid{
    {"read colours", 1}, {"read mesh", 6}, {"close mesh", 4}, {"find overlaps", 3}, {"cutting", 2}};

Stages solidStages(const CommandLine& line) {
    Stages stages = kReadSolid;
    const std::string route = line.textOrDefault("route").value_or("auto");
    if (route == "winding") {
        append(stages, {{"winding numbers", 15}, {"rows", 30}, {"subtract solid", 5}});
    }
    append(stages, {{"band-limiting", 60}, {"looking for overlaps", 2}, {"assembling", 4}});
    if (line.has("color")) append(stages, {{"colouring", 20}});
    return stages;
}

Stages levelStages(const CommandLine& line) {
    return {{"filtering", 12, readDetailLevels(line)}};
}

const Stages kMeshStages{{"find surface", 8},
                         {"place points", 4},
                         {"make triangles", 4},
                         {"leave points out", 8},
                         {"colour points", 2}};

Stages convertStages(const CommandLine& line) {
    Stages stages{{"identify input", 1}};
    if (line.has("skip-existing")) append(stages, {{"check output", 4}});
    const Conversion conversion = conversionOf(line);
    switch (conversion) {
        case Conversion::SolidToVolume:
        case Conversion::SolidToMesh:
            append(stages, solidStages(line));
            break;
        case Conversion::GridSolidToVolume:
        case Conversion::GridSolidToMesh:
            append(stages, {{"reading", 10}, {"finding the surface", 15}});
            append(stages, {{"filtering", 10}, {"band-limiting", 60}, {"assembling", 4}});
            break;
        case Conversion::PointsToVolume:
        case Conversion::PointsToMesh:
            append(stages,
                   {{"read points", 5}, {"drawing balls", 10}, {"fitting the surface", 60}});
            append(stages, {{"following the surface", 10}, {"finding the surface", 5}});
            append(stages, {{"band-limiting", 60}, {"assembling", 4}});
            break;
        case Conversion::VolumeToVolume:
            append(stages, {{"reading", 20}, {"filtering", 40}});
            break;
        case Conversion::VolumeToMesh:
            append(stages, {{"read", 6}});
            break;
    }
    const bool toMesh =
        conversion == Conversion::SolidToMesh || conversion == Conversion::GridSolidToMesh ||
        conversion == Conversion::PointsToMesh || conversion == Conversion::VolumeToMesh;
    if (toMesh) append(stages, kMeshStages);
    if (line.has("as")) append(stages, {{"distances", 15}});
    if (!toMesh) append(stages, levelStages(line));
    append(stages, {{"write", 6}});
    return stages;
}

}  // namespace

std::vector<ExpectedStage> expectedStages(const CommandLine& line) {
    const std::string& command = line.table().name;
    if (command == "convert") return convertStages(line);
    Stages stages;
    if (command == "voxelize") {
        stages = kReadSolid;
        append(stages, {{"voxelizing", 60}, {"assembling", 6}});
    } else if (command == "render") {
        stages = {{"read", 6}, {"preparing", 6}, {"drawing", 80}};
    } else if (command == "fit") {
        stages = {{"read points", 10}, {"fitting", 60}};
        if (line.has("volume")) {
            append(stages, {{"sampling", 30}});
        } else if (extensionOf(line.text("output").value_or("")) == ".vdb") {
            append(stages, {{"band-limiting", 60}, {"assembling", 4}});
        }
    } else if (command == "view") {
        stages = {{"read", 6}, {"reduce", 20}, {"count", 10}, {"spectrum", 30}};
    } else {
        stages = {{"read", 6}, {"read mesh", 6}, {"close mesh", 6}, {"find overlaps", 3}};
    }
    append(stages, {{"write", 6}});
    return stages;
}

}  // namespace bandvox::app
