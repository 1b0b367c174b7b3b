#include "source/face_solid.h"

#include "core/words.h"
#include "source/compensated_sum.h"
#include "source/face_trim.h"
#include "source/free_form_patch.h"
#include "source/patch_source.h"
#include "source/region_clip.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Vec3d;

constexpr double kBoxTolerance = 1e-7;  // of the size
constexpr double kFlatShell = 1e-9;     // volume, relative to area times size

/// Cells of patches, from coarse to fine.
std::array<ParameterCell, 4> quartersOf(const ParameterCell& c) {
    const double u = 0.5 * (c.u0 + c.u1), v = 0.5 * (c.v0 + c.v1);
    return {{{c.u0, u, c.v0, v}, {u, c.u1, c.v0, v}, {c.u0, u, v, c.v1}, {u, c.u1, v, c.v1}}};
}

class FaceSource final : public BoundarySource {
  public:
    FaceSource(std::string name, PatchModel model, Progress& progress)
        : mName(std::move(name)),
          mTopology(std::move(model.topology)),
          mRegions(mTopology),
          mProgress(&progress) {
        openvdb::BBoxd hull;
        for (std::size_t k = 0; k < model.patches.size(); ++k) {
            mPatches.emplace_back(std::move(model.patches[k]));
            mTrims.emplace_back(mRegions, static_cast<int>(k));
            hull.expand(mPatches.back().bounds({}));
        }
        mSize = hull.extents().length();
        findBounds();
        measure(hull);
        mProgress = nullptr;
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
        const std::size_t before = samples.size();
        const bool isTrimmed = mRegions.isTrimmed(static_cast<int>(i));
        samplePatch(mPatches[i], isTrimmed ? &mTrims[i] : nullptr, region, quadrature, samples);
        if (!isTurned(i)) return;
        for (std::size_t k = before; k < samples.size(); ++k) {
            samples[k].areaVector = -samples[k].areaVector;
        }
    }

    double size() const { return mSize; }
    std::size_t shells() const { return mTurned.size(); }
    std::size_t shellsTurned() const {
        return static_cast<std::size_t>(std::count(mTurned.begin(), mTurned.end(), true));
    }

  private:
    std::size_t shellOf(std::size_t patch) const {
        const int face = mTopology.places[patch].face;
        return static_cast<std::size_t>(mTopology.faces[static_cast<std::size_t>(face)].shell);
    }
    bool isTurned(std::size_t patch) const { return !mTurned.empty() && mTurned[shellOf(patch)]; }

    // The box of what belongs to the faces.
    void findBounds() {
        openvdb::BBoxd known;
        for (const FaceEdge& edge : mTopology.edges) {
            if (edge.uses.empty()) continue;
            for (const EdgePiece& piece : edge.uses[0].pieces) {
                constexpr int kSteps = 32;
                for (int k = 0; k <= kSteps; ++k) {
                    const auto [u, v] = jetAt(piece.curve, static_cast<double>(k) / kSteps).place;
                    known.expand(mPatches[static_cast<std::size_t>(piece.patch)].at(u, v).position);
                }
            }
        }
        openvdb::BBoxd rest;
        for (std::size_t i = 0; i < mPatches.size(); ++i) {
            mProgress->throwIfInterrupted();
            expandBy(i, known, rest);
        }
        known.expand(rest);
        mBounds = known;
    }

    void expandBy(std::size_t i, openvdb::BBoxd& known, openvdb::BBoxd& rest) const {
        constexpr int kDeepest = 24;
        const FreeFormPatch& patch = mPatches[i];
        std::vector<std::pair<ParameterCell, int>> pending{{{}, 0}};
        while (!pending.empty()) {
            const auto [cell, depth] = pending.back();
            pending.pop_back();
            const openvdb::BBoxd box = patch.bounds(cell);
            bool isWithin = true;
            for (int axis = 0; axis < 3; ++axis) {
                const double near = kBoxTolerance * mSize;
                isWithin &= box.min()[axis] >= known.min()[axis] - near &&
                            box.max()[axis] <= known.max()[axis] + near;
            }
            if (isWithin) continue;
            const CellTrim::Share share = mTrims[i].share(patch, cell);
            if (share == CellTrim::Share::None) continue;
            if (depth == kDeepest) {
                rest.expand(box);
                continue;
            }
            const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
            if (share == CellTrim::Share::All || mRegions.keeps(static_cast<int>(i), u, v)) {
                known.expand(patch.at(u, v).position);
            }
            for (const ParameterCell& part : quartersOf(cell)) {
                pending.emplace_back(part, depth + 1);
            }
        }
    }

