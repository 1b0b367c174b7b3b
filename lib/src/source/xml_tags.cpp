#include "source/xml_tags.h"

#include <algorithm>

namespace bandvox {
namespace {

constexpr std::string_view kXmlSpaces = " \t\r\n";

/// The place behind `end`, searched from `from` on; the text's end if it does not come.
std::size_t placeBehind(std::string_view text, std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string_view::npos ? text.size() : found + end.size();
}

/// The place of the '>' that ends the tag, which may also stand in a quoted value.
std::size_t endOfTag(std::string_view text, std::size_t from) {
    for (std::size_t i = from; i < text.size(); ++i) {
        if (text[i] == '>') return i;
        if (text[i] == '"' || text[i] == '\'') {
            i = placeBehind(text, text.substr(i, 1), i + 1) - 1;
        }
    }
    return text.size();
}

/// The place behind a document type declaration, whose own declarations are in brackets.
std::size_t behindDoctype(std::string_view text, std::size_t from) {
    const std::size_t end = endOfTag(text, from);
    const std::size_t bracket = text.find('[', from);
    return bracket < end ? placeBehind(text, "]", bracket) : end;
}

/// The tag that begins with the '<' there.
XmlTag tagAt(std::string_view text, std::size_t begin) {
    const bool closes = text.substr(begin).starts_with("</");
    const std::size_t end =
        closes ? std::min(text.find('>', begin), text.size()) : endOfTag(text, begin + 1);
    std::string_view inside = text.substr(begin + 1, end - begin - 1);
    XmlTag tag{XmlTag::Kind::Open, {}, {}, std::min(end + 1, text.size())};
    if (closes) {
        tag.kind = XmlTag::Kind::Close;
        inside.remove_prefix(1);
    } else if (end < text.size() && inside.ends_with('/')) {
        tag.kind = XmlTag::Kind::Empty;
        inside.remove_suffix(1);
    }
    tag.name = inside.substr(0, inside.find_first_of(kXmlSpaces));
    tag.attributes = inside.substr(tag.name.size());
    return tag;
}

}  // namespace

std::optional<std::string_view> XmlTag::attribute(std::string_view wanted) const {
    std::string_view rest = attributes;
    while (true) {
        const std::size_t equals = rest.find('=');
        const std::size_t quote = rest.find_first_of("\"'", equals);
        if (equals == std::string_view::npos || quote == std::string_view::npos) return {};
        std::string_view found = rest.substr(0, equals);
        found.remove_prefix(std::min(found.find_first_not_of(kXmlSpaces), found.size()));
        found = found.substr(0, found.find_first_of(kXmlSpaces));
        const std::size_t behind = std::min(rest.find(rest[quote], quote + 1), rest.size());
        if (found == wanted) return rest.substr(quote + 1, behind - quote - 1);
        rest.remove_prefix(std::min(behind + 1, rest.size()));
    }
}

void forEachXmlTag(std::string_view text, const std::function<void(const XmlTag&)>& visit) {
    for (std::size_t i = 0; (i = text.find('<', i)) < text.size();) {
        const std::string_view rest = text.substr(i);
        if (rest.starts_with("<!--")) {
            i = placeBehind(text, "-->", i + 4);
        } else if (rest.starts_with("<![CDATA[")) {
            i = placeBehind(text, "]]>", i);
        } else if (rest.starts_with("<?")) {
            i = placeBehind(text, "?>", i);
        } else if (rest.starts_with("<!")) {
            i = behindDoctype(text, i);
        } else {
            const XmlTag tag = tagAt(text, i);
            visit(tag);
            i = tag.end;
        }
    }
}

}  // namespace bandvox
