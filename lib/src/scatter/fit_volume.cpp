#include "core/words.h"
#include "scatter/net_stencil.h"
#include "scatter/space_bumps.h"
#include "scatter/space_solver.h"
#include "scatter/volume_problem.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/scatter/fit_volume.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace bandvox {
namespace {

constexpr double kSpaceStiffness = 1e-2;

/// Below this, in parts of the range, the shape of what is added does not matter any more.
constexpr double kSmallInSpace = 1e-7;

/// Of conjugate gradients, for a level or a round of it. More make the field hardly nearer.
constexpr int kStepsOfLevel = 60;

/// How far around points that lack something a finer net goes, in its cells.
constexpr double kReachOfRest = 1.5;

/// What is being fitted, from level to level.
class VolumeFitting {
  public:
    VolumeFitting(SplineVolumeParts parts, SpaceColumns values, const FitVolumeOptions& options,
                  Progress& progress)
        : mParts(std::move(parts)),
          mValues(std::move(values)),
          mLacking(mValues),
          mOptions(options),
          mProgress(progress) {
        mFit.points = mParts.points().size();
    }

    VolumeFit run();

  private:
    int chooseLevel();
    void makeNets(int level);
    void approximate(int level);
    void interpolate(const SpaceNets& nets, int level, const SpaceColumns& wanted,
                     SpaceColumns& control);
    bool smooth(int level);
    void takeRest(int level);
    void takeBumps();
    void solveColumns(const SpaceSolver& solver, const SpaceColumns& targets, double reduction,
                      int steps, SpaceColumns& control);
    void measure(const SpacePoints& points, const SpaceColumns& control,
                 const SpaceColumns& wanted);
    void measureLacking();
    void report(int level, std::size_t controlPoints);
    double noiseLeft() const;
    void keep(int level, SpaceNet net);
    double smallEnough() const { return std::max(mSmall, mOptions.tolerance); }

