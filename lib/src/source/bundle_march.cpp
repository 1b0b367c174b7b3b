#include "source/bundle_march.h"

#include "source/ray_crossing.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::Vec3d;

constexpr double kInside = WindingMap::kInside;

// Just before a triangle the winding number is asked for so far in front of it, voxels.
constexpr double kInFront = 0.01;

// What is thinner than this along a row, voxels, is left out: so near to the edge of a lone sheet
// the winding number cannot be told from that of something enclosed.
constexpr float kThinnest = 0.02F;

// A crossing of an opening is found to within this, voxels, by so many steps at most.
constexpr double kPrecision = 0.01;
constexpr int kMostSteps = 12;

// A cell is smooth if the winding number, whole numbers apart, changes by less than the first in
// it, and stays as far away from what is inside as the second.
constexpr double kSmooth = 0.2;
constexpr double kMarginOfSmooth = 0.03;

// Places of a coarse lattice agree if they are this far from what is inside. It has this many along
// a cell's side.
constexpr double kClear = 0.15;
constexpr int kFaceSide = WindingRows::kSide + 1;

}  // namespace

BundleMarch::BundleMarch(const WindingTree& tree, const WindingMap& map, const BBoxd& bounds,
                         const BundlePlace& place, const Coord& cell)
    : mTree(tree),
      mMap(map),
      mPlace(place),
      mCell(cell),
      mBegin(bounds.min().x() / place.lattice.voxelSize - place.xOrigin),
      mEnd(bounds.max().x() / place.lattice.voxelSize - place.xOrigin),
      mRows(std::size_t(WindingRows::kSide) * WindingRows::kSide * place.lattice.rowCount()) {
    const RowLattice& lattice = place.lattice;
    for (std::size_t i = 0; i < mRows.size(); ++i) {
        const auto voxel = static_cast<int>(i / lattice.rows.size());
        const RowLattice::Place& at = lattice.rows[i % lattice.rows.size()];
        const int y = voxel / WindingRows::kSide, z = voxel % WindingRows::kSide;
        mRows[i].y = lattice.voxelSize * (place.firstVoxel.y() + y + at.y);
        mRows[i].z = lattice.voxelSize * (place.firstVoxel.z() + z + at.z);
    }
}

void BundleMarch::run(std::vector<std::uint32_t>& start, std::vector<float>& crossings) {
    using State = WindingMap::State;
    State last = State::Outside;
    for (int x = 0; x < mMap.cells().count.x(); ++x) {
        const State state = mMap.state(mCell.offsetBy(x, 0, 0));
        if (state == State::Mixed) {
            passMixed(x);
        } else if (state != last) {
            passConstant(x);
        }
        last = state;
    }
    start.clear();
    crossings.clear();
    for (Row& row : mRows) {
        if (row.isInside) cross(row, mEnd);
        start.push_back(static_cast<std::uint32_t>(crossings.size()));
        crossings.insert(crossings.end(), row.crossings.begin(), row.crossings.end());
    }
    start.push_back(static_cast<std::uint32_t>(crossings.size()));
}

void BundleMarch::passConstant(int x) {
    const Coord cell = mCell.offsetBy(x, 0, 0);
    const bool isInside = mMap.state(cell) == WindingMap::State::Inside;
    for (Row& row : mRows) {
        if (row.isInside != isInside) cross(row, x * WindingRows::kSide);
        row.winding = mMap.winding(cell);
        row.isKnown = false;
    }
}

void BundleMarch::passMixed(int x) {
    // Collect what the winding number is made of here.
    const Coord cell = mCell.offsetBy(x, 0, 0);
    const CellLattice& cells = mMap.cells();
    const double begin = x * WindingRows::kSide, end = begin + WindingRows::kSide;
    const WindingRegion region{cells.origin + cells.side * (cell.asVec3d() + Vec3d(0.5)),
                               0.5 * std::sqrt(3.0) * cells.side};
    mTree.collect(region, WindingMap::kFarAway, mTerms);
    mNextIsInside.reset();
    if (x + 1 == cells.count.x()) {
        mNextIsInside = false;
    } else if (const auto next = mMap.state(cell.offsetBy(1, 0, 0));
               next != WindingMap::State::Mixed) {
        mNextIsInside = next == WindingMap::State::Inside;
    }

    // In a smooth cell one winding number tells the others.
    mFraction.reset();
    const double reach = kSmooth / region.radius;
    if (const double gradient = mTree.gradientBound(region, reach); gradient < reach) {
        const double winding = mTerms.at(region.center);
        const double fraction = winding - std::round(winding);
        if (0.5 - std::abs(fraction) > gradient * region.radius + kMarginOfSmooth) {
            mFraction = fraction;
        }
    }

    mFace.clear();
    findHits(begin, end);
    std::span<const Hit> rest = mHits;
    for (std::size_t i = 0; i < mRows.size(); ++i) {
        std::size_t count = 0;
        while (count < rest.size() && rest[count].row == static_cast<std::int32_t>(i)) ++count;
        Row& row = mRows[i];
        row.at = begin;
        const std::span<const Hit> hits = rest.first(count);
        if (!passSmooth(row, hits, end) && !passLikely(row, hits, end)) {
            passRough(row, hits, end);
        }
        rest = rest.subspan(count);
    }
}

