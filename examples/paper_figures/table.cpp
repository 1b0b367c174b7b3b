#include "table.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <fstream>
#include <iomanip>
#include <sstream>

namespace paper_figures {

namespace {

using Row = std::vector<std::string>;

std::string joined(const Row& cells, const std::string& between) {
    std::string line;
    for (const std::string& cell : cells) line += (line.empty() ? "" : between) + cell;
    return line;
}

std::string csvLine(const Row& cells) {
    Row quoted;
    for (const std::string& cell : cells) {
        quoted.push_back(cell.find(',') == std::string::npos ? cell : '"' + cell + '"');
    }
    return joined(quoted, ",") + '\n';
}

std::string markdownLine(const Row& cells) {
    return "| " + joined(cells, " | ") + " |\n";
}

void writeText(const std::filesystem::path& path, const std::string& text) {
    bandvox::AtomicFile file(path);
    std::ofstream stream = file.open();
    stream << text;
    stream.close();
    if (!stream) {
        throw bandvox::Error(bandvox::ErrorKind::Runtime, "cannot write " + path.string());
    }
    file.commit();
}

}  // namespace

void Table::write(const std::filesystem::path& folder, const std::string& name) const {
    std::string csv = csvLine(mHeader);
    std::string markdown = markdownLine(mHeader) + markdownLine(Row(mHeader.size(), "---"));
    for (const Row& row : mRows) {
        csv += csvLine(row);
        markdown += markdownLine(row);
    }
    writeText(folder / (name + ".csv"), csv);
    writeText(folder / (name + ".md"), markdown);
}

std::string fixed(double number, int digits) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(digits) << number;
    return text.str();
}

}  // namespace paper_figures
