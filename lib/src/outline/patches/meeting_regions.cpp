#include "outline/patches/meeting_regions.h"

#include <memory>
#include <utility>

namespace bandvox {
namespace {

constexpr double kFlat = 0.3;  // radians by which a cell's derivatives turn at most
constexpr std::size_t kMostPairs = 4096;
constexpr double kLeastSize = 1.0 / 8192;  // of a cell, in parameters

using CellPointer = std::shared_ptr<PatchCell>;

/// Divides pairs of cells, all of a depth before the next.
class RegionSearch {
  public:
    RegionSearch(double least, double reach, bool shares)
        : mLeast(least), mReach(reach), mShares(shares) {}

    std::vector<MeetingRegion> search(const PatchCell& a, const PatchCell& b) {
        auto first = std::make_shared<PatchCell>(a);
        const bool isSelf = a.patch == b.patch;
        auto second = isSelf ? first : std::make_shared<PatchCell>(b);
        mPairs.emplace_back(std::move(first), std::move(second));
        while (!mPairs.empty()) {
            const auto pairs = std::exchange(mPairs, {});
            // So many do not get fewer: both are the same surface, or nearly.
            const bool isLast = pairs.size() > kMostPairs;
            for (const auto& [p, q] : pairs) {
                if (p != q && areBoxesApart(*p, *q, mReach)) continue;
                completeCell(*p);
                completeCell(*q);
                if (p == q) {
                    divideSelf(*p);
                } else {
                    examine(p, q, isLast);
                }
            }
        }
        return std::move(mRegions);
    }

  private:
    bool isSmall(const PatchCell& cell) const {
        return cell.extent() < mLeast || cell.size < kLeastSize;
    }

    static bool isFlat(const PatchCell& cell) {
        return cell.alongU.halfAngle < kFlat && cell.alongV.halfAngle < kFlat;
    }

    static std::array<CellPointer, 4> shared(const PatchCell& cell) {
        auto quarters = quartersOf(cell);
        std::array<CellPointer, 4> result;
        for (std::size_t q = 0; q < 4; ++q) {
            result[q] = std::make_shared<PatchCell>(std::move(quarters[q]));
        }
        return result;
    }

    void divideSelf(const PatchCell& cell) {
        if (cell.isOneToOne() || isSmall(cell)) return;
        const auto parts = shared(cell);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = i; j < 4; ++j) mPairs.emplace_back(parts[i], parts[j]);
        }
    }

    void examine(const CellPointer& a, const CellPointer& b, bool isLast) {
        const CellRelation relation = relationOf(*a, *b, mReach);
        if (relation == CellRelation::Apart) return;
        const bool isSimple = relation == CellRelation::Transversal && isFlat(*a) && isFlat(*b);
        if (isSimple || isLast || (isSmall(*a) && isSmall(*b))) {
            mRegions.push_back({a->u0, a->v0, a->size, b->u0, b->v0, b->size, a, b});
            return;
        }
        // Cells that share a side have to be of the same size to know it.
        const double x = a->extent(), y = b->extent();
        const bool divideA = mShares || x > 0.5 * y, divideB = mShares || y > 0.5 * x;
        const auto partsA = divideA ? shared(*a) : std::array<CellPointer, 4>{a};
        const auto partsB = divideB ? shared(*b) : std::array<CellPointer, 4>{b};
        for (const CellPointer& p : partsA) {
            for (const CellPointer& q : partsB) {
                if (p && q) mPairs.emplace_back(p, q);  // what is not divided is the first alone
            }
        }
    }

    double mLeast, mReach;
    bool mShares;
    std::vector<std::pair<CellPointer, CellPointer>> mPairs;
    std::vector<MeetingRegion> mRegions;
};

}  // namespace

bool shareCorner(const PatchCell& a, const PatchCell& b, double reach) {
    if (a.patch == b.patch) return true;
    for (const int i : {0, a.m}) {
        for (const int j : {0, a.n}) {
            for (const int k : {0, b.m}) {
                for (const int l : {0, b.n}) {
                    const Vec d = minus(a.at(i, j), b.at(k, l));
                    if (lengthOf(d) <= reach) return true;
                }
            }
        }
    }
    return false;
}

std::vector<MeetingRegion> meetingRegions(const PatchCell& a, const PatchCell& b, double least,
                                          double reach) {
    return RegionSearch(least, reach, shareCorner(a, b, reach)).search(a, b);
}

}  // namespace bandvox
