#pragma once

#include "source/file_integrity.h"

#include <cstddef>
#include <string_view>

namespace bandvox {

/// How deep a mesh file may nest what is in it. Parsers call themselves once and more for each
/// level, and what is made to be deep ends with their stack. Honest files have a few tens.
constexpr std::size_t kDeepestNesting = 500;

/// The deepest nesting of arrays and objects in JSON.
std::size_t jsonDepth(std::string_view text);

/// The deepest nesting of elements in XML.
std::size_t xmlDepth(std::string_view text);

/// The deepest nesting of records in an FBX file, text or binary. Of a damaged one, up to where the
/// importer will find that.
std::size_t fbxDepth(std::string_view bytes);

/// Complains if that is deeper than kDeepestNesting.
void requireShallow(const FileContents& file, std::size_t depth);

}  // namespace bandvox
