#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// Corners of a triangle net over one patch: (steps + 1)² points in space.
struct PatchNet {
    int steps = 0;
    std::vector<std::array<double, 3>> points;  ///< [u][v]

    const std::array<double, 3>& at(int i, int j) const {
        return points[static_cast<std::size_t>(i) * static_cast<std::size_t>(steps + 1) +
                      static_cast<std::size_t>(j)];
    }
};

/// A place where two nets pass through each other: parameters in both patches.
struct NetMeeting {
    double u = 0, v = 0, s = 0, t = 0;
};

/// A chain of such places, of the patches `first` and `second`, first <= second.
struct NetMeetings {
    int first = 0, second = 0;
    bool closed = false;
    std::vector<NetMeeting> places;
};

/// Where triangles of nets pass through each other that do not share a corner. All have the same
/// number of steps.
std::vector<NetMeetings> netMeetings(std::span<const PatchNet> nets);

}  // namespace bandvox
