#include "scatter/fit_problem.h"
#include "scatter/mend_residual.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace bandvox {
namespace {

constexpr int kFinestLevel = 12;
constexpr double kStiffness = 1e-2;

void checkFitOptions(const FitSurfaceOptions& options) {
    const auto fail = [](const std::string& name, double found, const std::string& expected) {
        std::string message = name + " of a fit is ";
        message += std::to_string(found) + "; expected ";
        message += expected;
        throw Error(ErrorKind::Usage, message);
    };
    if (!(options.tolerance >= 0 && options.tolerance <= 1)) {
        fail("the tolerance", options.tolerance, "0 to 1");
    }
    if (!(options.noise >= 0 && std::isfinite(options.noise))) {
        fail("the noise", options.noise, "0 or more");
    }
    if (options.maxLevel && (*options.maxLevel < 1 || *options.maxLevel > 13)) {
        fail("the finest level", *options.maxLevel, "1 to 13");
    }
    if (options.tension && !(*options.tension >= 0.01 && *options.tension <= 1e4)) {
        fail("the tension", *options.tension, "0.01 to 10000");
    }
}

void checkInside(const ScatteredPoints& points, const Rectangle& r) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = points.x[i];
        const double y = points.y[i];
        if (x >= r.x0 && x <= r.x1 && y >= r.y0 && y <= r.y1) continue;
        std::string message = "the place (" + std::to_string(x) + ", ";
        message += std::to_string(y) + ") is outside the rectangle from (";
        message += std::to_string(r.x0) + ", " + std::to_string(r.y0) + ") to (";
        message += std::to_string(r.x1) + ", " + std::to_string(r.y1) + "); expected all inside";
        throw Error(ErrorKind::Input, message);
    }
}

using Columns = std::vector<std::vector<double>>;

/// What is being fitted, from level to level.
class Fitting {
  public:
    Fitting(UnitPoints unit, const FitSurfaceOptions& options, Progress& progress)
        : mUnit(std::move(unit)), mOptions(options), mProgress(progress),
          mLacking(mUnit.values.size(), std::vector<double>(mUnit.points.size())) {}

    SurfaceFit run();

  private:
    int finestOfData() const;
    void fitLevel(int level);
    void interpolate(int level);
    void mend(int level);
    void solveColumns(const NetSolver& solver, const NetPoints& points, const Columns& targets,
                      double reduction);
    void measure(const NetPoints& points);
    void enterLevel(const NetShape& shape);
    void keepLevel(int level);
    BsplineSurface surfaceOf(const NetShape& shape, const Columns& nets) const;
    bool isReached() const { return mLargest <= mOptions.tolerance; }

    UnitPoints mUnit;
    const FitSurfaceOptions& mOptions;
    Progress& mProgress;
    NetShape mShape;    // of the nets
    Columns mNets;      // control points of all levels so far
    Columns mLacking;   // of each point's values
    double mLargest = 1, mRms = 1;
    SurfaceFit mFit;
};

/// Where the tension and the points' distances are resolved.
int Fitting::finestOfData() const {
    const auto count = static_cast<double>(mUnit.points.size());
    constexpr double kFew = 3000;
    const double cells = count <= kFew ? 9 * count : std::max(9 * kFew, 2.25 * count);
    int level = 1;
    while (level < 10 && static_cast<double>(shapeOfLevel(level, mUnit.side, false).inner[0]) *
                                 shapeOfLevel(level, mUnit.side, false).inner[1] <
                             cells) {
        ++level;
    }
    constexpr double kMany = 1e5;
    if (count <= kMany) level = std::max(level, levelOfPoints(mUnit));
    return level;
}

/// The nets become those of a finer level, without a change of the surface.
void Fitting::enterLevel(const NetShape& shape) {
    if (mNets.empty()) {
        mNets.assign(mUnit.values.size(), std::vector<double>(shape.count()));
        mShape = shape;
        return;
    }
    NetShape fine = mShape;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (shape.inner[axis] == mShape.inner[axis]) continue;
        fine.inner[axis] *= 2;
        fine.margin[axis] *= 2;
    }
    for (auto& net : mNets) {
        std::vector<double> finer(fine.count());
        prolongate(mShape.points(), fine.points(), net, finer);
        // The margin loses what the new one does not have.
        net.resize(shape.count());
        const std::array<int, 2> skip{fine.margin[0] - shape.margin[0],
                                      fine.margin[1] - shape.margin[1]};
        const auto row = static_cast<std::size_t>(shape.points()[1]);
        for (int i = 0; i < shape.points()[0]; ++i) {
            const auto from = static_cast<std::ptrdiff_t>(i + skip[0]) * fine.points()[1] + skip[1];
            std::copy_n(finer.begin() + from, row,
                        net.begin() + static_cast<std::ptrdiff_t>(i) * shape.points()[1]);
        }
    }
    mShape = shape;
}

