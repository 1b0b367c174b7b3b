#pragma once

namespace bandvox {

/// ⌊x⌋ for |x| < 2³¹, without the call that std::floor is on machines of any age.
inline int floorToInt(double x) {
    const int towardsZero = static_cast<int>(x);
    return towardsZero - static_cast<int>(x < towardsZero);
}

}  // namespace bandvox
