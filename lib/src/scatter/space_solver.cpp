#include "scatter/space_solver.h"

#include "scatter/net_stencil.h"

#include <cmath>
#include <utility>

namespace bandvox {
namespace {

/// The mean sum of squares of the 64 splines at a point.
constexpr double kSpaceWeight = 151.0 / 315 * 151.0 / 315 * 151.0 / 315;

constexpr std::size_t kSpacePiece = std::size_t(1) << 14U;

DifferenceWeights weightsOfLevel(int level, double tension, double factor) {
    return DifferenceWeights::ofTension(tension, std::ldexp(1.0, -level), factor);
}

/// The factor of the energy that gives a control point of a level so much of it.
double factorOfStiffness(int level, double tension, double stiffness) {
    return stiffness * kSpaceWeight / weightsOfLevel(level, tension, 1).diagonal();
}

}  // namespace

SpaceNets makeSpaceNets(SpaceNet finest, int level, int coarsest, const Progress& progress) {
    SpaceNets result;
    result.finest = level;
    result.nets.push_back(std::move(finest));
    for (; level > coarsest; --level) result.nets.push_back(result.nets.back().parents(progress));
    std::reverse(result.nets.begin(), result.nets.end());
    return result;
}

SpaceSolver::SpaceSolver(const SpaceNets& nets, int level, const SortedSpacePoints& points,
                         double tension, double stiffness)
    : mNets(nets),
      mLevel(level),
      mPoints(points, nets.ofLevel(level), level),
      mEnergy(nets.ofLevel(level),
              weightsOfLevel(level, tension, factorOfStiffness(level, tension, stiffness))) {
    const double factor = factorOfStiffness(level, tension, stiffness);
    for (int l = nets.coarsest(); l <= level; ++l) {
        const SpaceNet& net = nets.ofLevel(l);
        auto& inverse = mInverse.emplace_back(net.numbers());
        SpacePoints(points, net, l).addDiagonal(inverse);
        SpaceEnergy(net, weightsOfLevel(l, tension, factor)).addDiagonal(inverse);
        for (double& number : inverse) number = number > 0 ? 1 / number : 0;
    }
}

void SpaceSolver::multiply(std::span<const double> x, std::span<double> y) const {
    std::fill(y.begin(), y.end(), 0.0);
    mPoints.addNormal(x, y);
    mEnergy.addTo(x, y);
}

void SpaceSolver::precondition(std::span<const double> residual, std::span<double> result) const {
    const std::size_t count = mInverse.size();
    std::vector<std::vector<double>> parts(count);
    parts[count - 1].assign(residual.begin(), residual.end());
    for (std::size_t l = count - 1; l > 0; --l) {
        parts[l - 1].resize(mInverse[l - 1].size());
        restrictSpace(mNets.nets[l - 1], mNets.nets[l], parts[l], parts[l - 1]);
    }
    std::vector<double> sum;
    for (std::size_t l = 0; l < count; ++l) {
        std::vector<double> finer(parts[l].size());
        if (l > 0) prolongSpace(mNets.nets[l - 1], mNets.nets[l], sum, finer);
        for (std::size_t i = 0; i < finer.size(); ++i) finer[i] += mInverse[l][i] * parts[l][i];
        sum = std::move(finer);
    }
    std::copy(sum.begin(), sum.end(), result.begin());
}

int SpaceSolver::solve(std::span<const double> b, std::span<double> x, const Stop& stop,
                       Progress& progress) const {
    std::vector<double> residual(x.size()), image(x.size()), better(x.size());
    multiply(x, residual);
    forPieces(x.size(), kSpacePiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) residual[i] = b[i] - residual[i];
    });
    precondition(residual, better);
    std::vector<double> direction = better;
    double measure = dotProduct(residual, better);
    const double enough = stop.reduction * stop.reduction * measure;
    int step = 0;
    for (; step < stop.steps && measure > enough; ++step) {
        progress.throwIfInterrupted();
        multiply(direction, image);
        const double curvature = dotProduct(direction, image);
        if (!(curvature > 0)) break;
        const double length = measure / curvature;
        forPieces(x.size(), kSpacePiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                x[i] += length * direction[i];
                residual[i] -= length * image[i];
            }
        });
        precondition(residual, better);
        const double next = dotProduct(residual, better);
        const double turn = next / measure;
        forPieces(x.size(), kSpacePiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                direction[i] = better[i] + turn * direction[i];
        });
        measure = next;
    }
    return step;
}

}  // namespace bandvox
