#include "source/join_patches.h"

#include "source/no_index.h"
#include "source/weld_points.h"

#include <algorithm>
#include <map>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Curve = std::vector<std::array<double, 4>>;

constexpr std::uint32_t kSides = 4;

// The sides, counter-clockwise as parameters: v = 0, u = 1, v = 1, u = 0.
Curve sideOf(const BezierPatch& patch, std::uint32_t side) {
    const int n = patch.degreeU;
    const int m = patch.degreeV;
    Curve curve;
    const int last = side % 2 == 0 ? n : m;
    for (int k = 0; k <= last; ++k) {
        switch (side) {
            case 0:
                curve.push_back(patch.at(k, 0));
                break;
            case 1:
                curve.push_back(patch.at(n, k));
                break;
            case 2:
                curve.push_back(patch.at(n - k, m));
                break;
            default:
                curve.push_back(patch.at(0, m - k));
        }
    }
    return curve;
}

Vec3d euclidean(const std::array<double, 4>& p) {
    return Vec3d(p[0], p[1], p[2]) / p[3];
}

bool isPoint(const Curve& curve, double tolerance) {
    return std::all_of(curve.begin(), curve.end(), [&](const auto& p) {
        return (euclidean(p) - euclidean(curve[0])).length() <= tolerance;
    });
}

// Rational curves of degrees n and m are the same if they agree at n + m + 1 parameters.
bool coincide(const Curve& a, const Curve& b, bool reversed, double tolerance) {
    const std::size_t steps = a.size() + b.size() - 2;
    for (std::size_t k = 0; k <= steps; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(steps);
        const Vec3d difference = curvePoint(a, t) - curvePoint(b, reversed ? 1 - t : t);
        if (difference.length() > tolerance) return false;
    }
    return true;
}

struct Side {
    Curve curve;
    std::uint32_t from = kNoIndex, to = kNoIndex;
    std::uint32_t mate = kNoIndex;
    bool agrees = false;  // runs against its mate
};

std::vector<Side> collectSides(const std::vector<BezierPatch>& patches, double tolerance) {
    std::vector<Side> sides(kSides * patches.size());
    std::vector<Vec3d> ends;
    for (std::uint32_t s = 0; s < sides.size(); ++s) {
        sides[s].curve = sideOf(patches[s / kSides], s % kSides);
        ends.push_back(euclidean(sides[s].curve.front()));
        ends.push_back(euclidean(sides[s].curve.back()));
    }
    const std::vector<std::uint32_t> ids = weld(ends, tolerance);
    for (std::size_t s = 0; s < sides.size(); ++s) {
        if (isPoint(sides[s].curve, tolerance)) continue;
        sides[s].from = ids[2 * s];
        sides[s].to = ids[2 * s + 1];
    }
    return sides;
}

// Makes mates of the sides that exactly two patches share. Returns how many are shared by more.
std::size_t findMates(std::vector<Side>& sides, double tolerance) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> byEnds;
    for (std::uint32_t s = 0; s < sides.size(); ++s) {
        if (sides[s].from == kNoIndex) continue;
        byEnds[std::minmax(sides[s].from, sides[s].to)].push_back(s);
    }
    std::size_t more = 0;
    for (auto& [ends, list] : byEnds) {
        while (!list.empty()) {
            // Of those between the same ends, the ones that are the same curve.
            const Side& first = sides[list.front()];
            std::vector<std::uint32_t> same, others;
            std::vector<bool> reversed;
            for (const std::uint32_t s : list) {
                const bool along = coincide(first.curve, sides[s].curve, false, tolerance);
                if (along || coincide(first.curve, sides[s].curve, true, tolerance)) {
                    same.push_back(s);
                    reversed.push_back(!along);
                } else {
                    others.push_back(s);
                }
            }
            if (same.size() == 2) {
                sides[same[0]].mate = same[1];
                sides[same[1]].mate = same[0];
                sides[same[0]].agrees = sides[same[1]].agrees = reversed[1];
            }
            if (same.size() > 2) ++more;
            list = std::move(others);
        }
    }
    return more;
}

