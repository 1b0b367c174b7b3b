#include "core/words.h"
#include "source/cap_holes.h"
#include "source/compensated_sum.h"
#include "source/index_blocks.h"
#include "source/mesh_bounds.h"
#include "source/orient_components.h"
#include "source/remove_duplicates.h"
#include "source/separate_soup.h"
#include "source/stitch_cracks.h"
#include "source/turn_outward.h"
#include "source/weld_points.h"

#include <bandvox/core/error.h>
#include <bandvox/source/close_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Volume, relative to area times size, below which a mesh counts as flat.
constexpr double kFlatMesh = 1e-9;

/// Part of a mesh's area that may be one-sided.
constexpr double kMostOneSided = 0.5;

/// Height of a triangle, relative to its longest edge, below which it has no area.
constexpr double kNoHeight = 1e-12;

/// Checks what later steps rely on.
void checkMesh(const Mesh& mesh) {
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
    if (mesh.triangles.size() > kMost || mesh.points.size() > kMost) {
        throw Error(ErrorKind::Input, "the mesh has " + std::to_string(mesh.points.size()) +
                                          " points and " + std::to_string(mesh.triangles.size()) +
                                          " triangles; expected at most " + std::to_string(kMost) +
                                          " of each");
    }
    const std::size_t pointCount = mesh.points.size();
    const std::size_t wrong = countIndices(mesh.triangles.size(), [&](std::size_t i) {
        const Vec3I& t = mesh.triangles[i];
        return std::max({t[0], t[1], t[2]}) >= pointCount;
    });
    for (std::size_t i = 0; wrong > 0 && i < mesh.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            if (mesh.triangles[i][k] < pointCount) continue;
            throw Error(ErrorKind::Input, "triangle " + std::to_string(i) + " refers to point " +
                                              std::to_string(mesh.triangles[i][k]) +
                                              "; expected less than " +
                                              std::to_string(mesh.points.size()));
        }
    }
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (mesh.points[i].isFinite()) continue;
        throw Error(ErrorKind::Input,
                    "point " + std::to_string(i) + " has a coordinate that is not finite");
    }
}

double largestCoordinate(const Mesh& mesh) {
    double largest = 0.0;
    for (const Vec3d& p : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis]));
    }
    return largest;
}

std::size_t countWithoutArea(const Mesh& mesh) {
    return countIndices(mesh.triangles.size(), [&](std::size_t i) {
        const Vec3I& t = mesh.triangles[i];
        const Vec3d e1 = mesh.points[t[1]] - mesh.points[t[0]];
        const Vec3d e2 = mesh.points[t[2]] - mesh.points[t[0]];
        const double longest = std::max({e1.lengthSqr(), e2.lengthSqr(), (e2 - e1).lengthSqr()});
        return e1.cross(e2).length() <= kNoHeight * longest;
    });
}

void requireTolerance(double tolerance, const char* name) {
    if (tolerance >= 0.0 && tolerance < 1.0) return;
    throw Error(ErrorKind::Usage, std::string("the ") + name + " tolerance is " +
                                      std::to_string(tolerance) +
                                      "; expected at least 0 and less than 1");
}

double longestSide(const Mesh& mesh) {
    const Vec3d size = boundsOf(mesh).extents();
    return std::max({size.x(), size.y(), size.z()});
}

/// Why a mesh has no inside, before it is closed: it is one-sided for the most part. Empty if not.
std::string problemOfSides(const Mesh& mesh, const MeshComponents& components) {
    if (components.oneSided.empty()) return {};
    std::vector<char> oneSided(components.count, 0);
    for (const std::uint32_t c : components.oneSided) oneSided[c] = 1;
    CompensatedSum all, ofOneSided;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3I& t = mesh.triangles[i];
        const Vec3d a = mesh.points[t[0]];
        const double area = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).length();
        all.add(area);
        if (oneSided[components.ofTriangle[i]] != 0) ofOneSided.add(area);
    }
    if (ofOneSided.value() <= kMostOneSided * all.value()) return {};
    return "the mesh is one-sided, as a Möbius strip is: neighbouring triangles cannot agree "
           "about what is outside, so there is no inside; expected the surface of a solid";
}

