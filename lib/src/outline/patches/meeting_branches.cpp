#include "outline/patches/meeting_branches.h"

#include "outline/patches/meeting_regions.h"
#include "outline/patches/meeting_sides.h"
#include "outline/patches/patch_cell.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace bandvox {
namespace {

constexpr double kLeastRegion = 2e-4;  // of the page
constexpr double kSamePoint = 2e-6;    // of the page

/// Finds the branches of one pair of patches.
class PairWork {
  public:
    PairWork(std::span<const ViewPatch> seen, const PatchCell& a, const PatchCell& b, double size)
        : mSize(size),
          mIsSelf(a.patch == b.patch),
          mShares(shareCorner(a, b, kSamePoint * size)),
          mMarch(seen[static_cast<std::size_t>(a.patch)], seen[static_cast<std::size_t>(b.patch)],
                 mShares, size) {}

    void search(const PatchCell& a, const PatchCell& b, std::vector<MeetingBranch>& branches) {
        const auto regions = meetingRegions(a, b, kLeastRegion * mSize, kSamePoint * mSize);
        // Branches from border to border are followed from their ends.
        for (const MeetingRegion& region : regions) seedSides(region, branches);
        for (const MeetingRegion& region : regions) {
            const MeetingPlace middle{
                region.u0 + 0.5 * region.sizeA, region.v0 + 0.5 * region.sizeA,
                region.s0 + 0.5 * region.sizeB, region.t0 + 0.5 * region.sizeB};
            if (const auto seed = mMarch.settled(middle)) {
                if (isNear(region, *seed)) add(*seed, branches);
            }
        }
    }

    /// Follows the branch that goes through a place of a side, parameter `k`, if it is new.
    void searchFrom(const MeetingPlace& guess, std::size_t k,
                    std::vector<MeetingBranch>& branches) {
        if (const auto seed = mMarch.settledOnSide(guess, k)) add(*seed, branches);
    }

  private:
    static bool isNear(const MeetingRegion& region, const MeetingPlace& p) {
        const auto within = [](double x, double low, double size) {
            return x >= low - size && x <= low + 2 * size;
        };
        return within(p[0], region.u0, region.sizeA) && within(p[1], region.v0, region.sizeA) &&
               within(p[2], region.s0, region.sizeB) && within(p[3], region.t0, region.sizeB);
    }

    void seedSides(const MeetingRegion& region, std::vector<MeetingBranch>& branches) {
        const MeetingPlace low{region.u0, region.v0, region.s0, region.t0};
        const std::array<double, 4> sizes{region.sizeA, region.sizeA, region.sizeB, region.sizeB};
        for (std::size_t k = 0; k < 4; ++k) {
            for (const double border : {0.0, 1.0}) {
                if (border == 0 ? low[k] != 0 : low[k] + sizes[k] != 1) continue;
                if (!mShares) {
                    seedPassages(region, k, border, branches);
                    continue;
                }
                // An arc that cuts a side twice has its places near both ends.
                for (const double along : {0.1, 0.5, 0.9}) {
                    MeetingPlace guess;
                    for (std::size_t i = 0; i < 4; ++i) guess[i] = low[i] + 0.5 * sizes[i];
                    guess[k ^ 1U] = low[k ^ 1U] + along * sizes[k];
                    guess[k] = border;
                    const auto seed = mMarch.settledOnSide(guess, k);
                    if (seed && isNear(region, *seed)) add(*seed, branches);
                }
            }
        }
    }

