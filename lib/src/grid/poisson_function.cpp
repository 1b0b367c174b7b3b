#include "grid/poisson_function.h"

#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

// CGAL finds solvers of sparse systems in Eigen if it is told to.
#define CGAL_EIGEN3_ENABLED 1
#include <CGAL/Eigen_solver_traits.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/property_map.h>

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

/// Whose work this thread does: CGAL has no place to hand that in where it takes long.
thread_local const Progress* asked = nullptr;

/// Throws if the caller wants the work to stop.
void askWhetherToStop() {
    if (asked != nullptr) asked->throwIfInterrupted();
}

/// Has a caller asked, for as long as this lives.
class AskedProgress {
  public:
    explicit AskedProgress(const Progress& progress) { asked = &progress; }
    ~AskedProgress() { asked = nullptr; }
    AskedProgress(const AskedProgress&) = delete;
    AskedProgress& operator=(const AskedProgress&) = delete;
};

/// Lets the triangulation stop, which asks this of each point and the cells around it.
struct StoppableKernel : CGAL::Exact_predicates_inexact_constructions_kernel {
    using Base = CGAL::Exact_predicates_inexact_constructions_kernel;

    using SideOfSphere = Base::Side_of_oriented_sphere_3;
    struct Side_of_oriented_sphere_3 : SideOfSphere {
        template <typename... Points>
        CGAL::Oriented_side operator()(const Points&... points) const {
            askWhetherToStop();
            return SideOfSphere::operator()(points...);
        }
    };
    Side_of_oriented_sphere_3 side_of_oriented_sphere_3_object() const { return {}; }
};

/// Scales by the diagonal, as usual, and lets the solver stop.
class StoppablePreconditioner : public Eigen::DiagonalPreconditioner<double> {
  public:
    using Base = Eigen::DiagonalPreconditioner<double>;

    template <typename Matrix>
    StoppablePreconditioner& compute(const Matrix& matrix) {
        Base::compute(matrix);
        return *this;
    }

    template <typename Right>
    auto solve(const Eigen::MatrixBase<Right>& right) const {
        askWhetherToStop();
        return Base::solve(right);
    }
};

/// Lets the matrix's making stop.
class StoppableMatrix : public CGAL::Eigen_sparse_symmetric_matrix<double> {
  public:
    using Base = CGAL::Eigen_sparse_symmetric_matrix<double>;

    using Base::Base;
    void set_coef(std::size_t row, std::size_t column, double number, bool isNew = false) {
        askWhetherToStop();
        Base::set_coef(row, column, number, isNew);
    }
};

using GradientSolver =
    Eigen::ConjugateGradient<StoppableMatrix::EigenType, Eigen::Lower, StoppablePreconditioner>;

}  // namespace
}  // namespace bandvox

// So CGAL is told which of its matrices a solver takes.
template <>
struct CGAL::internal::Get_eigen_matrix<bandvox::GradientSolver, double> {
    using type = bandvox::StoppableMatrix;
};

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Kernel = StoppableKernel;
using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using Function = CGAL::Poisson_reconstruction_function<Kernel>;
using Cell = Function::Cell_handle;

/// Measured; most of it is the triangulation's, which has three times as many vertices.
constexpr double kBytesPerPoint = 6000;

/// Of how many nearest points the spacing is the mean.
constexpr unsigned kNeighbors = 6;

/// CGAL adds this many vertices at most, and has to have some to add.
constexpr std::size_t kMostPoints = 3'000'000;

using Solver = CGAL::Eigen_solver_traits<GradientSolver>;

/// Is told of each point that is put into the triangulation.
class InsertionVisitor {
  public:
    explicit InsertionVisitor(Progress& progress) : mProgress(&progress) {}

    void before_insertion() const {
        constexpr std::int64_t kStep = 256;
        if (++mInserted % kStep != 0) return;
        mProgress->throwIfInterrupted();
        mProgress->advance(kStep);
    }

  private:
    Progress* mProgress;
    mutable std::int64_t mInserted = 0;
};

