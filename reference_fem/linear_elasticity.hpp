// Implicit linear elasticity on the character's own tets (deal.II simplices, P1 or P2), quasi-static.
//   LinearElasticity fem(mesh, options, attachment);   // assembles and factors once
//   fem.solve(spring_targets, vertex_targets);         // every frame: a right-hand side and a re-solve
//   fem.positions();
// Strains are small: a rotation by theta produces a fictitious strain of 1 - cos(theta). Above some 10 degrees it is a
// negative control. The header is plain; deal.II is seen by assembly.cpp alone, and SuiteSparse by linear_solvers.cpp.
#pragma once

#include "reference_fem/attachment.hpp"
#include "reference_fem/options.hpp"

#include <memory>

namespace reference_fem {

// Out of bounds: pbs::InputError from LinearElasticity's constructor.
struct LinearOptions {
    int element_order = 2;                                // 1, 2
    double young_pa = 1.0e5;                              // Young's modulus E > 0
    double poisson = 0.45;                                // Poisson's ratio, -1 < nu < 0.5; with taylor_hood > 0
    double density_kg_m3 = 1000.0;                        // >= 0; only gravity uses it
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero();           // of solve() without its own
    LinearSolver solver = LinearSolver::cholmod;          // taylor_hood: always UMFPACK
    Formulation formulation = Formulation::displacement;  // taylor_hood: element_order 2
};

// Numerical breakdown is reported here, never thrown.
struct SolveSummary {
    double seconds = 0.0;   // wall time of right-hand side and re-solve
    double residual = 0.0;  // |K u - f| / |f| over the free unknowns; infinite where singular
    bool finite = true;     // false: the matrix is singular in double
};

// Keeps what it needs: mesh, options and attachment may go.
class LinearElasticity {
public:
    // pbs::InputError where an option, the mesh or the attachment is out of bounds, or a connected part of the mesh is
    // not held.
    LinearElasticity(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment);
    ~LinearElasticity();

    // spring_targets: #S x 3 [m]; vertex_targets: #V x 3 [m], read at the vertices of prescribed tets only.
    // pbs::InputError for another number of either.
    SolveSummary solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets);
    // The same under another gravity than that of the options, for a rotating frame of reference.
    SolveSummary solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets,
                       const pbs::Vec3& gravity_m_s2);

    const pbs::Positions& positions() const;  // deformed vertices [m], #V x 3
    // of every node of the space [m], #dofs: vertices, then the middles of edges
    const Eigen::VectorXd& displacement() const;
    const Eigen::VectorXd& pressure_pa() const;  // lambda div u at the vertices, #V, with taylor_hood, else empty
    // where the tied points went [m], #S x 3: targets minus this is the grip error
    pbs::Positions spring_points_deformed() const;
    double strain_energy_j() const;                 // of the flesh alone, without the springs
    std::vector<bool> prescribed_vertices() const;  // #V
    const SetupSummary& setup() const;              // of the constructor's one assembly and factor

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace reference_fem