    // However small what is between two passages of a side.
    void seedPassages(const MeetingRegion& region, std::size_t k, double border,
                      std::vector<MeetingBranch>& branches) {
        const bool isFirst = k < 2;
        const int side = static_cast<int>(k % 2) * 2 + (border == 0 ? 0 : 1);
        const std::size_t other = isFirst ? 2 : 0;
        for (const SidePassage& passage :
             sidePassages(isFirst ? *region.cellA : *region.cellB, side,
                          isFirst ? *region.cellB : *region.cellA, kLeastRegion * mSize)) {
            MeetingPlace guess;
            guess[k] = border;
            guess[k ^ 1U] = passage.along;
            guess[other] = passage.s;
            guess[other + 1] = passage.t;
            const auto seed = mMarch.settledOnSide(guess, k);
            const auto isBeside = [&](std::size_t i, double size) {
                return std::abs((*seed)[i] - guess[i]) < size;
            };
            if (seed && isBeside(k ^ 1U, passage.sizeA) && isBeside(other, passage.sizeB) &&
                isBeside(other + 1, passage.sizeB)) {
                add(*seed, branches);
            }
        }
    }

    void add(const MeetingPlace& seed, std::vector<MeetingBranch>& branches) {
        const MeetingPlace turned{seed[2], seed[3], seed[0], seed[1]};
        for (const MeetingBranch& branch : branches) {
            if (mMarch.isOn(branch, seed) || (mIsSelf && mMarch.isOn(branch, turned))) return;
        }
        MeetingBranch branch = mMarch.follow(seed);
        if (branch.places.size() > 1) branches.push_back(std::move(branch));
    }

    double mSize;
    bool mIsSelf, mShares;
    MeetingMarch mMarch;
};

/// Finds the branches of all pairs, and follows them from patch to patch.
class BranchSearch {
  public:
    BranchSearch(std::span<const ViewPatch> seen, std::span<const SharedSide> sides,
                 const FaceRegions* faces, double size)
        : mSeen(seen), mSize(size), mCells(seen.size()), mShells(seen.size(), -1) {
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const int face = placeOf(faces, static_cast<int>(k)).face;
            if (face < 0) continue;
            mShells[k] = faces->topology().faces[static_cast<std::size_t>(face)].shell;
        }
        parallelFor(static_cast<std::int64_t>(seen.size()), [&](std::int64_t k) {
            mCells[static_cast<std::size_t>(k)] =
                cellOf(seen[static_cast<std::size_t>(k)], static_cast<int>(k));
        });
        for (const SharedSide& side : sides) {
            if (!side.b || side.isCrowded) continue;
            mBeside[keyOf(side.a)].push_back({*side.b, side.reversed});
            mBeside[keyOf(*side.b)].push_back({side.a, side.reversed});
        }
    }

    std::vector<MeetingPair> search(Progress& progress) {
        listPairs();
        parallelFor(static_cast<std::int64_t>(mPairs.size()), [&](std::int64_t k) {
            progress.throwIfInterrupted();
            MeetingPair& pair = mPairs[static_cast<std::size_t>(k)];
            const PatchCell &a = cell(pair.first), &b = cell(pair.second);
            PairWork(mSeen, a, b, mSize).search(a, b, pair.branches);
        });
        goOn();
        std::erase_if(mPairs, [](const MeetingPair& pair) { return pair.branches.empty(); });
        return std::move(mPairs);
    }

  private:
    struct Beside {
        PatchSide side;
        bool reversed;
    };
    struct OpenEnd {
        std::size_t pair;
        MeetingPlace place;
    };
    using SideKey = std::pair<int, int>;

    static SideKey keyOf(const PatchSide& side) { return {side.patch, side.side}; }
    const PatchCell& cell(int k) const { return mCells[static_cast<std::size_t>(k)]; }
    bool areOfOneShell(int a, int b) const {
        const int shell = mShells[static_cast<std::size_t>(a)];
        return shell >= 0 && shell == mShells[static_cast<std::size_t>(b)];
    }