void Fitting::measure(const NetPoints& points) {
    mLargest = 0;
    double squares = 0;
    for (std::size_t c = 0; c < mNets.size(); ++c) {
        points.evaluate(mNets[c], mLacking[c]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            mLacking[c][i] = mUnit.values[c][i] - mLacking[c][i];
            mLargest = std::max(mLargest, std::abs(mLacking[c][i]));
        }
        squares += dotProduct(mLacking[c], mLacking[c]);
    }
    mRms = std::sqrt(squares / static_cast<double>(points.size() * mNets.size()));
}

void Fitting::solveColumns(const NetSolver& solver, const NetPoints& points,
                           const Columns& targets, double reduction) {
    std::vector<double> right(mShape.count()), weighted(points.size());
    for (std::size_t c = 0; c < mNets.size(); ++c) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            weighted[i] = mUnit.points.weight[i] * targets[c][i];
        }
        std::fill(right.begin(), right.end(), 0);
        points.spread(weighted, right);
        solver.solve(right, mNets[c], {.reduction = reduction}, mProgress);
    }
}

void Fitting::fitLevel(int level) {
    const NetPoints points(mUnit.points, mShape);
    const NetSolver solver(makeNormalStencil(points, mUnit.side, mFit.tension, kStiffness));
    solveColumns(solver, points, mUnit.values, 1e-3);
    measure(points);
    keepLevel(level);
}

/// The smoothest surface with the values, by the method of multipliers: what a solution lacks is
/// added to what the next one is to take.
void Fitting::interpolate(int level) {
    const NetPoints points(mUnit.points, mShape);
    const NetSolver solver(makeNormalStencil(points, mUnit.side, mFit.tension, kStiffness));
    constexpr int kRounds = 40;
    Columns targets = mUnit.values;
    double before = 2;
    for (int round = 0; round < kRounds; ++round) {
        mProgress.throwIfInterrupted();
        solveColumns(solver, points, targets, 1e-4);
        measure(points);
        constexpr double kSlow = 0.9;
        if (isReached() || mLargest > kSlow * before) break;
        before = mLargest;
        for (std::size_t c = 0; c < mNets.size(); ++c) {
            for (std::size_t i = 0; i < points.size(); ++i) targets[c][i] += mLacking[c][i];
        }
    }
    keepLevel(level);
}

/// Adds bumps narrower than the points are apart.
void Fitting::mend(int level) {
    const NetShape shape = shapeOfLevel(level, mUnit.side, false);
    const ResidualMender mender(mUnit.points, shape);
    Columns bumps;
    for (auto& lacking : mLacking) {
        auto& net = bumps.emplace_back(shape.count());
        constexpr int kSteps = 400;
        mender.addTo(net, mender.multipliers(lacking, 0.3 * mOptions.tolerance, kSteps, mProgress));
    }
    const NetPoints points(mUnit.points, shape);
    double squares = 0;
    mLargest = 0;
    for (std::size_t c = 0; c < bumps.size(); ++c) {
        std::vector<double> added(points.size());
        points.evaluate(bumps[c], added);
        for (std::size_t i = 0; i < points.size(); ++i) {
            mLacking[c][i] -= added[i];
            mLargest = std::max(mLargest, std::abs(mLacking[c][i]));
        }
        squares += dotProduct(mLacking[c], mLacking[c]);
    }
    mRms = std::sqrt(squares / static_cast<double>(points.size() * bumps.size()));
    for (std::size_t c = 0; c < bumps.size(); ++c) {
        for (double& control : bumps[c]) control *= mUnit.range[c];
    }
    mFit.levels.push_back(surfaceOf(shape, bumps));
    mFit.report.push_back({level, shape.inner, mLargest, mRms});
}

