#include <bandvox/source/texture.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

constexpr float kOne = 65535;

/// The texels along an axis of n that a texel of half as many covers, and how much of each.
struct Cover {
    int first;
    std::vector<double> weight;  // they add up to 1
};

std::vector<Cover> coversOf(int size, int halfSize) {
    std::vector<Cover> covers;
    const double scale = static_cast<double>(size) / halfSize;
    for (int i = 0; i < halfSize; ++i) {
        const double begin = i * scale;
        const double end = begin + scale;
        Cover cover{static_cast<int>(begin), {}};
        for (int k = cover.first; k < size && k < end; ++k) {
            cover.weight.push_back((std::min(end, k + 1.0) - std::max<double>(begin, k)) / scale);
        }
        covers.push_back(std::move(cover));
    }
    return covers;
}

/// Index i of a picture that goes on beyond its edges as `wrap` says.
int wrapped(double i, int size, TextureWrap wrap) {
    if (wrap == TextureWrap::Clamp) {
        return static_cast<int>(std::clamp<double>(i, 0, size - 1));
    }
    const int period = wrap == TextureWrap::Mirror ? 2 * size : size;
    const int at = static_cast<int>(i - period * std::floor(i / period));
    // Rounding may end on the period itself, far out.
    const int inside = std::min(at, period - 1);
    return inside < size ? inside : period - 1 - inside;
}

/// Two texels along an axis, and how much the second of them counts.
struct Between {
    int first, second;
    float part;
};

Between betweenTexels(double at, int size, TextureWrap wrap) {
    const double place = at * size - 0.5;
    const double below = std::floor(place);
    return {wrapped(below, size, wrap), wrapped(below + 1, size, wrap),
            static_cast<float>(place - below)};
}

}  // namespace

Texture::Texture(int width, int height, std::vector<std::uint16_t> rgb) {
    assert(rgb.size() == static_cast<std::size_t>(width) * height * 3);
    mLevels.push_back({width, height, std::move(rgb)});
    while (mLevels.back().width > 1 || mLevels.back().height > 1) {
        mLevels.push_back(halved(mLevels.back()));
    }
}

// A side that is odd does not halve into whole texels, so they count by the part that is covered.
Texture::Level Texture::halved(const Level& level) {
    Level half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
    half.rgb.reserve(static_cast<std::size_t>(half.width) * half.height * 3);
    const std::vector<Cover> columns = coversOf(level.width, half.width);
    for (const Cover& row : coversOf(level.height, half.height)) {
        for (const Cover& column : columns) {
            double sum[3] = {0, 0, 0};
            for (std::size_t y = 0; y < row.weight.size(); ++y) {
                const std::uint16_t* texel =
                    level.rgb.data() +
                    3 * ((row.first + y) * static_cast<std::size_t>(level.width) + column.first);
                for (const double weight : column.weight) {
                    for (double& channel : sum) channel += row.weight[y] * weight * *texel++;
                }
            }
            for (const double channel : sum) {
                half.rgb.push_back(static_cast<std::uint16_t>(std::lround(channel)));
            }
        }
    }
    return half;
}

openvdb::Vec3f Texture::sample(const openvdb::Vec2d& at, const TextureWraps& wraps,
                               int level) const {
    const Level& texels = mLevels[level];
    const Between u = betweenTexels(at.x(), texels.width, wraps.u);
    const Between v = betweenTexels(1 - at.y(), texels.height, wraps.v);
    const auto texel = [&](int x, int y) {
        const std::uint16_t* rgb =
            texels.rgb.data() + 3 * (y * static_cast<std::size_t>(texels.width) + x);
        return openvdb::Vec3f(rgb[0], rgb[1], rgb[2]);
    };
    const auto row = [&](int y) {
        return (1 - u.part) * texel(u.first, y) + u.part * texel(u.second, y);
    };
    return ((1 - v.part) * row(v.first) + v.part * row(v.second)) / kOne;
}

}  // namespace bandvox
