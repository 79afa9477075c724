// Finds the tet that contains a point, with a uniform grid over the mesh's bounding box: one look-up visits a few tets.
//   const PointLocation where(mesh);
//   where.locate(point).tet;
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace pbs {

// The place of a point in a tet. Its coordinate on corner 1 is 1 - the sum of the others.
struct Location {
    int tet = -1;                               // -1: outside every tet
    Vec3 barycentric = Vec3::Zero();  // coordinates on corners 2, 3, 4 of that tet
};

// The grid has about one cell a tet.
class PointLocation {
public:
    explicit PointLocation(const TetMesh& mesh);  // the mesh outlives it

    // A point on a face, edge or vertex (to 1e-10 of a barycentric coordinate) goes to the lowest of the tets that share it.
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

}  // namespace pbs
