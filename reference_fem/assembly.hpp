// Integrals over the tets: mass, load, strain energy, error norms. One assembly serves both the reference and its
// verification.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/options.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace reference_fem {

using TetNodes = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // #T x 4 or #T x 10

// Continuous vector-valued finite elements on the character's own tets: P1 or P2 on straight tets (deal.II's
// FE_SimplexP). Node v is vertex v of the mesh; a P2 space numbers its mid-edge nodes after the vertices. Degree of
// freedom 3 n + c is component c at node n. The mesh may go.
class SimplexSpace {
public:
    struct Elements;  // deal.II's side, in assembly.cpp

    // Corners of the edge that mid-edge node 4 + k of a tet lies on: deal.II's order of a tet's lines, which is that of
    // C3D10.
    static constexpr int edge_corners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

    // A mesh that passes check_mesh; element_order 1 or 2, else pbs::InputError.
    SimplexSpace(const pbs::TetMesh& mesh, int element_order);
    ~SimplexSpace();

    int element_order() const { return element_order_; }                      // 1 or 2
    int nodes() const { return static_cast<int>(node_positions_.rows()); }    // #V with P1, #V + #E with P2
    int dofs() const { return 3 * nodes(); }                                  // 3 per node, prescribed ones too
    const pbs::Positions& node_positions() const { return node_positions_; }  // [m], #nodes x 3
    const TetNodes& tet_nodes() const { return tet_nodes_; }                  // the corners first, in the mesh's order

    // Shape functions of the element's 4 or 10 nodes at a point of a tet, given by its coordinates on corners 2, 3, 4.
    Eigen::VectorXd shape_values(const pbs::Vec3& barycentric) const;

    // Values given at the vertices, #V x 3, on all nodes, #nodes x 3: linear along each edge.
    pbs::Positions from_vertices(const pbs::Positions& at_vertices) const;

    const Elements& elements() const { return *elements_; }  // deal.II's side, for assembly.cpp

private:
    void number_nodes(const pbs::TetMesh& mesh);

    int element_order_;
    std::unique_ptr<Elements> elements_;
    pbs::Positions node_positions_;
    TetNodes tet_nodes_;
};

// The only sparse matrix format of the reference: compressed columns, 64-bit indices, as SuiteSparse's long interfaces
// read it in place. Stiffness matrices are symmetric and hold both triangles.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;  // compressed before a solver reads it

using VectorField = std::function<pbs::Vec3(const pbs::Vec3&)>;          // of a rest point [m]; unit by use: N/m^3, m
using GradientField = std::function<Eigen::Matrix3d(const pbs::Vec3&)>;  // (i, j): d u_i / d x_j at a rest point [m]

// M_ij = integral of density phi_i phi_j [kg], #nodes x #nodes: the consistent mass, the same for each component; exact
// on straight tets.
SparseMatrix mass_matrix(const SimplexSpace& space, double density_kg_m3);

// f_i = integral of body_force . phi_i [N], #dofs; body_force in N/m^3.
Eigen::VectorXd load_vector(const SimplexSpace& space, const VectorField& body_force);

// Forces on the boundary faces whose centre is `on`; `force` [N/m^2] may follow the outward unit normal.
struct Traction {
    std::function<bool(const pbs::Vec3& face_centre)> on;  // called once per boundary face, at its rest centre [m]
    std::function<pbs::Vec3(const pbs::Vec3& point, const pbs::Vec3& normal)> force;  // called at quadrature points [m]
};

// f_i = integral of force . phi_i over those faces [N], #dofs.
Eigen::VectorXd traction_load(const SimplexSpace& space, const Traction& traction);

// (i, j) = d u_i / d x_j at a vertex of the mesh, each tet that meets there with its own: their mean.
Eigen::Matrix3d gradient_at_vertex(const SimplexSpace& space, const Eigen::VectorXd& displacement, int vertex);

// Integral of lambda / 2 tr(eps)^2 + mu eps : eps [J] of a displacement [m], #dofs.
double strain_energy(const SimplexSpace& space, const Lame& material, const Eigen::VectorXd& displacement);

