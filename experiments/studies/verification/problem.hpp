// The problems that verify the reference. A new problem is a function that returns its rows, and one line in
// problem_list.cpp.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

using reference_fem::VerificationRow;
using reference_fem::VerificationRows;

struct Effort : reference_fem::Effort {
    // The built-in limb with about this number of vertices (0: its default). The caller meshes it, since only the
    // caller links CGAL. Problems that need the limb have no rows where the function is empty.
    std::function<pbs::Character(int vertices)> limb = {};
};

// The problems that need a character or PBS; reference_fem/verification/problems.hpp declares the others.
VerificationRows attached_limb_rows(const Effort& effort);
VerificationRows nested_convergence_rows(const Effort& effort);
VerificationRows pbs_locking_rows(const Effort& effort);
VerificationRows calculix_rows(const Effort& effort);

struct VerificationProblem {
    std::string name;        // README.md states its truth
    double quick_s, full_s;  // expected time on one core
    std::function<VerificationRows(const Effort& effort)> rows;
};
const std::vector<VerificationProblem>& verification_problems();

inline constexpr reference_fem::ElasticMaterial calculix_flesh{.young_pa = 1e5, .poisson = 0.3};

enum class BodyModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by C3D10's rule; the reference's own rule has six points
};

// A pose of the limb that CalculiX has solved.
struct CalculixLimb {
    int vertices;     // that the mesher is asked for
    std::string way;  // bent or twisted
    int angle_deg;    // of the forearm
    BodyModel model;
    int element_order;
    FemAttachment attachment = FemAttachment::nodes;  // or smooth

    bool is_smooth() const { return attachment == FemAttachment::smooth; }
    std::string problem() const;  // the name of its kept displacements
};
std::vector<CalculixLimb> calculix_limbs(bool full);

// The same pose as a problem of the reference. Its row compares the two programs at every node.
//   const HeldBody body = held_body(character, limb, calculix_flesh);
//   calculix_row(character, limb, body).value
struct HeldBody {
    reference_fem::ElasticMaterial material;
    BodyModel model = BodyModel::linear;
    int element_order = 1;
    reference_fem::Attachment attachment;  // no vertex is bound
    reference_fem::TargetsAt targets_at;   // of the pose at 1, and of rest, where a large rotation begins, at 0
};
HeldBody held_body(const pbs::Character& character, const CalculixLimb& limb,
                   const reference_fem::ElasticMaterial& material);
VerificationRow calculix_row(const pbs::Character& character, const CalculixLimb& limb, const HeldBody& body);

// A manufactured solution u_i = A sin(a_i . x + phi_i) of stable neo-Hookean flesh in the unit cube that is held by
// springs with the density k of a smooth attachment. The springs' targets lie a given offset c from the exact
// positions, so that the body force is f = -div P - k(x) c.
//   const AttachedSolution solution = solve_manufactured(mesh, 2, {});
//   solution.positions - exact_positions(mesh.rest)
// Elements of order p converge with h^(p+1) (Brenner and Scott, ch. 5) down to the error of the sample points, which
// grows with c: a small c serves the orders, and a large one shows whether the springs have the weight that the body
// force assumes. Young's modulus [Pa], Poisson's ratio
inline const reference_fem::ElasticMaterial manufactured_material = {1.0, 0.3};

struct ManufacturedSprings {
    pbs::Vec3 offset_m = {2e-6, -1e-6, 3e-6};  // c
    double weight = 1.0;                       // times the density that the body force assumes
};

struct AttachedSolution {
    pbs::Positions positions;  // vertices [m]
    double error = 0.0;        // of the displacement in L2, over the exact one
    int dofs = 0;
    bool converged = false;
};

// material: that of the solver; the body force belongs to manufactured_material.
AttachedSolution solve_manufactured(const pbs::TetMesh& mesh, int element_order, const ManufacturedSprings& springs,
                                    const reference_fem::ElasticMaterial& material = manufactured_material);

pbs::Positions exact_positions(const pbs::Positions& rest);  // [m]

}  // namespace experiments

// The entry into the module lib/libpbskin_verification.so, which carries deal.II.
extern "C" const std::vector<experiments::VerificationProblem>* pbskin_verification_problems();
