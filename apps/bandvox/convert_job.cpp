#include "convert_job.h"

#include "convert_settings.h"
#include "input_files.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/sha256.h>
#include <bandvox/grid/write_usd_volume.h>
#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <vector>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

// Inputs of more bytes are told by samples and by when they were written: reading all would take
// minutes.
constexpr std::uintmax_t kReadWhole = std::uintmax_t(1) << 30;
constexpr std::uintmax_t kSampleStep = 1 << 24;
constexpr std::size_t kSampleBytes = 1 << 16;

std::string digestOfSamples(const fs::path& file) {
    Sha256 digest;
    digest.add(std::to_string(fs::last_write_time(file).time_since_epoch().count()));
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> sample(kSampleBytes);
    const std::uintmax_t bytes = fs::file_size(file);
    for (std::uintmax_t at = 0; at < bytes; at += kSampleStep) {
        stream.seekg(static_cast<std::streamoff>(at));
        stream.read(sample.data(), static_cast<std::streamsize>(sample.size()));
        digest.add({sample.data(), static_cast<std::size_t>(stream.gcount())});
        stream.clear();
    }
    return digest.finish();
}

// What a file says of how it was made. Reads all of it, so that a damaged one is found out.
ConvertStamp readStamp(const std::string& file, Progress& progress) {
    if (!isWritableMesh(file)) return stampOf(readVdb(file));
    ConvertStamp stamp = fromNotes(readMeshNotes(file));
    if (!stamp.settings.empty() && !isAsWritten(file, progress)) {
        throw Error(ErrorKind::Input, "it is damaged, or was changed: its checksum is another");
    }
    return stamp;
}

// The files that two descriptions of an input tell of, without what they share.
std::set<std::string> changedFiles(const std::string& before, const std::string& now) {
    std::set<std::string> changed;
    std::set<std::string_view> all[2];
    const auto lines = [](const std::string& text) {
        const auto parts = split(text, '\n');
        return std::set<std::string_view>(parts.begin(), parts.end());
    };
    all[0] = lines(before);
    all[1] = lines(now);
    for (int side = 0; side < 2; ++side) {
        for (const std::string_view line : all[side]) {
            if (all[1 - side].contains(line)) continue;
            const std::size_t space = line.find(' ');
            const std::size_t name =
                space == std::string_view::npos ? 0 : line.find(' ', space + 1);
            changed.insert(printable(std::string(
                line.substr(name == std::string_view::npos || name == 0 ? 0 : name + 1))));
        }
    }
    changed.erase("");
    return changed;
}

}  // namespace

std::string ConvertJob::describeInput() const {
    const std::string& input = mLine.positional(0);
    if (isShape(input)) return input;
    std::string text;
    const ProgressStage stage(mRun.progress(), "identify input", 0);
    const std::vector<fs::path> files = filesOfInput(input, mLine.has("color"));
    std::uintmax_t bytes = 0;
    for (const fs::path& file : files) bytes += fs::file_size(file);
    for (const fs::path& file : files) {
        mRun.progress().throwIfInterrupted();
        if (!text.empty()) text += '\n';
        text += bytes > kReadWhole ? digestOfSamples(file) : sha256OfFile(file, mRun.progress());
        text += ' ';
        text += std::to_string(fs::file_size(file));
        text += ' ';
        text += printable(file.filename().string());
    }
    return text;
}

bool ConvertJob::begin() {
    const std::string output = mLine.requiredText("output");
    const bool skips = mLine.has("skip-existing");
    // What holds none needs none, and to read all of the input for it takes time.
    if (!skips && !holdsStamp(output)) return true;
    mStamp = {settingsText(mLine), describeInput()};
    if (!skips) return true;
    if (mStamp.input.empty() && isStandardInput(mLine.positional(0))) {
        throw Error(ErrorKind::Usage,
                    "--skip-existing cannot tell whether the standard input is the same as before; "
                    "expected a file as the input");
    }
    if (!holdsStamp(output)) {
        throw Error(ErrorKind::Usage,
                    "--skip-existing needs a kind of file that says how it was "
                    "made, and '" +
                        output + "' is none; expected " + "another one, as .vdb or .ply");
    }
    std::error_code ignored;
    const fs::path path = outputPath(output);
    if (!fs::exists(path, ignored) || !fs::is_regular_file(path, ignored)) return true;
    const auto why = whyToRedo(output, mStamp, mRun.progress());
    if (why) {
        // What is wrong with a file names it.
        const bool isNamed = why->find(output) != std::string::npos;
        mRun.say("redo     " + (isNamed ? *why : output + ": " + *why));
        return true;
    }
    mRun.skip(output, "it is whole, and made with the same settings from the same input");
    return false;
}

ConvertJob::ConvertJob(CommandRun& run, const CommandLine& line, const fs::path& usd)
    : mRun(run), mLine(line) {
    if (!usd.empty()) mUsd.emplace(usd);
}

void ConvertJob::writeVolume(AtomicFile& output, const openvdb::GridCPtrVec& grids,
                             const VdbWriteOptions& options) {
    const openvdb::GridCPtrVec written = stamped(grids, mStamp);
    for (const openvdb::GridBase::ConstPtr& grid : grids) mRun.leaveToExit(grid);
    // The volume gets its name first: nothing ever refers to one that is not there.
    mRun.writeOutput(output, [&](AtomicFile& file) {
        writeVdb(file, written, options);
        if (!mUsd) return;
        writeUsdVolume(*mUsd, file.target().filename().string(), written, options.half);
        mUsd->complete();
    });
    if (!mUsd) return;
    mUsd->commit();
    mRun.say("wrote    " + mUsd->target().string() + ", which refers to " +
             output.target().filename().string());
}

std::optional<std::string> whyToRedo(const std::string& output, const ConvertStamp& stamp,
                                     Progress& progress) {
    ConvertStamp found;
    try {
        const ProgressStage stage(progress, "check output", 0);
        found = readStamp(output, progress);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        return std::string(error.what());
    }
    progress.throwIfInterrupted();
    if (found.settings.empty()) return "it does not say with which settings it was made";
    const std::string difference = settingsDifference(found.settings, stamp.settings);
    if (!difference.empty()) return difference;
    if (found.input.empty()) return "it does not say from which input it was made";
    if (found.input == stamp.input) return std::nullopt;
    const std::set<std::string> changed = changedFiles(found.input, stamp.input);
    return "the input has changed: " + joined({changed.begin(), changed.end()}, ", ");
}

}  // namespace bandvox::app
