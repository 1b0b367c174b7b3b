#include "render/environment.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bandvox {

using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

namespace {

// The nine spherical harmonics of order 0 to 2.
std::array<double, 9> harmonics(const Vec3d& d) {
    return {0.282095,
            0.488603 * d[1],
            0.488603 * d[2],
            0.488603 * d[0],
            1.092548 * d[0] * d[1],
            1.092548 * d[1] * d[2],
            0.315392 * (3 * d[2] * d[2] - 1),
            1.092548 * d[0] * d[2],
            0.546274 * (d[0] * d[0] - d[1] * d[1])};
}

// What the cosine makes of each order, over π.
constexpr std::array<double, 9> kCosineLobe{1,    2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25,
                                            0.25, 0.25,    0.25,    0.25};

double brightness(const Vec3d& color) {
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

// Where in a rising sequence from 0 to 1 a number lies: the step, and the part of it.
std::pair<int, double> findIn(const double* sums, int steps, double u) {
    const double* above = std::upper_bound(sums, sums + steps + 1, u);
    const int step = std::clamp(static_cast<int>(above - sums) - 1, 0, steps - 1);
    const double width = sums[step + 1] - sums[step];
    return {step, width > 0 ? std::clamp((u - sums[step]) / width, 0.0, 1.0) : 0.5};
}

}  // namespace

EnvironmentMap::EnvironmentMap(PixelArray pixels, double turn, const std::string& name)
    : mPixels(std::move(pixels)),
      mSine(std::sin(turn * pi / 180)),
      mCosine(std::cos(turn * pi / 180)) {
    const int width = mPixels.width, height = mPixels.height;
    for (const float value : mPixels.values) {
        if (value >= 0 && std::isfinite(value)) continue;
        throw Error(ErrorKind::Input, name + ": a pixel is " + std::to_string(value) +
                                          "; expected light, 0 or more and finite");
    }
    // Sum up the brightness, and project on the harmonics.
    mRows.assign(height + 1, 0.0);
    mColumns.assign(static_cast<std::size_t>(height) * (width + 1), 0.0);
    for (int row = 0; row < height; ++row) {
        const double area =
            2 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
        double* sums = &mColumns[static_cast<std::size_t>(row) * (width + 1)];
        for (int column = 0; column < width; ++column) {
            const Vec3d light = pixel(column, row);
            // A trace everywhere, since between a bright and a black pixel there is light.
            sums[column + 1] = sums[column] + brightness(light) + 1e-12;
        }
        const double total = sums[width];
        mRows[row + 1] = mRows[row] + total * area;
        for (int column = 0; column <= width; ++column) sums[column] /= total;
    }
    const double total = mRows[height];
    for (double& sum : mRows) sum /= total;
    project();
}

// Small maps are looked at between their pixels, too: these are what light is interpolated between.
void EnvironmentMap::project() {
    constexpr int kLeastHeight = 64;
    const int rows = mPixels.height * std::max((kLeastHeight - 1) / mPixels.height + 1, 1);
    const int columns = mPixels.width * std::max((2 * kLeastHeight - 1) / mPixels.width + 1, 1);
    for (int row = 0; row < rows; ++row) {
        const double polar = pi * (row + 0.5) / rows;
        const double area =
            2 * pi / columns * (std::cos(pi * row / rows) - std::cos(pi * (row + 1) / rows));
        for (int column = 0; column < columns; ++column) {
            const double around = 2 * pi * (column + 0.5) / columns - pi;
            const Vec3d direction(std::sin(polar) * std::sin(around), std::cos(polar),
                                  -std::sin(polar) * std::cos(around));
            const auto basis = harmonics(direction);
            const Vec3d light = area * inMap(direction);
            for (int i = 0; i < 9; ++i) mHarmonics[i] += basis[i] * light;
        }
    }
}

Vec3d EnvironmentMap::pixel(int column, int row) const {
    const float* values =
        &mPixels
             .values[(static_cast<std::size_t>(row) * mPixels.width + column) * mPixels.channels];
    if (mPixels.channels < 3) return Vec3d(values[0]);
    return {values[0], values[1], values[2]};
}

Vec3d EnvironmentMap::toMap(const Vec3d& d) const {
    return {mCosine * d[0] - mSine * d[2], d[1], mSine * d[0] + mCosine * d[2]};
}

// In pixels, of a direction of the map.
Vec2d EnvironmentMap::placeOf(const Vec3d& d) const {
    const double around = std::atan2(d[0], -d[2]) / (2 * pi) + 0.5;
    return {around * mPixels.width, std::acos(std::clamp(d[1], -1.0, 1.0)) / pi * mPixels.height};
}

Vec3d EnvironmentMap::radiance(const Vec3d& direction) const {
    return inMap(toMap(direction));
}

Vec3d EnvironmentMap::inMap(const Vec3d& direction) const {
    const Vec2d place = placeOf(direction);
    const double x = place[0] - 0.5, y = std::clamp(place[1] - 0.5, 0.0, mPixels.height - 1.0);
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(y);
    const double right = x - column, down = y - row;
    const int left = (column + mPixels.width) % mPixels.width;
    const int next = (left + 1) % mPixels.width, below = std::min(row + 1, mPixels.height - 1);
    return (1 - down) * ((1 - right) * pixel(left, row) + right * pixel(next, row)) +
           down * ((1 - right) * pixel(left, below) + right * pixel(next, below));
}

Vec3d EnvironmentMap::irradiance(const Vec3d& normal) const {
    const auto basis = harmonics(toMap(normal));
    Vec3d sum(0.0);
    for (int i = 0; i < 9; ++i) sum += kCosineLobe[i] * basis[i] * mHarmonics[i];
    return {std::max(sum[0], 0.0), std::max(sum[1], 0.0), std::max(sum[2], 0.0)};
}

Vec3d EnvironmentMap::mean() const {
    return harmonics({0, 1, 0})[0] * mHarmonics[0];
}

EnvironmentMap::Sample EnvironmentMap::sample(const Vec2d& u) const {
    const auto [row, down] = findIn(mRows.data(), mPixels.height, u[0]);
    const double* sums = &mColumns[static_cast<std::size_t>(row) * (mPixels.width + 1)];
    const auto [column, right] = findIn(sums, mPixels.width, u[1]);
    // Within a row places are spread evenly over the sphere.
    const double high = std::cos(pi * row / mPixels.height);
    const double low = std::cos(pi * (row + 1) / mPixels.height);
    const double y = high + down * (low - high);
    const double across = std::sqrt(std::max(1 - y * y, 0.0));
    const double around = 2 * pi * (column + right) / mPixels.width - pi;
    const Vec3d d(across * std::sin(around), y, -across * std::cos(around));
    const Vec3d direction(mCosine * d[0] + mSine * d[2], d[1], -mSine * d[0] + mCosine * d[2]);
    return {direction, density(direction)};
}

double EnvironmentMap::density(const Vec3d& direction) const {
    const Vec2d place = placeOf(toMap(direction));
    const int column = std::clamp(static_cast<int>(place[0]), 0, mPixels.width - 1);
    const int row = std::clamp(static_cast<int>(place[1]), 0, mPixels.height - 1);
    const double* sums = &mColumns[static_cast<std::size_t>(row) * (mPixels.width + 1)];
    const double area =
        2 * pi / mPixels.width *
        (std::cos(pi * row / mPixels.height) - std::cos(pi * (row + 1) / mPixels.height));
    return (mRows[row + 1] - mRows[row]) * (sums[column + 1] - sums[column]) / area;
}

std::shared_ptr<const EnvironmentMap> readEnvironmentMap(const std::filesystem::path& path,
                                                         double turn) {
    return std::make_shared<const EnvironmentMap>(imageLibrary().read(path), turn, path.string());
}

}  // namespace bandvox
