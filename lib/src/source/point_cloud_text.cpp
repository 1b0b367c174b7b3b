#include "source/file_integrity.h"
#include "source/point_columns.h"
#include "source/table_rows.h"

#include <array>
#include <string>

namespace bandvox {
namespace {

/// Of a first row without names.
PointColumns columnsByCount(const TableRows& table) {
    PointColumns columns;
    columns.isNamed = false;
    const std::size_t count = table.cells().size();
    if (count != 3 && count != 4 && count != 6) {
        table.fail("has " + std::to_string(count) + (count == 1 ? " number" : " numbers") +
                   "; expected 3 (x y z), 4 (and the radius) or 6 (and the normal), or names of "
                   "the columns");
    }
    for (std::size_t i = 0; i < (count == 6 ? 6 : 3); ++i) columns.column[i] = i;
    if (count == 4) columns.column[kRadiusValue] = 3;
    return columns;
}

}  // namespace

PointCloud readTextPoints(const FileContents& file, Progress& progress) {
    TableRows table(file);
    if (!table.begin(namePoints)) file.fail("has no points; expected one at least");
    const auto fail = [&](const std::string& what) { table.fail(what); };
    const bool isNamed = !table.isOfNumbers();
    const PointColumns columns =
        isNamed ? columnsByName(table.names(), fail) : columnsByCount(table);
    const std::size_t width = table.cells().size();

    PointCloudBuilder builder(columns, 0);
    std::array<double, kPointValues> values{};
    constexpr std::size_t kStep = std::size_t(1) << 22;
    std::size_t told = 0;
    for (bool isThere = !isNamed || table.next(); isThere; isThere = table.next()) {
        table.requireWidth(width);
        for (std::size_t i = 0; i < kPointValues; ++i) {
            if (columns.column[i])
                values[i] = table.number(*columns.column[i], kPointValueNames[i]);
        }
        builder.add(values, fail);
        if (table.position() - told < kStep) continue;
        progress.throwIfInterrupted();
        const auto steps = [&](std::size_t at) { return 100 * at / file.bytes.size(); };
        progress.advance(static_cast<std::int64_t>(steps(table.position()) - steps(told)));
        told = table.position();
    }
    return builder.take();
}

}  // namespace bandvox
