#include <bandvox/source/face_topology.h>

#include <algorithm>
#include <utility>

namespace bandvox {

void FaceTopology::append(FaceTopology other, std::size_t patches, std::size_t otherPatches) {
    if (places.empty() && other.places.empty()) return;
    places.resize(patches);
    other.places.resize(otherPatches);
    const int firstFace = static_cast<int>(faces.size());
    int firstShell = 0;
    for (const TrimmedFace& face : faces) firstShell = std::max(firstShell, face.shell + 1);
    for (FacePlace& place : other.places) {
        if (place.face >= 0) place.face += firstFace;
        places.push_back(place);
    }
    for (TrimmedFace& face : other.faces) {
        face.shell += firstShell;
        faces.push_back(std::move(face));
    }
    for (FaceEdge& edge : other.edges) {
        for (EdgeUse& use : edge.uses) {
            use.face += firstFace;
            for (EdgePiece& piece : use.pieces) piece.patch += static_cast<int>(patches);
        }
        edges.push_back(std::move(edge));
    }
}

}  // namespace bandvox
