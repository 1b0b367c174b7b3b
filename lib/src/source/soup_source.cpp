#include "source/compensated_sum.h"
#include "source/mesh_bounds.h"
#include "source/region_clip.h"
#include "source/winding_rows.h"

#include <bandvox/core/error.h>
#include <bandvox/source/soup_source.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace bandvox {

namespace {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::Vec3d;

constexpr int kMostRows = 64;

// Along faces that the rows do not cross, samples without area stand this far apart, voxels.
constexpr double kMarkSpacing = 2;

std::shared_ptr<const WindingRows> makeRows(const Mesh& soup, const SoupOptions& options,
                                            Progress& progress) {
    if (options.rowsPerVoxel < 1 || options.rowsPerVoxel > kMostRows) {
        throw Error(ErrorKind::Usage, "the rows are " + std::to_string(options.rowsPerVoxel) +
                                          " to a voxel; expected 1 to " +
                                          std::to_string(kMostRows));
    }
    if (!(options.voxelSize > 0 && std::isfinite(options.voxelSize))) {
        throw Error(ErrorKind::Usage, "the voxel size is " + std::to_string(options.voxelSize) +
                                          "; expected a positive one, in world units");
    }
    const auto rows = std::make_shared<WindingRows>(
        WindingTree(soup), boundsOf(soup),
        RowLattice::turned(options.voxelSize, options.rowsPerVoxel), progress);
    if (options.solid != nullptr && !options.solid->triangles.empty()) {
        rows->subtract(*options.solid, progress);
    }
    return rows;
}

// Places where one of two rows is inside and the other is not, in runs longer than the spacing of
// marks: those are what the faces between them, which no row crosses, are made of.
template <typename Visit>
void forEachDifference(std::span<const float> a, std::span<const float> b, const Visit& visit) {
    std::size_t i = 0, j = 0;
    bool inA = false, inB = false;
    float begin = 0;
    while (i < a.size() || j < b.size()) {
        const bool takesA = j == b.size() || (i < a.size() && a[i] <= b[j]);
        const float x = takesA ? a[i++] : b[j++];
        if (inA != inB && x - begin > kMarkSpacing) visit(begin, x);
        (takesA ? inA : inB) ^= true;
        begin = x;
    }
}

}  // namespace

SoupSource::SoupSource(std::string name, const Mesh& soup, const SoupOptions& options,
                       Progress& progress)
    : mName(std::move(name)), mRows(makeRows(soup, options, progress)) {
    findElements();
    if (!mElements.empty()) return;
    throw Error(ErrorKind::Result,
                mName +
                    ": the winding number of its triangles is above 0.5 nowhere; expected "
                    "triangles that enclose something, counter-clockwise seen from outside");
}

SoupSource::SoupSource(const SoupSource& all, bool isWider)
    : mName(all.mName), mRows(all.mRows), mIsWider(isWider) {
    findElements();
}

SoupSource::~SoupSource() = default;

std::unique_ptr<SoupSource> SoupSource::withFewerRows() const {
    return std::unique_ptr<SoupSource>(new SoupSource(*this, true));
}

std::int64_t SoupSource::rowCount() const {
    const Coord bundles = mRows->bundleCount();
    std::int64_t count = 0;
    for (std::int64_t b = 0; b < std::int64_t(bundles.y()) * bundles.z(); ++b) {
        forEachRow(b, [&](int, int, int) { ++count; });
    }
    return count;
}

std::int64_t SoupSource::evaluations() const {
    return mRows->evaluations();
}

// The area that a row stands for, voxels².
double SoupSource::areaOfRow() const {
    return (mIsWider ? 4.0 : 1.0) / mRows->lattice().rowCount();
}

void SoupSource::findElements() {
    const Coord bundles = mRows->bundleCount();
    const double voxel = mRows->lattice().voxelSize;
    CompensatedSum length;
    std::int64_t crossings = 0;
    for (std::int64_t b = 0; b < std::int64_t(bundles.y()) * bundles.z(); ++b) {
        float low = HUGE_VALF, high = -HUGE_VALF;
        forEachRow(b, [&](int y, int z, int i) {
            const std::span<const float> row = mRows->row(b, y, z, i);
            if (row.empty()) return;
            low = std::min(low, row.front());
            high = std::max(high, row.back());
            crossings += std::ssize(row);
            for (std::size_t k = 0; k < row.size(); k += 2) {
                length.add(static_cast<double>(row[k + 1]) - row[k]);
            }
        });
        if (low > high) continue;
        const Vec3d first(mRows->firstVoxel(b).asVec3d());
        const BBoxd box(voxel * Vec3d(mRows->xOrigin() + low, first.y(), first.z()),
                        voxel * Vec3d(mRows->xOrigin() + high, first.y() + WindingRows::kSide,
                                      first.z() + WindingRows::kSide));
        mElements.push_back({b, box});
        mBounds.expand(box);
    }
    mVolume = length.value() * areaOfRow() * voxel * voxel * voxel;
    mArea = 2.0 * static_cast<double>(crossings) * areaOfRow() * voxel * voxel;
}

