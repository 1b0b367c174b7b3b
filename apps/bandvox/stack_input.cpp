#include "stack_input.h"

#include "command_run.h"
#include "option_values.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <array>

namespace bandvox::app {
namespace {

constexpr const char* kStackOptions[] = {"channel", "series", "spacing", "origin"};

// One number for all axes, or three.
std::optional<openvdb::Vec3d> readSpacing(const CommandLine& line) {
    const Range positive{.low = 0, .high = 1e30, .lowOpen = true};
    const auto given = line.text("spacing");
    if (!given) return std::nullopt;
    if (given->find(',') != std::string::npos) return line.vector("spacing", positive);
    return openvdb::Vec3d(line.number("spacing", positive, 1));
}

}  // namespace

std::vector<OptionEntry> stackEntries() {
    const std::string volumes = "Volumes as input";
    return {
        {"spacing", 0, "A[,B,C]", "as the file says, else 1",
         "Of an array or a stack of images, world units from voxel to voxel along x, y and z.",
         volumes},
        {"origin", 0, "X,Y,Z", "as the file says, else 0",
         "The same for the place of its first voxel's centre, in the file's own space.", volumes},
        {"space",
         0,
         "LPS|RAS",
         "as the file says",
         "Of scans and their grids, where the result's axes point: to left, posterior and superior "
         "as those of DICOM do, or to right, anterior and superior.",
         volumes,
         {.words = {"LPS", "RAS"}}},
        {"channel", 0, "NAME", "",
         "Of images with several channels, the one to take: R, G, B, A, luminance, or a number "
         "from 0. Needed unless R, G and B are equal and nothing is transparent.",
         volumes},
        {"series", 0, "N|UID", "",
         "Of a folder with several DICOM series, the one to take; without it they are listed.",
         volumes},
    };
}

bool isStackInput(const std::string& input) {
    return !isShape(input) && isArrayInput(input);
}

StackRequest readStackRequest(const CommandLine& line, const std::string& input) {
    if (!isStackInput(input)) {
        for (const char* name : kStackOptions) {
            if (!line.has(name)) continue;
            throw Error(ErrorKind::Usage, std::string("option --") + name +
                                              " is for arrays and stacks of images, and '" + input +
                                              "' is none");
        }
    }
    if (line.has("space") && !isStackInput(input) &&
        (isShape(input) || extensionOf(input) != ".vdb")) {
        throw Error(ErrorKind::Usage, "option --space is for scans and .vdb files, and '" + input +
                                          "' does not say where its axes point");
    }
    StackRequest request;
    request.options.channel = line.text("channel").value_or("");
    request.options.series = line.text("series").value_or("");
    request.spacing = readSpacing(line);
    request.origin = line.vector("origin", kAnyPlace);
    if (line.has("space")) {
        request.space = std::array{"LPS", "RAS", "LPS",
                                   "RAS"}[line.choice("space", {"LPS", "RAS", "lps", "ras"}, 0)];
    }
    return request;
}

std::unique_ptr<ArraySource> openStack(const std::string& input, const StackRequest& request) {
    auto source = openArray(input, request.options);
    source->place(request.spacing, request.origin);
    if (!request.space.empty()) source->turnTo(request.space);
    return source;
}

std::vector<std::string> arrayInWords(const ArrayInfo& info) {
    std::string line = "array    " + std::to_string(info.size.x()) + " x ";
    line += std::to_string(info.size.y()) + " x " + std::to_string(info.size.z());
    line += " values of type " + info.valueType;
    if (!info.hasTransform) line += ", of which nothing says how large they are";
    if (!info.space.empty()) line += ", axes " + info.space;
    if (!info.unit.empty()) line += ", unit " + info.unit;
    std::vector<std::string> lines{line};
    for (const std::string& note : info.notes) lines.push_back("         " + note);
    return lines;
}

}  // namespace bandvox::app