/// The points, each place once, with the sum of its normals. CGAL's search trees get a level deeper
/// with each point of a place, and end the process when it has many.
std::vector<Oriented> asOriented(const OrientedPoints& points) {
    const std::size_t count = points.points.size();
    std::vector<std::uint32_t> order(count), first(count);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(points.points[a], a) < std::pair(points.points[b], b);
    });
    std::vector<Vec3d> normals(count, Vec3d(0));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t point = order[i];
        const bool isNew = i == 0 || points.points[order[i - 1]] != points.points[point];
        first[point] = isNew ? point : first[order[i - 1]];
        normals[first[point]] += Vec3d(points.normals[point]);
    }
    std::vector<Oriented> oriented;
    oriented.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (first[i] != i) continue;
        const Vec3d &p = points.points[i], &n = normals[i];
        oriented.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()),
                              Kernel::Vector_3(n.x(), n.y(), n.z()));
    }
    return oriented;
}

using PointOf = CGAL::First_of_pair_property_map<Oriented>;
using NormalOf = CGAL::Second_of_pair_property_map<Oriented>;

Kernel::Point_3 pointOf(const Vec3d& place) {
    return {place.x(), place.y(), place.z()};
}

/// What the function, linear in a cell, is at a place in it.
double valueIn(const Cell& cell, const Kernel::Point_3& place) {
    const Kernel::Point_3& a = cell->vertex(0)->point();
    const Kernel::Point_3& b = cell->vertex(1)->point();
    const Kernel::Point_3& c = cell->vertex(2)->point();
    const Kernel::Point_3& d = cell->vertex(3)->point();
    const double whole = CGAL::volume(a, b, c, d);
    return (CGAL::volume(place, b, c, d) * cell->vertex(0)->f() +
            CGAL::volume(a, place, c, d) * cell->vertex(1)->f() +
            CGAL::volume(a, b, place, d) * cell->vertex(2)->f() +
            CGAL::volume(a, b, c, place) * cell->vertex(3)->f()) /
           whole;
}

}  // namespace

struct PoissonFunction::Implementation {
    explicit Implementation(const std::vector<Oriented>& points, Progress& progress)
        : spacing(CGAL::compute_average_spacing<CGAL::Sequential_tag>(
              points, kNeighbors, CGAL::parameters::point_map(PointOf()))),
          function(points.begin(), points.end(), PointOf(), NormalOf(),
                   InsertionVisitor(progress)) {}

    double spacing;
    Function function;
};

PoissonFunction::PoissonFunction(const OrientedPoints& points, Progress& progress) {
    const std::size_t count = points.points.size();
    if (count > kMostPoints) {
        throw Error(ErrorKind::Input,
                    "there are " + std::to_string(count) + " points with normals; expected " +
                        std::to_string(kMostPoints) + " at most, or fewer of them, evenly chosen");
    }
    requireMemory(kBytesPerPoint * double(count), "the triangulation of the points");
    const ProgressStage stage(progress, "fitting the surface", static_cast<std::int64_t>(count));
    const AskedProgress here(progress);
    mImplementation = std::make_unique<Implementation>(asOriented(points), progress);
    Function& function = mImplementation->function;
    if (function.tr().dimension() < 3) {
        throw Error(ErrorKind::Input,
                    "the points lie in a plane, on a line or in one place; expected those of "
                    "a solid's surface");
    }
    Solver solver;
    if (!function.compute_implicit_function(solver, InsertionVisitor(progress))) {
        throw Error(ErrorKind::Result,
                    "no function fits the normals: the system of equations has no solution that "
                    "could be found; expected points of a closed surface, with normals outward");
    }
}

PoissonFunction::~PoissonFunction() = default;

double PoissonFunction::spacing() const {
    return mImplementation->spacing;
}

void PoissonFunction::read(std::span<const Vec3d> places, std::span<float> values) const {
    const Function::Triangulation& cells = mImplementation->function.tr();
    Cell cell;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Kernel::Point_3 place = pointOf(places[i]);
        cell = cells.locate(place, cell);
        if (cells.is_infinite(cell)) {
            // Beyond all cells it goes on as it is at the nearest ones' corner.
            const int away = cell->index(cells.infinite_vertex());
            values[i] = static_cast<float>(cell->vertex((away + 1) & 3)->f());
        } else {
            values[i] = static_cast<float>(valueIn(cell, place));
        }
    }
}

}  // namespace bandvox
