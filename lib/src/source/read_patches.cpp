#include "source/read_patches.h"

#include "core/letter_case.h"
#include "source/text_lines.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_patches.h>

#include <algorithm>
#include <string>

namespace bandvox {
namespace {

// Goes through the numbers of a text, wherever its lines end.
class NumberWalk {
  public:
    explicit NumberWalk(const FileContents& file) : mFile(file), mLines(file) {}

    // Goes to the next number; `what` is that the file ends before otherwise.
    void step(const std::string& what) {
        if (++mWord < mLines.words().size()) return;
        mWord = 0;
        if (!mLines.nextWithWords()) {
            mFile.fail("ends after line " + std::to_string(mLines.number()) + "; expected " + what);
        }
    }
    std::int64_t integer(const std::string& what) {
        step(what);
        return mLines.integer(mWord);
    }
    double coordinate(const std::string& what) {
        step(what);
        return mLines.coordinate(mWord);
    }
    [[noreturn]] void fail(const std::string& what) const { mLines.fail(what); }
    bool hasMore() { return mWord + 1 < mLines.words().size() || mLines.nextWithWords(); }

  private:
    const FileContents& mFile;
    TextLines mLines;
    std::size_t mWord = 0;
};

int degreeFrom(NumberWalk& numbers, const std::string& what) {
    const std::int64_t degree = numbers.integer("the degree of " + what);
    if (degree < 1 || degree > BezierPatch::kHighestDegree) {
        numbers.fail("has the degree " + std::to_string(degree) + "; expected 1 to " +
                     std::to_string(BezierPatch::kHighestDegree));
    }
    return static_cast<int>(degree);
}

}  // namespace

bool isPatchFile(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension == ".obj") return std::filesystem::is_regular_file(path) && hasFreeForm(path);
    return extension == ".bpt" || isCadFile(path);
}

bool isCadFile(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    const auto& known = cadExtensions();
    return std::find(known.begin(), known.end(), extension) != known.end();
}

const std::vector<std::string>& cadExtensions() {
    static const std::vector<std::string> extensions{".step", ".stp", ".iges", ".igs", ".brep"};
    return extensions;
}

bool hasFreeForm(const std::filesystem::path& obj) {
    const FileContents file = readFile(obj);
    TextLines lines(file);
    while (lines.nextWithWords()) {
        if (lines.words()[0] == "surf") return true;
    }
    return false;
}

PatchModel readBptPatches(const FileContents& file, Progress& progress) {
    NumberWalk numbers(file);
    const std::int64_t count = numbers.integer("the number of patches");
    // A patch takes 5 bytes for its degrees and 6 for each of 4 points or more.
    const auto most = static_cast<std::int64_t>(file.bytes.size() / 24);
    if (count < 0 || count > most) {
        numbers.fail("announces " + std::to_string(count) + " patches; expected 0 to " +
                     std::to_string(most) + ", which is what a file of this size can hold");
    }
    PatchModel model;
    model.objects.push_back(file.path.stem().string());
    for (std::int64_t k = 0; k < count; ++k) {
        if (k % 1024 == 0) progress.throwIfInterrupted();
        const std::string what = "patch " + std::to_string(k + 1) + " of " + std::to_string(count);
        BezierPatch patch;
        patch.degreeU = degreeFrom(numbers, what);
        patch.degreeV = degreeFrom(numbers, what);
        for (int i = 0; i < (patch.degreeU + 1) * (patch.degreeV + 1); ++i) {
            std::array<double, 4> point{0, 0, 0, 1};
            for (std::size_t c = 0; c < 3; ++c) point[c] = numbers.coordinate("points of " + what);
            patch.control.push_back(point);
        }
        model.patches.push_back(std::move(patch));
    }
    if (numbers.hasMore()) {
        numbers.fail("goes on after the last of " + std::to_string(count) +
                     " patches; expected the end of the file");
    }
    return model;
}

PatchModel readPatches(const std::filesystem::path& path, Progress& progress) {
    const std::string extension = lowerExtension(path);
    if (extension == ".bpt") return readBptPatches(readFile(path), progress);
    if (extension == ".obj") return readObjPatches(readFile(path), progress);
    if (isCadFile(path)) return readCadPatches(path, progress);
    throw Error(ErrorKind::Input, "\"" + path.string() +
                                      "\" is no file of free-form surfaces; expected .bpt, .obj, "
                                      ".step, .stp, .iges, .igs or .brep");
}

}  // namespace bandvox
