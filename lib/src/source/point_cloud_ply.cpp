#include "source/ply_vertices.h"
#include "source/point_columns.h"

namespace bandvox {

PointCloud readPlyPoints(const FileContents& file, Progress& progress) {
    PlyVertices vertices(file);
    if (vertices.header().hasFaces()) file.fail("has faces; expected points alone");
    const auto fail = [&](const std::string& what) { file.fail(what); };
    const PointColumns known = columnsByName(vertices.names(), fail);
    std::vector<std::size_t> columns;
    std::vector<std::size_t> meanings;  // which value of a point each column is
    for (std::size_t i = 0; i < kPointValues; ++i) {
        if (!known.column[i]) continue;
        columns.push_back(*known.column[i]);
        meanings.push_back(i);
    }
    PointCloudBuilder builder(known, vertices.count());
    std::array<double, kPointValues> point{};
    const auto take = [&](std::size_t row, const std::vector<double>& values) {
        for (std::size_t i = 0; i < values.size(); ++i) point[meanings[i]] = values[i];
        builder.add(point, [&](const std::string& what) {
            file.fail("point " + std::to_string(row + 1) + " " + what);
        });
    };
    vertices.read(columns, take, progress);
    return builder.take();
}

}  // namespace bandvox
