#include <bandvox/source/world_space.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace bandvox {

namespace {

struct ScanSpace {
    std::string_view letters, name;
};

constexpr std::array<ScanSpace, 3> kScanSpaces{{{"ras", "right-anterior-superior"},
                                                {"las", "left-anterior-superior"},
                                                {"lps", "left-posterior-superior"}}};

const ScanSpace* scanSpace(const std::string& words) {
    std::string lower = words;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const ScanSpace& space : kScanSpaces) {
        if (lower == space.letters || lower == space.name) return &space;
    }
    return nullptr;
}

}  // namespace

std::string worldSpaceName(const std::string& words) {
    const ScanSpace* space = scanSpace(words);
    return space ? std::string(space->name) : words;
}

std::optional<openvdb::Mat4d> spaceToSpace(const std::string& from, const std::string& to) {
    const ScanSpace* first = scanSpace(from);
    const ScanSpace* other = scanSpace(to);
    if (!first || !other) return std::nullopt;
    openvdb::Mat4d signs = openvdb::Mat4d::identity();
    for (int axis = 0; axis < 3; ++axis) {
        if (first->letters[axis] != other->letters[axis]) signs(axis, axis) = -1;
    }
    return signs;
}

std::string axesFrom(const openvdb::Mat4d& toWorld) {
    static constexpr std::array<std::string_view, 3> kEnds{"RL", "AP", "IS"};
    std::string letters(3, ' ');
    std::array<bool, 3> isTaken{};
    // The clearest axis first, so that each direction of the world is there once.
    for (int turn = 0; turn < 3; ++turn) {
        int best = 0, bestWorld = 0;
        double most = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const openvdb::Vec3d step(toWorld(axis, 0), toWorld(axis, 1), toWorld(axis, 2));
            for (int world = 0; world < 3 && letters[axis] == ' '; ++world) {
                const double share = std::abs(step[world]) / step.length();
                if (isTaken[world] || share <= most) continue;
                most = share;
                best = axis;
                bestWorld = world;
            }
        }
        isTaken[bestWorld] = true;
        letters[best] = kEnds[bestWorld][toWorld(best, bestWorld) < 0 ? 1 : 0];
    }
    return letters;
}

}  // namespace bandvox
