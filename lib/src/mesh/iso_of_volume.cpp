#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/mesh/density_to_mesh.h>
#include <bandvox/mesh/iso_of_volume.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace bandvox {

namespace {

constexpr double kVolumeTolerance = 1e-5;  // of the volume that is wanted
constexpr int kMostMeshes = 40;

// Values nearer than this part of what the grid reaches to its ends are not tried.
constexpr double kEndPart = 1e-3;

/// An iso-value, and how much more than what is wanted it encloses, world units³.
struct IsoTrial {
    double iso, difference;
};

[[noreturn]] void failToEnclose(const openvdb::FloatGrid& grid, double volume,
                                const IsoTrial& trial) {
    // As where all of a part of the grid is of one value.
    throw Error(ErrorKind::Result, "no iso-value of the grid \"" + grid.getName() +
                                       "\" encloses a volume of " + inShort(volume) + ": " +
                                       inShort(trial.iso) + " encloses " +
                                       inShort(trial.difference + volume));
}

}  // namespace

VolumeIso isoOfVolume(const openvdb::FloatGrid::ConstPtr& grid, double volume, Progress& progress) {
    if (!grid) throw Error(ErrorKind::Usage, "an iso-value needs a grid, but got none");
    if (!(volume > 0) || !std::isfinite(volume)) {
        throw Error(ErrorKind::Usage,
                    "the volume to enclose is " + inShort(volume) + "; expected one above 0");
    }
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw Error(ErrorKind::Input, "the grid \"" + grid->getName() +
                                          "\" is a level set; an iso-value by volume is for "
                                          "densities");
    }
    const auto difference = [&](double iso) {
        MeshOptions options;
        options.iso = iso;
        return IsoTrial{iso, densityToMesh(grid, options, progress).volume - volume};
    };
    const auto isDone = [volume](const IsoTrial& trial) {
        return std::abs(trial.difference) <= kVolumeTolerance * volume;
    };

    // From the middle of the values go on towards the end that gives what is missing.
    const double low = grid->background();
    double high = low;
    for (auto value = grid->cbeginValueOn(); value; ++value) high = std::max(high, double(*value));
    const double reach = high - low;
    IsoTrial trial = difference(low + 0.5 * reach);
    const bool startsTooLarge = trial.difference > 0;
    IsoTrial more = trial, less = trial;
    for (double part = 0.25; (trial.difference > 0) == startsTooLarge; part *= 0.5) {
        if (isDone(trial)) return {trial.iso, trial.difference + volume};
        if (part < kEndPart) failToEnclose(*grid, volume, trial);
        more = less = trial;
        trial = difference(startsTooLarge ? high - part * reach : low + part * reach);
    }
    (startsTooLarge ? less : more) = trial;

    // The secant between both; an end that stays counts half (the Illinois algorithm).
    for (int meshes = 0; meshes < kMostMeshes && !isDone(trial); ++meshes) {
        const bool wasTooLarge = trial.difference > 0;
        trial = difference((more.iso * less.difference - less.iso * more.difference) /
                           (less.difference - more.difference));
        const bool isTooLarge = trial.difference > 0;
        if (isTooLarge == wasTooLarge) (isTooLarge ? less : more).difference *= 0.5;
        (isTooLarge ? more : less) = trial;
    }
    if (!isDone(trial)) failToEnclose(*grid, volume, trial);
    return {trial.iso, trial.difference + volume};
}

}  // namespace bandvox
