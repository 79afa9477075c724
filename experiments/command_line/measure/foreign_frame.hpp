// Frames that another program has written. They must have the vertices of the rest mesh, in the same order and in the same unit.
//   const RestMesh rest(pbs::read_tet_mesh("rest.msh"));
//   const pbs::Positions positions = rest.read_frame("frame_0001.vtu");
#pragma once

#include "pbs/geometry/mesh_io.hpp"

#include <string>

namespace experiments {

class RestMesh {
public:
    explicit RestMesh(const pbs::MeshReading& reading);

    // [m], #V x 3. InputError for another number of vertices, for other tets, and for positions in another unit. The order of the tets and
    // of their corners may differ, for readers and exporters change it; the metrics take that of the rest mesh.
    pbs::Positions read_frame(const std::string& path) const;

    const pbs::TetMesh& mesh() const { return mesh_; }
    const pbs::Edges& edges() const { return edges_; }

private:
    void require_same_tets(const std::string& path, const pbs::Tets& tets) const;
    void require_same_units(const std::string& path, const pbs::Positions& positions) const;

    pbs::TetMesh mesh_;
    std::vector<int> file_vertex_;  // of the rest mesh's file, #V
    int file_vertices_ = 0;
    pbs::Edges edges_;
    pbs::Tets corners_;  // each tet's in ascending order as the file numbers them, and the tets sorted
};

}  // namespace experiments
