#include "mesh/mesh_assembly.h"

#include "mesh/cell_polygons.h"
#include "reconstruct/coefficient_brick.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

namespace bandvox {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

// Blocks that read the same brick are one task.
constexpr int kGroupSide = CoefficientBrick::kSide;
constexpr std::size_t kCandidatesPerTask = 256;
constexpr std::size_t kMostEdgePoints = std::numeric_limits<std::int32_t>::max();

int nodeOf(int x, int y, int z) {
    return (x * kBlockSide + y) * kBlockSide + z;
}

Coord coordOf(int node) {
    return {node / (kBlockSide * kBlockSide), node / kBlockSide % kBlockSide, node % kBlockSide};
}

}  // namespace

/// Goes through the cells of blocks.
class MeshAssembly::CellWalk {
  public:
    CellWalk(const MeshAssembly& assembly, std::size_t group)
        : mAssembly(assembly), mProbe(assembly.mField.reconstruction.probe()), mGroup(group) {}

    CellTriangles walk(const SurfaceMesh& mesh);

  private:
    void visitCell(const Coord& cell, unsigned inside, const SurfaceMesh& mesh);
    unsigned joinedFaces(const Coord& cell, unsigned ambiguous) const;
    std::uint32_t pointOn(int edge, const Coord& cell) const;
    void cutAroundMiddle(std::span<const std::uint32_t> points, const SurfaceMesh& mesh);
    void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    const MeshAssembly& mAssembly;
    std::unique_ptr<DensityProbe> mProbe;
    std::size_t mGroup;
    const Block* mBlock = nullptr;
    std::array<const Block*, 8> mNear;  // this one and those above it
    std::vector<openvdb::Vec3I> mCut;
    CellTriangles mPart;
};

std::size_t MeshAssembly::CoordHash::operator()(const Coord& c) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ static_cast<std::uint32_t>(c[axis])) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    return hash;
}

MeshAssembly::MeshAssembly(const MeshedField& field, Progress& progress)
    : mField(field), mProgress(progress), mMap(field.grid.transform().baseMap()) {
    const Vec3d axes[] = {mMap->applyJacobian({1, 0, 0}), mMap->applyJacobian({0, 1, 0}),
                          mMap->applyJacobian({0, 0, 1})};
    mIsMirrored = axes[0].cross(axes[1]).dot(axes[2]) < 0;
    findBlocks();
    groupBlocks();
}

void MeshAssembly::findBlocks() {
    const std::vector<Coord> candidates = candidateBlocks(mField.grid, mField.iso, kGroupSide);
    const std::size_t tasks = (candidates.size() + kCandidatesPerTask - 1) / kCandidatesPerTask;
    std::vector<std::vector<Block>> found(tasks);
    const ProgressStage stage(mProgress, "find surface", static_cast<std::int64_t>(tasks));
    parallelFor(static_cast<std::int64_t>(tasks), [&](std::int64_t task) {
        mProgress.throwIfInterrupted();
        const std::size_t begin = static_cast<std::size_t>(task) * kCandidatesPerTask;
        const std::size_t end = std::min(begin + kCandidatesPerTask, candidates.size());
        BlockValues values;
        for (std::size_t i = begin; i < end; ++i) {
            values.read(mField.grid, candidates[i]);
            if (!values.crosses(mField.iso)) continue;
            found[task].push_back({candidates[i], CrossedEdges(values, mField.iso)});
        }
        mProgress.advance();
    });
    std::size_t count = 0;
    for (const auto& blocks : found) count += blocks.size();
    mBlocks.reserve(count);
    for (const auto& blocks : found) mBlocks.insert(mBlocks.end(), blocks.begin(), blocks.end());
}

