// Frames that another program has written, held against the rest mesh: the same vertices in the same order, in the same units.
//   const RestMesh rest(pbs::read_tet_mesh("rest.msh").mesh);
//   const pbs::Positions positions = rest.read_frame("frame_0001.vtu");
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <string>

namespace experiments {

class RestMesh {
public:
    explicit RestMesh(pbs::TetMesh mesh);

    // [m], #V x 3. InputError for another number of vertices, other tets (the order of tets and of their corners aside: readers and
    // exporters change it, and the ruler takes the rest mesh's), and for the rest mesh's body in other units.
    pbs::Positions read_frame(const std::string& path) const;

    const pbs::TetMesh& mesh() const { return mesh_; }
    const pbs::Edges& edges() const { return edges_; }

private:
    void require_same_tets(const std::string& path, const pbs::Tets& tets) const;
    void require_same_units(const std::string& path, const pbs::Positions& positions) const;

    pbs::TetMesh mesh_;
    pbs::Edges edges_;
    pbs::Tets corners_;  // of each tet in ascending order, the tets sorted
};

}  // namespace experiments
