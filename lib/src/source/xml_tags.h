#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace bandvox {

/// A tag of an XML text.
struct XmlTag {
    enum class Kind { Open, Close, Empty } kind;
    std::string_view name;
    std::string_view attributes;  ///< what stands between the name and the end
    std::size_t end;              ///< the place behind it

    /// The value of an attribute, without its quotes; nothing if the tag has none of that name.
    std::optional<std::string_view> attribute(std::string_view wanted) const;
};

/// Calls visit with each tag, from the first to the last. Comments, instructions, declarations and
/// character data are none. Of a damaged text these are what a parser meets up to the damage, at
/// least.
void forEachXmlTag(std::string_view text, const std::function<void(const XmlTag&)>& visit);

}  // namespace bandvox
