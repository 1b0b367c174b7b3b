#include "source/nesting_depth.h"

#include "source/little_endian.h"
#include "source/xml_tags.h"

#include <algorithm>
#include <cstdint>
#include <vector>

// Each text is gone through once, without a parser that could run out of its stack itself.

namespace bandvox {
namespace {

/// Counts levels as they open and close.
class Depth {
  public:
    void open() { mDeepest = std::max(mDeepest, ++mOpen); }
    void close() { mOpen -= mOpen > 0 ? 1 : 0; }
    std::size_t deepest() const { return mDeepest; }

  private:
    std::size_t mOpen = 0;
    std::size_t mDeepest = 0;
};

/// The place behind `end`, searched from `from` on; the text's end if it does not come.
std::size_t behind(std::string_view text, std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string_view::npos ? text.size() : found + end.size();
}

std::size_t fbxTextDepth(std::string_view text) {
    Depth depth;
    // The importer's text ends with the first zero.
    text = text.substr(0, text.find('\0'));
    for (std::size_t i = 0; i < text.size(); ++i) {
        switch (text[i]) {
            case '"':
                i = behind(text, "\"", i + 1) - 1;
                break;
            case ';':
                i = std::min(text.find_first_of("\r\n\f", i), text.size());
                break;
            case '{':
                depth.open();
                break;
            case '}':
                depth.close();
                break;
            default:
                break;
        }
    }
    return depth.deepest();
}

std::size_t fbxBinaryDepth(std::string_view bytes) {
    constexpr std::size_t kVersion = 23;
    constexpr std::size_t kHeader = 27;
    constexpr std::uint32_t kWideVersion = 7500;
    if (bytes.size() < kHeader) return 0;
    // A record: its end, the number of its properties, and their size, three numbers of this width;
    // the length of its name, a byte; name, properties, and then nested records, behind which
    // follows an empty one.
    const std::size_t width = littleEndian32(bytes, kVersion) >= kWideVersion ? 8 : 4;
    const std::size_t emptyRecord = 3 * width + 1;

    std::size_t deepest = 0;
    std::vector<std::uint64_t> ends;  // of the records that are open, without the empty ones
    std::uint64_t place = kHeader;
    while (true) {
        while (!ends.empty() && place >= ends.back()) {
            ends.pop_back();
            place += emptyRecord;
        }
        const std::uint64_t limit = ends.empty() ? bytes.size() : ends.back();
        if (place + width > limit) break;
        const std::uint64_t end = unsignedAt(bytes, place, width);
        if (end == 0) {
            // At the highest level it is the end; below, the importer goes on.
            if (ends.empty()) break;
            place += width;
            continue;
        }
        if (end > limit || end < place || place + emptyRecord > limit) break;
        const std::uint64_t size = unsignedAt(bytes, place + 2 * width, width);
        const std::uint64_t name = unsignedAt(bytes, place + 3 * width, 1);
        place += emptyRecord + name;
        if (place > limit || size > limit - place) break;
        place += size;
        deepest = std::max(deepest, ends.size() + 1);
        if (place > end) break;
        if (place == end) continue;
        if (end - place < emptyRecord) break;
        ends.push_back(end - emptyRecord);
    }
    return deepest;
}

}  // namespace

std::size_t jsonDepth(std::string_view text) {
    Depth depth;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '\\') {
            ++i;
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && (c == '[' || c == '{')) {
            depth.open();
        } else if (!quoted && (c == ']' || c == '}')) {
            depth.close();
        }
    }
    return depth.deepest();
}

std::size_t xmlDepth(std::string_view text) {
    Depth depth;
    forEachXmlTag(text, [&depth](const XmlTag& tag) {
        if (tag.kind == XmlTag::Kind::Open) depth.open();
        if (tag.kind == XmlTag::Kind::Close) depth.close();
    });
    return depth.deepest();
}

std::size_t fbxDepth(std::string_view bytes) {
    return bytes.starts_with("Kaydara FBX Binary") ? fbxBinaryDepth(bytes) : fbxTextDepth(bytes);
}

void requireShallow(const FileContents& file, std::size_t depth) {
    if (depth <= kDeepestNesting) return;
    file.fail("is nested " + std::to_string(depth) + " deep; at most " +
              std::to_string(kDeepestNesting) + " is read");
}

}  // namespace bandvox