// Distance of a displacement u_h from the exact u over the whole volume.
struct ErrorNorms {
    double l2 = 0.0;           // sqrt of the integral of |u - u_h|^2 [m^(5/2)]
    double h1_seminorm = 0.0;  // sqrt of the integral of |grad u - grad u_h|^2 [m^(3/2)]
};
// displacement [m], #dofs. By quadrature with 4 points per direction, exact to degree 7.
ErrorNorms error_norms(const SimplexSpace& space, const Eigen::VectorXd& displacement, const VectorField& exact,
                       const GradientField& exact_gradient);

// The elements of a space as arrays: what an energy over the tets needs of deal.II, computed once. On straight tets the
// gradients are those of the rest configuration (total Lagrangian). Quadrature point q of tet t has the index t *
// points_per_tet + q.
struct ElementTables {
    int nodes_per_tet = 0, points_per_tet = 0;  // nodes: 4 or 10
    Eigen::VectorXd weights;                    // [m^3], #T * points: quadrature weight times Jacobian
    pbs::Positions shape_gradients;             // d N_a / d X [1/m], (#T * points * nodes) x 3

    // The nodes' gradients at point q of a tet, nodes x 3.
    auto gradients(Eigen::Index tet, int q) const
    {
        return shape_gradients.middleRows((tet * points_per_tet + q) * nodes_per_tet, nodes_per_tet);
    }
    double weight(Eigen::Index tet, int q) const { return weights(tet * points_per_tet + q); }  // [m^3]
};

// Quadrature with `points_1d` points per direction: exact to degree 2 points_1d - 1; 1 to 4.
ElementTables element_tables(const SimplexSpace& space, int points_1d);

// Any rule: points by their coordinates on corners 2, 3, 4; the weights add up to 1/6, the volume of the unit tet.
struct TetQuadrature {
    pbs::Positions points;    // #points x 3
    Eigen::VectorXd weights;  // #points
};
// any number of points; ElasticPotential takes 6
ElementTables element_tables(const SimplexSpace& space, const TetQuadrature& quadrature);

using NodePair = std::array<int, 2>;

// A symmetric sparse matrix over the nodes of a space, of 3 x 3 blocks: block (i, j) exists where a tet has both nodes,
// or where they are coupled. It is stored as the plain compressed columns that SuiteSparse reads, so adding a block is
// nine additions in place. Degree of freedom 3 n + c is component c at node n.
class NodalMatrix {
public:
    explicit NodalMatrix(const SimplexSpace& space);  // zeros; the space may go

    void set_zero() { matrix_.coeffs().setZero(); }  // the pattern stays
    // Makes place for blocks of further pairs of nodes, both ways. If one of them has none yet, places of earlier
    // couplings that are not among them are dropped, all values become 0, and the answer is true: the pattern has
    // changed.
    bool couple(const std::vector<NodePair>& pairs);
    // of two nodes that share a tet or are coupled
    void add_block(int row_node, int column_node, const Eigen::Matrix3d& block);
    // Blocks of one tet, k of them a side: values 3 k x 3 k.
    void add_tet(Eigen::Index tet, const Eigen::Ref<const Eigen::MatrixXd>& values);
    // factor times another NodalMatrix of this space without couplings, #dofs x #dofs.
    void add(const SparseMatrix& of_tets, double factor);
    // factor times a matrix over the nodes, #nodes x #nodes with an entry where a tet has both: a multiple of the
    // identity in each block.
    void add_isotropic(const SparseMatrix& of_nodes, double factor);

    const SparseMatrix& matrix() const& { return matrix_; }  // #dofs x #dofs, both triangles
    SparseMatrix matrix() && { return std::move(matrix_); }  // the same, moved out

private:
    void set_pattern(std::vector<std::vector<int>> rows_of_column);         // of nodes, both sorted
    SparseMatrix::StorageIndex place(int row_node, int column_node) const;  // of the block's first row in its columns
    bool has_place(int row_node, int column_node) const;
    template <typename Block>
    void add_at(SparseMatrix::StorageIndex place, int column_node, const Block& block);

    SparseMatrix matrix_;
    TetNodes tet_nodes_;
    std::vector<SparseMatrix::StorageIndex> tet_places_;  // per tet, row by row
};

}  // namespace reference_fem
