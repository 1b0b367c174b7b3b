#include "write_manual.h"

#include "manual_markdown.h"
#include "manual_page.h"
#include "shell_completion.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <fstream>
#include <string>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

void writeText(const fs::path& path, const std::string& text) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
        throw Error(ErrorKind::Runtime, "cannot make the folder '" + path.parent_path().string() +
                                            "': " + error.message());
    }
    AtomicFile file(path);
    std::ofstream stream = file.open();
    stream << text;
    stream.close();
    if (!stream) throw Error(ErrorKind::Runtime, "cannot write '" + path.string() + "'");
    file.commit();
}

}  // namespace

void writeManual(const fs::path& folder, const std::vector<const CommandTable*>& tables) {
    writeText(folder / "man" / "bandvox.1", overviewPage(tables));
    for (const CommandTable* table : tables) {
        writeText(folder / "man" / ("bandvox-" + table->name + ".1"), manualPage(*table, tables));
        writeText(folder / "markdown" / ("bandvox-" + table->name + ".md"), markdownPage(*table));
    }
    writeText(folder / "markdown" / "bandvox.md", markdownOverview(tables));
    writeText(folder / "bash" / "bandvox", bashCompletion(tables));
    writeText(folder / "zsh" / "_bandvox", zshCompletion(tables));
    writeText(folder / "fish" / "bandvox.fish", fishCompletion(tables));
}

}  // namespace bandvox::app
