#pragma once

#include "outline/patches/view_patch.h"

#include <array>
#include <optional>
#include <vector>

namespace bandvox {

/// A place of two patches: (u, v) of the first one, (s, t) of the second one.
using MeetingPlace = std::array<double, 4>;

/// A part of the curve in which two patches meet.
struct MeetingBranch {
    std::vector<MeetingPlace> places;
    bool closed = false;  ///< the last place is the first one
};

/// Follows the curve in which two patches meet, by steps along its tangent and back onto both
/// patches, in the plane across the step. Steps are as long as the curve turns little, so that
/// branches which nearly touch each other are not mixed up.
class MeetingMarch {
  public:
    /// `shares`: the patches share a side or a corner, or are the same, so that a place where both
    /// are on their borders is none. `size`: of the page. The patches are kept by reference.
    MeetingMarch(const ViewPatch& a, const ViewPatch& b, bool shares, double size);

    /// The place nearest to a guess where both patches meet; none if there is none, if they touch
    /// there or share it.
    std::optional<MeetingPlace> settled(const MeetingPlace& guess) const;

    /// The same where parameter k, 0 to 3, keeps its value.
    std::optional<MeetingPlace> settledOnSide(const MeetingPlace& guess, std::size_t k) const;

    /// The branch through a place, in both directions up to the borders of the patches.
    MeetingBranch follow(const MeetingPlace& seed) const;

    /// Whether a place is on a branch.
    bool isOn(const MeetingBranch& branch, const MeetingPlace& place) const;

  private:
    using Row = std::array<double, 4>;  // in lengths, as parameters times mWeights
    struct Step {
        MeetingPlace place;
        Row tangent;         // length 1
        double opening = 0;  // grows with the angle between the patches
    };
    struct Walk {
        std::vector<MeetingPlace> places;  // after the start
        bool closed = false;
    };

    std::array<Row, 3> jacobian(const MeetingPlace& p, std::array<double, 3>& gap) const;
    Row tangentAt(const MeetingPlace& p, double* opening = nullptr) const;
    bool isProper(const MeetingPlace& p) const;
    bool converge(MeetingPlace& p, std::optional<Row> row, const MeetingPlace& base) const;
    std::optional<Step> advanced(const Step& from, double length) const;
    bool closes(const Step& from, double length, const MeetingPlace& start) const;
    std::optional<MeetingPlace> leftBetween(const MeetingPlace& a, const MeetingPlace& b) const;
    double safeLength(const Step& from, const Step& to, double apart) const;
    Walk walk(const MeetingPlace& start, const Row& direction) const;
    Row lengths(const MeetingPlace& from, const MeetingPlace& to) const;

    const ViewPatch& mA;
    const ViewPatch& mB;
    bool mShares, mIsSelf;
    double mSize;
    Row mWeights;  // lengths of the derivatives by the parameters
};

}  // namespace bandvox
