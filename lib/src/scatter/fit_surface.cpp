#include "scatter/fit_problem.h"
#include "scatter/mend_residual.h"
#include "scatter/surface_swing.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace bandvox {
namespace {

constexpr int kFinestLevel = 13;
constexpr double kStiffness = 1e-2;

/// Below this, in parts of the range, the shape of what is added does not matter any more.
constexpr double kSmall = 1e-7;

/// So few points are worth the smoothest shape even of what is smaller than that.
constexpr std::size_t kFewPoints = 300;

using Columns = std::vector<std::vector<double>>;

/// What is being fitted, from level to level.
class Fitting {
  public:
    Fitting(UnitPoints unit, const FitSurfaceOptions& options, Progress& progress)
        : mUnit(std::move(unit)),
          mOptions(options),
          mProgress(progress),
          mLacking(mUnit.values.size(), std::vector<double>(mUnit.points.size())) {}

    SurfaceFit run();

  private:
    int levelOfCount() const;
    void approximate(int level);
    void takeValues(int level);
    void takeLacking(int level);
    void takeRest(int allowed);
    void mend(int level);
    void smooth(int level);
    double noiseLeft() const;
    NetSolver makeSolver(const NetPoints& points, double stiffness) const;
    void interpolate(const NetPoints& points, const Columns& wanted);
    void solveColumns(const NetSolver& solver, const NetPoints& points, const Columns& targets,
                      double reduction);
    void measure(const NetPoints& points, const Columns& nets, const Columns& wanted);
    void enterLevel(const NetShape& shape);
    void keepSum(int level);
    void keepAlone(int level, const NetShape& shape, const Columns& nets);
    BsplineSurface surfaceOf(const NetShape& shape, const Columns& nets) const;
    bool isReached() const { return mLargest <= mOptions.tolerance; }
    /// What smooth levels may leave to bumps.
    double smallEnough() const {
        return mUnit.points.size() <= kFewPoints ? mOptions.tolerance
                                                 : std::max(kSmall, mOptions.tolerance);
    }

