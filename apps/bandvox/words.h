#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bandvox::app {

/// A number with up to `digits` significant digits.
std::string formatNumber(double value, int digits = 6);

/// "(x, y, z)".
std::string formatVector(const openvdb::Vec3d& vector, int digits = 6);

/// "2 x 3 x 4".
std::string formatSize(const openvdb::Coord& size);

/// A size with a unit that keeps it readable: "512 bytes", "3.2 MB" (powers of ten).
std::string formatBytes(std::int64_t bytes);

/// "1 hole", "3 holes": `one` is the word for one of them, `many` for several.
std::string formatCount(std::int64_t count, const std::string& one, const std::string& many);

/// All strings in one, with `separator` between them.
std::string joined(const std::vector<std::string>& strings, const std::string& separator);

/// The text with its control characters written out, as in "two\nlines": a name from a file must
/// neither break a line nor steer a terminal.
std::string printable(const std::string& text);

/// A word of a command as a shell takes it: in single quotes if it would split or expand it.
std::string shellWord(const std::string& text);

/// ASCII letters in lower case.
std::string lowerCase(std::string text);

}  // namespace bandvox::app