// Visits the rows of a bundle that are used.
template <typename Visit>
void SoupSource::forEachRow(std::int64_t bundle, const Visit& visit) const {
    const RowLattice& lattice = mRows->lattice();
    const Coord first = mRows->firstVoxel(bundle);
    for (int y = 0; y < WindingRows::kSide; ++y) {
        for (int z = 0; z < WindingRows::kSide; ++z) {
            for (int i = 0; i < lattice.rowCount(); ++i) {
                if (mIsWider && !lattice.isOfWiderLattice(first.y() + y, first.z() + z, i)) {
                    continue;
                }
                visit(y, z, i);
            }
        }
    }
}

// The crossings of a row that may lie in a bundle beside the given one.
std::span<const float> SoupSource::rowNear(std::int64_t bundle, int y, int z, int i) const {
    constexpr int kSide = WindingRows::kSide;
    const Coord bundles = mRows->bundleCount();
    const auto by = static_cast<int>(bundle / bundles.z()) + (y == kSide ? 1 : y < 0 ? -1 : 0);
    const auto bz = static_cast<int>(bundle % bundles.z()) + (z == kSide ? 1 : z < 0 ? -1 : 0);
    if (by < 0 || bz < 0 || by >= bundles.y() || bz >= bundles.z()) return {};
    return mRows->row(std::int64_t(by) * bundles.z() + bz, (y + kSide) % kSide, (z + kSide) % kSide,
                      i);
}

void SoupSource::sampleElement(std::size_t i, const SamplingRegion& region,
                               const SurfaceQuadrature& /*quadrature*/,
                               std::vector<SurfaceSample>& samples) const {
    const std::int64_t bundle = mElements[i].bundle;
    const RowLattice& lattice = mRows->lattice();
    // Relative to a whole voxel, as a mesh is sampled.
    const Coord first = mRows->firstVoxel(bundle);
    const Vec3d base(mRows->xOrigin(), first.y(), first.z());
    const RegionClip clip({region.voxelSize, region.origin - base, region.extent});
    const double low = region.origin.x() - base.x(), high = low + region.extent.x();
    const Vec3d area(areaOfRow(), 0, 0);
    forEachRow(bundle, [&](int y, int z, int k) {
        const std::span<const float> row = mRows->row(bundle, y, z, k);
        Vec3d at(0, y + lattice.rows[k].y, z + lattice.rows[k].z);
        const auto begin = std::lower_bound(row.begin(), row.end(), low);
        for (auto x = begin; x != row.end() && *x < high; ++x) {
            at.x() = *x;
            clip.append(at, (x - row.begin()) % 2 == 0 ? -area : area, samples);
        }
    });

    // Mark the faces along x that lie between the rows of a voxel, or of it and its neighbours.
    for (int voxel = 0; voxel < WindingRows::kSide * WindingRows::kSide; ++voxel) {
        const int y = voxel / WindingRows::kSide, z = voxel % WindingRows::kSide;
        for (int k = 0; k < lattice.rowCount(); ++k) {
            Vec3d at(0, y + lattice.rows[k].y, z + lattice.rows[k].z);
            const auto mark = [&](float from, float to) {
                const double end = std::min<double>(to, high);
                const double skipped = std::floor((low - from) / kMarkSpacing);
                for (at.x() = from + kMarkSpacing * std::max(0.0, skipped); at.x() < end;
                     at.x() += kMarkSpacing) {
                    clip.append(at, Vec3d(0.0), samples);
                }
            };
            const std::span<const float> row = mRows->row(bundle, y, z, k);
            if (k + 1 < lattice.rowCount()) {
                forEachDifference(row, mRows->row(bundle, y, z, k + 1), mark);
            }
            if (k != 0) continue;
            forEachDifference(row, rowNear(bundle, y + 1, z, 0), mark);
            forEachDifference(row, rowNear(bundle, y, z + 1, 0), mark);
            forEachDifference(row, rowNear(bundle, y - 1, z, 0), mark);
            forEachDifference(row, rowNear(bundle, y, z - 1, 0), mark);
        }
    }
}

}  // namespace bandvox
