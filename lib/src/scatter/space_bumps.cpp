#include "scatter/space_bumps.h"

#include "scatter/net_stencil.h"

#include <cmath>

namespace bandvox {
namespace {

/// The cubic B-spline with knots 1/2 apart, 1 at 0 and 0 from 1 on.
double bumpProfile(double t) {
    const double u = 2 * std::abs(t);
    if (u >= 2) return 0;
    if (u <= 1) return 1 + u * u * (0.75 * u - 1.5);
    const double rest = 2 - u;
    return rest * rest * rest / 4;
}

/// Its derivative.
double bumpSlope(double t) {
    const double u = 2 * std::abs(t);
    if (u >= 2) return 0;
    const double slope = u <= 1 ? u * (2.25 * u - 3) : -0.75 * (2 - u) * (2 - u);
    return t < 0 ? -2 * slope : 2 * slope;
}

/// Calls body(other) for the points in the cells around that of point `i`.
template <typename Body>
void forOthers(const SortedSpacePoints& points, const OccupiedCells& cells, std::size_t i,
               const Body& body) {
    const SpaceNet::Place own = points.cell(i, cells.level());
    for (int k = 0; k < 27; ++k) {
        const auto [begin, end] =
            cells.pointsOf({own[0] + k / 9 - 1, own[1] + k / 3 % 3 - 1, own[2] + k % 3 - 1});
        for (std::uint32_t other = begin; other < end; ++other) {
            if (other != i) body(other);
        }
    }
}

}  // namespace

double bumpHeight(const std::array<double, 3>& offset, double radius) {
    return bumpProfile(offset[0] / radius) * bumpProfile(offset[1] / radius) *
           bumpProfile(offset[2] / radius);
}

std::array<double, 3> bumpGradient(const std::array<double, 3>& offset, double radius) {
    std::array<double, 3> gradient{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        gradient[axis] = 1 / radius;
        for (std::size_t a = 0; a < 3; ++a) {
            const double t = offset[a] / radius;
            gradient[axis] *= a == axis ? bumpSlope(t) : bumpProfile(t);
        }
    }
    return gradient;
}

double sharedCells(const SortedSpacePoints& points, const OccupiedCells& cells) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [begin, end] = cells.pointsOf(points.cell(i, cells.level()));
        sum += end - begin - 1;
    }
    return sum;
}

SpaceBumps::SpaceBumps(const SortedSpacePoints& points, int level) : mStart(points.size() + 1) {
    const OccupiedCells cells(points, level);
    const double radius = std::ldexp(1.0, -level);
    const auto heightAt = [&](std::size_t i, std::size_t other) {
        const auto& a = points.at[i];
        const auto& b = points.at[other];
        return bumpHeight({a[0] - b[0], a[1] - b[1], a[2] - b[2]}, radius);
    };
    constexpr std::size_t kPointsInPiece = 2048;
    forPieces(points.size(), kPointsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            forOthers(points, cells, i, [&](std::uint32_t other) {
                if (heightAt(i, other) > 0) ++mStart[i + 1];
            });
        }
    });
    for (std::size_t i = 0; i < points.size(); ++i) mStart[i + 1] += mStart[i];
    mOthers.resize(mStart.back());
    mHeights.resize(mStart.back());
    forPieces(points.size(), kPointsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t to = mStart[i];
            forOthers(points, cells, i, [&](std::uint32_t other) {
                const double height = heightAt(i, other);
                if (height <= 0) return;
                mOthers[to] = other;
                mHeights[to++] = height;
            });
        }
    });
}

void SpaceBumps::evaluate(std::span<const double> sizes, std::span<double> values) const {
    constexpr std::size_t kPointsInPiece = 8192;
    forPieces(values.size(), kPointsInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double sum = sizes[i];
            for (std::size_t k = mStart[i]; k < mStart[i + 1]; ++k) {
                sum += mHeights[k] * sizes[mOthers[k]];
            }
            values[i] = sum;
        }
    });
}

std::vector<double> SpaceBumps::sizes(std::span<const double> values, double tolerance, int steps,
                                      Progress& progress) const {
    // Every bump is 1 at its point, so the diagonal is 1.
    std::vector<double> result(values.size()), residual(values.begin(), values.end());
    std::vector<double> direction = residual, image(values.size());
    double measure = dotProduct(residual, residual);
    for (int step = 0; step < steps; ++step) {
        progress.throwIfInterrupted();
        const bool isReached = std::all_of(residual.begin(), residual.end(), [&](double number) {
            return std::abs(number) <= tolerance;
        });
        if (isReached) break;
        evaluate(direction, image);
        const double curvature = dotProduct(direction, image);
        if (!(curvature > 0)) break;
        const double length = measure / curvature;
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        const double next = dotProduct(residual, residual);
        const double turn = next / measure;
        for (std::size_t i = 0; i < result.size(); ++i) {
            direction[i] = residual[i] + turn * direction[i];
        }
        measure = next;
    }
    return result;
}

}  // namespace bandvox
