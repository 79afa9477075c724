// Frames of tets that another program has written. They must have the vertices of the rest mesh, in the same order and
// in the same unit.
//   const RestMesh rest(pbs::read_tet_mesh("rest.msh", false), "");
//   const pbs::Positions positions = rest.read_frame("frame_0001.vtu");
#pragma once

#include "experiments/references/export/plain_vtu.hpp"
#include "experiments/meshes/mesh_io.hpp"

#include <array>
#include <string>
#include <vector>

namespace experiments {

// A deformed shape from a file.
struct FileShape {
    pbs::Positions positions;  // [m], #V x 3
    bool is_at_rest = false;   // the file's points are those of the rest mesh, and it has no displacement
    PlainFields fields = {};   // of a .vtu in plain text, in the order of the rest mesh's vertices
};

class RestMesh {
public:
    // the name of a vector of the frames' points; frame_points.hpp
    RestMesh(const pbs::MeshReading& reading, std::string displacement);

    // [m], #V x 3. InputError for another number of vertices, for other tets, and for positions in another unit. The
    // order of the tets and of their corners may differ, for readers and exporters change it; the metrics take that of
    // the rest mesh. Where the file's points are those of the rest mesh and no vector is named, a .vtu in plain text
    // may state the shape as a field `displacement` [m], as exported references do; `is_displaced`, if wanted, becomes
    // true then.
    pbs::Positions read_frame(const std::string& path, bool* is_displaced = nullptr) const;
    FileShape read_shape(const std::string& path) const;  // the same with the file's fields, for references

    const pbs::TetMesh& mesh() const { return mesh_; }
    const pbs::Edges& edges() const { return edges_; }

private:
    using Corners = std::array<int, 4>;

    static std::vector<Corners> sorted_corners(const pbs::Tets& tets);
    struct FramePoints {
        pbs::Positions points;           // [m], #V x 3
        const std::vector<int>& places;  // of the vertices in the frame's file, #V
    };
    FramePoints points_in(const std::string& path) const;
    FileShape shape_of(const std::string& path, const FramePoints& frame) const;
    // Where a frame has the vertices. One of a .msh that lists its nodes in another order than by their tags may have
    // either order; the tets show which. InputError for other tets.
    const std::vector<int>& places_in(const std::string& path, const pbs::Tets& tets) const;

    pbs::TetMesh mesh_;
    std::vector<int> file_vertex_;  // of the rest mesh's file, #V
    int file_vertices_ = 0;
    pbs::Edges edges_;
    // each tet's in ascending order as the file numbers them, and the tets sorted
    std::vector<Corners> corners_;
    std::vector<int> listed_vertex_;       // the place where the file lists each vertex, #V, and the tets by these;
    std::vector<Corners> listed_corners_;  // empty: in the order of corners_
    std::string displacement_;
};

}  // namespace experiments