// Finds the triangles in the rows' way between two places.
void BundleMarch::findHits(double begin, double end) {
    mHits.clear();
    const RowLattice& lattice = mPlace.lattice;
    const CellLattice& cells = mMap.cells();
    const Vec3d center = cells.origin + cells.side * (mCell.asVec3d() + Vec3d(0.5)) +
                         Vec3d(begin * lattice.voxelSize, 0, 0);
    const auto voxelsWithin = [&](double low, double high, int first) {
        const auto voxel = [&](double at) {
            return static_cast<int>(std::floor(at / lattice.voxelSize)) - first;
        };
        return std::pair(std::max(voxel(low), 0), std::min(voxel(high), WindingRows::kSide - 1));
    };
    mTree.visitNear({center, 0.5 * std::sqrt(3.0) * cells.side}, [&](std::uint32_t t) {
        const std::array<Vec3d, 3> corner = mTree.corners(t);
        const auto [yLow, yHigh] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
        const auto [zLow, zHigh] = std::minmax({corner[0].z(), corner[1].z(), corner[2].z()});
        const auto [yFirst, yLast] = voxelsWithin(yLow, yHigh, mPlace.firstVoxel.y());
        const auto [zFirst, zLast] = voxelsWithin(zLow, zHigh, mPlace.firstVoxel.z());
        for (int y = yFirst; y <= yLast; ++y) {
            for (int z = zFirst; z <= zLast; ++z) {
                const int firstRow = (y * WindingRows::kSide + z) * lattice.rowCount();
                for (int i = firstRow; i < firstRow + lattice.rowCount(); ++i) {
                    const Row& row = mRows[i];
                    if (row.y < yLow || row.y > yHigh || row.z < zLow || row.z > zHigh) continue;
                    const auto crossing = lineCrossing(row.y, row.z, corner);
                    if (!crossing) continue;
                    const double x = crossing->x / lattice.voxelSize - mPlace.xOrigin;
                    if (x >= begin && x < end) mHits.push_back({i, x, crossing->leaving});
                }
            }
        }
    });
    std::sort(mHits.begin(), mHits.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.row, a.x, a.leaving) < std::tie(b.row, b.x, b.leaving);
    });
}

// Where the winding number changes but little apart from its jumps. Returns false, having done
// nothing, if that cannot be relied on.
bool BundleMarch::passSmooth(Row& row, std::span<const Hit> hits, double end) {
    if (!mFraction) return false;
    constexpr double kAlike = 0.4;
    const double whole = std::round(row.winding - *mFraction);
    double winding = whole + *mFraction;
    if (std::abs(row.winding - winding) > kAlike || (winding > kInside) != row.isInside)
        return false;
    double last = winding;
    for (const Hit& hit : hits) last -= hit.leaving;
    if (mNextIsInside && *mNextIsInside != (last > kInside)) return false;
    for (const Hit& hit : hits) {
        winding -= hit.leaving;
        if ((winding > kInside) != row.isInside) cross(row, hit.x);
    }
    row.at = end;
    row.winding = winding;
    row.isKnown = false;
    return true;
}

// Where triangles lead in and out by turns, to what the surroundings at the end say. Returns false,
// having done nothing, where they do not.
bool BundleMarch::passLikely(Row& row, std::span<const Hit> hits, double end) {
    bool isInside = row.isInside;
    for (const Hit& hit : hits) {
        if (hit.leaving != (isInside ? 1 : -1)) return false;
        isInside = !isInside;
    }
    if (likelyAtEnd(row, end) != isInside) return false;
    for (const Hit& hit : hits) cross(row, hit.x);
    row.at = end;
    row.winding = isInside ? 1 : 0;
    row.isKnown = false;
    return true;
}

