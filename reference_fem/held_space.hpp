// A mesh's elements and what the skeleton holds of them: what LinearElasticity and ElasticBody have in common.
#pragma once

#include "reference_fem/attached_points.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/prepared_solver.hpp"

namespace reference_fem {

// pbs::InputError where the springs, prescribed tets or bound vertices do not fit the mesh.
void check_attachment(const pbs::TetMesh& mesh, const Attachment& attachment);

// Keeps what it needs: mesh and attachment may go.
class HeldSpace {
public:
    // pbs::InputError where the mesh, an option or the attachment is out of bounds, or a connected part of the mesh is not held.
    HeldSpace(const pbs::TetMesh& mesh, int element_order, double density_kg_m3, const Attachment& attachment);

    const SimplexSpace& space() const { return space_; }                 // its node v is vertex v of the mesh
    const AttachedPoints& springs() const { return springs_; }           // in the attachment's order, those outside too
    const std::vector<bool>& prescribed() const { return prescribed_; }  // #dofs
    const pbs::Positions& rest() const { return rest_; }                 // vertices [m], #V x 3

    Eigen::VectorXd gravity_load(const pbs::Vec3& gravity_m_s2) const { return gravity_loads_ * gravity_m_s2; }  // [N], #dofs
    // Vertex targets [m], #V x 3, as displacements of every node [m], #dofs.
    Eigen::VectorXd prescribed_values(const pbs::Positions& vertex_targets) const;
    // Deformed vertices [m], #V x 3, of a displacement [m], #dofs.
    pbs::Positions vertices(const Eigen::VectorXd& displacement) const;
    std::vector<bool> prescribed_vertices() const;  // #V

    // pbs::InputError unless there is one target a spring point and one a vertex.
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
