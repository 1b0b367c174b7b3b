#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace paper_figures {

/// Words and numbers in rows and columns.
class Table {
  public:
    explicit Table(std::vector<std::string> header) : mHeader(std::move(header)) {}

    /// As many cells as the header has.
    void addRow(std::vector<std::string> cells) { mRows.push_back(std::move(cells)); }

    /// Writes NAME.csv and NAME.md.
    void write(const std::filesystem::path& folder, const std::string& name) const;

  private:
    std::vector<std::string> mHeader;
    std::vector<std::vector<std::string>> mRows;
};

/// A number with so many digits behind the point.
std::string fixed(double number, int digits);

}  // namespace paper_figures
