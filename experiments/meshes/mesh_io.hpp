// Reading and writing meshes.
//   const MeshReading arm = read_tet_mesh("arm.msh");       // a mesh to compute on: checked, positively oriented
//   const TetMesh frame = read_tet_frame("arm_0007.vtu");   // a deformed frame as it is in the file
//   write_tet_mesh("arm.vtu", arm.mesh);
// VTK reads .vtu, .pvtu, .vtk and .vtp, and CGAL reads .ply, .off and .stl. Gmsh's .msh, MEDIT's .mesh, TetGen's
// .node/.ele, .tobj and .obj are read here, since their libraries drop or guess without a word what a file holds. A bad
// file is an InputError, and so is every file in a build without PBS_WITH_MESH_IO. experiments/rigs/surface_reader.hpp
// reads surfaces.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace pbs {

// The result of read_tet_mesh.
struct MeshReading {
    TetMesh mesh;           // positively oriented, in the file's order; nodes and elements of a .msh by their tags [m]
    int flipped_tets = 0;   // number of tets whose orientation was normalised
    int file_vertices = 0;  // of the file
    std::vector<int> file_vertex;      // the file's number of each vertex, from 0, #V
    std::vector<int> unused_vertices;  // of the file, left out because no tet uses them
    // of the file, at which parts touch without a common face: each part got a vertex of its own
    std::vector<int> split_vertices;
    // vertices of the file; in each, tets touch that no face joins around it
    std::vector<std::array<int, 2>> touching_edges;
    int cut_faces = 0;  // in two tets of the file, but in one each after the split
    // Vertices of the file in one place, as at cracks and where bodies touch: each with the one before it there. For
    // metrics alone.
    std::vector<std::array<int, 2>> doubled_vertices;
    int overlapping =
        -1;  // a vertex of the file near which the boundary intersects itself; -1: it does not, or nothing was checked
    int flattest_tet = 0;     // of the file, with the least volume over its longest edge cubed
    double flatness = 0.118;  // that number; 0.118 is the regular tet's
    int repeated_tets = 0;    // on the same four vertices as an earlier one of the file; each counts once
    // where a .msh lists its nodes: the place of each of them by tag; empty: they are listed by their tags
    std::vector<int> listed_at;
    std::string read_as;  // the usual extension of the file's format, if its own is another one; empty: as it is named
};

// Reads a tet mesh to compute on. The content of the file chooses the reader if it shows the format, otherwise the
// extension does; for TetGen and .tobj it is always the extension.
// InputError unless the mesh is finite and not empty, its indices are in range, each tet has a volume, no face is in
// three tets, neighbours do not overlap, the boundary does not intersect itself (checked in builds with CGAL), and no
// two vertices are in one place. Unused vertices are left out, tets that touch in a vertex or an edge alone are
// separated there, so that the boundary is manifold, and the orientation is normalised.
// for_computing: false keeps the file's vertices, and states those in one place and a boundary that intersects itself
// in the result. This is for metrics, which need neither a manifold boundary nor one that bodies do not share.
MeshReading read_tet_mesh(const std::string& path, bool for_computing = true);

// Reads points [m] and tets as they are in the file, including inverted tets, which the metrics of deformed frames
// need. A tet that is listed several times counts once. InputError if there is no tet, if an index is out of range, or
// if a coordinate is not finite or is beyond 1e9 m.
TetMesh read_tet_frame(const std::string& path);

// Reads the arrays of the points of a .vtu, .vtk, .vtp or .msh ($NodeData) that have one or three components, such as a
// displacement, by their names: #P x 1 or #P x 3, in the order of read_tet_frame. name: reads this array alone, so that
// damage in others does no harm; empty: all. A file of another format has none. InputError for arrays that cannot be
// read.
std::map<std::string, Eigen::MatrixXd> read_point_arrays(const std::string& path, const std::string& name = "");

// write_tet_mesh writes a mesh in the format of its extension: .msh (4.1 ASCII), .vtu or .mesh. Coordinates read back
// to the bit. The file is written under a temporary name and then renamed. InputError for another extension, and if the
// file cannot be written. require_tet_mesh_format checks the extension alone, before the work.
void require_tet_mesh_format(const std::string& path);
void write_tet_mesh(const std::string& path, const TetMesh& mesh);

// A triangle mesh, closed or not; its maker says whether it was checked.
struct SurfaceMesh {
    Positions points;     // [m], #S x 3
    Triangles triangles;  // #F x 3
};

// One deformed frame as VTK XML: Float64, compressed, atomic. Fields have one entry per point (or 3, or one per cell).
struct FrameFields {
    std::map<std::string, Positions> point_vectors;       // e.g. displacement, rest_position
    std::map<std::string, std::vector<int>> point_flags;  // e.g. prescribed
    std::map<std::string, Eigen::VectorXd> cell_scalars;  // e.g. volume_ratio
};
// points [m], #V x 3. InputError where a field has not one entry per point (per cell), or the file cannot be written;
// the extension of the path is not checked.
void write_vtu(const std::string& path, const Positions& points, const Tets& tets, const FrameFields& fields);
// A surface, without fields; errors as of write_vtu.
void write_vtp(const std::string& path, const Positions& points, const Triangles& triangles);

// Reads the names of the files of a .pvd in the order of their times, relative to the current folder. InputError if the
// file is no such collection, or if it has several parts of one time.
std::vector<std::string> read_pvd(const std::string& path);

// A ParaView collection of frames: time [s] -> file name relative to the .pvd, in the order given; names stand in it as
// they are, without a check. InputError where it cannot be written.
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& frames);

// Remarks on properties of a mesh that are accepted although its author may not have intended them: one line each,
// printed for the user.
//   for (const std::string& remark : remarks_on("arm.msh", read_tet_mesh("arm.msh"))) ...
// A name that does not fit the content, nodes that are not listed by tag, tets that are listed several times, turned
// tets, the flattest tet where it is a sliver, vertices that were left out or split, edges at which parts touch, faces
// that were cut, parts that no face joins, and a size that speaks for other units than metres (under 1 mm or above 100
// m).
std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading);

// The remark on a file whose content has the format of files with another extension.
std::string remark_on_name(const std::string& path, const std::string& content_extension);

// For readers: remarks on a surface after its points were joined, and on what was left out of it: points that no
// triangle uses, triangles that are a line or a point, holes, edges in three triangles or more, triangles that cross
// (checked in builds with CGAL), closed cavities, a surface inside out, and the size as above.
std::vector<std::string> remarks_on(const std::string& path, const SurfaceMesh& surface, int unused_points,
                                    int triangles_without_area);

}  // namespace pbs
