#include "source/channel_choice.h"

#include "core/words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace bandvox {

namespace {

// Of ITU-R BT.709; the numbers are taken as they are stored.
constexpr std::array kLuminance{0.2126F, 0.7152F, 0.0722F};

std::string listOf(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

int indexOf(const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

// By name or by number; -1 if there is none.
int channelNamed(const std::vector<std::string>& names, const std::string& asked) {
    if (const int index = indexOf(names, asked); index >= 0) return index;
    int number = 0;
    const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
    const bool isNumber = error == std::errc() && end == asked.data() + asked.size();
    return isNumber && number >= 0 && number < static_cast<int>(names.size()) ? number : -1;
}

}  // namespace

ChannelChoice::ChannelChoice(const std::string& name, const SliceFileInfo& info,
                             const std::string& asked)
    : mNames(info.channels) {
    if (asked == "luminance") {
        mWay = Way::Luminance;
        mCount = static_cast<int>(mNames.size());
        for (const char* color : {"R", "G", "B"}) mColors.push_back(indexOf(mNames, color));
        if (*std::min_element(mColors.begin(), mColors.end()) < 0) {
            throw Error(ErrorKind::Usage, "the luminance of " + name +
                                              " was asked for, and its channels are " +
                                              listOf(mNames) + "; expected R, G and B");
        }
        return;
    }
    if (!asked.empty()) {
        mFirst = channelNamed(mNames, asked);
        if (mFirst >= 0) return;
        throw Error(ErrorKind::Usage, "the channel '" + asked + "' of " + name +
                                          " was asked for, and its channels are " + listOf(mNames) +
                                          "; expected one of them, or a number "
                                          "from 0");
    }
    if (mNames.size() == 1) return;
    mWay = Way::Equal;
    mCount = static_cast<int>(mNames.size());
    mAlpha = indexOf(mNames, "A");
    for (int i = 0; i < mCount; ++i) {
        if (i != mAlpha) mColors.push_back(i);
    }
}

void ChannelChoice::combine(std::span<const float> from, std::span<float> to, float full,
                            const std::string& where, int width) const {
    if (mWay == Way::One) {
        std::copy(from.begin(), from.end(), to.begin());
        return;
    }
    for (std::size_t i = 0; i < to.size(); ++i) {
        const float* pixel = &from[i * mCount];
        if (mWay == Way::Luminance) {
            to[i] = kLuminance[0] * pixel[mColors[0]] + kLuminance[1] * pixel[mColors[1]] +
                    kLuminance[2] * pixel[mColors[2]];
            continue;
        }
        to[i] = pixel[mColors.front()];
        int odd = -1;
        for (const int color : mColors) {
            if (pixel[color] != to[i]) odd = color;
        }
        if (mAlpha >= 0 && pixel[mAlpha] != full) odd = mAlpha;
        if (odd < 0) continue;
        const int y = static_cast<int>(i) / width, x = static_cast<int>(i) % width;
        std::string message = where + ": its pixel (" + std::to_string(x) + ", ";
        message += std::to_string(y) + ") has " + mNames[odd] + " = " + inShort(pixel[odd]);
        message += odd == mAlpha ? " and is transparent"
                                 : " and " + mNames[mColors.front()] + " = " + inShort(to[i]);
        message += "; expected equal channels, or one that is chosen (--channel) of ";
        throw Error(ErrorKind::Input, message + listOf(mNames));
    }
}

}  // namespace bandvox
