#include "source/directed_edges.h"

#include <utility>

namespace bandvox {

std::vector<std::uint32_t> groupEdges(const DirectedEdges& edges, std::size_t pointCount) {
    // Collect them by their lower end, then sort the few of each point.
    std::vector<std::size_t> start(pointCount + 1, 0);
    const auto edgeCount = static_cast<std::uint32_t>(edges.count());
    for (std::uint32_t e = 0; e < edgeCount; ++e) ++start[edges.low(e) + 1];
    for (std::size_t i = 0; i < pointCount; ++i) start[i + 1] += start[i];
    std::vector<std::uint32_t> order(edgeCount);
    std::vector<std::size_t> cursor = start;
    for (std::uint32_t e = 0; e < edgeCount; ++e) order[cursor[edges.low(e)]++] = e;
    for (std::size_t i = 0; i < pointCount; ++i) {
        std::sort(order.begin() + static_cast<std::ptrdiff_t>(start[i]),
                  order.begin() + static_cast<std::ptrdiff_t>(start[i + 1]),
                  [&](std::uint32_t a, std::uint32_t b) {
                      return std::pair(edges.high(a), a) < std::pair(edges.high(b), b);
                  });
    }
    return order;
}

}  // namespace bandvox