/// Why a closed mesh is no solid: it encloses nothing. Empty if it does.
std::string problemOfVolume(const Mesh& mesh) {
    const openvdb::BBoxd box = boundsOf(mesh);
    CompensatedSum volume;
    CompensatedSum area;
    for (const Vec3I& t : mesh.triangles) {
        const Vec3d a = mesh.points[t[0]] - box.getCenter();
        const Vec3d normal =
            (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
        volume.add(a.dot(normal) / 6.0);
        area.add(0.5 * normal.length());
    }
    const double size = box.extents().length();
    if (std::abs(volume.value()) > kFlatMesh * area.value() * size) return {};
    std::ostringstream text;
    text << "the mesh is flat: it encloses a volume of " << volume.value() << " with an area of "
         << area.value() << " and a size of " << size << "; expected a solid";
    return text.str();
}

// The holes of pieces that are not soup, in order of falling perimeter.
std::vector<CappedHole> holesOfSolids(const std::vector<HoleOfPiece>& all,
                                      const std::vector<char>& isSoup) {
    std::vector<CappedHole> holes;
    for (const HoleOfPiece& hole : all) {
        if (isSoup.empty() || isSoup[hole.piece] == 0) holes.push_back(hole.hole);
    }
    std::stable_sort(holes.begin(), holes.end(), [](const CappedHole& a, const CappedHole& b) {
        return a.perimeter > b.perimeter;
    });
    return holes;
}

SeparatedSoup separate(Mesh& mesh, MeshComponents& components, std::size_t firstCap,
                       Capping capping) {
    switch (capping) {
        case Capping::All:
            return {};
        case Capping::Sensible:
            return separateSoup(mesh, components, firstCap);
        case Capping::None:
            return separateAll(mesh, components, firstCap);
    }
    return {};
}

void requireNoProblem(const CloseMeshOptions& options, const CloseMeshReport& report) {
    if (options.requireSolid && !report.problem.empty()) {
        throw Error(ErrorKind::Result, report.problem);
    }
}

void describe(const MeshComponents& components, const TurnedComponents& turned, Capping capping,
              CloseMeshReport& report) {
    const auto warn = [&report](const std::string& text) { report.warnings.push_back(text); };
    if (report.duplicateTriangles > 0) {
        warn(counted(report.duplicateTriangles, "triangle lies", "triangles lie") +
             " on another with the same corners and " +
             (report.duplicateTriangles == 1 ? "was" : "were") + " dropped");
    }
    if (report.crackPoints + report.edgesSplit > 0) {
        warn("cracks were stitched: " + counted(report.crackPoints, "point", "points") +
             " joined, " + counted(report.edgesSplit, "edge", "edges") +
             " split at points that lie on them");
    }
    if (report.nonManifoldEdges > 0) {
        warn(counted(report.nonManifoldEdges, "edge is", "edges are") +
             " shared by more than two triangles");
    }
    if (report.oneSided > 0) {
        warn(counted(report.oneSided, "piece is", "pieces are") +
             " one-sided, so that inside and outside are not defined there");
    }
    if (components.trianglesFlipped > 0) {
        warn(counted(components.trianglesFlipped, "triangle", "triangles") +
             " disagreed with the neighbours about what is outside and " +
             (components.trianglesFlipped == 1 ? "was" : "were") + " flipped");
    }
    if (report.sheets > 0) {
        warn(counted(report.sheets, "piece is a sheet", "pieces are sheets") +
             " that enclose hardly anything, alone or with others");
    }
    if (report.soupPieces > 0 && capping != Capping::None) {
        warn(counted(report.soupPieces, "piece", "pieces") + " of " +
             counted(report.soupTriangles, "triangle", "triangles") + " " +
             (report.soupPieces == 1 ? "is" : "are") +
             " not closed; what the triangles enclose together is told by their winding number");
    }
    if (!report.holes.empty()) {
        std::ostringstream text;
        text << counted(report.holes.size(), "hole", "holes")
             << " capped (largest: " << report.holes.front().edges << " edges, perimeter "
             << report.holes.front().perimeter << ")";
        warn(text.str());
    }
    if (turned.components > 0) {
        warn(counted(turned.components, "piece was", "pieces were") + " inside out and " +
             (turned.components == 1 ? "was" : "were") + " turned");
    }
}

}  // namespace

ClosedMesh closeMesh(Mesh mesh, const CloseMeshOptions& options, Progress& progress) {
    requireTolerance(options.weldTolerance, "weld");
    requireTolerance(options.crackTolerance, "crack");
    const ProgressStage stage(progress, "close mesh", 4);
    const auto advance = [&progress] {
        progress.advance();
        progress.throwIfInterrupted();
    };
    ClosedMesh closed;
    CloseMeshReport& report = closed.report;

    // Make the mesh one of distinct points and distinct triangles.
    checkMesh(mesh);
    removeUnusedPoints(mesh);
    report.pointsWelded = weldPoints(mesh, options.weldTolerance * largestCoordinate(mesh));
    report.degenerateTriangles = dropCollapsed(mesh);
    report.duplicateTriangles = removeDuplicates(mesh);
    if (mesh.triangles.empty()) {
        throw Error(ErrorKind::Input, "the mesh has no triangle with an area; expected a solid");
    }
    StitchedCracks cracks = stitchCracks(mesh,
                                         std::max(options.crackTolerance * longestSide(mesh),
                                                  options.weldTolerance * largestCoordinate(mesh)),
                                         progress);
    report.crackPoints = cracks.pointsJoined;
    report.edgesSplit = cracks.edgesSplit;
    report.degenerateTriangles += countWithoutArea(mesh);
    advance();

    // Make the pieces consistent and closed.
    MeshComponents components = orientComponents(mesh, cracks.edges);
    cracks.edges = {};
    report.components = components.count;
    report.oneSided = components.oneSided.size();
    report.problem = problemOfSides(mesh, components);
    requireNoProblem(options, report);
    report.nonManifoldEdges = components.nonManifoldEdges;
    advance();
    const std::size_t firstCap = mesh.triangles.size();
    const std::vector<HoleOfPiece> holes = capHoles(mesh, components);
    SeparatedSoup separated = report.problem.empty()
                                  ? separate(mesh, components, firstCap, options.capping)
                                  : SeparatedSoup();
    report.soupPieces = separated.pieces;
    report.soupTriangles = separated.soup.triangles.size();
    report.sheets = separated.sheets;
    report.holes = holesOfSolids(holes, separated.isSoup);
    closed.soup = std::move(separated.soup);
    advance();

    // Turn them outward. Triangles without area stay: their neighbours' edges are theirs.
    const TurnedComponents turned = turnOutward(mesh, components);
    report.componentsTurned = turned.components;
    report.trianglesFlipped =
        components.trianglesFlipped + separated.trianglesFlipped + turned.triangles;
    if (report.problem.empty()) report.problem = problemOfVolume(mesh);
    if (report.soupTriangles > 0 && !report.problem.empty()) {
        // What encloses nothing adds nothing to the soup.
        report.problem.clear();
        mesh = {};
    }
    requireNoProblem(options, report);
    describe(components, turned, options.capping, report);
    advance();
    closed.mesh = std::move(mesh);
    return closed;
}

}  // namespace bandvox