// Visits the component of a patch that has none yet, and decides which patches to flip.
void visit(std::uint32_t seed, const std::vector<Side>& sides, std::vector<bool>& flip,
           JoinedPatches& joined) {
    const auto component = static_cast<std::uint32_t>(joined.components++);
    std::vector<std::uint32_t> members{seed};
    joined.ofPatch[seed] = component;
    bool isOneSided = false;
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (std::uint32_t s = kSides * members[i]; s < kSides * (members[i] + 1); ++s) {
            if (sides[s].mate == kNoIndex) continue;
            const std::uint32_t other = sides[s].mate / kSides;
            const bool turn = sides[s].agrees == flip[members[i]];
            if (joined.ofPatch[other] == kNoIndex) {
                joined.ofPatch[other] = component;
                flip[other] = turn;
                members.push_back(other);
            } else if (flip[other] != turn) {
                isOneSided = true;
            }
        }
    }
    if (isOneSided) ++joined.oneSided;
    auto flips = static_cast<std::size_t>(
        std::count_if(members.begin(), members.end(), [&](std::uint32_t p) { return flip[p]; }));
    if (2 * flips > members.size()) {
        for (const std::uint32_t p : members) flip[p] = !flip[p];
        flips = members.size() - flips;
    }
    joined.flipped += flips;
}

}  // namespace

Vec3d curvePoint(Curve control, double t) {
    for (std::size_t rest = control.size() - 1; rest > 0; --rest) {
        for (std::size_t i = 0; i < rest; ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                control[i][c] = (1 - t) * control[i][c] + t * control[i + 1][c];
            }
        }
    }
    return euclidean(control[0]);
}

BezierPatch turned(const BezierPatch& patch) {
    BezierPatch result = patch;
    for (int i = 0; i <= patch.degreeU; ++i) {
        for (int j = 0; j <= patch.degreeV; ++j) {
            result.at(i, j) = patch.at(i, patch.degreeV - j);
        }
    }
    return result;
}

JoinedPatches joinPatches(std::vector<BezierPatch>& patches, double tolerance) {
    std::vector<Side> sides = collectSides(patches, tolerance);
    JoinedPatches joined;
    joined.sharedByMore = findMates(sides, tolerance);
    joined.ofPatch.assign(patches.size(), kNoIndex);
    std::vector<bool> flip(patches.size(), false);
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
        if (joined.ofPatch[p] == kNoIndex) visit(p, sides, flip, joined);
    }
    for (std::size_t s = 0; s < sides.size(); ++s) {
        const std::size_t p = s / kSides;
        Side& side = sides[s];
        if (side.from == kNoIndex || side.mate != kNoIndex) continue;
        if (flip[p]) {
            std::swap(side.from, side.to);
            std::reverse(side.curve.begin(), side.curve.end());
        }
        joined.open.push_back({joined.ofPatch[p], side.from, side.to, std::move(side.curve)});
    }
    for (std::size_t p = 0; p < patches.size(); ++p) {
        if (flip[p]) patches[p] = turned(patches[p]);
    }
    return joined;
}

std::vector<std::vector<OpenSide>> findLoops(const std::vector<OpenSide>& open) {
    // As many sides arrive at a point as leave it, so a walk ends where it has been.
    std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::size_t> leaving;
    for (std::size_t s = 0; s < open.size(); ++s) {
        leaving.emplace(std::pair(open[s].component, open[s].from), s);
    }
    std::vector<std::vector<OpenSide>> loops;
    while (!leaving.empty()) {
        std::vector<OpenSide> path;
        std::pair<std::uint32_t, std::uint32_t> at = leaving.begin()->first;
        for (auto next = leaving.find(at); next != leaving.end(); next = leaving.find(at)) {
            path.push_back(open[next->second]);
            at.second = path.back().to;
            leaving.erase(next);
            // Cut off the loop that has just closed, and go on from where it did.
            const auto start = std::find_if(path.begin(), path.end(), [&](const OpenSide& side) {
                return side.from == at.second;
            });
            if (start == path.end()) continue;
            loops.emplace_back(start, path.end());
            path.erase(start, path.end());
        }
    }
    return loops;
}

}  // namespace bandvox
