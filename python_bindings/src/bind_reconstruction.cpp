// Grids, read between their voxels.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "grid_object.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <algorithm>
#include <memory>

namespace bandvox::python {

namespace py = pybind11;

namespace {

using openvdb::Vec3d;

/// A grid, read between its voxels.
class ReconstructionObject {
  public:
    ReconstructionObject(const openvdb::FloatGrid::Ptr& grid, double tolerance,
                         std::size_t cacheBytes)
        : mGrid(grid) {
        if (const auto metadata = densityMetadata(*grid)) {
            mReconstruction = makeBrickReconstruction(
                grid, {{metadata->order, metadata->cutoff}, tolerance, cacheBytes});
        } else {
            mReconstruction = makeSplineReconstruction(grid, cacheBytes);
        }
        if (!grid->transform().isLinear()) {
            throw Error(ErrorKind::Input, "the grid's transform is not linear");
        }
        mToIndex = grid->transform().baseMap()->getAffineMap()->getMat4().inverse();
    }

    py::array value(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> values(places.size());
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            values[i] = probe.value(place);
        });
        return ownedArray(std::move(values), {static_cast<py::ssize_t>(places.size())});
    }

    py::array gradient(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> gradients(3 * places.size());
        const openvdb::Mat3d turn = mToIndex.getMat3();
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            const Vec3d world = turn * probe.evaluate(place).gradient;
            for (std::size_t k = 0; k < 3; ++k) gradients[3 * i + k] = world[static_cast<int>(k)];
        });
        return ownedArray(std::move(gradients), {static_cast<py::ssize_t>(places.size()), 3});
    }

    py::array hessian(const py::handle& points) const {
        const std::vector<Vec3d> places = vectorsOf(points, "points");
        std::vector<double> entries(9 * places.size());
        const openvdb::Mat3d turn = mToIndex.getMat3();
        forPlaces(places, [&](DensityProbe& probe, const Vec3d& place, std::size_t i) {
            const openvdb::Mat3d world = turn * probe.expand(place).hessian * turn.transpose();
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    entries[9 * i + static_cast<std::size_t>(3 * r + c)] = world(r, c);
                }
            }
        });
        return ownedArray(std::move(entries), {static_cast<py::ssize_t>(places.size()), 3, 3});
    }

  private:
    template <typename Visit>
    void forPlaces(const std::vector<Vec3d>& places, const Visit& visit) const {
        if (places.size() <= kTogether) {
            const py::gil_scoped_release unlocked;
            visitAll(places, visit, silentProgress());
            return;
        }
        runInBackground([&](Progress& progress) { visitAll(places, visit, progress); }, py::none(),
                        0);
    }

    template <typename Visit>
    void visitAll(const std::vector<Vec3d>& places, const Visit& visit,
                  const Progress& progress) const {
        const std::size_t pieces = (places.size() + kTogether - 1) / kTogether;
        parallelFor(static_cast<std::int64_t>(pieces), [&](std::int64_t piece) {
            progress.throwIfInterrupted();
            const auto probe = mReconstruction->probe();
            const std::size_t first = static_cast<std::size_t>(piece) * kTogether;
            const std::size_t last = std::min(places.size(), first + kTogether);
            for (std::size_t i = first; i < last; ++i) {
                visit(*probe, mToIndex.transform(places[i]), i);
            }
        });
    }

    // Fewer are not worth another thread.
    static constexpr std::size_t kTogether = 4096;

    openvdb::FloatGrid::Ptr mGrid;
    std::unique_ptr<Reconstruction> mReconstruction;
    openvdb::Mat4d mToIndex;
};

}  // namespace

void bindReconstruction(py::module_& module) {
    py::class_<ReconstructionObject>(module, "Reconstruction",
                                     R"(The continuous density that a grid's voxels stand for.

Reconstruction(grid, tolerance=1.5e-5, cache_bytes=2**29): by its own filter if the grid is a density
of this library, by a cubic B-spline otherwise. tolerance: error of the density allowed, and of its
gradient relative to a flat face's, 1e-6 to 0.1. cache_bytes: memory for what has been read. Safe to
use from many threads.)")
        .def(py::init([](const py::object& grid, double tolerance, std::size_t cacheBytes) {
                 return std::make_unique<ReconstructionObject>(floatGridOf(grid), tolerance,
                                                               cacheBytes);
             }),
             py::arg("grid"), py::kw_only(), py::arg("tolerance") = 1.5e-5,
             py::arg("cache_bytes") = std::size_t(512) << 20)
        .def("value", &ReconstructionObject::value, py::arg("points"),
             "(n,) float64: the density at points of shape (n, 3), world units.")
        .def("gradient", &ReconstructionObject::gradient, py::arg("points"),
             "(n, 3) float64: its gradient there, per world unit.")
        .def("hessian", &ReconstructionObject::hessian, py::arg("points"),
             "(n, 3, 3) float64: its second derivatives there, per world unit squared.");
}

}  // namespace bandvox::python
