#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bandvox::app {

/// Numbers from `first` to `last`, both included, in steps.
struct FrameRange {
    int first, last, step;

    std::vector<int> numbers() const;
};

/// Reads "7", "1-100" or "1-100x2"; nothing if it is none of these.
std::optional<FrameRange> parseFrames(const std::string& text);

/// True if a name has a place for the number of a frame: a run of '#', or "%d" or "%04d". There is
/// no file of that very name.
bool hasFrame(const std::string& name);

/// The name with a frame's number in that place, with zeros in front as the pattern has it. Names
/// without such a place stay as they are.
std::string withFrame(const std::string& name, int frame);

/// The numbers of the frames of a name that has a place for one which are there as files, in
/// order; at most kMostFrame.
std::vector<int> framesOnDisk(const std::string& name);

/// The largest number of a frame.
inline constexpr int kMostFrame = 1000000;

}  // namespace bandvox::app
