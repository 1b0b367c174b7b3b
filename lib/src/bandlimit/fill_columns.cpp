#include "bandlimit/fill_columns.h"

#include "bandlimit/element_bins.h"
#include "core/worker_pool.h"

#include <bandvox/core/parallel.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace bandvox {

ColumnStatistics FilledColumns::total() const {
    ColumnStatistics sum;
    for (const ColumnStatistics& column : statistics) sum.add(column);
    return sum;
}

FilledColumns fillColumns(const BoundarySource& source, const TilePlan& plan,
                          const TileLayout& layout, const TileFilter& filter, const char* stage,
                          Progress& progress, const std::vector<bool>& wanted) {
    const ElementBins bins(source, layout, plan.halo);
    const std::int64_t count = static_cast<std::int64_t>(layout.count.y()) * layout.count.z();
    FilledColumns columns;
    columns.blocks.resize(count);
    columns.statistics.resize(count);
    WorkerPool<DensityColumn> pool(
        [&] { return std::make_unique<DensityColumn>(source, plan, layout, filter); });
    const ProgressStage inProgress(progress, stage, count);
    parallelFor(count, [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const int y = static_cast<int>(i / layout.count.z());
        const int z = static_cast<int>(i % layout.count.z());
        const std::span<const std::uint32_t> elements = bins.column(y, z);
        if (!elements.empty() && (wanted.empty() || wanted[i])) {
            std::unique_ptr<DensityColumn> worker = pool.take();
            columns.blocks[i] = worker->fill(y, z, elements, columns.statistics[i], progress);
            pool.giveBack(std::move(worker));
        }
        progress.advance();
    });
    return columns;
}

}  // namespace bandvox
