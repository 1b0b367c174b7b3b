#include "source/shape_tree.h"

#include "source/solid_formula.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// The proportions of the tree, in units of its trunk's height before it is fitted to the box.
constexpr int kLevels = 6;             ///< of branches above the trunk
constexpr double kTrunkFoot = 0.15;    ///< half width
constexpr double kTrunkTop = 0.115;    ///< half width
constexpr double kFirstHeight = 0.62;  ///< of the lowest branches
constexpr double kHeightRatio = 0.80;  ///< from one level to the next
constexpr double kTaper = 0.94;        ///< side of a top relative to its foot, as squares
constexpr double kLean = 0.54;         ///< sideways per height, away from the sibling
constexpr double kLeanKept = 0.62;     ///< of the parent's lean
constexpr double kVariation = 0.22;    ///< by which siblings differ in lean and height

}  // namespace

TreeShape::TreeShape() {
    Branch trunk;
    trunk.y0 = 0.0;
    trunk.y1 = 1.0;
    trunk.foot = {{-kTrunkFoot, -kTrunkFoot}, {kTrunkFoot, kTrunkFoot}};
    trunk.top = {{-kTrunkTop, -kTrunkTop}, {kTrunkTop, kTrunkTop}};
    constexpr double kFar = 1e3;
    grow(trunk, {{-kFar, -kFar}, {kFar, kFar}}, {0.0, 0.0}, 0);
    fitToBox();
    boundBranches();
}

/// Adds a branch and all that grows from it, within `room`, and returns its index.
int TreeShape::grow(const Branch& sprout, const Rectangle& room, const double (&lean)[2],
                    int level) {
    const int index = static_cast<int>(mBranches.size());
    mBranches.push_back(sprout);
    if (level == kLevels) return index;

    const int axis = level % 2;
    const double split = 0.5 * (sprout.top.min[axis] + sprout.top.max[axis]);
    for (int side = 0; side < 2; ++side) {
        // Give the child its half of the foot and of the room.
        const double outward = side == 0 ? -1.0 : 1.0;
        Branch child;
        child.foot = sprout.top;
        Rectangle childRoom = room;
        (side == 0 ? child.foot.max : child.foot.min)[axis] = split;
        (side == 0 ? childRoom.max : childRoom.min)[axis] = split;

        // Let one of the siblings lean more, and the other grow higher.
        const double vary = (side + level / 2) % 2 == 0 ? kVariation : -kVariation;
        const double height = kFirstHeight * std::pow(kHeightRatio, level) * (1.0 - vary);
        double childLean[2] = {kLeanKept * lean[0], kLeanKept * lean[1]};
        childLean[axis] += outward * kLean * (1.0 + vary);

        // Set the top square where it leans to, but in the room.
        const double footArea =
            (child.foot.max[0] - child.foot.min[0]) * (child.foot.max[1] - child.foot.min[1]);
        for (int a = 0; a < 2; ++a) {
            const double width = childRoom.max[a] - childRoom.min[a];
            const double half = std::min(0.5 * kTaper * std::sqrt(footArea), 0.45 * width);
            const double middle = 0.5 * (child.foot.min[a] + child.foot.max[a]);
            const double center =
                std::clamp(middle + height * childLean[a], childRoom.min[a] + 1.1 * half,
                           childRoom.max[a] - 1.1 * half);
            child.top.min[a] = center - half;
            child.top.max[a] = center + half;
        }
        child.y0 = sprout.y1;
        child.y1 = sprout.y1 + height;
        const int childIndex = grow(child, childRoom, childLean, level + 1);
        mBranches[index].children[side] = childIndex;
    }
    return index;
}

/// Moves and scales all branches so that the height becomes [-1, 1].
void TreeShape::fitToBox() {
    double height = 0.0;
    Rectangle box = mBranches.front().foot;
    for (const Branch& b : mBranches) {
        height = std::max(height, b.y1);
        for (int a = 0; a < 2; ++a) {
            box.min[a] = std::min(box.min[a], b.top.min[a]);
            box.max[a] = std::max(box.max[a], b.top.max[a]);
        }
    }
    const double scale = 2.0 / height;
    const auto fitHeight = [&](double y) { return y == height ? 1.0 : y * scale - 1.0; };
    const auto fit = [&](double& x, int a) { x = (x - 0.5 * (box.min[a] + box.max[a])) * scale; };
    for (Branch& b : mBranches) {
        b.y0 = fitHeight(b.y0);
        b.y1 = fitHeight(b.y1);
        for (int a = 0; a < 2; ++a) {
            for (Rectangle* r : {&b.foot, &b.top}) {
                fit(r->min[a], a);
                fit(r->max[a], a);
            }
        }
    }
}

void TreeShape::boundBranches() {
    // Children come after their parents.
    // NOLINTNEXTLINE(modernize-loop-convert): Clang 14 cannot compile GCC's std::views::reverse.
    for (auto b = mBranches.rbegin(); b != mBranches.rend(); ++b) {
        b->bounds = openvdb::BBoxd();
        for (const auto& [r, y] : {std::pair(b->foot, b->y0), std::pair(b->top, b->y1)}) {
            b->bounds.expand(Vec3d(r.min[0], y, r.min[1]));
            b->bounds.expand(Vec3d(r.max[0], y, r.max[1]));
        }
        for (const int child : b->children) {
            if (child >= 0) b->bounds.expand(mBranches[child].bounds);
        }
    }
}

