#include "scatter/net_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

constexpr std::size_t kNumbersInPiece = std::size_t(1) << 14;

/// y += factor * x.
void addScaled(std::span<double> y, double factor, std::span<const double> x) {
    forPieces(y.size(), kNumbersInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) y[i] += factor * x[i];
    });
}

/// y = x + factor * y.
void scaleAndAdd(std::span<double> y, double factor, std::span<const double> x) {
    forPieces(y.size(), kNumbersInPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) y[i] = x[i] + factor * y[i];
    });
}

}  // namespace

NetSolver::NetSolver(NetStencil stencil, std::size_t largestFactored) {
    // The coarsest may be larger than what pays if it cannot be coarsened.
    const bool isFactored = stencil.count() <= std::max(largestFactored, kSmallEnough);
    mLevels.push_back(std::move(stencil));
    while (!isFactored && mLevels.back().canCoarsen() && mLevels.back().count() > kSmallEnough) {
        mLevels.push_back(mLevels.back().coarsened());
    }
    mFactor.emplace(mLevels.back());
}

void NetSolver::cycle(std::size_t level, std::span<const double> b, std::span<double> x) const {
    if (level + 1 == mLevels.size()) {
        mFactor->solve(b, x);
        return;
    }
    const NetStencil& fine = mLevels[level];
    const NetStencil& coarse = mLevels[level + 1];
    std::fill(x.begin(), x.end(), 0);
    fine.relax(b, x, true);
    std::vector<double> residual(x.size());
    fine.multiply(x, residual);
    scaleAndAdd(residual, -1, b);
    std::vector<double> below(coarse.count());
    restrictNet(coarse.points(), fine.points(), residual, below);
    std::vector<double> correction(coarse.count());
    cycle(level + 1, below, correction);
    prolongate(coarse.points(), fine.points(), correction, residual);
    addScaled(x, 1, residual);
    fine.relax(b, x, false);
}

int NetSolver::solve(std::span<const double> b, std::span<double> x, const Stop& stop,
                     Progress& progress) const {
    const NetStencil& matrix = stencil();
    if (mLevels.size() == 1) {
        mFactor->solve(b, x);
        return 1;
    }
    std::vector<double> residual(x.size()), image(x.size()), better(x.size()), direction;
    matrix.multiply(x, residual);
    scaleAndAdd(residual, -1, b);
    cycle(0, residual, better);
    direction = better;
    double measure = dotProduct(residual, better);
    const double enough = stop.reduction * stop.reduction * measure;
    int step = 0;
    for (; step < stop.steps && measure > enough; ++step) {
        progress.throwIfInterrupted();
        matrix.multiply(direction, image);
        const double curvature = dotProduct(direction, image);
        if (!(curvature > 0)) break;
        const double length = measure / curvature;
        addScaled(x, length, direction);
        addScaled(residual, -length, image);
        cycle(0, residual, better);
        const double next = dotProduct(residual, better);
        scaleAndAdd(direction, next / measure, better);
        measure = next;
    }
    return step;
}

}  // namespace bandvox