    // Volumes and areas, and which shells are inside out.
    void measure(const openvdb::BBoxd& hull) {
        constexpr double kCells = 200;
        SurfaceQuadrature quadrature;
        for (std::size_t k = 0; k < kIntervalRules; ++k) {
            quadrature.cellSide[k] =
                k < 4 ? 0.05 * static_cast<double>(k + 1) : 0.5 * static_cast<double>(k);
        }
        const double cell = mSize / kCells;
        const SamplingRegion region{cell, hull.getCenter() / cell - Vec3d(kCells),
                                    Vec3d(2 * kCells)};
        std::vector<PatchIntegrals> integrals(mPatches.size());
        parallelFor(static_cast<std::int64_t>(mPatches.size()), [&](std::int64_t i) {
            mProgress->throwIfInterrupted();
            const auto k = static_cast<std::size_t>(i);
            if (!mRegions.isTrimmed(static_cast<int>(i))) {
                integrals[k] = integrate(mPatches[k], hull.getCenter(), mSize);
                return;
            }
            std::vector<SurfaceSample> samples;
            sampleElement(k, region, quadrature, samples);
            for (const SurfaceSample& s : samples) {
                const Vec3d normal(s.areaVector);
                integrals[k].area += normal.length() * cell * cell;
                integrals[k].flux +=
                    (Vec3d(s.position) - Vec3d(kCells)).dot(normal) * cell * cell * cell;
            }
        });
        std::vector<CompensatedSum> fluxes;
        CompensatedSum area;
        for (std::size_t i = 0; i < mPatches.size(); ++i) {
            if (fluxes.size() <= shellOf(i)) fluxes.resize(shellOf(i) + 1);
            fluxes[shellOf(i)].add(integrals[i].flux / 3);
            area.add(integrals[i].area);
        }
        CompensatedSum volume;
        for (const CompensatedSum& flux : fluxes) {
            mTurned.push_back(flux.value() < 0);
            volume.add(std::abs(flux.value()));
        }
        mVolume = volume.value();
        mArea = area.value();
    }

    std::string mName;
    FaceTopology mTopology;
    FaceRegions mRegions;
    std::vector<FreeFormPatch> mPatches;
    std::vector<FaceTrim> mTrims;
    std::vector<bool> mTurned;  // shells
    openvdb::BBoxd mBounds;
    double mSize = 0, mVolume = 0, mArea = 0;
    Progress* mProgress;  // while it is made
};

std::size_t openEdges(const FaceTopology& topology) {
    return static_cast<std::size_t>(
        std::count_if(topology.edges.begin(), topology.edges.end(), [](const FaceEdge& edge) {
            std::ptrdiff_t turn = 0;
            for (const EdgeUse& use : edge.uses) turn += use.isReversed ? -1 : 1;
            return turn != 0;
        }));
}

}  // namespace

PatchSolid makeFaceSolid(const std::string& name, PatchModel model, Progress& progress) {
    const FaceTopology& topology = model.topology;
    const bool isAllFaces = std::all_of(topology.places.begin(), topology.places.end(),
                                        [](const FacePlace& place) { return place.face >= 0; });
    if (!isAllFaces) {
        throw Error(ErrorKind::Usage, "trimmed faces and patches of other kinds are together in '" +
                                          name + "'; expected the one or the other");
    }
    if (const std::size_t open = openEdges(topology); open > 0) {
        throw Error(ErrorKind::Result,
                    "the surface is open: " + counted(open, "edge has", "edges have") +
                        " a face on one side only, or faces that disagree about what is outside; "
                        "expected the closed shells of solids");
    }
    PatchSolid solid;
    auto source = std::make_unique<FaceSource>(name, std::move(model), progress);
    if (!(source->volume() > kFlatShell * source->area() * source->size())) {
        throw Error(ErrorKind::Result, "the surface is flat: it encloses a volume of " +
                                           inShort(source->volume()) + " with an area of " +
                                           inShort(source->area()) + "; expected a solid");
    }
    solid.report.pieces = source->shells();
    solid.report.piecesTurned = source->shellsTurned();
    if (solid.report.piecesTurned > 0) {
        solid.report.warnings.push_back(
            counted(solid.report.piecesTurned, "piece was", "pieces were") + " inside out and " +
            (solid.report.piecesTurned == 1 ? "was" : "were") + " turned");
    }
    solid.source = std::move(source);
    return solid;
}

}  // namespace bandvox
