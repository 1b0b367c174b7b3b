// bandvox convert in.####.obj -o out.####.vdb: a sequence of frames by one process.

#include "convert_frames.h"

#include "convert_grid_solid.h"
#include "convert_points.h"
#include "convert_settings.h"
#include "convert_solid.h"
#include "convert_to_mesh.h"
#include "convert_volume.h"
#include "frame_pattern.h"
#include "memory_limit.h"
#include "words.h"

#include <bandvox/grid/write_image_stack.h>
#include <bandvox/source/array_source.h>
#include <bandvox/source/point_cloud.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <map>
#include <new>
#include <optional>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFramesListed = 20;

struct Sequence {
    std::string input, output;  // with places for numbers
    std::vector<int> frames;
    bool keepGoing = false;
};

/// A frame that could not be converted.
struct FailedFrame {
    int frame = 0;
    ErrorKind kind = ErrorKind::Runtime;
    std::string message;  // without the frame's number
};

void requirePlaces(const Sequence& sequence) {
    const bool hasInput = hasFrame(sequence.input);
    if (hasInput && hasFrame(sequence.output)) return;
    const std::string found =
        hasInput ? "option --output is '" + sequence.output : "the input is '" + sequence.input;
    throw Error(ErrorKind::Usage,
                found + "'; expected a place for the number of a frame in it, as in " +
                    (hasInput ? "name.####.vdb, as the input has one"
                              : "name.####.obj, or neither --frames nor one in the output"));
}

Sequence readSequence(const CommandLine& line) {
    Sequence sequence{line.positional(0), line.requiredText("output"), {}, line.has("keep-going")};
    std::optional<FrameRange> range;
    if (const auto text = line.text("frames")) {
        range = parseFrames(*text);
        if (!range) line.fail("frames", "frames as in 7, 1-100 or 1-100x2");
    }
    requirePlaces(sequence);
    sequence.frames = range ? range->numbers() : framesOnDisk(sequence.input);
    if (sequence.frames.empty()) {
        throw Error(ErrorKind::Input,
                    "there is no file of the name '" + sequence.input + "' with a number in it");
    }
    return sequence;
}

// "2, 5, 7", or the first of many.
std::string listed(const std::vector<int>& frames) {
    std::vector<std::string> numbers;
    for (std::size_t i = 0; i < std::min(frames.size(), kFramesListed); ++i) {
        numbers.push_back(std::to_string(frames[i]));
    }
    std::string text = joined(numbers, ", ");
    if (frames.size() > kFramesListed) {
        text += " and " + std::to_string(frames.size() - kFramesListed) + " more";
    }
    return text;
}

// One frame's output may not be another frame's input, another's output, or the statistics.
void requireOwnFiles(const CommandLine& line, const Sequence& sequence) {
    std::map<fs::path, std::string> uses;
    const auto add = [&](const std::string& name, const std::string& use) {
        std::error_code ignored;
        const fs::path path = fs::weakly_canonical(fs::absolute(name), ignored);
        const auto [earlier, isNew] = uses.emplace(path, use);
        if (isNew) return;
        throw Error(ErrorKind::Usage, "'" + name + "' is " + earlier->second + " and " + use +
                                          "; expected different files");
    };
    for (const char* option : {"stats", "onto", "like", "config"}) {
        const auto given = line.text(option);
        if (given) add(*given, std::string("the file of --") + option);
    }
    for (const int frame : sequence.frames) {
        const std::string number = std::to_string(frame);
        add(withFrame(sequence.input, frame), "the input of frame " + number);
        add(withFrame(sequence.output, frame), "the output of frame " + number);
    }
}

std::string missingMessage(const std::string& name) {
    return "there is no file '" + name + "'";
}

// Nothing is begun that cannot be finished, unless frames may fail.
void requireAllFrames(const Sequence& sequence) {
    std::vector<int> missing;
    for (const int frame : sequence.frames) {
        if (!fs::exists(withFrame(sequence.input, frame))) missing.push_back(frame);
    }
    if (missing.empty()) return;
    std::string message = "frame " + std::to_string(missing.front()) + ": " +
                          missingMessage(withFrame(sequence.input, missing.front()));
    if (missing.size() > 1) {
        message += "; missing are " + std::to_string(missing.size()) + " of " +
                   std::to_string(sequence.frames.size()) + " frames: " + listed(missing);
    }
    throw Error(ErrorKind::Input, message + "; --keep-going converts the others");
}

void convertFrame(CommandRun& run, const CommandLine& line) {
    const std::string& input = line.positional(0);
    if (!fs::exists(input)) throw Error(ErrorKind::Input, missingMessage(input));
    ConvertJob job(run, line);
    convertOne(job);
}

// What went wrong with a frame, if anything.
std::optional<FailedFrame> tryFrame(CommandRun& run, const CommandLine& line, int frame) {
    try {
        convertFrame(run, line);
        return std::nullopt;
    } catch (const Error& error) {
        return FailedFrame{frame, error.kind(), error.what()};
    } catch (const std::bad_alloc&) {
        return FailedFrame{frame, ErrorKind::Memory, "not enough memory"};
    } catch (const std::exception& error) {
        return FailedFrame{frame, ErrorKind::Runtime, error.what()};
    }
}

[[noreturn]] void throwFailed(const FailedFrame& failed) {
    // Wrong options are no frame's fault.
    if (failed.kind == ErrorKind::Usage) throw Error(failed.kind, failed.message);
    throw Error(failed.kind, "frame " + std::to_string(failed.frame) + ": " + failed.message);
}

