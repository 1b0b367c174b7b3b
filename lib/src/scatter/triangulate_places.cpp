#include "scatter/triangulate_places.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <utility>

namespace bandvox {

std::vector<std::array<std::size_t, 3>> triangulatePlaces(std::span<const double> x,
                                                          std::span<const double> y) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
    using Triangulation =
        CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;
    std::vector<std::pair<Kernel::Point_2, std::size_t>> places;
    places.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) places.emplace_back(Kernel::Point_2(x[i], y[i]), i);
    const Triangulation triangulation(places.begin(), places.end());
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto& face : triangulation.finite_face_handles()) {
        triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return triangles;
}

}  // namespace bandvox