// What the next cell is, or what the four nearest places of a coarse lattice agree about.
std::optional<bool> BundleMarch::likelyAtEnd(const Row& row, double end) {
    if (mNextIsInside) return mNextIsInside;
    // Of few rows each can be asked for itself.
    if (mPlace.lattice.perSide < 2) return std::nullopt;
    if (mFace.empty()) sampleFace(end);
    const Vec3d corner = mMap.cells().origin + mMap.cells().side * mCell.asVec3d();
    const auto voxel = [&](double at) {
        return std::clamp(static_cast<int>(at / mPlace.lattice.voxelSize), 0,
                          WindingRows::kSide - 1);
    };
    const int y = voxel(row.y - corner.y()), z = voxel(row.z - corner.z());
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int i : {0, 1, kFaceSide, kFaceSide + 1}) {
        const double winding = mFace[y * kFaceSide + z + i];
        low = std::min(low, winding);
        high = std::max(high, winding);
    }
    if (low > kInside + kClear) return true;
    if (high < kInside - kClear) return false;
    return std::nullopt;
}

void BundleMarch::sampleFace(double x) {
    const CellLattice& cells = mMap.cells();
    const Vec3d corner = cells.origin + cells.side * mCell.asVec3d();
    for (int y = 0; y < kFaceSide; ++y) {
        for (int z = 0; z < kFaceSide; ++z) {
            ++mEvaluations;
            mFace.push_back(mTerms.at(corner + mPlace.lattice.voxelSize * Vec3d(x, y, z)));
        }
    }
}

void BundleMarch::passRough(Row& row, std::span<const Hit> hits, double end) {
    for (const Hit& hit : hits) {
        // Compare what it is in front of the triangle with what it was.
        const double front = hit.x - kInFront;
        if (front > row.at || !row.isKnown) {
            const double winding = windingAt(row, front);
            if ((winding > kInside) != row.isInside) cross(row, findCrossing(row, front, winding));
            row.winding = winding;
            row.isKnown = true;
        }
        row.at = hit.x;
        row.winding -= hit.leaving;
        if ((row.winding > kInside) != row.isInside) cross(row, hit.x);
    }
    leave(row, end);
}

// Follows a row to the end of a cell.
void BundleMarch::leave(Row& row, double end) {
    if (mNextIsInside && *mNextIsInside == row.isInside) {
        row.at = end;
        row.isKnown = false;
        return;
    }
    const double winding = windingAt(row, end);
    const bool isInside = mNextIsInside ? *mNextIsInside : winding > kInside;
    if (isInside != row.isInside) cross(row, findCrossing(row, end, winding));
    row.at = end;
    row.winding = winding;
    row.isKnown = true;
}

void BundleMarch::cross(Row& row, double x) {
    row.isInside = !row.isInside;
    x = std::clamp(x, mBegin, mEnd);
    const float last = row.crossings.empty() ? 0 : row.crossings.back();
    const float place = std::max(static_cast<float>(x), last);
    if (!row.isInside && place - last < kThinnest) {
        row.crossings.pop_back();
    } else {
        row.crossings.push_back(place);
    }
}

// Where the winding number passes kInside between a row's place and `end`, no triangle being there.
double BundleMarch::findCrossing(const Row& row, double end, double windingAtEnd) {
    double low = row.at, high = end;
    if (high - low <= kPrecision) return high;
    double atLow = (row.isKnown ? row.winding : windingAt(row, low)) - kInside;
    double atHigh = windingAtEnd - kInside;
    // By the rule of Illinois: false position that halves the weight of an end that stays.
    int stayed = 0;
    for (int step = 0; step < kMostSteps && high - low > kPrecision; ++step) {
        if ((atLow > 0) == (atHigh > 0)) return high;
        const double x = std::clamp(low + (high - low) * atLow / (atLow - atHigh),
                                    low + 0.1 * kPrecision, high - 0.1 * kPrecision);
        const double at = windingAt(row, x) - kInside;
        if (std::abs(at) < 1e-3) return x;
        if ((at > 0) == (atHigh > 0)) {
            high = x;
            atHigh = at;
            if (stayed < 0) atLow *= 0.5;
            stayed = -1;
        } else {
            low = x;
            atLow = at;
            if (stayed > 0) atHigh *= 0.5;
            stayed = 1;
        }
    }
    return 0.5 * (low + high);
}

double BundleMarch::windingAt(const Row& row, double x) {
    ++mEvaluations;
    return mTerms.at(placeOf(row, x));
}

}  // namespace bandvox
