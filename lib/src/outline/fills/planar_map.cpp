#include "outline/fills/planar_map.h"

#include <CGAL/Arr_curve_data_traits_2.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <unordered_map>

namespace bandvox {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using SegmentTraits = CGAL::Arr_segment_traits_2<Kernel>;

struct SegmentName {
    std::int32_t chain, segment;
    bool operator<(const SegmentName& other) const {
        return chain != other.chain ? chain < other.chain : segment < other.segment;
    }
    bool operator==(const SegmentName& other) const {
        return chain == other.chain && segment == other.segment;
    }
};

struct LowerName {
    SegmentName operator()(const SegmentName& a, const SegmentName& b) const {
        return std::min(a, b);
    }
};

using Traits = CGAL::Arr_curve_data_traits_2<SegmentTraits, SegmentName, LowerName>;
using Arrangement = CGAL::Arrangement_2<Traits>;

Arrangement arranged(std::span<const PlanarChain> chains) {
    std::vector<Traits::Curve_2> curves;
    for (std::size_t c = 0; c < chains.size(); ++c) {
        const PlanarChain& chain = chains[c];
        std::vector<Kernel::Point_2> points;
        points.reserve(chain.size());
        for (const auto& [x, y] : chain) points.emplace_back(x, y);
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            if (chain[i] == chain[i + 1]) continue;
            curves.emplace_back(
                SegmentTraits::Curve_2(points[i], points[i + 1]),
                SegmentName{static_cast<std::int32_t>(c), static_cast<std::int32_t>(i)});
        }
    }
    Arrangement arrangement;
    CGAL::insert(arrangement, curves.begin(), curves.end());
    return arrangement;
}

}  // namespace

PlanarMap planarMap(std::span<const PlanarChain> chains) {
    const Arrangement arrangement = arranged(chains);
    PlanarMap map;
    std::unordered_map<const void*, std::int32_t> faces, halves, vertices;
    for (auto f = arrangement.faces_begin(); f != arrangement.faces_end(); ++f) {
        if (f->is_unbounded()) map.outside = map.faces;
        faces[&*f] = map.faces++;
    }
    for (auto v = arrangement.vertices_begin(); v != arrangement.vertices_end(); ++v) {
        vertices[&*v] = map.vertices++;
    }
    std::int32_t count = 0;
    for (auto e = arrangement.halfedges_begin(); e != arrangement.halfedges_end(); ++e) {
        halves[&*e] = count++;
    }
    map.halves.reserve(static_cast<std::size_t>(count));
    for (auto e = arrangement.halfedges_begin(); e != arrangement.halfedges_end(); ++e) {
        const auto& from = e->source()->point();
        PlanarMap::HalfEdge half;
        half.start = {CGAL::to_double(from.x()), CGAL::to_double(from.y())};
        half.origin = vertices.at(&*e->source());
        half.twin = halves.at(&*e->twin());
        half.next = halves.at(&*e->next());
        half.face = faces.at(&*e->face());
        const SegmentName name = e->curve().data();
        half.chain = name.chain;
        half.segment = name.segment;
        const PlanarChain& chain = chains[static_cast<std::size_t>(name.chain)];
        const auto& a = chain[static_cast<std::size_t>(name.segment)];
        const auto& b = chain[static_cast<std::size_t>(name.segment) + 1];
        // Points of a segment are in the order of its ends, by x and then by y.
        const bool goesUp = e->direction() == CGAL::ARR_LEFT_TO_RIGHT;
        half.isForward = goesUp == (a < b);
        map.halves.push_back(half);
    }
    return map;
}

}  // namespace bandvox
