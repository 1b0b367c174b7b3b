#pragma once

#include "command_line.h"
#include "command_run.h"
#include "option_table.h"

#include <bandvox/grid/write_array.h>

#include <openvdb/openvdb.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Volumes as arrays and stacks of images: what convert writes instead of a .vdb file.
namespace bandvox::app {

/// True if the output is an array, an image or a pattern of images, by its name.
bool isArrayOutput(const std::string& name);

/// The options --type, --range and --box.
std::vector<OptionEntry> arrayOutputEntries();

/// An output that is an array or a stack of images.
class ArrayOutput {
  public:
    /// Nothing if --output is neither. Throws Error(ErrorKind::Usage) for options that have no
    /// meaning with it, and for its own options without it; as AtomicFile if it cannot be written.
    static std::unique_ptr<ArrayOutput> read(const CommandLine& line);

    /// Writes the grid, and says and counts what came of it. The last step of a command.
    void write(CommandRun& run, const openvdb::FloatGrid& grid);

  private:
    enum class Kind { Npy, Nrrd, MetaImage, Pages, Pattern };

    ArrayOutput(const CommandLine& line, std::filesystem::path path, Kind kind);
    static std::optional<Kind> kindOf(const std::string& name);
    friend bool isArrayOutput(const std::string& name);
    bool isImages() const { return mKind == Kind::Pages || mKind == Kind::Pattern; }
    void writePattern(CommandRun& run, const openvdb::FloatGrid& grid);
    WrittenVoxels writeFiles(CommandRun& run, const openvdb::FloatGrid& grid);
    void say(CommandRun& run, const openvdb::FloatGrid& grid, const WrittenVoxels& written) const;

    std::filesystem::path mPath;
    Kind mKind;
    std::string mInput;
    VoxelsToWrite mVoxels;
    bool mCompress = false;
    std::unique_ptr<AtomicFile> mFile;    // none of a pattern
    std::unique_ptr<AtomicFile> mValues;  // of a header that stands alone
};

}  // namespace bandvox::app
