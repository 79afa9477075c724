// Tet meshes of the built-in bodies and of surfaces, by CGAL (Mesh_3, alpha_wrap_3).
//   TetMesh limb = mesh_limb(1775);
//   TetMesh body = mesh_surface(read_surface("body.obj"), {.vertices = 2000});  // experiments/rigs/surface_reader.hpp
// The same call gives the same mesh to the bit: seeds are fixed and no limit depends on time.
#pragma once

#include "experiments/meshes/mesh_io.hpp"
#include "pbs/geometry/input_error.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace pbs {

// Limb: capsule of radius 0.15 m round (-1,0,0) -> (1,0,0) m with round caps. Bar: [-1, 1] x [-0.15, 0.15]^2 m.
// `vertices`: wanted number, at least 300 (limb) or 200 (bar); what comes out is within 10 % (the cell size is
// searched).
TetMesh mesh_limb(int vertices);
TetMesh mesh_bar(int vertices);
// InputError of both for fewer vertices than that, where CGAL's perturbation has no end, and in a build without CGAL.

// The InputError of mesh_surface where parts are so thin that the tets would be many times as many as wanted.
struct TooManyTets : InputError {
    explicit TooManyTets(const InputError& error) : InputError(error) {}
};

// A closed or nearly closed surface [m] -> tets of about the wanted number of vertices: wrapped (alpha_wrap_3), meshed
// with a cell size proportional to the local thickness, perturbed and exuded, checked, tried again with another facet
// distance where the check fails. The tets' boundary lies up to about wrap_offset_m + wrap_alpha_m from the surface. If
// no offset is requested and the surface is not watertight, a wrap that cannot be meshed is repeated with 3 times and
// then with 6 times the offset, so that the distance grows likewise.
struct SurfaceMeshing {
    int vertices = 2000;         // wanted, 150 or more
    double wrap_alpha_m = 0.0;   // smallest gap the wrap enters; 0: the bounding box's diagonal / 170
    double wrap_offset_m = 0.0;  // 0: alpha / 3; 3 or 6 times that where open surfaces need it
    // The sizes of facets and cells, which the search for the wanted number of vertices multiplies by one factor.
    double cells_across = 2.9;  // a facet is at most this part of the local thickness
    double smallest_facet = 0.0042,
           largest_facet = 0.021;     // over the diagonal: they give a standing human 2,000 vertices
    double facet_distance = 0.0032;   // from the wrap, over the diagonal
    double inside_to_skin = 1.2;      // size of cells over size of facets
    double radius_edge_ratio = 2.5;   // largest of a cell
    double good_dihedral_deg = 12.0;  // perturbing and exuding end once all tets have it
    double min_dihedral_deg = 5.0;    // required of every tet
    // How often the perturbation may ask whether a point lies inside, for each 4,000 vertices begun. The arm of the
    // examples asks most, 600,000 times, with 150 vertices, and at most 12 times per vertex with 800 to 2,300
    // (CGAL 5.5). Above it, there is no end.
    std::size_t most_questions = 2'000'000;
    std::optional<int> boundary_euler = 2;  // required of the boundary; 2: a ball, 0: a body with one handle; null: any
    bool is_closed = true;                  // required of the surface: its wrap holds about what it encloses
    bool is_one_piece = true;               // required of the tets
    std::vector<Vec3> inside = {};          // points that must lie inside, e.g. joints
};
// InputError where fewer than 150 vertices are requested; the surface has fewer than 4 triangles, a point that is not
// finite, an index out of range or a diagonal below 1e-9 m; a surface that must be closed has no volume, or its wrap
// holds less than half or more than twice what it encloses (an open sheet, triangles turned both ways); the wrap has
// another Euler number or leaves a point of `inside` outside; or no attempt has the required quality and a perturbation
// with an end. Also in a build without CGAL.
TetMesh mesh_surface(const SurfaceMesh& surface, const SurfaceMeshing& options);

// Other tets inside the boundary of these. The refinement begins with its vertices; its edges are not kept. Cells are
// as large as the triangles of the boundary near them, and those of the skin are smaller in the balls.
struct FineBall {
    Vec3 centre = Vec3::Zero();  // [m]
    double radius_m = 0.0,
           size_m = 0.0;  // edges inside have about this length; outside it grows by a third of the distance
};
struct Remeshing {
    unsigned seed =
        0;  // another one changes all sizes by up to most_change, at random, so that the refinement takes other points
    std::vector<FineBall> fine = {};
    double most_change = 0.1;
    double facet_size = 0.75,
           cell_size = 0.9;        // over the edges of the boundary: they give as many vertices as the tets had
    double facet_distance = 0.05;  // from the boundary, over its mean edge
};
// InputError where the boundary is not manifold; where the result would have a dihedral angle below 5 degrees, more
// pieces, another Euler number or a boundary that intersects itself; where it would take more than 30,000 vertices and
// six times those of the mesh; and where CGAL's perturbation has no end.
TetMesh mesh_anew(const TetMesh& mesh, const Remeshing& options);

// How far mesh_surface thickens a surface to both sides if it encloses no volume and need not be closed [m]; 0 if it
// encloses one.
double sheet_offset_m(const SurfaceMesh& surface);

// Triangles that share no vertex or edge meet somewhere, or neighbours overlap. InputError in a build without CGAL, as
// for all below.
bool self_intersects(const Positions& positions, const Triangles& boundary);
// pairs of triangles, sorted
std::vector<std::array<int, 2>> self_intersections(const Positions& positions, const Triangles& boundary);
// of those pairs
int count_self_intersections(const Positions& positions, const Triangles& boundary);

// The closed lines in which each plane cuts a surface, points [m], #P x 3 per line, the first not repeated at its end.
// A surface that intersects itself is cut all the same, triangle by triangle.
struct CuttingPlane {
    Vec3 point, normal;  // any point of the plane [m]; of any length except zero
};
// The lines of each plane, #planes; lines that do not close are left out. InputError where a normal is zero.
std::vector<std::vector<Positions>> section_outlines(const Positions& positions, const Triangles& boundary,
                                                     const std::vector<CuttingPlane>& planes);

// Which points [m] lie inside or on a closed manifold boundary, #points. InputError where it has no triangle or is not
// closed.
std::vector<bool> points_inside(const Positions& positions, const Triangles& boundary, const std::vector<Vec3>& points);

}  // namespace pbs
