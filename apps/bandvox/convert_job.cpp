#include "convert_job.h"

#include "convert_settings.h"
#include "input_files.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/sha256.h>
#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kInputKey = "bandvox_input";

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
    for (const fs::path& file : filesOfInput(input, mLine.has("color"))) {
        if (!text.empty()) text += '\n';
        text += sha256OfFile(file, mRun.progress());
        text += ' ';
        text += std::to_string(fs::file_size(file));
        text += ' ';
        text += printable(file.filename().string());
    }
    return text;
}

bool ConvertJob::begin() {
    mStamp = {settingsText(mLine), describeInput()};
    if (!mLine.has("skip-existing")) return true;
    const std::string output = mLine.requiredText("output");
    if (mStamp.input.empty() && isStandardInput(mLine.positional(0))) {
        throw Error(ErrorKind::Usage,
                    "--skip-existing cannot tell whether the standard input is the same as before; "
                    "expected a file as the input");
    }
    std::error_code ignored;
    const fs::path path = outputPath(output);
    if (!fs::exists(path, ignored) || !fs::is_regular_file(path, ignored)) return true;
    const auto why = whyToRedo(output, mStamp, mRun.progress());
    if (why) {
        mRun.say("redo     " + output + ": " + *why);
        return true;
    }
    mRun.skip(output, "it is whole, and made with the same settings from the same input");
    return false;
}

void ConvertJob::writeVolume(AtomicFile& output, const openvdb::GridCPtrVec& grids,
                             const VdbWriteOptions& options) const {
    openvdb::GridCPtrVec stamped;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid->copyGrid());
        for (const char* key : {kSettingsKey, kInputKey}) {
            if ((*copy)[key]) copy->removeMeta(key);
        }
        copy->insertMeta(kSettingsKey, openvdb::StringMetadata(mStamp.settings));
        if (!mStamp.input.empty()) {
            copy->insertMeta(kInputKey, openvdb::StringMetadata(mStamp.input));
        }
        stamped.push_back(copy);
    }
    mRun.writeOutput(output, [&](AtomicFile& file) { writeVdb(file, stamped, options); });
}

std::optional<std::string> whyToRedo(const std::string& output, const ConvertStamp& stamp,
                                     Progress& progress) {
    openvdb::GridPtrVec grids;
    try {
        const ProgressStage stage(progress, "check output", 0);
        grids = readVdb(output);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        return std::string(error.what());
    }
    progress.throwIfInterrupted();
    const auto settings = settingsOf(grids);
    if (!settings) return "it does not say with which settings it was made";
    const std::string difference = settingsDifference(*settings, stamp.settings);
    if (!difference.empty()) return difference;
    const auto input = grids.front()->getMetadata<openvdb::StringMetadata>(kInputKey);
    if (!input) return "it does not say from which input it was made";
    if (input->value() == stamp.input) return std::nullopt;
    const std::set<std::string> changed = changedFiles(input->value(), stamp.input);
    return "the input has changed: " + joined({changed.begin(), changed.end()}, ", ");
}

}  // namespace bandvox::app
