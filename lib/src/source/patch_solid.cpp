#include "core/words.h"
#include "source/close_patches.h"
#include "source/compensated_sum.h"
#include "source/face_solid.h"
#include "source/free_form_patch.h"
#include "source/patch_source.h"
#include "source/patch_trim.h"
#include "source/region_clip.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/patch_solid.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

/// Of the box's diagonal: its own exactness, the distance at which faces lie on each other, and
/// the parts that pieces are cut into to find where they meet.
constexpr double kExactBox = 1e-7;
constexpr double kOnEachOther = 1e-8;
constexpr double kPart = 1.0 / 64;

/// Volume, relative to area times size, below which a surface counts as flat.
constexpr double kFlatPatches = 1e-9;

double largestCoordinateOf(const std::vector<BezierPatch>& patches) {
    double largest = 0;
    for (const BezierPatch& patch : patches) {
        for (const auto& p : patch.control) {
            for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(p[c] / p[3]));
        }
    }
    return largest;
}

openvdb::BBoxd hullOfPatches(const std::vector<BezierPatch>& patches) {
    openvdb::BBoxd box;
    for (const BezierPatch& patch : patches) {
        for (const auto& p : patch.control) box.expand(Vec3d(p[0], p[1], p[2]) / p[3]);
    }
    return box;
}

/// Free-form patches, all of them or what a union leaves.
class FreeFormSource final : public BoundarySource {
  public:
    struct Piece {
        double volume = 0, area = 0;
    };

    FreeFormSource(std::string name, const std::vector<BezierPatch>& patches,
                   std::vector<std::uint32_t> ofPatch, std::size_t pieces, Progress& progress)
        : mName(std::move(name)), mOfPatch(std::move(ofPatch)), mParts(pieces) {
        const openvdb::BBoxd hull = hullOfPatches(patches);
        mSize = hull.extents().length();
        for (const BezierPatch& patch : patches) mPatches.emplace_back(patch);
        mBounds = tightBounds(mPatches, kExactBox * mSize);
        std::vector<PatchIntegrals> integrals(mPatches.size());
        parallelFor(static_cast<std::int64_t>(mPatches.size()), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            const auto k = static_cast<std::size_t>(i);
            integrals[k] = integrate(mPatches[k], hull.getCenter(), mSize);
        });
        std::vector<CompensatedSum> flux(pieces), area(pieces);
        for (std::size_t i = 0; i < mPatches.size(); ++i) {
            flux[mOfPatch[i]].add(integrals[i].flux / 3);
            area[mOfPatch[i]].add(integrals[i].area);
        }
        for (std::size_t p = 0; p < pieces; ++p) mParts[p] = {flux[p].value(), area[p].value()};
    }

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    double volume() const override { return mVolume; }
    double area() const override { return mArea; }
    std::size_t elementCount() const override { return mPatches.size(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override { return mPatches[i].bounds({}); }
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override {
        requireUsefulLength(quadrature.cellSide.back(), "cell side");
        samplePatch(mPatches[i], mTrims.empty() ? nullptr : &mTrims[mOfPatch[i]], region,
                    quadrature, samples);
    }

    double size() const { return mSize; }
    std::size_t patchesOf(std::size_t piece) const {
        return static_cast<std::size_t>(
            std::count(mOfPatch.begin(), mOfPatch.end(), static_cast<std::uint32_t>(piece)));
    }

    /// Turns pieces outward. Returns which.
    std::vector<bool> turnOutward();

    /// Leaves what is outside of all others. Returns how many pieces others may meet.
    std::size_t unite(Progress& progress);

    void addUp() {
        for (const Piece& part : mParts) {
            mVolume += part.volume;
            mArea += part.area;
        }
    }

  private:
    std::vector<PatchTrim::Piece> windings() const;
    void measureUnion(Progress& progress);

    std::string mName;
    std::vector<FreeFormPatch> mPatches;
    std::vector<std::uint32_t> mOfPatch;
    std::vector<Piece> mParts;
    std::vector<PatchTrim::Piece> mPieces;  ///< of a union
    std::vector<PatchTrim> mTrims;          ///< one for each piece of it
    openvdb::BBoxd mBounds;
    double mSize = 0, mVolume = 0, mArea = 0;
};

std::vector<PatchTrim::Piece> FreeFormSource::windings() const {
    std::vector<std::vector<const BezierPatch*>> members(mParts.size());
    std::vector<openvdb::BBoxd> boxes(mParts.size());
    for (std::size_t i = 0; i < mPatches.size(); ++i) {
        members[mOfPatch[i]].push_back(&mPatches[i].patch());
        boxes[mOfPatch[i]].expand(mPatches[i].bounds({}));
    }
    std::vector<PatchTrim::Piece> pieces(mParts.size());
    parallelFor(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t p) {
        const auto k = static_cast<std::size_t>(p);
        pieces[k].winding = std::make_unique<PatchWinding>(members[k], boxes[k], kPart * mSize);
    });
    return pieces;
}

