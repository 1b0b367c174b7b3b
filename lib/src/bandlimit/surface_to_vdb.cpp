#include "bandlimit/density_steps.h"
#include "bandlimit/exact_route.h"
#include "bandlimit/fill_columns.h"
#include "bandlimit/find_overlap.h"
#include "bandlimit/spooled_assembly.h"
#include "core/words.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/bandlimit/surface_to_vdb.h>
#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace {

/// What writing, and whatever else is small, may take, bytes.
constexpr double kReserve = 20 << 20;

/// Of blocks that a budget is for, the allocator and what is made of them take so much more, by
/// measurement up to an eighth.
constexpr double kOverhead = 1.15;

std::string inMebibytes(double bytes) {
    return std::to_string(std::llround(std::ceil(bytes / (1 << 20)))) + " MiB";
}

[[noreturn]] void failMemory(const ExactRoute& route, const std::string& what, double limit) {
    throw Error(ErrorKind::Memory, route.wanted() + what + " of memory, more than the limit of " +
                                       inMebibytes(limit) +
                                       "; raise it, or take larger voxels or fewer threads");
}

// A tile and the filter's table have to fit, whatever else there is. To be asked before they are
// made.
void requireTile(const ExactRoute& route, std::int64_t limit) {
    const double side = route.plan.side;
    const double bytes = sizeof(float) * (std::pow(side, 3) + std::pow(side / 2 + 1, 3));
    const double all = static_cast<double>(residentMemory()) + bytes;
    if (all <= static_cast<double>(limit)) return;
    failMemory(route, " needs more than " + inMebibytes(all), static_cast<double>(limit));
}

/// What is known of the memory that work within a limit may take, and takes.
class MemoryBudget {
  public:
    MemoryBudget(const ExactRoute& route, const ExactRouteMemory& memory, std::int64_t limit)
        : mRoute(route),
          mLimit(static_cast<double>(std::min(limit, residentMemory() + availableMemory()))),
          mFixed(kReserve + memory.columns + threadCount() * memory.thread) {}

    /// Takes what the process holds now for what it goes on to hold.
    void measure() {
        returnFreeMemory();
        mHeld = static_cast<double>(residentMemory());
    }

    /// Throws Error(ErrorKind::Memory) if the process has come to hold more than the limit.
    void requireKept() const {
        const auto peak = static_cast<double>(peakMemory());
        if (peak <= mLimit || peak <= mPeakBefore) return;
        failMemory(mRoute, " took " + inMebibytes(peak), mLimit);
    }

    /// For blocks, beside `others`.
    double left(double others) const { return (mLimit - mHeld - mFixed - others) / kOverhead; }

    /// Throws Error(ErrorKind::Memory) unless there is room for `bytes` beside what is held.
    void require(double bytes) const {
        if (bytes <= left(0)) return;
        failMemory(mRoute, " needs about " + inMebibytes(mLimit + kOverhead * (bytes - left(0))),
                   mLimit);
    }

  private:
    const ExactRoute& mRoute;
    double mLimit, mHeld = 0, mFixed;
    double mPeakBefore = static_cast<double>(peakMemory());
};

/// The columns of a grid that were filled in parts.
struct FilledInParts {
    std::unique_ptr<SpooledAssembly> assembly;  ///< if there was more than one part
    std::vector<ColumnBlocks> blocks;           ///< else
    FilledColumns measured;                     ///< without blocks
};

// Fills all columns. Nothing if the error is more than is allowed, which it then is.
std::optional<FilledInParts> fillInParts(const ExactRoute& route, const TileFilter& filter,
                                         const VdbTarget& target, MemoryBudget& budget,
                                         double& error, Progress& progress) {
    const ProgressStage stage(progress, "band-limiting",
                              ColumnFiller::steps(route.source, route.plan, route.layout));
    ColumnFiller filler(route.source, route.plan, route.layout, filter);
    budget.measure();
    FilledInParts filled;
    ColumnStatistics total;
    while (!filler.isDone()) {
        const double held = filled.assembly ? filled.assembly->memory() : 0;
        const double left = budget.left(held);
        FilledColumns part = filler.fillNext(left, progress);
        budget.requireKept();
        budget.require(held + filler.leastMemory());
        std::vector<ColumnStatistics>& statistics = filled.measured.statistics;
        statistics.insert(statistics.end(), part.statistics.begin(), part.statistics.end());
        filled.measured.brickSeconds += part.brickSeconds;
        total.add(part.total());
        error = total.closureError;
        if (!(error <= route.allowedError())) return std::nullopt;
        if (filler.isDone() && !filled.assembly) {
            filled.blocks = std::move(part.blocks);
            break;
        }
        if (!filled.assembly) {
            const AssemblyOptions assembly{route.plan.threshold, route.options.clamp};
            filled.assembly = std::make_unique<SpooledAssembly>(route.layout, assembly,
                                                                target.write.half, target.file);
        }
        filled.assembly->add(std::move(part.blocks));
        // Other threads may need it next time than those that have given it back.
        returnFreeMemory();
        budget.require(filled.assembly->finalMemory());
    }
    return filled;
}