void sayFailed(CommandRun& run, const FailedFrame& failed) {
    run.sayError("frame " + std::to_string(failed.frame) + ": " + failed.message);
}

[[noreturn]] void throwSummary(const std::vector<FailedFrame>& failed, std::size_t count) {
    std::vector<int> frames;
    frames.reserve(failed.size());
    for (const FailedFrame& one : failed) frames.push_back(one.frame);
    throw Error(failed.front().kind,
                std::to_string(failed.size()) + " of " +
                    formatCount(static_cast<std::int64_t>(count), "frame", "frames") +
                    " failed: " + listed(frames));
}

// True if no other frame would fare better, or nobody wants one.
bool endsAll(const FailedFrame& failed) {
    return failed.kind == ErrorKind::Usage || failed.kind == ErrorKind::Interrupted;
}

nlohmann::json describeFrame(const CommandLine& line, const std::optional<FailedFrame>& failed) {
    nlohmann::json entry{{"input", line.positional(0)}, {"output", line.requiredText("output")}};
    if (failed) {
        entry["error"] = failed->message;
        entry["exit_status"] = static_cast<int>(failed->kind);
    }
    return entry;
}

std::vector<FailedFrame> convertAll(CommandRun& run, const CommandLine& line,
                                    const Sequence& sequence) {
    std::vector<FailedFrame> failed;
    int written = 0, skipped = 0;
    for (const int frame : sequence.frames) {
        const CommandLine single =
            line.withFiles(withFrame(sequence.input, frame), withFrame(sequence.output, frame));
        run.beginFrame(frame);
        run.say("frame    " + std::to_string(frame));
        const auto failure = tryFrame(run, single, frame);
        if (failure) {
            if (failure->kind == ErrorKind::Interrupted) {
                throw Error(failure->kind, failure->message + " in frame " + std::to_string(frame) +
                                               ", after " + std::to_string(written + skipped) +
                                               " of " + std::to_string(sequence.frames.size()));
            }
            if (!sequence.keepGoing || endsAll(*failure)) throwFailed(*failure);
            sayFailed(run, *failure);
            failed.push_back(*failure);
        } else {
            ++(run.skipped() ? skipped : written);
        }
        run.endFrame(failure         ? "failed"
                     : run.skipped() ? "skipped"
                                     : "written",
                     describeFrame(single, failure));
    }
    run.say("done     " + std::to_string(written) + " of " +
            formatCount(std::ssize(sequence.frames), "frame", "frames") + " written, " +
            std::to_string(skipped) + " skipped, " + std::to_string(failed.size()) + " failed");
    return failed;
}

}  // namespace

std::vector<OptionEntry> frameEntries() {
    const std::string group = "Many files";
    return {
        {"frames", 0, "A-BxS", "all that are there",
         "Which frames, 7, 1-100 or 1-100x2, where the names of input and output have a place for "
         "the number, #### or %04d.",
         group},
        {"keep-going", 0, "", "",
         "Go on with the other frames where one fails; the exit status is that of the first.",
         group},
        {"skip-existing", 0, "", "",
         "Leave an output alone that is whole and was made with the same settings, by the same "
         "version, from the same input, as it says itself.",
         group},
        {"like",
         0,
         "FILE",
         "",
         "Use the settings of a .vdb file that convert has written; other options win over it.",
         group,
         {.endings = {".vdb"}}},
    };
}

void convertOne(ConvertJob& job) {
    readMemoryLimit(job.line());  // refuses
    switch (conversionOf(job.line())) {
        case Conversion::SolidToVolume:
        case Conversion::SolidToMesh:
            return convertSolid(job);
        case Conversion::VolumeToVolume:
            return convertVolume(job);
        case Conversion::VolumeToMesh:
            return convertGridToMesh(job);
        case Conversion::GridSolidToVolume:
        case Conversion::GridSolidToMesh:
            return convertGridSolid(job);
        case Conversion::PointsToVolume:
        case Conversion::PointsToMesh:
            return convertPoints(job);
    }
}

bool asksForFrames(const CommandLine& line) {
    if (line.has("frames") || line.has("keep-going")) return true;
    const std::string output = line.text("output").value_or("");
    // Of images, many are one stack.
    if (hasFrame(output) && !isWritableImage(output)) return true;
    // Of other kinds of files, many may be one input.
    const std::string& input = line.positional(0);
    const bool isWhole = isMeshFile(input) || extensionOf(input) == ".bpt" || isCadFile(input) ||
                         extensionOf(input) == ".vdb" || isArrayFile(input) ||
                         isPointCloudFile(input);
    return isWhole && hasFrame(input);
}

void convertFrames(const CommandLine& line) {
    const Sequence sequence = readSequence(line);
    requireOwnFiles(line, sequence);
    if (!sequence.keepGoing) requireAllFrames(sequence);
    CommandRun run(line);
    run.beginFrames(sequence.frames.size());
    run.say("frames   " + std::to_string(sequence.frames.size()) + " of " + sequence.input + ": " +
            listed(sequence.frames));
    const std::vector<FailedFrame> failed = convertAll(run, line, sequence);
    if (failed.empty()) return run.finish();
    run.finishFailed();
    throwSummary(failed, sequence.frames.size());
}

}  // namespace bandvox::app