std::vector<bool> FreeFormSource::turnOutward() {
    const std::size_t count = mParts.size();
    std::vector<std::size_t> outermost(count);
    for (std::size_t p = 0; p < count; ++p) outermost[p] = p;
    if (count > 1) {
        const std::vector<PatchTrim::Piece> pieces = windings();
        for (std::size_t p = 0; p < count; ++p) {
            for (std::size_t other = 0; other < count; ++other) {
                const double held = std::abs(mParts[other].volume);
                if (!(held > std::abs(mParts[outermost[p]].volume))) continue;
                bool isAround = true;
                for (std::size_t i = 0; i < mPatches.size() && isAround; ++i) {
                    if (mOfPatch[i] != p) continue;
                    isAround = pieces[other].winding->at(mPatches[i].at(0.5, 0.5).position) != 0;
                }
                if (isAround) outermost[p] = other;
            }
        }
    }
    std::vector<bool> turns(count);
    for (std::size_t p = 0; p < count; ++p) turns[p] = mParts[outermost[p]].volume < 0;
    for (std::size_t i = 0; i < mPatches.size(); ++i) {
        if (turns[mOfPatch[i]]) mPatches[i] = FreeFormPatch(turned(mPatches[i].patch()));
    }
    for (std::size_t p = 0; p < count; ++p) {
        if (turns[p]) mParts[p].volume = -mParts[p].volume;
    }
    return turns;
}

std::size_t FreeFormSource::unite(Progress& progress) {
    mPieces = windings();
    for (std::size_t p = 0; p < mPieces.size(); ++p) mPieces[p].isCavity = mParts[p].volume < 0;
    std::size_t meeting = 0;
    for (std::size_t p = 0; p < mPieces.size(); ++p) {
        const auto& box = mPieces[p].winding->bounds();
        const bool meets = std::any_of(mPieces.begin(), mPieces.end(), [&](const auto& other) {
            return &other != &mPieces[p] && other.winding->bounds().hasOverlap(box);
        });
        meeting += meets ? 1 : 0;
    }
    if (meeting == 0) {
        addUp();
        return 0;
    }
    for (std::size_t p = 0; p < mPieces.size(); ++p) {
        mTrims.emplace_back(mPieces, p, kOnEachOther * mSize);
    }
    measureUnion(progress);
    return meeting;
}

void FreeFormSource::measureUnion(Progress& progress) {
    // Fine enough for volume and area, which are shown.
    constexpr double kCells = 100;
    SurfaceQuadrature quadrature;
    for (std::size_t k = 0; k < kIntervalRules; ++k) {
        quadrature.cellSide[k] =
            k < 4 ? 0.05 * static_cast<double>(k + 1) : 0.5 * static_cast<double>(k);
    }
    const double cell = mSize / kCells;
    const Vec3d center = mBounds.getCenter() / cell;
    const SamplingRegion region{cell, center - Vec3d(kCells), Vec3d(2 * kCells)};
    std::vector<PatchIntegrals> integrals(mPatches.size());
    parallelFor(static_cast<std::int64_t>(mPatches.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto k = static_cast<std::size_t>(i);
        std::vector<SurfaceSample> samples;
        sampleElement(k, region, quadrature, samples);
        for (const SurfaceSample& s : samples) {
            const Vec3d normal(s.areaVector);
            integrals[k].area += normal.length();
            integrals[k].flux += (Vec3d(s.position) - Vec3d(kCells)).dot(normal);
        }
    });
    CompensatedSum volume, area;
    for (const PatchIntegrals& i : integrals) {
        volume.add(i.flux / 3);
        area.add(i.area);
    }
    mVolume = volume.value() * cell * cell * cell;
    mArea = area.value() * cell * cell;
}

