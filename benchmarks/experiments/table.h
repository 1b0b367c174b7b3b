#pragma once

#include <bandvox/core/error.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace bandvox::experiments {

/// A comma-separated file, written line by line; the first line names the columns.
class Table {
  public:
    Table(const std::filesystem::path& path, const std::string& columns) : mFile(path) {
        mFile.precision(6);
        mFile << columns << '\n';
        if (!mFile) throw Error(ErrorKind::Runtime, "cannot write " + path.string());
    }

    /// Numbers and words, in the order of the columns.
    template <typename First, typename... Rest>
    void add(const First& first, const Rest&... rest) {
        mFile << first;
        ((mFile << ',' << rest), ...);
        // Flushed, so that a long measurement can be watched.
        mFile << std::endl;
    }

  private:
    std::ofstream mFile;
};

/// Where the tables go.
struct Folder {
    Table table(const std::string& name, const std::string& columns) const {
        return {path / (name + ".csv"), columns};
    }

    std::filesystem::path path;
};

}  // namespace bandvox::experiments
