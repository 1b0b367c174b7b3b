#include "paper_shapes.h"

#include <bandvox/source/close_mesh.h>
#include <bandvox/source/unite_shells.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;
using std::numbers::pi;

using Ring = std::vector<Vec3d>;  // counter-clockwise seen from where the next one lies

// Adds the solid between rings of as many points each, its ends being flat.
void addLoft(const std::vector<Ring>& rings, Mesh& mesh) {
    const auto start = static_cast<openvdb::Index32>(mesh.points.size());
    const auto count = static_cast<openvdb::Index32>(rings[0].size());
    for (const Ring& ring : rings) mesh.points.insert(mesh.points.end(), ring.begin(), ring.end());
    const auto at = [&](std::size_t ring, openvdb::Index32 i) {
        return start + static_cast<openvdb::Index32>(ring) * count + i % count;
    };
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        for (openvdb::Index32 i = 0; i < count; ++i) {
            mesh.triangles.emplace_back(at(r, i), at(r, i + 1), at(r + 1, i + 1));
            mesh.triangles.emplace_back(at(r, i), at(r + 1, i + 1), at(r + 1, i));
        }
    }
    // The ends, as fans about their middles.
    for (const bool isLast : {false, true}) {
        const std::size_t r = isLast ? rings.size() - 1 : 0;
        Vec3d middle(0.0);
        for (const Vec3d& p : rings[r]) middle += p / double(count);
        const auto center = static_cast<openvdb::Index32>(mesh.points.size());
        mesh.points.push_back(middle);
        for (openvdb::Index32 i = 0; i < count; ++i) {
            const openvdb::Index32 a = at(r, i), b = at(r, i + 1);
            mesh.triangles.emplace_back(isLast ? a : b, isLast ? b : a, center);
        }
    }
}

// Adds a bar from `from` to `to` with a regular section of so many sides.
void addBar(const Vec3d& from, const Vec3d& to, double radius, int sides, Mesh& mesh) {
    Vec3d along = to - from;
    along.normalize();
    Vec3d u = along.cross(std::abs(along.y()) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0));
    u.normalize();
    const Vec3d v = along.cross(u);
    const auto ring = [&](const Vec3d& middle) {
        Ring points;
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * pi * (i + 0.5) / sides;
            points.push_back(middle + radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
        return points;
    };
    addLoft({ring(from), ring(to)}, mesh);
}

void addBox(const Vec3d& low, const Vec3d& high, Mesh& mesh) {
    const auto ring = [&](double y) {
        return Ring{{low.x(), y, low.z()},
                    {low.x(), y, high.z()},
                    {high.x(), y, high.z()},
                    {high.x(), y, low.z()}};
    };
    addLoft({ring(low.y()), ring(high.y())}, mesh);
}

// A section of a blade at a distance from the axis, which is y: a symmetric aerofoil of the NACA's
// four digits, its trailing edge closed.
Ring bladeSection(double distance, double chord, double twist) {
    constexpr int kHalf = 48;
    constexpr double kThickness = 0.16;
    Ring ring;
    for (int i = 0; i < 2 * kHalf; ++i) {
        const double angle = pi * i / kHalf;
        const double x = 0.5 * (1 + std::cos(angle));
        const double half = 5 * kThickness *
                            (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x +
                             0.2843 * x * x * x - 0.1036 * x * x * x * x);
        const double u = chord * (x - 0.4), v = chord * (i <= kHalf ? half : -half);
        ring.push_back({distance, std::cos(twist) * v + std::sin(twist) * u,
                        std::cos(twist) * u - std::sin(twist) * v});
    }
    return ring;
}

Vec3d turnedAboutY(const Vec3d& p, double angle) {
    return {std::cos(angle) * p.x() + std::sin(angle) * p.z(), p.y(),
            std::cos(angle) * p.z() - std::sin(angle) * p.x()};
}

// Closes what is to be closed, makes one solid of the parts, and turns it.
MeshSource finished(const std::string& name, Mesh mesh) {
    for (Vec3d& p : mesh.points) {
        p = turnedAboutY(p, 0.44);
        p = Vec3d(p.x(), std::cos(0.53) * p.y() - std::sin(0.53) * p.z(),
                  std::sin(0.53) * p.y() + std::cos(0.53) * p.z());
        p = Vec3d(std::cos(0.37) * p.x() - std::sin(0.37) * p.y(),
                  std::sin(0.37) * p.x() + std::cos(0.37) * p.y(), p.z());
    }
    return {name, uniteShells(closeMesh(std::move(mesh)).mesh).mesh};
}

}  // namespace

MeshSource chair() {
    Mesh mesh;
    addBox({-0.5, 0.9, -0.48}, {0.5, 1.0, 0.5}, mesh);
    const auto leg = [](double sideX, double sideZ, double height) {
        const double splay = 0.5 - 0.12 * height;
        return Vec3d(sideX * splay, height, sideZ * splay);
    };
    for (const double x : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) addBar(leg(x, z, 0), leg(x, z, 0.95), 0.06, 4, mesh);
        addBar(leg(x, -1, 0.35), leg(x, 1, 0.35), 0.035, 12, mesh);
        addBar(leg(-1, x, 0.5), leg(1, x, 0.5), 0.035, 12, mesh);
        addBar({0.42 * x, 0.95, -0.42}, {0.46 * x, 2.0, -0.72}, 0.055, 4, mesh);
    }
    for (const double height : {1.25, 1.45, 1.65, 1.85}) {
        const double z = -0.42 - 0.3 * (height - 0.95) / 1.05;
        addBar({-0.45, height, z}, {0.45, height, z}, 0.04, 6, mesh);
    }
    return finished("chair", std::move(mesh));
}

MeshSource propeller() {
    Mesh mesh;
    for (int blade = 0; blade < 3; ++blade) {
        constexpr int kSections = 40;
        std::vector<Ring> rings;
        for (int i = 0; i <= kSections; ++i) {
            const double t = static_cast<double>(i) / kSections;
            const double distance = 0.1 + 0.9 * t;
            const double chord = 0.28 + 0.5 * t * (1 - t) - 0.08 * t;
            const double twist = 0.3 + 0.8 * (1 - t);
            Ring ring = bladeSection(distance, chord, twist);
            for (Vec3d& p : ring) p = turnedAboutY(p, 2 * pi * blade / 3);
            rings.push_back(std::move(ring));
        }
        addLoft(rings, mesh);
    }
    std::vector<Ring> hub;
    constexpr int kRings = 48, kSides = 96;
    for (int i = 1; i < kRings; ++i) {
        const double polar = pi * i / kRings;
        Ring ring;
        for (int k = 0; k < kSides; ++k) {
            ring.push_back(turnedAboutY({0.2 * std::sin(polar), -0.32 * std::cos(polar), 0},
                                        2 * pi * k / kSides));
        }
        hub.push_back(std::move(ring));
    }
    addLoft(hub, mesh);
    return finished("propeller", std::move(mesh));
}

}  // namespace bandvox::experiments
