// One function per format, behind mesh_io.hpp. The readers return points and tets as they are in the file: indices in
// range, the rest unchecked. Cells of lower dimension are left out; volume cells that are not four-node tets are
// InputErrors.
#pragma once

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/system/files.hpp"

#include <array>
#include <map>
#include <vector>

namespace pbs {

struct TetFile {
    TetMesh mesh;                     // in the order of their tags where nodes and elements have any, else as listed
    std::vector<int> listed_at = {};  // as in MeshReading
    int repeated_tets = 0;
};

TetMesh read_vtk(const std::string& path);  // .vtu, .pvtu, .vtk, by VTK
TetFile read_msh(const std::string& path);  // Gmsh's .msh
// As read_point_arrays. Without a name, a view that does not cover all nodes, or has several steps, has no rows; by its
// name it is refused.
std::map<std::string, Eigen::MatrixXd> read_msh_point_arrays(const std::string& path, const std::string& name);
TetMesh read_medit(const std::string& path);   // .mesh
TetMesh read_tobj(const std::string& path);    // .tobj
TetMesh read_tetgen(const std::string& path);  // .node or .ele; the other file is in the same folder

SurfaceMesh read_polygons(const std::string& path);  // .ply, .off, .stl, by CGAL
// InputError for a word of such a text that is no number where the format has one, and for words behind what its counts
// state. STL: in lower case.
void check_polygon_text(const std::string& path, const std::string& text, const std::string& extension);
SurfaceMesh read_vtp(const std::string& path);  // .vtp and .vtk with a surface, by VTK

// .obj; mesh_name as in read_surface. Polygons are triangulated by CGAL, in a build without it by fans, where these are
// right.
SurfaceMesh read_obj(const std::string& path, const std::string& mesh_name);

// The corners of triangles that cover polygons [places in points, #S x 3], by CGAL. InputError: a corner out of range,
// a polygon without area, or one whose edges cross.
std::vector<int> triangulated(const std::string& path, const Positions& points,
                              const std::vector<std::vector<std::size_t>>& polygons);

void write_msh(const std::string& path, const TetMesh& mesh);    // 4.1 ASCII
void write_medit(const std::string& path, const TetMesh& mesh);  // .mesh, version 2

// An InputError unless the file is there, can be read, is not empty and not larger.
void require_readable(const std::string& path, std::uintmax_t most_bytes);

// An InputError where there is none, so that no index could be right.
void require_points(const std::string& path, long long points);

// An InputError unless the points' bounding box is 1e-9 m or more from corner to corner: products of three lengths stay
// in a double's range.
void require_extent(const std::string& path, const Positions& points);

// The index as int, or an InputError: vertex indices begin at 0 and stay below the number of points.
int checked_index(const std::string& path, long long tet, long long index, long long points);

// The conditions on a tet mesh before anything is computed on it; each violation is an InputError naming the file, the
// vertex or tet, its value and the rule. Vertices and tets are counted from 0, as in VTK. At least one tet, indices in
// range, coordinates finite and within 1e9 m, so that volumes are finite too.
void check_frame(const std::string& path, const TetMesh& mesh);

// check_frame, and: not smaller than 1e-9 m, no tet without volume, no two vertices in one place, no face in three
// tets, no overlap of neighbours and, in a build with CGAL, no self-intersection of the boundary. The mesh is repaired;
// the orientation is normalised by swapping the last two vertices. for_computing: read_tet_mesh.
MeshReading check_rest(const std::string& path, TetMesh mesh, bool for_computing = true);

// Repairs that move no tet: unused vertices are left out, and the vertices of tets that touch without a common face are
// split, so that the boundary is manifold; not if `separates` is false. Where other tets join what touches, some of
// their faces are cut. Indices in range, at most two tets at a face (unchecked). A mesh that needs no repair stays as
// it is.
MeshReading repaired(const TetMesh& mesh, bool separates = true);

// The edges that are in more than two triangles of the boundary, sorted.
std::vector<std::array<int, 2>> touching_edges(const Tets& tets);

}  // namespace pbs