void MeshAssembly::groupBlocks() {
    mBlockAt.reserve(mBlocks.size());
    Coord last;
    for (std::size_t i = 0; i < mBlocks.size(); ++i) {
        Block& block = mBlocks[i];
        block.firstPoint = static_cast<std::uint32_t>(mPoints);
        mPoints += static_cast<std::size_t>(block.edges.count());
        // Points inside of cells come on top, and are few.
        if (mPoints > kMostEdgePoints) {
            throw Error(ErrorKind::Memory, "the mesh has more than " +
                                               std::to_string(kMostEdgePoints) +
                                               " points; expected fewer, as larger voxels give");
        }
        mBlockAt.emplace(block.origin, static_cast<std::uint32_t>(i));
        const Coord group = block.origin & ~(kGroupSide - 1);
        if (i == 0 || group != last) mGroups.push_back(i);
        last = group;
    }
    mGroups.push_back(mBlocks.size());
    // A closed surface has about two triangles to a point; they are gathered before they are
    // joined.
    constexpr double kBytesPerPoint =
        sizeof(Vec3d) + sizeof(openvdb::Vec3f) + 2 * 2 * sizeof(openvdb::Vec3I);
    requireMemory(kBytesPerPoint * static_cast<double>(mPoints), "the mesh");
}

SurfaceMesh MeshAssembly::make() {
    SurfaceMesh mesh;
    mesh.mesh.points.resize(mPoints);
    mesh.normals.resize(mPoints);
    const auto groups = static_cast<std::int64_t>(mGroups.size()) - 1;
    {
        const ProgressStage stage(mProgress, "place points", groups);
        parallelFor(groups, [&](std::int64_t group) {
            mProgress.throwIfInterrupted();
            placePoints({&mBlocks[mGroups[group]], mGroups[group + 1] - mGroups[group]}, mesh);
            mProgress.advance();
        });
    }
    std::vector<CellTriangles> parts(groups);
    {
        const ProgressStage stage(mProgress, "make triangles", groups);
        parallelFor(groups, [&](std::int64_t group) {
            mProgress.throwIfInterrupted();
            parts[group] = CellWalk(*this, static_cast<std::size_t>(group)).walk(mesh);
            mProgress.advance();
        });
    }
    join(parts, mesh);
    return mesh;
}

void MeshAssembly::setPoint(SurfaceMesh& mesh, std::size_t point, const SurfacePlace& place) const {
    mesh.mesh.points[point] = mMap->applyMap(place.index);
    const Vec3d normal = -mMap->applyIJT(place.gradient);
    const double length = normal.length();
    mesh.normals[point] = length > 0 ? openvdb::Vec3f(normal / length) : openvdb::Vec3f(0.0F);
}

void MeshAssembly::placePoints(std::span<const Block> blocks, SurfaceMesh& mesh) const {
    const auto probe = mField.reconstruction.probe();
    const auto accessor = mField.grid.getConstAccessor();
    for (const Block& block : blocks) {
        std::size_t point = block.firstPoint;
        block.edges.forEach([&](int axis, int node) {
            LatticeEdge edge{block.origin + coordOf(node), axis, 0, 0};
            Coord upper = edge.node;
            ++upper[axis];
            edge.low = accessor.getValue(edge.node) - mField.iso;
            edge.high = accessor.getValue(upper) - mField.iso;
            setPoint(mesh, point++, findCrossing(*probe, edge, mField.iso, mField.tolerance));
        });
    }
}

void MeshAssembly::join(std::vector<CellTriangles>& parts, SurfaceMesh& mesh) {
    std::size_t triangles = 0, points = mPoints;
    for (const CellTriangles& part : parts) {
        triangles += part.triangles.size();
        points += part.middles.size();
        mCells += part.cells;
        mAmbiguousFaces += part.ambiguousFaces;
    }
    mAmbiguousFaces /= 2;  // each belongs to two cells
    mesh.mesh.points.resize(points);
    mesh.normals.resize(points);
    mesh.mesh.triangles.reserve(triangles);
    std::size_t next = mPoints;
    for (CellTriangles& part : parts) {
        // Points inside of cells were numbered within their group, behind those on edges.
        const auto shift = static_cast<std::uint32_t>(next - mPoints);
        for (openvdb::Vec3I triangle : part.triangles) {
            for (int k = 0; k < 3; ++k) {
                if (triangle[k] >= mPoints) triangle[k] += shift;
            }
            mesh.mesh.triangles.push_back(triangle);
        }
        for (const SurfacePlace& place : part.middles) setPoint(mesh, next++, place);
        part = {};
    }
}

