#pragma once

#include "core/slice_files.h"

#include <span>
#include <string>
#include <vector>

namespace bandvox {

/// Which channels of an image are read, and how they become one number.
class ChannelChoice {
  public:
    /// `asked` as ArrayReadOptions::channel. Throws Error(ErrorKind::Usage) if the images of
    /// `name` have no such channel.
    ChannelChoice(const std::string& name, const SliceFileInfo& info, const std::string& asked);

    int first() const { return mFirst; }
    int count() const { return mCount; }

    /// Takes [pixel][count] values, of which `full` is an alpha that hides nothing. Throws
    /// Error(ErrorKind::Input) where colours differ, or something is transparent, and no channel
    /// was asked for. `where` names the slice.
    void combine(std::span<const float> from, std::span<float> to, float full,
                 const std::string& where, int width) const;

  private:
    enum class Way { One, Equal, Luminance } mWay = Way::One;
    int mFirst = 0, mCount = 1;
    std::vector<int> mColors;         // of those that are read
    int mAlpha = -1;                  // the same; -1: none
    std::vector<std::string> mNames;  // of all
};

}  // namespace bandvox
