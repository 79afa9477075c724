// Continuous vector-valued finite elements on the character's own tets: P1 or P2 on straight tets (deal.II's FE_SimplexP).
// Node v is vertex v of the mesh; a P2 space numbers its mid-edge nodes after the vertices. Degree of freedom 3 n + c is component c at
// node n. The header is plain; deal.II is seen by simplex_space.cpp and assembly.cpp alone.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <memory>

namespace reference_fem {

using TetNodes = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // #T x 4 or #T x 10

// The mesh may go.
class SimplexSpace {
public:
    struct Elements;  // deal.II's side, in simplex_elements.hpp

    // Corners of the edge that mid-edge node 4 + k of a tet lies on: deal.II's order of a tet's lines, which is that of C3D10.
    static constexpr int edge_corners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

    // A mesh that passes check_mesh; element_order 1 or 2, else pbs::InputError.
    SimplexSpace(const pbs::TetMesh& mesh, int element_order);
    ~SimplexSpace();

    int element_order() const { return element_order_; }                      // 1 or 2
    int nodes() const { return static_cast<int>(node_positions_.rows()); }    // #V with P1, #V + #E with P2
    int dofs() const { return 3 * nodes(); }                                  // 3 a node, prescribed ones too
    const pbs::Positions& node_positions() const { return node_positions_; }  // [m], #nodes x 3
    const TetNodes& tet_nodes() const { return tet_nodes_; }                  // the corners first, in the mesh's order

    // Shape functions of the element's 4 or 10 nodes at a point of a tet, given by its coordinates on corners 2, 3, 4.
    Eigen::VectorXd shape_values(const pbs::Vec3& barycentric) const;

    // Values given at the vertices, #V x 3, on all nodes, #nodes x 3: linear along each edge.
    pbs::Positions from_vertices(const pbs::Positions& at_vertices) const;

    const Elements& elements() const { return *elements_; }  // deal.II's side, for those who include simplex_elements.hpp

private:
    void number_nodes(const pbs::TetMesh& mesh);

    int element_order_;
    std::unique_ptr<Elements> elements_;
    pbs::Positions node_positions_;
    TetNodes tet_nodes_;
};

}  // namespace reference_fem
