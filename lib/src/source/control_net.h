#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace bandvox {

/// Control points of kRows coordinates; those of a bicubic patch need no memory of their own.
template <std::size_t kRows>
class ControlNet {
  public:
    using Point = std::array<double, kRows>;

    ControlNet() = default;
    explicit ControlNet(std::size_t count) { resize(count); }
    ControlNet(const ControlNet& other) { *this = other; }
    ControlNet& operator=(const ControlNet& other) {
        if (this == &other) return *this;
        resize(other.mCount);
        std::copy(other.begin(), other.end(), begin());
        return *this;
    }
    ControlNet(ControlNet&& other) noexcept : mCount(other.mCount) {
        if (mCount > kFew) {
            mMany = std::move(other.mMany);
        } else {
            std::copy_n(other.mFew.begin(), mCount, mFew.begin());
        }
    }
    ControlNet& operator=(ControlNet&& other) noexcept {
        mCount = other.mCount;
        if (mCount > kFew) {
            mMany = std::move(other.mMany);
        } else {
            std::copy_n(other.mFew.begin(), mCount, mFew.begin());
        }
        return *this;
    }
    ~ControlNet() = default;

    void resize(std::size_t count) {
        mCount = count;
        if (count > kFew) mMany.resize(count);
    }
    std::size_t size() const { return mCount; }
    bool empty() const { return mCount == 0; }
    Point* begin() { return mCount > kFew ? mMany.data() : mFew.data(); }
    const Point* begin() const { return mCount > kFew ? mMany.data() : mFew.data(); }
    Point* end() { return begin() + mCount; }
    const Point* end() const { return begin() + mCount; }
    Point& operator[](std::size_t k) { return begin()[k]; }
    const Point& operator[](std::size_t k) const { return begin()[k]; }

  private:
    static constexpr std::size_t kFew = 16;
    std::size_t mCount = 0;
    std::array<Point, kFew> mFew;  // left as it is until there are points
    std::vector<Point> mMany;
};

/// Replaces points of a curve, `step` apart, by those of its first half; writes those of the
/// second.
template <std::size_t kRows>
void halveLine(std::array<double, kRows>* low, std::array<double, kRows>* high, int degree,
               std::ptrdiff_t step) {
    high[degree * step] = low[degree * step];
    for (int r = 1; r <= degree; ++r) {
        for (int i = degree; i >= r; --i) {
            auto& here = low[i * step];
            const auto& before = low[(i - 1) * step];
            for (std::size_t c = 0; c < kRows; ++c) here[c] = 0.5 * (here[c] + before[c]);
        }
        high[(degree - r) * step] = low[degree * step];
    }
}

/// Replaces a net of (m + 1) * (n + 1) points, [u][v], by its half of low u, or v; returns the
/// other one.
template <std::size_t kRows>
ControlNet<kRows> halveNet(ControlNet<kRows>& net, int m, int n, bool alongU) {
    ControlNet<kRows> high(net.size());
    if (alongU) {
        for (int j = 0; j <= n; ++j) halveLine(net.begin() + j, high.begin() + j, m, n + 1);
    } else {
        for (int i = 0; i <= m; ++i) {
            const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(i) * (n + 1);
            halveLine(net.begin() + k, high.begin() + k, n, 1);
        }
    }
    return high;
}

}  // namespace bandvox
