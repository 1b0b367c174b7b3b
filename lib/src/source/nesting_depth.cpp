#include "source/nesting_depth.h"

#include "source/little_endian.h"

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

/// The place of the '>' that ends the tag, which may also stand in a quoted value.
std::size_t tagEnd(std::string_view text, std::size_t from) {
    for (std::size_t i = from; i < text.size(); ++i) {
        if (text[i] == '>') return i;
        if (text[i] == '"' || text[i] == '\'') i = behind(text, text.substr(i, 1), i + 1) - 1;
    }
    return text.size();
}

/// The place behind a document type declaration, whose own declarations are in brackets.
std::size_t behindDoctype(std::string_view text, std::size_t from) {
    const std::size_t end = tagEnd(text, from);
    const std::size_t bracket = text.find('[', from);
    return bracket < end ? behind(text, "]", bracket) : end;
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
    for (std::size_t i = 0; (i = text.find('<', i)) < text.size();) {
        const std::string_view rest = text.substr(i);
        if (rest.starts_with("<!--")) {
            i = behind(text, "-->", i + 4);
        } else if (rest.starts_with("<![CDATA[")) {
            i = behind(text, "]]>", i);
        } else if (rest.starts_with("<?")) {
            i = behind(text, "?>", i);
        } else if (rest.starts_with("<!")) {
            i = behindDoctype(text, i);
        } else if (rest.starts_with("</")) {
            depth.close();
            i = behind(text, ">", i);
        } else {
            const std::size_t end = tagEnd(text, i + 1);
            if (end == text.size() || text[end - 1] != '/') depth.open();
            i = end;
        }
    }
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
