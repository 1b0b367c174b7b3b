// Which iso-value keeps the volume?

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr double kFineStep = 1.0 / 4;  // voxels

// The volume that the iso-surfaces of a density enclose, from values at the centres of fine cells
// of one octant. The solid is symmetric about the planes x = 0, y = 0, z = 0.
class IsoVolume {
  public:
    IsoVolume(const openvdb::FloatGrid::Ptr& grid, const ExponentialFilter& filter) {
        const openvdb::Vec3d last = grid->evalActiveVoxelBoundingBox().max().asVec3d();
        const auto cells = [](double length) {
            return static_cast<std::int64_t>(std::ceil(length / kFineStep));
        };
        const DensityReader whole(grid, filter);
        std::vector<std::vector<Cell>> layers(cells(last.x()));
        parallelFor(static_cast<std::int64_t>(layers.size()), [&](std::int64_t i) {
            const DensityReader reader = whole.another();
            for (std::int64_t j = 0; j < cells(last.y()); ++j) {
                for (std::int64_t k = 0; k < cells(last.z()); ++k) {
                    const Vec3d place = kFineStep * (Vec3d(double(i), double(j), double(k)) + 0.5);
                    const DensityAt density = reader.at(place);
                    const Vec3d& g = density.gradient;
                    const double spread =
                        kFineStep * (std::abs(g.x()) + std::abs(g.y()) + std::abs(g.z()));
                    layers[i].push_back({density.value, spread});
                }
            }
        });
        for (const auto& layer : layers) mCells.insert(mCells.end(), layer.begin(), layer.end());
    }

    /// Voxels³. Counting by wider and by narrower cells cancels what their width adds where the
    /// surface is curved.
    double operator()(double iso) const { return (4 * count(iso, 1) - count(iso, 2)) / 3; }

    double largest() const {
        const auto less = [](const Cell& a, const Cell& b) { return a.value < b.value; };
        return std::max_element(mCells.begin(), mCells.end(), less)->value;
    }

  private:
    struct Cell {
        double value;
        double spread;  // of the density over the cell
    };

    // A cell that the surface cuts counts by how far it lies inside; `width` in cells.
    double count(double iso, double width) const {
        double sum = 0;
        for (const Cell& cell : mCells) {
            const double above = cell.value - iso;
            const double spread = width * cell.spread;
            sum += std::abs(above) < 0.5 * spread ? 0.5 + above / spread : (above > 0 ? 1.0 : 0.0);
        }
        return 8 * sum * std::pow(kFineStep, 3);
    }

    std::vector<Cell> mCells;
};

}  // namespace

void measureVolume(const Folder& folder) {
    Table table =
        folder.table("volume", "solid,size,order,cutoff,keeping_iso,volume_error,largest_density");
    const auto measure = [&](const std::string& name, double size, const BoundarySource& solid,
                             double volume, double voxelSize, const ExponentialFilter& filter) {
        const IsoVolume enclosed(exactDensity(solid, filter, voxelSize).grid, filter);
        // The volume falls as the iso-value rises.
        const double most = enclosed.largest();
        const double keeping =
            solveRising([&](double iso) { return -enclosed(iso); }, -volume, 0.02, most);
        table.add(name, size, filter.order, filter.cutoff, keeping, enclosed(0.5) / volume - 1,
                  most);
    };
    const auto ball = makeShapeBoundary("shape:sphere");  // its radius is 1
    for (const ExponentialFilter& filter : kFilters) {
        for (const double radius : {1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0}) {
            const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
            measure("ball", 2 * radius, *ball, volume, 1 / radius, filter);
        }
        const auto measureBox = [&](const std::string& name, double size, const Vec3d& sides) {
            const Box box{0.5 * sides};
            measure(name, size, box.boundary(), box.volume(), 1, filter);
        };
        for (const double side : {3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0}) {
            measureBox("cube", side, Vec3d(side));
        }
        for (const double thickness : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
            measureBox("plate", thickness, Vec3d(thickness, 32, 32));
            measureBox("rod", thickness, Vec3d(thickness, thickness, 32));
        }
    }
}

}  // namespace bandvox::experiments