BsplineSurface Fitting::surfaceOf(const NetShape& shape, const Columns& nets) const {
    BsplineSurface surface(mUnit.rectangle, shape.inner, static_cast<int>(nets.size()));
    for (std::size_t c = 0; c < nets.size(); ++c) {
        const auto to = surface.control(static_cast<int>(c));
        const auto row = static_cast<std::size_t>(shape.inner[1]) + 3;
        for (std::size_t i = 0; i < static_cast<std::size_t>(shape.inner[0]) + 3; ++i) {
            const std::size_t from = (i + static_cast<std::size_t>(shape.margin[0])) *
                                         static_cast<std::size_t>(shape.points()[1]) +
                                     static_cast<std::size_t>(shape.margin[1]);
            std::copy_n(nets[c].begin() + static_cast<std::ptrdiff_t>(from), row,
                        to.begin() + static_cast<std::ptrdiff_t>(i * row));
        }
    }
    return surface;
}

/// What this level has that those before do not.
void Fitting::keepLevel(int level) {
    BsplineSurface surface = surfaceOf(mShape, mNets);
    for (std::size_t c = 0; c < mNets.size(); ++c) {
        for (double& control : surface.control(static_cast<int>(c))) {
            control = control * mUnit.range[c] + mUnit.mean[c];
        }
    }
    if (!mFit.levels.empty()) {
        const BsplineSurface before = mFit.sum().refinedTo(surface.cells());
        for (int c = 0; c < surface.columns(); ++c) {
            const auto from = before.control(c);
            const auto to = surface.control(c);
            for (std::size_t i = 0; i < to.size(); ++i) to[i] -= from[i];
        }
    }
    mFit.levels.push_back(std::move(surface));
    mFit.report.push_back({level, mShape.inner, mLargest, mRms});
}

SurfaceFit Fitting::run() {
    mFit.points = mUnit.points.size();
    mFit.tension = mOptions.tension ? *mOptions.tension : chooseTension(mUnit, mProgress);
    const int allowed = mOptions.maxLevel.value_or(kFinestLevel);
    const int finest = std::min(finestOfData(), allowed);
    // Below this the shape of what is added does not matter any more.
    constexpr double kSmall = 1e-7;
    for (int level = 1; level <= finest; ++level) {
        mProgress.throwIfInterrupted();
        enterLevel(shapeOfLevel(level, mUnit.side, true));
        if (level == finest) {
            interpolate(level);
        } else {
            fitLevel(level);
            if (mLargest <= std::max(kSmall, mOptions.tolerance)) break;
        }
    }
    int level = mFit.report.back().level;
    const auto apart = static_cast<int>(
        std::ceil(std::log2(4 * std::sqrt(static_cast<double>(mUnit.points.size())))));
    level = std::max(level + 1, apart);
    for (; !isReached() && level <= allowed; ++level) mend(level);
    return std::move(mFit);
}

}  // namespace

BsplineSurface SurfaceFit::sum(std::size_t first, std::size_t last) const {
    if (first > last || last >= levels.size()) {
        throw Error(ErrorKind::Usage, "levels " + std::to_string(first) + " to " +
                                          std::to_string(last) + " of " +
                                          std::to_string(levels.size()) +
                                          "; expected some of those that are there");
    }
    BsplineSurface total = levels[first];
    for (std::size_t i = first + 1; i <= last; ++i) {
        BsplineSurface finer = total.refinedTo(levels[i].cells());
        finer.add(levels[i]);
        total = std::move(finer);
    }
    return total;
}

SurfaceFit fitSurface(const ScatteredPoints& points, const FitSurfaceOptions& options,
                      Progress& progress) {
    checkFitOptions(options);
    const MergedPoints merged = mergeDuplicates(points, options.noise > 0 ? -1 : options.tolerance);
    const Rectangle rectangle =
        options.rectangle ? *options.rectangle : boundingRectangle(merged.points);
    if (merged.points.size() < 2) boundingRectangle(merged.points);  // refuses
    checkInside(merged.points, rectangle);
    Fitting fitting(makeUnitPoints(merged, rectangle), options, progress);
    SurfaceFit fit = fitting.run();
    fit.duplicates = merged.duplicates;
    return fit;
}

}  // namespace bandvox