    UnitPoints mUnit;
    const FitSurfaceOptions& mOptions;
    Progress& mProgress;
    NetShape mShape;   // of the nets
    Columns mNets;     // control points: of the sum of all levels, or of one
    Columns mLacking;  // of each point's values
    double mLargest = 1, mRms = 1;
    SurfaceFit mFit;
};

/// The coarsest level with enough control points to take all values. A coarser net is a smoother
/// one.
int Fitting::levelOfCount() const {
    constexpr double kCellsForPoint = 1.6;
    int level = 1;
    const auto cells = [&] {
        const NetShape shape = shapeOfLevel(level, mUnit.side, false);
        return static_cast<double>(shape.inner[0]) * shape.inner[1];
    };
    while (level < 10 && cells() < kCellsForPoint * static_cast<double>(mUnit.points.size())) {
        ++level;
    }
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

/// What the nets lack of `wanted` at the points.
void Fitting::measure(const NetPoints& points, const Columns& nets, const Columns& wanted) {
    mLargest = 0;
    double squares = 0;
    std::vector<double> found(points.size());
    for (std::size_t c = 0; c < nets.size(); ++c) {
        points.evaluate(nets[c], found);
        for (std::size_t i = 0; i < points.size(); ++i) {
            mLacking[c][i] = wanted[c][i] - found[i];
            const double lacking = std::abs(mLacking[c][i]);
            // So that what is no number is not passed over.
            if (!(lacking <= mLargest)) mLargest = lacking;
        }
        squares += dotProduct(mLacking[c], mLacking[c]);
    }
    mRms = std::sqrt(squares / static_cast<double>(points.size() * nets.size()));
}

void Fitting::solveColumns(const NetSolver& solver, const NetPoints& points, const Columns& targets,
                           double reduction) {
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

NetSolver Fitting::makeSolver(const NetPoints& points, double stiffness) const {
    NetStencil stencil = makeNormalStencil(points, mUnit.side, mFit.tension, stiffness);
    constexpr std::size_t kManyForEach = 10;
    const bool isHeld = points.size() > kManyForEach * stencil.count();
    return isHeld ? NetSolver(std::move(stencil), NetSolver::kSmallEnough)
                  : NetSolver(std::move(stencil));
}

/// The smoothest surface near the values.
void Fitting::approximate(int level) {
    enterLevel(shapeOfLevel(level, mUnit.side, true));
    const NetPoints points(mUnit.points, mShape);
    solveColumns(makeSolver(points, kStiffness), points, mUnit.values, 1e-3);
    measure(points, mNets, mUnit.values);
    keepSum(level);
}

/// The smoothest surface with the values, by the method of multipliers: what a solution lacks is
/// added to what the next one is to take.
void Fitting::interpolate(const NetPoints& points, const Columns& wanted) {
    const NetSolver solver = makeSolver(points, kStiffness);
    constexpr int kRounds = 40;
    Columns targets = wanted;
    double before = mLargest;
    for (int round = 0; round < kRounds; ++round) {
        mProgress.throwIfInterrupted();
        solveColumns(solver, points, targets, 1e-4);
        measure(points, mNets, wanted);
        constexpr double kSlow = 0.9;
        if (mLargest <= smallEnough() || (round > 0 && mLargest > kSlow * before)) break;
        before = mLargest;
        for (std::size_t c = 0; c < mNets.size(); ++c) {
            for (std::size_t i = 0; i < points.size(); ++i) targets[c][i] += mLacking[c][i];
        }
    }
}

/// The level that is to take all values.
void Fitting::takeValues(int level) {
    enterLevel(shapeOfLevel(level, mUnit.side, true));
    interpolate(NetPoints(mUnit.points, mShape), mUnit.values);
    keepSum(level);
}

/// A level that takes what is lacking still.
void Fitting::takeLacking(int level) {
    mShape = shapeOfLevel(level, mUnit.side, true);
    mNets.assign(mUnit.values.size(), std::vector<double>(mShape.count()));
    interpolate(NetPoints(mUnit.points, mShape), Columns(mLacking));
    keepAlone(level, mShape, mNets);
}

/// Adds bumps narrower than the points are apart.
void Fitting::mend(int level) {
    const NetShape shape = shapeOfLevel(level, mUnit.side, false);
    const ResidualMender mender(mUnit.points, shape);
    if (mender.isCrowded()) return;
    Columns bumps;
    for (const auto& lacking : mLacking) {
        auto& net = bumps.emplace_back(shape.count());
        constexpr int kSteps = 400;
        mender.addTo(net, mender.multipliers(lacking, 0.7 * mOptions.tolerance, kSteps, mProgress));
    }
    const Columns before = mLacking;
    const double largest = mLargest, rms = mRms;
    measure(NetPoints(mUnit.points, shape), bumps, before);
    // Of more points in a cell than it has control points the sizes may be anything.
    if (mLargest < largest) return keepAlone(level, shape, bumps);
    mLacking = before;
    mLargest = largest;
    mRms = rms;
}

/// The mean square of what is lacking, in parts of that which the noise makes expect.
double Fitting::noiseLeft() const {
    double sum = 0;
    for (std::size_t c = 0; c < mLacking.size(); ++c) {
        const double scale = mUnit.range[c] / mOptions.noise;
        for (std::size_t i = 0; i < mLacking[c].size(); ++i) {
            const double parts = scale * mLacking[c][i];
            sum += mUnit.points.weight[i] * parts * parts;
        }
    }
    return sum / static_cast<double>(mLacking.size() * mUnit.points.size());
}

/// The smoothest surface that differs by as much as the noise: the stiffness for that is bracketed
/// and halved on a logarithmic scale. V. A. Morozov's discrepancy principle.
void Fitting::smooth(int level) {
    enterLevel(shapeOfLevel(level, mUnit.side, true));
    const NetPoints points(mUnit.points, mShape);
    const auto tryStiffness = [&](double logarithm) {
        mProgress.throwIfInterrupted();
        solveColumns(makeSolver(points, std::pow(10, logarithm)), points, mUnit.values, 1e-5);
        measure(points, mNets, mUnit.values);
        return noiseLeft() < 1;
    };
    double low = -3;
    double high = 9;
    constexpr double kFineEnough = 0.02;
    while (high - low > kFineEnough) {
        const double middle = (low + high) / 2;
        (tryStiffness(middle) ? low : high) = middle;
    }
    tryStiffness(low);
    mFit.noiseLeft = std::sqrt(noiseLeft());
    keepSum(level);
}

void Fitting::keepAlone(int level, const NetShape& shape, const Columns& nets) {
    BsplineSurface surface = surfaceOf(shape, nets);
    for (std::size_t c = 0; c < nets.size(); ++c) {
        for (double& control : surface.control(static_cast<int>(c))) control *= mUnit.range[c];
    }
    mFit.levels.push_back(std::move(surface));
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

/// What the nets, which are the sum of all levels, have that the levels before do not.
void Fitting::keepSum(int level) {
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

/// Levels for what is lacking: smooth ones as long as points are nearer to each other than cells
/// are wide, then bumps.
void Fitting::takeRest(int allowed) {
    constexpr double kMany = 1e5;
    const auto count = static_cast<double>(mUnit.points.size());
    int level = mFit.report.back().level + 1;
    if (mLargest > smallEnough() && count <= kMany) {
        const int apart = std::min(levelOfPoints(mUnit), allowed);
        for (; level <= apart && mLargest > smallEnough(); ++level) takeLacking(level);
    }
    level = std::max(level, static_cast<int>(std::ceil(std::log2(2.5 * std::sqrt(count)))));
    for (; !isReached() && level <= allowed; ++level) mend(level);
}

SurfaceFit Fitting::run() {
    mFit.points = mUnit.points.size();
    mFit.tension = mOptions.tension ? *mOptions.tension : chooseTension(mUnit, mProgress);
    const int allowed = mOptions.maxLevel.value_or(kFinestLevel);
    const int full = std::min(levelOfCount(), allowed);
    if (mOptions.noise > 0) {
        for (int level = 1; level < full; ++level) approximate(level);
        smooth(full);
        return std::move(mFit);
    }
    for (int level = 1; level < full; ++level) {
        mProgress.throwIfInterrupted();
        approximate(level);
        if (mLargest <= std::max(kSmall, mOptions.tolerance)) break;
    }
    if (mFit.levels.empty() || mLargest > std::max(kSmall, mOptions.tolerance)) takeValues(full);
    takeRest(allowed);
    return std::move(mFit);
}

}  // namespace

BsplineSurface SurfaceFit::sum(std::size_t first, std::size_t last) const {
    if (first > last || last >= levels.size()) {
        throw Error(ErrorKind::Usage,
                    "levels " + std::to_string(first) + " to " + std::to_string(last) + " of " +
                        std::to_string(levels.size()) + "; expected some of those that are there");
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
    if (points.isInSpace()) {
        throw Error(ErrorKind::Usage, "the points have a z; expected places in a plane");
    }
    const MergedPoints merged = mergeDuplicates(points, options.noise > 0 ? -1 : options.tolerance);
    const Rectangle rectangle =
        options.rectangle ? *options.rectangle : boundingRectangle(merged.points);
    if (merged.points.size() < 2) boundingRectangle(merged.points);  // refuses
    checkInside(merged.points, rectangle);
    const UnitPoints unit = makeUnitPoints(merged, rectangle);
    const auto fitWith = [&](const FitSurfaceOptions& chosen) {
        SurfaceFit fit = Fitting(unit, chosen, progress).run();
        fit.swing = swingOf(fit.levels, merged.points);
        return fit;
    };
    SurfaceFit fit = fitWith(options);
    // The likely tension looks at points that tell little of a crowd among few others: where the
    // surface leaves their values far behind, a stiffer one is better.
    constexpr double kTooFar = 1;
    constexpr double kMostTension = 1000;
    constexpr std::size_t kMostPoints = 20000;
    FitSurfaceOptions stiffer = options;
    while (!options.tension && options.noise == 0 && merged.points.size() <= kMostPoints &&
           fit.swing > kTooFar && 4 * fit.tension <= kMostTension) {
        stiffer.tension = 4 * fit.tension;
        SurfaceFit other = fitWith(stiffer);
        if (!(other.swing < fit.swing) ||
            !(other.report.back().largest <= fit.report.back().largest ||
              other.report.back().largest <= options.tolerance)) {
            break;
        }
        fit = std::move(other);
    }
    fit.duplicates = merged.duplicates;
    return fit;
}

}  // namespace bandvox
