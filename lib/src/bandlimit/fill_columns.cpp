#include "bandlimit/fill_columns.h"

#include "bandlimit/element_bins.h"
#include "bandlimit/spread_bricks.h"
#include "core/worker_pool.h"

#include <bandvox/core/parallel.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace bandvox {

ColumnStatistics FilledColumns::total() const {
    ColumnStatistics sum;
    sum.spreadSeconds = brickSeconds;
    for (const ColumnStatistics& column : statistics) sum.add(column);
    return sum;
}

FilledColumns fillColumns(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter, const char* stage,
                          Progress& progress, const std::vector<bool>& wanted) {
    const std::int64_t count = static_cast<std::int64_t>(layout.count.y()) * layout.count.z();
    const bool areMany = SpreadBricks::payFor(source, layout.voxelSize);
    const ProgressStage inProgress(progress, stage,
                                   count + (areMany ? SpreadBricks::steps(plan, layout) : 0));
    std::optional<SpreadBricks> bricks;
    std::optional<ElementBins> bins;
    if (areMany) {
        bricks.emplace(source, plan, layout, filter, wanted, progress);
    } else {
        bins.emplace(source, layout, plan.halo);
    }
    FilledColumns columns;
    columns.blocks.resize(count);
    columns.statistics.resize(count);
    if (bricks) columns.brickSeconds = bricks->spreadSeconds();
    WorkerPool<DensityColumn> pool([&] {
        return std::make_unique<DensityColumn>(source, plan, layout, filter,
                                               bricks ? &*bricks : nullptr);
    });
    parallelFor(count, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int y = static_cast<int>(i / layout.count.z());
        const int z = static_cast<int>(i % layout.count.z());
        const std::span<const std::uint32_t> elements =
            bins ? bins->column(y, z) : std::span<const std::uint32_t>();
        const bool hasContent = bricks ? bricks->isInColumn(y, z) : !elements.empty();
        if (hasContent && (wanted.empty() || wanted[i])) {
            std::unique_ptr<DensityColumn> worker = pool.take();
            columns.blocks[i] = worker->fill(y, z, elements, columns.statistics[i], progress);
            pool.giveBack(std::move(worker));
        }
        progress.advance();
    });
    return columns;
}

}  // namespace bandvox