FilledInParts fillToToleranceInParts(ExactRoute& route, const TileFilter& filter,
                                     const VdbTarget& target, MemoryBudget& budget,
                                     int& refinements, Progress& progress) {
    for (refinements = 0;; ++refinements) {
        double error = 0;
        auto filled = fillInParts(route, filter, target, budget, error, progress);
        if (filled) return std::move(*filled);
        route.refine(refinements, error);
    }
}

// Joins what was spooled to the result's grid; what rounding has changed is to be stated later.
SpooledAssembly::Grid finishSpooled(const ExactRoute& route, SpooledAssembly& assembly,
                                    DensityResult& result, Progress& progress) {
    const ProgressStage stage(progress, "assembling", 0);
    SpooledAssembly::Grid made = assembly.finish(result.metadata.clamped);
    result.grid = made.grid;
    progress.throwIfInterrupted();
    describeGrid(route.options, route.plan, made.integral, result);
    return made;
}

void roundGrid(DensityResult& result, Progress& progress) {
    roundAndRestate(*result.grid, progress);
    result.metadata = *densityMetadata(*result.grid);
}

}  // namespace

DensityResult surfaceToSpooledDensity(const BoundarySource& source, const DensityOptions& options,
                                      const VdbTarget& target, Progress& progress) {
    if (!options.shard.isWhole()) {
        throw Error(ErrorKind::Usage,
                    "a part of a grid is made without a limit of memory; take "
                    "more parts if one does not fit");
    }
    if (target.memoryLimit <= 0) {
        DensityResult result = surfaceToDensity(source, options, progress);
        if (target.write.half) roundGrid(result, progress);
        return result;
    }
    // Decide how the work is cut up, and whether it can fit.
    ExactRoute route(source, options);
    requireTile(route, target.memoryLimit);
    const TileFilter filter(route.plan);
    const ExactRouteMemory memory(route, filter);
    MemoryBudget budget(route, memory, target.memoryLimit);
    budget.measure();
    budget.require(memory.elements + SpooledAssembly::leastFinalMemory(memory.leaves));

    // Filter the tiles, and check what was measured on the way.
    DensityResult result;
    warnOfFilter(options.filter, options.tolerance, result.warnings);
    FilledInParts filled =
        fillToToleranceInParts(route, filter, target, budget, result.refinements, progress);
    const ColumnStatistics statistics = filled.measured.total();
    budget.requireKept();
    budget.measure();
    result.overlaps =
        !options.sumOverlaps && findOverlap(source, options, route.layout,
                                            filled.measured.statistics, progress, budget.left(0));

    // Join the columns to one grid.
    stateMeasured(route, statistics, result);
    if (!filled.assembly) {
        finishGrid(filled.blocks, route.layout, options, route.plan, result, progress);
        stateGrid(route, statistics, result);
        if (target.write.half) roundGrid(result, progress);
        return result;
    }
    const SpooledAssembly::Grid made = finishSpooled(route, *filled.assembly, result, progress);
    stateGrid(route, statistics, result);
    if (target.write.half) {
        result.metadata.storageError = made.storageError;
        result.metadata.gridVolume = made.storedIntegral;
        setDensityMetadata(*result.grid, result.metadata);
    }
    return result;
}

DensityResult surfaceToVdb(const BoundarySource& source, const DensityOptions& options,
                           const VdbTarget& target, Progress& progress) {
    AtomicFile file(target.file);
    DensityResult result = surfaceToSpooledDensity(source, options, target, progress);
    writeVdb(file, {result.grid}, target.write, progress);
    progress.throwIfInterrupted();
    file.commit();
    return result;
}

}  // namespace bandvox
