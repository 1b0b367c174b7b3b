#include "source/triangulate_loop.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <iterator>

namespace bandvox {

namespace {

// Points up to which all triangles are tried where the tetrahedralization has no solution; that
// takes time with the third power.
constexpr std::size_t kShort = 300;

}  // namespace

std::vector<openvdb::Vec3I> triangulateLoop(const std::vector<openvdb::Vec3d>& loop) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    points.reserve(loop.size());
    for (const openvdb::Vec3d& p : loop) points.emplace_back(p.x(), p.y(), p.z());
    std::vector<CGAL::Triple<int, int, int>> found;
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        points, std::back_inserter(found),
        CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(
            points.size() > kShort));
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(found.size());
    for (const auto& t : found) triangles.emplace_back(t.first, t.second, t.third);
    return triangles;
}

}  // namespace bandvox