    SplineVolumeParts mParts;
    SpaceColumns mValues;
    SpaceColumns mLacking;
    const FitVolumeOptions& mOptions;
    Progress& mProgress;
    SpaceNets mNets;
    SpaceColumns mControl;     // of the present level
    std::size_t mNumbers = 0;  // of the control points of the net in reach of all points
    double mLargest = 1, mRms = 1;
    double mSmall = kSmallInSpace;  // what nets may leave to bumps
    VolumeFit mFit;
};

/// The level of the net that is to take the values: with as many cells as points, where there are
/// points, and a reach of not too many cells.
int VolumeFitting::chooseLevel() {
    constexpr double kCellsForPoint = 0.7;
    const int allowed = mOptions.maxLevel.value_or(kFinestSpaceLevel);
    const double wanted = kCellsForPoint * static_cast<double>(mParts.points().size());
    int level = 1;
    while (level < allowed && static_cast<double>(countOccupied(mParts.points(), level)) < wanted) {
        ++level;
    }
    constexpr double kReachInSpacings = 4;
    constexpr double kFarthestUnasked = 0.5;  // of the longest side, where points are few
    mParts.reach = mOptions.reach
                       ? *mOptions.reach / mParts.longest
                       : std::min(kFarthestUnasked,
                                  kReachInSpacings * spacingOf(mParts.points(), level, mProgress));
    constexpr double kFarthest = 4;
    if (!(mParts.reach > 0 && mParts.reach <= kFarthest)) {
        throw Error(ErrorKind::Usage,
                    "the reach of a volume's fit is " + inShort(mParts.reach * mParts.longest) +
                        "; expected more than 0, and up to 4 times the longest side of the "
                        "points' box, which is " +
                        inShort(mParts.longest));
    }
    while (level > 1 && std::ldexp(mParts.reach, level) > SpaceNet::kMostReach) --level;
    return level;
}

void VolumeFitting::makeNets(int level) {
    mParts.occupied = std::make_unique<OccupiedCells>(mParts.points(), level, mProgress);
    const SpaceNet places = mParts.occupied->places();
    const double reach = std::min(std::ldexp(mParts.reach, level), SpaceNet::kMostReach);
    mParts.near = places.dilated(reach, false, mProgress);
    mParts.sure = places.dilated(reach, true, mProgress);
    SpaceNet net = mParts.near.controlsOfCells(mProgress);
    // The vectors of a solution, of what precedes it, and of the columns.
    const double vectors = 12 + 2 * static_cast<double>(mValues.size());
    requireMemory(vectors * sizeof(double) * static_cast<double>(net.numbers()),
                  "the control points in reach of the points");
    mNumbers = net.numbers();
    mNets = makeSpaceNets(std::move(net), level, 1, mProgress);
}

/// What the nets lack of `wanted` at the points.
void VolumeFitting::measure(const SpacePoints& points, const SpaceColumns& control,
                            const SpaceColumns& wanted) {
    std::vector<double> found(points.size());
    for (std::size_t c = 0; c < control.size(); ++c) {
        points.evaluate(control[c], found);
        for (std::size_t i = 0; i < found.size(); ++i) mLacking[c][i] = wanted[c][i] - found[i];
    }
    measureLacking();
}

void VolumeFitting::measureLacking() {
    mLargest = 0;
    double squares = 0;
    for (const auto& column : mLacking) {
        for (const double lacking : column) {
            // So that what is no number is not passed over.
            if (!(std::abs(lacking) <= mLargest)) mLargest = std::abs(lacking);
        }
        squares += dotProduct(column, column);
    }
    mRms = std::sqrt(squares / static_cast<double>(mParts.points().size() * mLacking.size()));
}

void VolumeFitting::report(int level, std::size_t controlPoints) {
    mFit.report.push_back({level, controlPoints, mLargest, mRms});
}

void VolumeFitting::solveColumns(const SpaceSolver& solver, const SpaceColumns& targets,
                                 double reduction, int steps, SpaceColumns& control) {
    std::vector<double> weighted(mParts.points().size());
    for (std::size_t c = 0; c < control.size(); ++c) {
        for (std::size_t i = 0; i < weighted.size(); ++i) {
            weighted[i] = mParts.points().weight[i] * targets[c][i];
        }
        std::vector<double> right(control[c].size());
        solver.points().spread(weighted, right);
        solver.solve(right, control[c], {.reduction = reduction, .steps = steps}, mProgress);
    }
}

/// The smoothest field near the values, from that of the level before.
void VolumeFitting::approximate(int level) {
    const SpaceNet& net = mNets.ofLevel(level);
    if (mControl.empty()) {
        mControl.assign(mValues.size(), std::vector<double>(net.numbers()));
    } else {
        for (auto& control : mControl) {
            std::vector<double> finer(net.numbers());
            prolongSpace(mNets.ofLevel(level - 1), net, control, finer);
            control = std::move(finer);
        }
    }
    const SpaceSolver solver(mNets, level, mParts.points(), mOptions.tension, kSpaceStiffness);
    solveColumns(solver, mValues, 1e-2, kStepsOfLevel, mControl);
    measure(solver.points(), mControl, mValues);
    report(level, net.count());
}

/// The smoothest field with the values, by the method of multipliers: what a solution lacks is
/// added to what the next one is to take.
void VolumeFitting::interpolate(const SpaceNets& nets, int level, const SpaceColumns& wanted,
                                SpaceColumns& control) {
    const SpaceSolver solver(nets, level, mParts.points(), mOptions.tension, kSpaceStiffness);
    constexpr int kRounds = 30;
    SpaceColumns targets = wanted;
    double before = 1;
    for (int round = 0; round < kRounds; ++round) {
        solveColumns(solver, targets, 1e-2, kStepsOfLevel, control);
        measure(solver.points(), control, wanted);
        constexpr double kSlow = 0.8;
        if (mLargest <= smallEnough() || (round > 1 && mRms > kSlow * before)) break;
        before = mRms;
        for (std::size_t c = 0; c < targets.size(); ++c) {
            for (std::size_t i = 0; i < targets[c].size(); ++i) targets[c][i] += mLacking[c][i];
        }
    }
}

/// The mean square of what is lacking, in parts of that which the noise makes expect.
double VolumeFitting::noiseLeft() const {
    double sum = 0;
    for (std::size_t c = 0; c < mLacking.size(); ++c) {
        const double scale = mParts.range[c] / mOptions.noise;
        for (std::size_t i = 0; i < mLacking[c].size(); ++i) {
            const double parts = scale * mLacking[c][i];
            sum += mParts.points().weight[i] * parts * parts;
        }
    }
    return sum / static_cast<double>(mLacking.size() * mParts.points().size());
}

/// The smoothest field that differs by as much as the noise, as V. A. Morozov's discrepancy
/// principle has it. False if none of the net differs by as little, or the noise is more than all
/// that the values do.
bool VolumeFitting::smooth(int level) {
    const auto tryStiffness = [&](double logarithm) {
        const SpaceSolver solver(mNets, level, mParts.points(), mOptions.tension,
                                 std::pow(10, logarithm));
        solveColumns(solver, mValues, 1e-2, 2 * kStepsOfLevel, mControl);
        measure(solver.points(), mControl, mValues);
        return noiseLeft() < 1;
    };
    constexpr double kSoftest = -3;
    constexpr double kStiffest = 6;
    double low = kSoftest;
    double high = kStiffest;
    constexpr double kFineEnough = 0.1;
    while (high - low > kFineEnough) {
        const double middle = (low + high) / 2;
        (tryStiffness(middle) ? low : high) = middle;
        // What does not differ by as much where it is stiff does so nowhere.
        const bool isHopeless = low > kStiffest - 3 && std::sqrt(noiseLeft()) < 0.5;
        if (isHopeless) return false;
    }
    tryStiffness(low);
    constexpr double kNearly = 0.1;
    return std::abs(std::sqrt(noiseLeft()) - 1) <= kNearly;
}

void VolumeFitting::keep(int level, SpaceNet net) {
    report(level, net.count());
    mParts.layers.push_back({level, std::move(net), std::exchange(mControl, {})});
}

/// Finer nets around the points that lack something still.
void VolumeFitting::takeRest(int level) {
    constexpr int kLevelsMore = 6;
    const int last = std::min(mOptions.maxLevel.value_or(kFinestSpaceLevel), level + kLevelsMore);
    while (mLargest > smallEnough() && ++level <= last) {
        SpaceNet places;
        for (std::size_t i = 0; i < mParts.points().size(); ++i) {
            const bool lacks = std::any_of(mLacking.begin(), mLacking.end(), [&](const auto& l) {
                return std::abs(l[i]) > smallEnough();
            });
            if (lacks) places.add(mParts.points().cell(i, level));
        }
        places.sort();
        // Points far from each other take whole blocks of control points each: bumps do it for
        // less.
        SpaceNet finest = places.dilated(kReachOfRest, false, mProgress).controlsOfCells(mProgress);
        constexpr std::size_t kMostNumbers = std::size_t(1) << 21U;
        if (finest.numbers() > std::max(kMostNumbers, mNumbers)) break;
        constexpr int kLevelsBelow = 3;
        const SpaceNets nets =
            makeSpaceNets(std::move(finest), level, std::max(1, level - kLevelsBelow), mProgress);
        const SpaceColumns wanted = mLacking;
        const double largest = mLargest, rms = mRms;
        mControl.assign(mValues.size(), std::vector<double>(nets.nets.back().numbers()));
        interpolate(nets, level, wanted, mControl);
        if (mRms < rms) {
            keep(level, nets.nets.back());
            continue;
        }
        mLacking = wanted;
        mLargest = largest;
        mRms = rms;
    }
}

/// Bumps that take what is left, from such as nearly meet to such as do not.
void VolumeFitting::takeBumps() {
    const auto count = static_cast<double>(mParts.points().size());
    constexpr double kCrowded = 32;
    int level = mParts.occupied->level();
    while (level < SortedSpacePoints::kFinest &&
           sharedCells(mParts.points(), OccupiedCells(mParts.points(), level, mProgress)) >
               0.5 * count) {
        ++level;
    }
    // Those that are narrower still are for pairs of points.
    for (; mLargest > mOptions.tolerance && level <= SortedSpacePoints::kFinest; level += 2) {
        const SpaceBumps bumps(mParts.points(), level);
        if (static_cast<double>(bumps.meetings()) > kCrowded * count) continue;
        constexpr int kSteps = 200;
        constexpr int kPasses = 2;  // the second takes what rounding has left of the first
        for (int pass = 0; pass < kPasses && mLargest > mOptions.tolerance; ++pass) {
            BumpLayer layer{level, {}};
            std::vector<double> found(mParts.points().size());
            for (auto& lacking : mLacking) {
                layer.sizes.push_back(
                    bumps.sizes(lacking, 0.3 * mOptions.tolerance, kSteps, mProgress));
                bumps.evaluate(layer.sizes.back(), found);
                for (std::size_t i = 0; i < found.size(); ++i) lacking[i] -= found[i];
            }
            measureLacking();
            mParts.bumps.push_back(std::move(layer));
        }
    }
}

VolumeFit VolumeFitting::run() {
    int level = chooseLevel();
    makeNets(level);
    const bool isSmooth = mOptions.noise > 0;
    for (int l = mNets.coarsest(); l <= level; ++l) {
        mProgress.throwIfInterrupted();
        approximate(l);
        if (isSmooth || mLargest > smallEnough()) continue;
        // Coarser cells are enough, so what there is on the finest ones is left as it is.
        for (int finer = l + 1; finer <= level; ++finer) {
            for (auto& control : mControl) {
                std::vector<double> more(mNets.ofLevel(finer).numbers());
                prolongSpace(mNets.ofLevel(finer - 1), mNets.ofLevel(finer), control, more);
                control = std::move(more);
            }
        }
        break;
    }
    // What a net half as fine lacks tells how much of the field is still unknown: bumps of a part
    // of that change nothing.
    if (mFit.report.size() > 1) {
        constexpr double kPart = 0.1;
        constexpr double kMostForBumps = 1e-4;
        const double coarser = mFit.report[mFit.report.size() - 2].largest;
        mSmall = std::clamp(kPart * coarser, kSmallInSpace, kMostForBumps);
    }
    mFit.report.pop_back();
    if (isSmooth) {
        mFit.noiseReached = smooth(level);
    } else if (mLargest > smallEnough()) {
        interpolate(mNets, level, mValues, mControl);
    }
    keep(level, std::move(mNets.nets.back()));
    mNets = {};
    if (!isSmooth) takeRest(level);
    if (!isSmooth && !mOptions.maxLevel) takeBumps();
    mFit.largest = mLargest;
    mFit.rms = mRms;
    mFit.volume = SplineVolume(std::make_shared<const SplineVolumeParts>(std::move(mParts)));
    return std::move(mFit);
}

}  // namespace

VolumeFit fitVolume(const ScatteredPoints& points, const FitVolumeOptions& options,
                    Progress& progress) {
    checkVolumeOptions(options);
    if (!points.isInSpace()) {
        throw Error(ErrorKind::Usage, "the points have no z; expected places in space");
    }
    const MergedPoints merged = mergeDuplicates(points, options.noise > 0 ? -1 : options.tolerance);
    if (merged.points.size() == 0) {
        throw Error(ErrorKind::Input, "there are no points; expected some");
    }
    progress.throwIfInterrupted();
    SpaceColumns values;
    SplineVolumeParts parts = makeUnitVolume(merged, values);
    VolumeFitting fitting(std::move(parts), std::move(values), options, progress);
    VolumeFit fit = fitting.run();
    fit.duplicates = merged.duplicates;
    return fit;
}

}  // namespace bandvox
