#include "voxelize/lattice_mesh.h"

#include <bandvox/core/memory.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// A lattice is at most 2^21 samples wide, so differences of points take 39 bits, and the products
// of three that a crossing is found by stay below 2^121.
__extension__ using Wide = __int128;

// The least whole number not below n / d.
std::int64_t ceilOfRatio(Wide n, Wide d) {
    if (d < 0) {
        n = -n;
        d = -d;
    }
    const Wide quotient = n / d;  // rounded towards 0
    return static_cast<std::int64_t>(quotient * d < n ? quotient + 1 : quotient);
}

}  // namespace

// Where the plane of a triangle crosses rows: x = (d - ny y - nz z) / nx, fixed point.
struct LatticeMesh::Plane {
    Wide nx, ny, nz, d;
    bool behindItself;

    Plane(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, ScanAxis axis) {
        const Wide ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        const Wide vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        nx = uy * vz - uz * vy;
        ny = uz * vx - ux * vz;
        nz = ux * vy - uy * vx;
        d = nx * a[0] + ny * a[1] + nz * a[2];
        behindItself = isBehindItself<Wide>({nx, ny, nz}, axis);
    }

    // The first voxel of a row whose sample is behind the plane.
    int voxelBehind(int y, int z) const {
        const Wide n = d - ny * (y * kVoxel) - nz * (z * kVoxel);
        const std::int64_t first = ceilOfRatio(n, nx * kVoxel);
        const bool isOnPlane = !behindItself && nx * kVoxel * first == n;
        return static_cast<int>(isOnPlane ? first + 1 : first);
    }
};

LatticeMesh::LatticeMesh(const Mesh& mesh, const VoxelLattice& lattice)
    : mMesh(mesh), mLattice(lattice), mPoints(roundToLattice(mesh, lattice)) {
    requireMemory(static_cast<double>(sizeof(mStart[0]) * lattice.columnCount()),
                  "the mesh on the lattice");
    // Sort the triangles by column: count, then place.
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    mStart.assign(lattice.columnCount() + 1, 0);
    for (std::uint32_t t = 0; t < count; ++t) {
        forEachColumn(t, [&](std::int64_t column) { ++mStart[column + 1]; });
    }
    for (std::size_t c = 1; c < mStart.size(); ++c) mStart[c] += mStart[c - 1];
    requireMemory(static_cast<double>(mStart.back() * sizeof(mTriangles[0]) +
                                      mStart.size() * sizeof(mStart[0])),
                  "the mesh on the lattice");
    mTriangles.resize(mStart.back());
    std::vector<std::uint64_t> next(mStart.begin(), mStart.end() - 1);
    for (std::uint32_t t = 0; t < count; ++t) {
        forEachColumn(t, [&](std::int64_t column) { mTriangles[next[column]++] = t; });
    }
}

// Visits the columns of which a row may meet a triangle. Most triangles of a fine mesh lie
// between the rows; long slanted ones meet few of the columns in their box.
void LatticeMesh::forEachColumn(std::uint32_t triangle,
                                const std::function<void(std::int64_t)>& visit) const {
    const LatticePoint a = point(triangle, 0), b = point(triangle, 1), c = point(triangle, 2);
    const auto range = [&](int axis) {
        return Interval{ceilVoxel(std::min({a[axis], b[axis], c[axis]})),
                        ceilVoxel(std::max({a[axis], b[axis], c[axis]}))};
    };
    const Interval rows = range(1), planes = range(2);
    if (rows.begin >= rows.end) return;
    for (int z = planes.begin; z < planes.end;) {
        const int block = z >> kBlockLog2;
        const int end = std::min(planes.end, (block + 1) << kBlockLog2);
        Interval y = rows;
        if (rows.end - rows.begin > kBlockSide) y = reachBetween(triangle, z, end - 1);
        const int first = std::max(y.begin, rows.begin) >> kBlockLog2;
        const int last = (std::min(y.end, rows.end) - 1) >> kBlockLog2;
        for (int column = first; column <= last; ++column) {
            visit(static_cast<std::int64_t>(column) * mLattice.blockCount.z() + block);
        }
        z = end;
    }
}

