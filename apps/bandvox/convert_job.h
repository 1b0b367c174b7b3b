#pragma once

#include "command_line.h"
#include "command_run.h"
#include "convert_stamp.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/openvdb.h>

#include <filesystem>
#include <optional>
#include <string>

namespace bandvox::app {

/// One input that becomes one output.
class ConvertJob {
  public:
    /// `usd`: a .usda file that is to refer to the .vdb output, which lies in the same folder;
    /// empty for none. Throws Error(ErrorKind::Runtime) if it cannot be written.
    ConvertJob(CommandRun& run, const CommandLine& line, const std::filesystem::path& usd = {});

    CommandRun& run() const { return mRun; }
    const CommandLine& line() const { return mLine; }

    /// To be called when the options have been read, before the input is. False if there is nothing
    /// to be done, because of --skip-existing. Throws Error(ErrorKind::Interrupted).
    bool begin();

    /// Writes grids that say how they were made, as CommandRun::writeOutput does, and the file that
    /// refers to them.
    void writeVolume(AtomicFile& output, const openvdb::GridCPtrVec& grids,
                     const VdbWriteOptions& options);

    /// What the output says of how it was made. After begin().
    const ConvertStamp& stamp() const { return mStamp; }

  private:
    std::string describeInput() const;

    CommandRun& mRun;
    const CommandLine& mLine;
    ConvertStamp mStamp;
    std::optional<AtomicFile> mUsd;
};

/// Why a file that is there has to be made again: it is not whole, or was made with other settings
/// or from another input. Nothing if it need not.
std::optional<std::string> whyToRedo(const std::string& output, const ConvertStamp& stamp,
                                     Progress& progress);

}  // namespace bandvox::app