/// Calls visit(value, slope) for each plane of a branch, for the signed distance along an axis
/// value + slope·p that is ≤ 0 inside.
template <typename Visitor>
void TreeShape::visitPlanes(const Branch& b, const Visitor& visit) {
    visit(b.y0, Vec3d(0.0, -1.0, 0.0));
    visit(-b.y1, Vec3d(0.0, 1.0, 0.0));
    for (int a = 0; a < 2; ++a) {
        Vec3d along(0.0);
        along[2 * a] = 1.0;
        // The faces lean: they stand at foot + lean·(y - y0).
        const double low = (b.top.min[a] - b.foot.min[a]) / (b.y1 - b.y0);
        const double high = (b.top.max[a] - b.foot.max[a]) / (b.y1 - b.y0);
        visit(b.foot.min[a] - low * b.y0, Vec3d(0.0, low, 0.0) - along);
        visit(-b.foot.max[a] + high * b.y0, along - Vec3d(0.0, high, 0.0));
    }
}

void TreeShape::cross(SolidRow& row) const {
    crossBranch(0, row);
}

/// Fills the row where it runs inside a branch or what grows from it.
void TreeShape::crossBranch(int index, SolidRow& row) const {
    const Branch& b = mBranches[index];
    LineInterval near = row.whole();
    for (int axis = 0; axis < 3; ++axis) {
        near.clip(row.start[axis] - b.bounds.max()[axis], row.step[axis]);
        near.clip(b.bounds.min()[axis] - row.start[axis], -row.step[axis]);
    }
    // A row that only touches the box is not worth telling apart from one that misses it by
    // rounding.
    if (near.low > near.high + 1) return;
    LineInterval inside = row.whole();
    visitPlanes(b, [&](double value, const Vec3d& slope) {
        inside.clip(value + slope.dot(row.start), slope.dot(row.step));
    });
    row.fill(inside);
    for (const int child : b.children) {
        if (child >= 0) crossBranch(child, row);
    }
}

std::optional<bool> TreeShape::constantIn(const openvdb::BBoxd& box) const {
    bool isInside = false;
    if (isOutside(0, box, isInside)) return false;
    return isInside ? std::optional(true) : std::nullopt;
}

/// True if the box is outside a branch and all that grows from it. Sets `isInside` if it is
/// inside one of them.
bool TreeShape::isOutside(int index, const openvdb::BBoxd& box, bool& isInside) const {
    const Branch& b = mBranches[index];
    openvdb::BBoxd reach = b.bounds;
    reach.expand(kBoxMargin);
    if (!reach.hasOverlap(box)) return true;
    const Vec3d center = box.getCenter();
    const Vec3d half = 0.5 * box.extents();
    bool beyond = false;
    bool within = true;
    visitPlanes(b, [&](double value, const Vec3d& slope) {
        const double middle = value + slope.dot(center);
        double spread = 0.0;
        for (int axis = 0; axis < 3; ++axis) spread += std::abs(slope[axis]) * half[axis];
        const double margin = kBoxMargin * (1.0 + std::abs(slope.y()));
        beyond = beyond || middle - spread > margin;
        within = within && middle + spread <= -margin;
    });
    isInside = isInside || within;
    for (const int child : b.children) {
        if (child >= 0) beyond = isOutside(child, box, isInside) && beyond;
    }
    return beyond;
}

double TreeShape::volume() const {
    // The cross-section is the product of two linear functions of the height.
    double volume = 0.0;
    for (const Branch& b : mBranches) {
        double foot[2];
        double top[2];
        for (int a = 0; a < 2; ++a) {
            foot[a] = b.foot.max[a] - b.foot.min[a];
            top[a] = b.top.max[a] - b.top.min[a];
        }
        volume += (b.y1 - b.y0) * ((foot[0] * foot[1] + top[0] * top[1]) / 3.0 +
                                   (foot[0] * top[1] + top[0] * foot[1]) / 6.0);
    }
    return volume;
}

double TreeShape::appendPatches(PatchList& patches) const {
    double area = 0.0;
    const auto append = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
        auto patch = std::make_unique<QuadPatch>(a, b, c, d);
        area += patch->area();
        patches.push_back(std::move(patch));
    };
    for (const Branch& b : mBranches) {
        // Name the corners counter-clockwise as seen from above.
        const auto corners = [](const Rectangle& r, double y) {
            return std::array<Vec3d, 4>{Vec3d(r.min[0], y, r.max[1]), Vec3d(r.max[0], y, r.max[1]),
                                        Vec3d(r.max[0], y, r.min[1]), Vec3d(r.min[0], y, r.min[1])};
        };
        const std::array<Vec3d, 4> foot = corners(b.foot, b.y0);
        const std::array<Vec3d, 4> top = corners(b.top, b.y1);
        for (int i = 0; i < 4; ++i) {
            const int next = (i + 1) % 4;
            append(foot[i], foot[next], top[next], top[i]);
        }
        if (&b == &mBranches.front()) append(foot[0], foot[3], foot[2], foot[1]);
        if (b.children[0] < 0) append(top[0], top[1], top[2], top[3]);
    }
    return area;
}

}  // namespace bandvox
