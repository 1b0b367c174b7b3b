#include "source/text_lines.h"

namespace bandvox {
namespace {

/// The largest index that a statement of one kind is referred to by, and where.
struct Reference {
    const char* what;          ///< "point", ...
    std::int64_t count = 0;    ///< of statements so far
    std::int64_t largest = 0;  ///< counted from 1
    std::size_t line = 0;      ///< where the largest was found
};

/// Takes one index of a face's corner and returns it counted from 1. Negative ones count back
/// from the last statement.
std::int64_t resolve(std::int64_t index, Reference& reference, const TextLines& lines) {
    const std::int64_t resolved = index < 0 ? reference.count + 1 + index : index;
    if (resolved < 1) {
        lines.fail("refers to " + std::string(reference.what) + " " + std::to_string(index) +
                   " after " + std::to_string(reference.count) +
                   "; expected 1 or more, or a negative number that counts back");
    }
    if (resolved > reference.largest) {
        reference.largest = resolved;
        reference.line = lines.number();
    }
    return resolved;
}

/// Reads "point/texture/normal", where the last two may be missing; returns the point.
std::int64_t readCorner(std::string_view word, const TextLines& lines, Reference (&references)[3]) {
    const std::string text(word.substr(0, 40));
    std::int64_t point = 0;
    for (int i = 0; i < 3; ++i) {
        const auto integer = leadingInteger(word);
        if (integer) {
            const std::int64_t resolved = resolve(integer->value, references[i], lines);
            if (i == 0) point = resolved;
            word = integer->rest;
        }
        const bool mayBeMissing = i == 1;
        if ((!integer && !mayBeMissing) || !(word.empty() || word.starts_with('/'))) {
            lines.fail("has a face with the corner \"" + text +
                       "\"; expected point, point/texture or point/texture/normal");
        }
        if (word.empty()) break;
        word.remove_prefix(1);
        // A slash at the end is tolerated by all readers.
        if (word.empty()) break;
    }
    return point;
}

}  // namespace

void checkObj(const FileContents& file, std::vector<std::string>& warnings) {
    if (file.bytes.starts_with("\xEF\xBB\xBF")) {
        file.fail(
            "begins with a byte-order mark, behind which the first line would be lost; "
            "expected plain text");
    }
    Reference references[3] = {{"point"}, {"texture coordinate"}, {"normal"}};
    PointUse use;
    std::size_t faces = 0;
    TextLines lines(file);
    while (lines.nextWithWords()) {
        while (lines.joinContinued()) {
        }
        if (lines.words().empty()) continue;
        const auto& words = lines.words();
        if (words[0] == "v") {
            if (words.size() < 4) {
                lines.fail("has a point with " + std::to_string(words.size() - 1) +
                           " coordinates; expected 3");
            }
            for (std::size_t i = 1; i < 4; ++i) lines.coordinate(i);
            ++references[0].count;
        } else if (words[0] == "vt") {
            ++references[1].count;
        } else if (words[0] == "vn") {
            ++references[2].count;
        } else if (words[0] == "mtllib") {
            const bool isItself = words.size() > 1 && words.back() == file.path.filename().string();
            if (isItself) lines.fail("takes the file itself for its materials; expected another");
        } else if (words[0] == "f") {
            if (words.size() < 4) {
                lines.fail("has a face with " + std::to_string(words.size() - 1) +
                           " corners; expected at least 3");
            }
            for (std::size_t i = 1; i < words.size(); ++i) {
                const auto point =
                    static_cast<std::size_t>(readCorner(words[i], lines, references));
                // No file has more points than bytes; such an index is judged at the end.
                if (point <= file.bytes.size()) use.use(point - 1);
            }
            ++faces;
        }
    }

    // Faces may come before the points they refer to, so judge the indices at the end.
    for (const Reference& r : references) {
        if (r.largest <= r.count) continue;
        file.fail("line " + std::to_string(r.line) + " refers to " + r.what + " " +
                  std::to_string(r.largest) + "; the file has " + std::to_string(r.count));
    }
    if (faces == 0) file.fail("has no faces; expected a surface");
    use.setCount(static_cast<std::size_t>(references[0].count));
    use.finish(file, warnings);
}

}  // namespace bandvox