    // Pairs of patches whose boxes have a part in common, by sweeping along x.
    void listPairs() {
        std::vector<int> order;
        for (int k = 0; k < static_cast<int>(mCells.size()); ++k) {
            if (mSeen[static_cast<std::size_t>(k)].hasFold) order.push_back(k);
        }
        std::sort(order.begin(), order.end(), [&](int a, int b) {
            return std::pair(cell(a).low[0], a) < std::pair(cell(b).low[0], b);
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const PatchCell& a = cell(order[i]);
            for (std::size_t j = i; j < order.size(); ++j) {
                const PatchCell& b = cell(order[j]);
                if (b.low[0] > a.high[0]) break;
                const bool isApart = a.low[1] > b.high[1] || b.low[1] > a.high[1] ||
                                     a.low[2] > b.high[2] || b.low[2] > a.high[2];
                if (isApart || areOfOneShell(order[i], order[j])) continue;
                mPairs.push_back({std::min(order[i], order[j]), std::max(order[i], order[j]), {}});
            }
        }
        std::sort(mPairs.begin(), mPairs.end(), [](const MeetingPair& a, const MeetingPair& b) {
            return std::pair(a.first, a.second) < std::pair(b.first, b.second);
        });
        for (std::size_t k = 0; k < mPairs.size(); ++k) {
            mPairOf[{mPairs[k].first, mPairs[k].second}] = k;
        }
    }

    // A branch that ends on a side that patches share has another one beyond it, however short.
    void goOn() {
        for (std::size_t k = 0; k < mPairs.size(); ++k) addEnds(k, 0);
        while (!mEnds.empty()) {
            const OpenEnd end = mEnds.front();
            mEnds.pop_front();
            for (std::size_t k = 0; k < 4; ++k) {
                if (end.place[k] == 0 || end.place[k] == 1) cross(end, k);
            }
        }
    }

    void addEnds(std::size_t pair, std::size_t firstBranch) {
        const auto& branches = mPairs[pair].branches;
        for (std::size_t i = firstBranch; i < branches.size(); ++i) {
            if (branches[i].closed) continue;
            mEnds.push_back({pair, branches[i].places.front()});
            mEnds.push_back({pair, branches[i].places.back()});
        }
    }

    void cross(const OpenEnd& end, std::size_t k) {
        const bool isFirst = k < 2;
        const int patch = isFirst ? mPairs[end.pair].first : mPairs[end.pair].second;
        const int other = isFirst ? mPairs[end.pair].second : mPairs[end.pair].first;
        const int side = static_cast<int>(k % 2) * 2 + (end.place[k] == 0 ? 0 : 1);
        const auto found = mBeside.find({patch, side});
        if (found == mBeside.end()) return;
        const double along = end.place[k ^ 1U];
        const std::size_t at = isFirst ? 2 : 0;
        for (const Beside& beside : found->second) {
            const auto [u, v] = onSide(beside.side.side, beside.reversed ? 1 - along : along);
            const int next = beside.side.patch;
            const bool isOrdered = next <= other;
            const MeetingPlace guess = isOrdered
                                           ? MeetingPlace{u, v, end.place[at], end.place[at + 1]}
                                           : MeetingPlace{end.place[at], end.place[at + 1], u, v};
            const auto pair = mPairOf.find({std::min(next, other), std::max(next, other)});
            if (pair == mPairOf.end()) continue;
            MeetingPair& into = mPairs[pair->second];
            const std::size_t before = into.branches.size();
            const std::size_t fixed = (isOrdered ? 0U : 2U) + (beside.side.side < 2 ? 0U : 1U);
            PairWork(mSeen, cell(into.first), cell(into.second), mSize)
                .searchFrom(guess, fixed, into.branches);
            addEnds(pair->second, before);
        }
    }

    std::span<const ViewPatch> mSeen;
    double mSize;
    std::vector<PatchCell> mCells;
    std::vector<int> mShells;  // of patches; -1: of none
    std::map<SideKey, std::vector<Beside>> mBeside;
    std::vector<MeetingPair> mPairs;
    std::map<std::pair<int, int>, std::size_t> mPairOf;
    std::deque<OpenEnd> mEnds;
};

}  // namespace

std::vector<MeetingPair> meetingBranches(std::span<const ViewPatch> seen,
                                         std::span<const SharedSide> sides, double size,
                                         Progress& progress, const FaceRegions* faces) {
    return BranchSearch(seen, sides, faces, size).search(progress);
}

}  // namespace bandvox
