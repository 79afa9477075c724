// The positions that the skeleton prescribes, as arrays, and the report of a solver's set-up.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <string>
#include <vector>

namespace reference_fem {

// Springs tie material points to targets. Every node of a prescribed tet is at its target. The bind constraint keeps
// vertices at a distance from moving points, by the energy sum_i k_i / 2 (|x_i - q_i| - d_i)^2.
struct Attachment {
    pbs::Positions spring_points = {};      // rest points [m], #S x 3; a point outside the tets is left out and counted
    Eigen::VectorXd spring_stiffness = {};  // [N/m], #S
    // All nodes of these tets are held. A mid-edge node follows the mean of its edge's ends, which is exact for affine
    // targets.
    std::vector<int> prescribed_tets = {};
    Eigen::VectorXd bind_distance = {};   // d_i [m], #V, or empty: nothing is bound. Not for LinearElasticity
    Eigen::VectorXd bind_stiffness = {};  // k_i [N/m], #V; 0: this vertex is not bound
};

// For records: what was built, by which library, in how many seconds of wall time.
struct SetupSummary {
    int dofs = 0;  // number of unknowns, including prescribed ones and, with taylor_hood, one pressure per vertex
    double assemble_s = 0.0, analyse_s = 0.0,
           factor_s = 0.0;  // the last analysis and factor; assembly only of LinearElasticity, else 0
    std::string elements;   // e.g. "deal.II 9.4.1"
    std::string solver;     // e.g. "CHOLMOD 3.0.14 supernodal, METIS"
    std::string blas;       // the BLAS that was resolved
    bool factored = false;  // false: the matrix is singular in double; every solve then reports finite = false
    double reciprocal_condition = 0.0;  // the solver's own rough estimate
    std::vector<int> spring_tet;        // tet that holds each spring point, -1: outside
};

// Springs between material points of the flesh and given targets: an energy sum_s k_s / 2 |x(p_s) - target_s|^2, where
// x(p_s) is interpolated by the element's own shape functions. A point outside every tet is left out. Keeps what it
// needs of mesh and space.
class AttachedPoints {
public:
    // points [m], #S x 3; stiffness [N/m], #S.
    AttachedPoints(const pbs::TetMesh& mesh, const SimplexSpace& space, const pbs::Positions& points,
                   const Eigen::VectorXd& stiffness);

    // Adds k N^T N to the stiffness matrix [N/m]; a spring couples nodes of one tet only, so the pattern stays.
    void add_to(SparseMatrix& matrix) const;

    // Adds k N^T (target - point) to the load [N], #dofs; targets [m], #S x 3.
    void add_load(const pbs::Positions& targets, Eigen::VectorXd& load) const;

    // Adds the same to a matrix whose blocks exist already.
    void add_to(NodalMatrix& matrix) const;

    // The energy [J]; targets [m], #S x 3, displacement [m], #dofs.
    double energy(const pbs::Positions& targets, const Eigen::VectorXd& displacement) const;
    // Adds the gradient of that energy, k N^T (point + displacement - target) [N], #dofs.
    void add_pull(const pbs::Positions& targets, const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const;

    // The points [m] moved by a displacement [m], #dofs -> #S x 3; not a number for points that were left out.
    pbs::Positions moved(const Eigen::VectorXd& displacement) const;

    const std::vector<int>& tets() const { return tet_; }  // #S, -1: outside

private:
    pbs::Vec3 moved(Eigen::Index spring, const Eigen::VectorXd& displacement) const;
    void sum_tets();

    pbs::Positions points_;
    Eigen::VectorXd stiffness_;
    std::vector<int> tet_;
    Eigen::MatrixXi nodes_;   // nodes per tet x #S
    Eigen::MatrixXd shapes_;  // their shape functions at the point
    // k N^T N summed over the springs of each gripped tet, nodes per tet x nodes per tet: as stiff as any number of
    // springs in it.
    struct GrippedTet {
        Eigen::VectorXi nodes;
        Eigen::MatrixXd stiffness;  // [N/m]
    };
    std::vector<GrippedTet> gripped_;
};

// A part of the mesh that nothing holds can move rigidly for free, and its stiffness matrix is singular.
// Each connected part of the mesh (over shared vertices) must contain three held points that are not on one line, else
// pbs::InputError naming a tet of the part. `points` [m], #P x 3, lie in `tets`, #P; -1: left out.
void require_held(const pbs::TetMesh& mesh, const pbs::Positions& points, const std::vector<int>& tets);

// pbs::InputError where the springs, prescribed tets or bound vertices do not fit the mesh.
void check_attachment(const pbs::TetMesh& mesh, const Attachment& attachment);

// A mesh's elements and what the skeleton holds of them: what LinearElasticity and ElasticBody have in common. Mesh and
// attachment may go.
class HeldSpace {
public:
    // pbs::InputError where the mesh, an option or the attachment is out of bounds, or a connected part of the mesh is
    // not held.
    HeldSpace(const pbs::TetMesh& mesh, int element_order, double density_kg_m3, const Attachment& attachment);

    const SimplexSpace& space() const { return space_; }                 // its node v is vertex v of the mesh
    const AttachedPoints& springs() const { return springs_; }           // in the attachment's order, those outside too
    const std::vector<bool>& prescribed() const { return prescribed_; }  // #dofs
    const pbs::Positions& rest() const { return rest_; }                 // vertices [m], #V x 3

    // [N], #dofs
    Eigen::VectorXd gravity_load(const pbs::Vec3& gravity_m_s2) const { return gravity_loads_ * gravity_m_s2; }
    // Vertex targets [m], #V x 3, as displacements of every node [m], #dofs.
    Eigen::VectorXd prescribed_values(const pbs::Positions& vertex_targets) const;
    // Deformed vertices [m], #V x 3, of a displacement [m], #dofs.
    pbs::Positions vertices(const Eigen::VectorXd& displacement) const;
    std::vector<bool> prescribed_vertices() const;  // #V

    // pbs::InputError unless there is one target per spring point and one per vertex.
    void require_targets(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets) const;
    SetupSummary summary(const PreparedSolver* factor, double assemble_s) const;  // null: nothing is factored yet

private:
    pbs::Positions rest_;
    SimplexSpace space_;
    AttachedPoints springs_;
    std::vector<bool> prescribed_;
    Eigen::MatrixXd gravity_loads_;  // [kg], #dofs x 3: for unit acceleration along each axis
};

}  // namespace reference_fem
