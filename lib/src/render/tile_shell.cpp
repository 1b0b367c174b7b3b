#include "render/tile_shell.h"

#include <cstddef>

namespace bandvox {

std::array<ShellPiece, 26> shellAround(const openvdb::CoordBBox& box) {
    std::array<ShellPiece, 26> pieces;
    std::size_t count = 0;
    for (int i = 0; i < 27; ++i) {
        const openvdb::Coord outward(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
        if (outward == openvdb::Coord(0)) continue;
        openvdb::CoordBBox piece = box;
        for (int axis = 0; axis < 3; ++axis) {
            if (outward[axis] < 0) piece.max()[axis] = piece.min()[axis] = box.min()[axis] - 1;
            if (outward[axis] > 0) piece.min()[axis] = piece.max()[axis] = box.max()[axis] + 1;
        }
        pieces[count++] = {piece, outward};
    }
    return pieces;
}

}  // namespace bandvox
