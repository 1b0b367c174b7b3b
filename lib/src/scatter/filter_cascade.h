#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bandvox {

/// Filters 2^m + 1 numbers to 2^k + 1: (1/6, 2/3, 1/6) at every second one, again and again; beyond
/// the ends the outermost numbers go on. Equation 1 of M. Hashimoto, "Smooth Interpolation using
/// Multiresolution Analysis".
std::vector<double> filterLine(std::vector<double> line, std::size_t cells);

/// The same across rows that come one after another, of which it keeps two for each halving.
class RowCascade {
  public:
    using Sink = std::function<void(const std::vector<double>&)>;

    /// `cells`: one less than the rows that come; `fewer`: one less than those that leave, `cells`
    /// divided by a power of two. `sink` gets them in their order.
    RowCascade(std::size_t cells, std::size_t fewer, Sink sink);

    void push(const std::vector<double>& row) { push(0, row); }

  private:
    struct Stage {
        std::size_t cells;
        std::size_t next = 0;        // row that comes
        std::vector<double> before;  // the last one with an odd number
        std::vector<double> sum;     // of what the row that is being made has so far
    };
    void push(std::size_t stage, const std::vector<double>& row);

    std::vector<Stage> mStages;
    Sink mSink;
};

}  // namespace bandvox