void describePieces(const PatchSolidReport& report, std::vector<std::string>& warnings) {
    if (report.sidesSharedByMore > 0) {
        warnings.push_back(counted(report.sidesSharedByMore, "side is", "sides are") +
                           " shared by more than two patches");
    }
    if (report.patchesFlipped > 0) {
        warnings.push_back(counted(report.patchesFlipped, "patch", "patches") +
                           " disagreed with the neighbours about what is outside and " +
                           (report.patchesFlipped == 1 ? "was" : "were") + " flipped");
    }
    if (!report.holes.empty()) {
        const CappedHole& largest = report.holes.front();
        warnings.push_back(counted(report.holes.size(), "hole", "holes") +
                           " capped (largest: " + counted(largest.edges, "edge", "edges") +
                           ", perimeter " + inShort(largest.perimeter) + ")");
    }
    if (report.piecesTurned > 0) {
        warnings.push_back(counted(report.piecesTurned, "piece was", "pieces were") +
                           " inside out and " + (report.piecesTurned == 1 ? "was" : "were") +
                           " turned");
    }
}

}  // namespace

PatchSolid makePatchSolid(const std::string& name, std::vector<BezierPatch> patches,
                          const PatchSolidOptions& options, Progress& progress) {
    if (!(options.joinTolerance >= 0 && options.joinTolerance < 1)) {
        throw Error(ErrorKind::Usage, "the join tolerance is " + inFull(options.joinTolerance) +
                                          "; expected at least 0 and less than 1");
    }
    if (patches.empty()) {
        throw Error(ErrorKind::Input, "'" + name + "' has no patches; expected a surface");
    }

    // Join the patches, and close what is open.
    PatchSolid solid;
    PatchSolidReport& report = solid.report;
    JoinedPatches joined =
        joinPatches(patches, options.joinTolerance * largestCoordinateOf(patches));
    progress.throwIfInterrupted();
    if (joined.oneSided > 0) {
        throw Error(ErrorKind::Result,
                    "the surface is one-sided, as a Möbius strip is: neighbouring patches cannot "
                    "agree about what is outside, so there is no inside; expected the surface of "
                    "a solid");
    }
    report.pieces = joined.components;
    report.sidesSharedByMore = joined.sharedByMore;
    report.patchesFlipped = joined.flipped;
    if (options.base) {
        standOnBase(patches, joined, *options.base);
    } else {
        report.holes = capLoops(patches, joined);
    }

    // Turn the pieces outward, and unite them.
    auto source = std::make_unique<FreeFormSource>(name, patches, std::move(joined.ofPatch),
                                                   joined.components, progress);
    const std::vector<bool> turns = source->turnOutward();
    report.piecesTurned = static_cast<std::size_t>(std::count(turns.begin(), turns.end(), true));
    if (options.unite && joined.components > 1) {
        report.piecesMeeting = source->unite(progress);
    } else {
        source->addUp();
    }
    if (!(std::abs(source->volume()) > kFlatPatches * source->area() * source->size())) {
        throw Error(ErrorKind::Result, "the surface is flat: it encloses a volume of " +
                                           inShort(source->volume()) + " with an area of " +
                                           inShort(source->area()) + "; expected a solid");
    }
    describePieces(report, report.warnings);
    solid.source = std::move(source);
    return solid;
}

PatchSolid makePatchSolid(const std::string& name, PatchModel model,
                          const PatchSolidOptions& options, Progress& progress) {
    if (model.topology.faces.empty()) {
        return makePatchSolid(name, std::move(model.patches), options, progress);
    }
    if (options.base) {
        throw Error(ErrorKind::Usage, "a base is for a surface over a plane, and '" + name +
                                          "' is a part with faces of its own; expected none");
    }
    return makeFaceSolid(name, std::move(model), progress);
}

}  // namespace bandvox