MeshAssembly::CellTriangles MeshAssembly::CellWalk::walk(const SurfaceMesh& mesh) {
    BlockValues values;
    for (std::size_t i = mAssembly.mGroups[mGroup]; i < mAssembly.mGroups[mGroup + 1]; ++i) {
        mBlock = &mAssembly.mBlocks[i];
        for (int k = 0; k < 8; ++k) {
            const auto found = mAssembly.mBlockAt.find(mBlock->origin.offsetBy(
                (k & 1) * kBlockSide, (k >> 1 & 1) * kBlockSide, (k >> 2) * kBlockSide));
            mNear[k] =
                found == mAssembly.mBlockAt.end() ? nullptr : &mAssembly.mBlocks[found->second];
        }
        values.read(mAssembly.mField.grid, mBlock->origin);
        for (int node = 0; node < kBlockSide * kBlockSide * kBlockSide; ++node) {
            const Coord cell = coordOf(node);
            const unsigned inside = values.inside(cell[0], cell[1], cell[2], mAssembly.mField.iso);
            if (inside != 0 && inside != 0xFF) visitCell(cell, inside, mesh);
        }
    }
    return std::move(mPart);
}

void MeshAssembly::CellWalk::visitCell(const Coord& cell, unsigned inside,
                                       const SurfaceMesh& mesh) {
    const unsigned ambiguous = facesToDecide(inside);
    const CellPolygons polygons =
        traceCell(inside, ambiguous == 0 ? 0 : joinedFaces(cell, ambiguous));
    ++mPart.cells;
    mPart.ambiguousFaces += static_cast<std::size_t>(std::popcount(ambiguous));
    const std::uint8_t* ring = polygons.edges.data();
    for (int r = 0; r < polygons.rings; ring += polygons.sizes[r++]) {
        const std::size_t size = polygons.sizes[r];
        std::array<std::uint32_t, 12> points;
        std::array<Vec3d, 12> places;
        for (std::size_t k = 0; k < size; ++k) {
            points[k] = pointOn(ring[k], cell);
            places[k] = mesh.mesh.points[points[k]];
        }
        mCut.clear();
        if (!cutRing({ring, size}, {places.data(), size}, mCut)) {
            cutAroundMiddle({points.data(), size}, mesh);
        }
        for (const openvdb::Vec3I& t : mCut) emit(points[t[0]], points[t[1]], points[t[2]]);
    }
}

// In the middle of a face the field tells which corners belong together. Both cells at it ask at
// the same place.
unsigned MeshAssembly::CellWalk::joinedFaces(const Coord& cell, unsigned ambiguous) const {
    unsigned joined = 0;
    for (int face = 0; face < 6; ++face) {
        if ((ambiguous >> face & 1) == 0) continue;
        Vec3d middle = (mBlock->origin + cell).asVec3d() + Vec3d(0.5);
        middle[face / 2] += face % 2 == 0 ? -0.5 : 0.5;
        if (mProbe->value(middle) > mAssembly.mField.iso) joined |= 1U << face;
    }
    return joined;
}

std::uint32_t MeshAssembly::CellWalk::pointOn(int edge, const Coord& cell) const {
    const int corner = lowerCorner(edge);
    int near = 0;
    Coord node(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2));
    for (int axis = 0; axis < 3; ++axis) {
        if (node[axis] < kBlockSide) continue;
        node[axis] = 0;
        near |= 1 << axis;
    }
    const Block& block = *mNear[near];
    const int rank = block.edges.rank(edge / 4, nodeOf(node[0], node[1], node[2]));
    return block.firstPoint + static_cast<std::uint32_t>(rank);
}

void MeshAssembly::CellWalk::cutAroundMiddle(std::span<const std::uint32_t> points,
                                             const SurfaceMesh& mesh) {
    Vec3d sum(0.0);
    for (const std::uint32_t point : points) sum += mesh.mesh.points[point];
    const Vec3d index = mAssembly.mMap->applyInverseMap(sum / double(points.size()));
    const auto middle = static_cast<std::uint32_t>(mAssembly.mPoints + mPart.middles.size());
    mPart.middles.push_back(
        projectToSurface(*mProbe, index, mAssembly.mField.iso, mAssembly.mField.tolerance));
    for (std::size_t k = 0; k < points.size(); ++k) {
        emit(points[k], points[(k + 1) % points.size()], middle);
    }
}

void MeshAssembly::CellWalk::emit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mAssembly.mIsMirrored) std::swap(b, c);
    mPart.triangles.emplace_back(a, b, c);
}

}  // namespace bandvox
