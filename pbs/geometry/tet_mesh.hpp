// Tet meshes: arrays, volumes, refinement, the tet at a point, division into regions.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace pbs {

// The floating point of methods that compute in float or in double.
enum class Precision { f32, f64 };

// A position or a gradient of a constraint, 3 x 1.
template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

// The array types every module shares. Row-major, so that one row is one point, edge or tet in memory.
using Vec3 = Eigen::Vector3d;                                                 // a point or vector [m], 3 x 1
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;  // points [m], #V x 3
using Tets = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;          // vertex indices, #T x 4
using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;         // vertex indices, #E x 2, first < second
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;     // vertex indices, #F x 3, outward

inline constexpr double farthest_m =
    1e9;  // of a point from the origin: beyond, products of three lengths leave the range of a double

// read_tet_mesh checks what it reads. For other meshes PbsSolver checks that indices are in range and volumes positive;
// most functions check nothing.
struct TetMesh {
    Positions rest;  // rest positions [m], #V x 3
    Tets tets;       // #T x 4, positively oriented: (p2-p1) x (p3-p1) . (p4-p1) > 0
};

// Signed volume [m^3] of one tet: (p2 - p1) x (p3 - p1) . (p4 - p1) / 6; negative when inverted.
inline double tet_volume(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4)
{
    const Vec3 p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    return (p21(1) * p31(2) - p21(2) * p31(1)) * p41(0) / 6.0 + (p21(2) * p31(0) - p21(0) * p31(2)) * p41(1) / 6.0 +
           (p21(0) * p31(1) - p21(1) * p31(0)) * p41(2) / 6.0;
}

// Signed volumes [m^3] of all tets, #T. Indices of tets are in range (unchecked), here and below.
Eigen::VectorXd tet_volumes(const Positions& positions, const Tets& tets);
// the same; an InputError where one is not above 0
Eigen::VectorXd positive_volumes(const Positions& rest, const Tets& tets);

// Gradients of the barycentric coordinates of a tet at rest [1/m], one per column, and its signed volume [m^3], if
// wanted.
Eigen::Matrix<double, 3, 4> barycentric_gradients(const TetMesh& mesh, Eigen::Index tet, double* volume_m3 = nullptr);

// A quarter of the rest volume of each tet around a vertex [m^3], #V: the lumped rest volume.
Eigen::VectorXd lumped_volumes(const Positions& rest, const Tets& tets);

// The area of the triangle of three points [m^2].
double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);
// The sum of the triangles' areas [m^2].
double surface_area(const Positions& points, const Triangles& triangles);
// A third of the area of each triangle around a point [m^2], #V.
Eigen::VectorXd lumped_areas(const Positions& points, const Triangles& triangles);

// The signed volume inside the triangles [m^3], as if closed by a fan from the points' mean; negative where they face
// inward.
double fan_volume(const Positions& points, const Triangles& triangles);

// Uniform red refinement: every tet into eight, every edge halved; the body stays the same polyhedron.
//   // fine.mesh: the vertices of `mesh` first, then the midpoints
//   const Refinement fine = refine(mesh);
//   const Positions carried = prolongated(positions, fine.parents);  // a field of the coarse vertices on the fine ones
// The four tets at the corners are similar to their parent. The octahedron between them is cut along its shortest
// diagonal (of equal ones the first of 01-23, 02-13, 03-12, numbers being the parent's corners; S. Zhang, Houston
// Journal of Mathematics 21, 1995; A. Liu and B. Joe, Mathematics of Computation 65, 1996), which bounds the mean ratio
// of its four tets, 12 (3 V)^(2/3) over the sum S of squared edges, from below by 3/4 of their parent's: of the
// parent's edges they have five, halved, and the diagonal, and the squares of the three diagonals sum to S / 4. Bey's
// rule (Computing 55, 1995), always 02-13, has three shapes in all but may begin with a long diagonal.
struct Refinement {
    TetMesh mesh;   // tets 8 t .. 8 t + 7 are the children of tet t, oriented as it is; child k < 4 lies at its corner
                    // k, which it keeps
    Edges parents;  // the two coarse vertices that new vertex #V_coarse + e lies between: each coarse edge once, sorted
};
// 8 #T tets and #V + #E vertices; positively oriented tets stay so, and their volumes add up. Indices are in range
// (unchecked).
Refinement refine(const TetMesh& mesh);

// Barycentric coordinates of the point of a triangle that is nearest to a point [m]: that of its plane if it lies
// inside, else the best of its edges. corners: rows; the triangle may be flat.
Vec3 nearest_in_triangle(const Vec3& point, const Eigen::Matrix3d& corners);

// A field of the coarse vertices, #V x 3, and at the new ones the mean of their parents: linear on every coarse tet. #V
// + #E rows; that the edges are those of the field's vertices is not checked.
Positions prolongated(const Positions& coarse, const Edges& parents);

// Finds the tet that contains a point, with a uniform grid over the mesh's bounding box: one look-up visits a few tets.
//   const PointLocation where(mesh);
//   where.locate(point).tet;
// A place in a tet: its coordinate on corner 1 is 1 - the sum of the others.
struct Location {
    int tet = -1;                     // -1: outside every tet
    Vec3 barycentric = Vec3::Zero();  // coordinates on corners 2, 3, 4 of that tet
};

// The grid has about one cell per tet.
class PointLocation {
public:
    explicit PointLocation(const TetMesh& mesh);  // the mesh outlives it

    // A point on a face, edge or vertex (to 1e-10 of a barycentric coordinate) goes to the lowest of the tets that
    // share it.
    Location locate(const Vec3& point) const;

private:
    using Cell = Eigen::Vector3i;

    Cell cell_of(const Vec3& point) const;  // clamped to the grid
    int index_of(const Cell& cell) const { return (cell(2) * cells_(1) + cell(1)) * cells_(0) + cell(0); }
    template <typename Visit>
    void for_each_cell_of_tet(Eigen::Index tet, Visit visit) const;

    const TetMesh& mesh_;
    Vec3 low_, cell_size_m_;
    Cell cells_;
    std::vector<int> first_;  // tets of cell c: tet_in_cell_[first_[c]] .. [first_[c + 1]] - 1, increasing
    std::vector<int> tet_in_cell_;
};

// A division of a mesh's tets into connected regions of about equal size, the same on every machine.
//   const std::vector<int> region = tet_regions(tets, 256);
//   const std::vector<Triangles> surfaces = region_surfaces(tets, region);
// Greedy growing (C. Farhat, A simple and efficient automatic FEM domain decomposer, Computers and Structures 28,
// 1988): a region begins at the first tet, in breadth-first order over shared faces, that has no region yet, and takes
// neighbours breadth-first until it is full. A part that is cut off with less than half of the size joins the region to
// which it has most faces, so that a region may be larger. The region of each tet, #T: regions are numbered from 0 in
// the order in which they begin. region_size: in tets, 1 or more (unchecked). A connected part of fewer tets than half
// of that, connected over faces, is a region of its own.
std::vector<int> tet_regions(const Tets& tets, int region_size);

// The surface of each region, oriented outward, #regions; region: #T, numbers from 0 without gaps.
std::vector<Triangles> region_surfaces(const Tets& tets, const std::vector<int>& region);

}  // namespace pbs
