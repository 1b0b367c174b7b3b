#pragma once

#include "command_line.h"
#include "option_table.h"

#include <bandvox/source/array_source.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

// Arrays, stacks of images and DICOM series as inputs.
namespace bandvox::app {

/// The options --channel, --series, --spacing, --origin and --space.
std::vector<OptionEntry> stackEntries();

/// What these options ask for.
struct StackRequest {
    ArrayReadOptions options;
    std::optional<openvdb::Vec3d> spacing, origin;
    std::string space;  ///< "LPS", "RAS", or empty: as it is
};

/// Throws Error(ErrorKind::Usage) for values that are none, and if one other than --space was given
/// and the input is no array.
StackRequest readStackRequest(const CommandLine& line, const std::string& input);

/// True if the input is an array, an image, a pattern of them, a folder, or of DICOM.
bool isStackInput(const std::string& input);

/// Opens the array and puts it where it is asked for. Throws what openArray does.
std::unique_ptr<ArraySource> openStack(const std::string& input, const StackRequest& request);

/// What is said of an array, a line each.
std::vector<std::string> arrayInWords(const ArrayInfo& info);

}  // namespace bandvox::app
