// Measures what docs/experiments/README.md, docs/math/sampled-route.md and docs/voxelize.md report,
// each question as one or two .csv files.
//
//     bandvox_experiments FOLDER [EXPERIMENT]...   (kExperiments names them)

#include "experiments.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace bandvox;
using namespace bandvox::experiments;

const std::pair<std::string, void (*)(const Folder&)> kExperiments[] = {
    {"oversampling", measureOversampling}, {"near-objects", measureNearObjects},
    {"lost-detail", measureLostDetail},    {"volume", measureVolume},
    {"stated-error", measureStatedError},  {"voxel-accuracy", measureVoxelAccuracy},
    {"voxel-times", measureVoxelTimes},    {"winding", measureWinding},
    {"normals", measureNormals},
};

void run(const Folder& folder, const std::vector<std::string>& wanted) {
    for (const std::string& name : wanted) {
        const auto isKnown = [&](const auto& experiment) { return experiment.first == name; };
        if (std::none_of(std::begin(kExperiments), std::end(kExperiments), isKnown)) {
            throw Error(ErrorKind::Usage, "there is no experiment '" + name + "'");
        }
    }
    for (const auto& [name, measure] : kExperiments) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
            continue;
        }
        const auto start = std::chrono::steady_clock::now();
        measure(folder);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        std::cerr << name << ": " << taken.count() << " s\n";
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "usage: bandvox_experiments FOLDER [EXPERIMENT]...\n";
        return static_cast<int>(ErrorKind::Usage);
    }
    try {
        run({argv[1]}, {argv + 2, argv + argc});
        return EXIT_SUCCESS;
    } catch (const Error& error) {
        std::cerr << error.what() << '\n';
        return error.exitStatus();
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