// The rows y that a triangle may meet on the planes from `zFirst` to `zLast`: a triangle is
// convex, so its edges there bound it. In floating point, hence a voxel more on each side.
LatticeMesh::Interval LatticeMesh::reachBetween(std::uint32_t triangle, int zFirst,
                                                int zLast) const {
    const double low = double(zFirst) * kVoxel, high = double(zLast) * kVoxel;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int corner = 0; corner < 3; ++corner) {
        LatticePoint p = point(triangle, corner), q = point(triangle, (corner + 1) % 3);
        if (p[2] > q[2]) std::swap(p, q);
        const double pz = double(p[2]), qz = double(q[2]);
        if (qz < low || pz > high) continue;
        const double slope = qz > pz ? double(q[1] - p[1]) / (qz - pz) : 0;
        const double enters = pz < low ? double(p[1]) + slope * (low - pz) : double(p[1]);
        const double leaves = qz > high ? double(p[1]) + slope * (high - pz) : double(q[1]);
        least = std::min({least, enters, leaves});
        most = std::max({most, enters, leaves});
    }
    if (least > most) return {0, 0};
    return {static_cast<int>(std::floor(least / kVoxel)) - 1,
            static_cast<int>(std::ceil(most / kVoxel)) + 2};
}

// The rows y of the plane z that meet a triangle. Its edges are cut where they pass the plane, an
// end on the plane counting as before it; two of them do, or none.
LatticeMesh::Interval LatticeMesh::rowsOf(std::uint32_t triangle, int z) const {
    const std::int64_t plane = z * kVoxel;
    std::array<int, 2> cuts{};
    std::size_t found = 0;
    for (int corner = 0; corner < 3; ++corner) {
        LatticePoint p = point(triangle, corner), q = point(triangle, (corner + 1) % 3);
        if (p[2] > q[2]) std::swap(p, q);
        if (p[2] > plane || q[2] <= plane) continue;
        const Wide height = q[2] - p[2];
        cuts[found++] = static_cast<int>(
            ceilOfRatio(p[1] * height + Wide(plane - p[2]) * (q[1] - p[1]), height * kVoxel));
    }
    if (found < 2) return {0, 0};
    return {std::min(cuts[0], cuts[1]), std::max(cuts[0], cuts[1])};
}

void LatticeMesh::cross(const openvdb::Coord& block, std::vector<RowCrossing>& crossings) const {
    // The column's rows, and its triangles.
    const openvdb::Coord place = block - mLattice.firstBlock;
    const openvdb::Coord corner = place << kBlockLog2;
    const int first = mLattice.corner().x();
    const std::size_t column =
        static_cast<std::size_t>(place.y()) * mLattice.blockCount.z() + place.z();
    const std::span<const std::uint32_t> triangles(mTriangles.data() + mStart[column],
                                                   mTriangles.data() + mStart[column + 1]);
    // The normal points outward. The order of a scan along y is a mirrored one.
    const int inwards = mLattice.axis == ScanAxis::Y ? -1 : 1;
    for (const std::uint32_t t : triangles) {
        const Plane plane(point(t, 0), point(t, 1), point(t, 2), mLattice.axis);
        if (plane.nx == 0) continue;
        const auto change = static_cast<std::int16_t>(plane.nx < 0 ? inwards : -inwards);
        for (int z = corner.z(); z < corner.z() + kBlockSide; ++z) {
            const Interval rows = rowsOf(t, z);
            const int begin = std::max(rows.begin, corner.y());
            const int end = std::min(rows.end, corner.y() + kBlockSide);
            for (int y = begin; y < end; ++y) {
                const int row = kBlockSide * (y - corner.y()) + (z - corner.z());
                crossings.push_back(
                    {first + plane.voxelBehind(y, z), static_cast<std::int16_t>(row), change});
            }
        }
    }
}

}  // namespace bandvox
