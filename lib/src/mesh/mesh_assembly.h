#pragma once

#include "mesh/crossed_edges.h"
#include "mesh/lattice_blocks.h"

#include <bandvox/core/progress.h>
#include <bandvox/mesh/surface_mesh.h>
#include <bandvox/reconstruct/reconstruction.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace bandvox {

/// A field whose surface is wanted, larger inside than outside.
struct MeshedField {
    const openvdb::FloatGrid& grid;
    const Reconstruction& reconstruction;
    double iso;        ///< above the background
    double tolerance;  ///< distance of points from the surface, voxels
};

/// The triangles of a surface, put together block by block: first what lies on the edges of the
/// lattice is counted, then the points are found, then the cells are gone through.
class MeshAssembly {
  public:
    /// Finds the blocks that the surface passes. Throws Error(ErrorKind::Input) if a value is not
    /// finite, Error(ErrorKind::Memory) if the mesh would not fit.
    MeshAssembly(const MeshedField& field, Progress& progress);

    /// True if no cell has corners on both sides.
    bool empty() const { return mBlocks.empty(); }

    /// The mesh; normals are 0 where the field has no gradient.
    SurfaceMesh make();

    std::size_t cells() const { return mCells; }
    std::size_t ambiguousFaces() const { return mAmbiguousFaces; }

  private:
    struct Block {
        openvdb::Coord origin;
        CrossedEdges edges;
        std::uint32_t firstPoint = 0;
    };
    /// What the cells of a group of blocks make.
    struct CellTriangles {
        std::vector<openvdb::Vec3I> triangles;
        std::vector<SurfacePlace> middles;  ///< points inside of cells
        std::size_t cells = 0, ambiguousFaces = 0;
    };
    class CellWalk;
    struct CoordHash {
        std::size_t operator()(const openvdb::Coord& c) const;
    };

    void findBlocks();
    void groupBlocks();
    void placePoints(std::span<const Block> blocks, SurfaceMesh& mesh) const;
    void setPoint(SurfaceMesh& mesh, std::size_t point, const SurfacePlace& place) const;
    void join(std::vector<CellTriangles>& parts, SurfaceMesh& mesh);

    MeshedField mField;
    Progress& mProgress;
    openvdb::math::MapBase::ConstPtr mMap;
    bool mIsMirrored;
    std::vector<Block> mBlocks;
    std::vector<std::size_t> mGroups;  // first blocks of each, and the number of all
    std::unordered_map<openvdb::Coord, std::uint32_t, CoordHash> mBlockAt;
    std::size_t mPoints = 0;  // on edges
    std::size_t mCells = 0, mAmbiguousFaces = 0;
};

}  // namespace bandvox
