#include "source/text_lines.h"

namespace bandvox {

void checkOff(const FileContents& file, std::vector<std::string>& warnings) {
    // The first line holds the kind, such as OFF or NCOFF, and perhaps the counts as well.
    TextLines lines(file);
    if (!lines.nextWithWords()) file.fail("is empty; expected an OFF file");
    std::size_t counts = 0;
    if (lines.words()[0].ends_with("OFF")) {
        if (lines.words().size() > 1 && lines.words()[1] == "BINARY") {
            file.fail("is a binary OFF file; expected one in text");
        }
        const bool onlyKind = lines.words().size() == 1;
        if (onlyKind && !lines.nextWithWords()) file.fail("is cut short before its counts");
        counts = onlyKind ? 0 : 1;
    } else {
        lines.fail("begins with \"" + std::string(lines.words()[0].substr(0, 40)) +
                   "\"; expected \"OFF\"");
    }
    if (lines.words().size() < counts + 2) {
        lines.fail("has no counts; expected those of points, faces and edges");
    }
    const std::int64_t points = lines.integer(counts);
    const std::int64_t faces = lines.integer(counts + 1);
    if (points < 0 || faces < 0) lines.fail("has a negative count; expected 0 or more");

    for (std::int64_t i = 0; i < points; ++i) {
        if (!lines.nextWithWords()) {
            file.fail("is cut short: it has " + std::to_string(i) + " of its " +
                      std::to_string(points) + " points");
        }
        if (lines.words().size() < 3) {
            lines.fail("has a point with " + std::to_string(lines.words().size()) +
                       " coordinates; expected 3");
        }
        for (std::size_t k = 0; k < 3; ++k) lines.coordinate(k);
    }

    if (faces == 0) file.fail("has no faces; expected a surface");
    PointUse use(static_cast<std::size_t>(points));
    for (std::int64_t i = 0; i < faces; ++i) {
        if (!lines.nextWithWords()) {
            file.fail("is cut short: it has " + std::to_string(i) + " of its " +
                      std::to_string(faces) + " faces");
        }
        const std::int64_t corners = lines.integer(0);
        if (corners < 1 || static_cast<std::uint64_t>(corners) >= lines.words().size()) {
            lines.fail("has a face of " + std::to_string(corners) + " corners with " +
                       std::to_string(lines.words().size() - 1) + " numbers");
        }
        for (std::size_t k = 1; k <= static_cast<std::size_t>(corners); ++k) {
            const std::int64_t point = lines.integer(k);
            if (point < 0 || point >= points) {
                lines.fail("refers to point " + std::to_string(point) + "; expected 0 to " +
                           std::to_string(points - 1));
            }
            use.use(static_cast<std::size_t>(point));
        }
    }
    use.finish(file, warnings);
}

}  // namespace bandvox
