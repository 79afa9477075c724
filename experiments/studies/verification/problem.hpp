// The problems by which the study `verification` compares the reference and PBS with known answers. A new problem is a
// function that returns its rows, and one line in problem_list.cpp.
//   for (const VerificationProblem& problem : verification_problems()) problem.rows(effort);
// The problems that need a character or PBS are declared here, with the parts that their tests use:
//   attached_limb_rows, nested_convergence_rows   attached_limb.cpp, nested_convergence.cpp
//   pbs_locking_rows                              pbs_locking.cpp
//   calculix_rows                                 calculix.cpp
// All others are those of reference_fem/verification/problems.hpp.
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

// How much of the problems is solved.
struct Effort : reference_fem::Effort {
    // Makes the built-in limb with about this number of vertices (0: its default). The caller meshes it, since only the
    // caller links CGAL. Problems that need the limb have no rows if the function is empty.
    std::function<pbs::Character(int vertices)> limb = {};
};

// The rows are values with their references and bounds. Nothing is thrown for a bound that does not hold.
VerificationRows attached_limb_rows(const Effort& effort);
VerificationRows nested_convergence_rows(const Effort& effort);
VerificationRows pbs_locking_rows(const Effort& effort);
VerificationRows calculix_rows(const Effort& effort);

struct VerificationProblem {
    std::string name;        // as in README.md, which states what the values are compared with
    double quick_s, full_s;  // expected time on one core
    std::function<VerificationRows(const Effort& effort)> rows;
};
const std::vector<VerificationProblem>& verification_problems();

// A comparison with CalculiX, which has solved the limb in some poses.
//   for (const CalculixLimb& limb : calculix_limbs(false)) {
//       const HeldBody body = held_body(character, limb, calculix_flesh);
//       calculix_row(character, limb, body).value;   // the largest difference at a node
//   }
inline constexpr reference_fem::ElasticMaterial calculix_flesh{.young_pa = 1e5, .poisson = 0.3};

enum class BodyModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by the rule of C3D10; the reference's own rule has six points
};

// A pose of the limb that CalculiX has solved.
struct CalculixLimb {
    int vertices;                                     // the number that the mesher is asked for
    std::string way;                                  // "bent" or "twisted"
    int angle_deg;                                    // the angle of the forearm
    BodyModel model;                                  // of the reference
    int element_order;                                // 1 or 2
    FemAttachment attachment = FemAttachment::nodes;  // nodes or smooth

    bool is_smooth() const { return attachment == FemAttachment::smooth; }
    std::string problem() const;  // the name of its kept displacements
};
std::vector<CalculixLimb> calculix_limbs(bool full);  // full: quadratic elements on the larger mesh

// The same pose as a problem of the reference.
struct HeldBody {
    reference_fem::ElasticMaterial material;
    BodyModel model = BodyModel::linear;
    int element_order = 1;
    reference_fem::Attachment attachment;  // no vertex is bound
    // The targets of the bones on the way from rest, at 0, to the pose, at 1. A large rotation begins at rest.
    reference_fem::TargetsAt targets_at;
};
HeldBody held_body(const pbs::Character& character, const CalculixLimb& limb,
                   const reference_fem::ElasticMaterial& material);
// Compares the two programs at every node. character: the limb with limb.vertices.
VerificationRow calculix_row(const pbs::Character& character, const CalculixLimb& limb, const HeldBody& body);

// A manufactured solution u_i = A sin(a_i . x + phi_i) of stable neo-Hookean flesh in the unit cube that is held by
// springs with the density k of a smooth attachment. The springs' targets lie a given offset c from the exact
// positions, so that the body force is f = -div P - k(x) c.
//   const AttachedSolution solution = solve_manufactured(mesh, 2, {});
//   solution.positions - exact_positions(mesh.rest)
// Elements of order p converge with h^(p+1) (Brenner and Scott, ch. 5) down to the error of the sample points, which
// grows with c. A small c therefore serves to measure the orders, and a large one shows whether the springs have the
// weight that the body force assumes.
inline const reference_fem::ElasticMaterial manufactured_material = {.young_pa = 1.0, .poisson = 0.3};

struct ManufacturedSprings {
    pbs::Vec3 offset_m = {2e-6, -1e-6, 3e-6};  // c
    double weight = 1.0;                       // a factor on the density that the body force assumes
};

struct AttachedSolution {
    pbs::Positions positions;  // of the vertices [m], #V x 3
    double error = 0.0;        // L2 norm of the displacement's error over that of the exact displacement
    int dofs = 0;              // degrees of freedom
    bool converged = false;    // whether Newton's method reached its tolerance
};

// mesh: of the unit cube. element_order: 1 or 2. material: that of the solver; the body force always belongs to
// manufactured_material.
AttachedSolution solve_manufactured(const pbs::TetMesh& mesh, int element_order, const ManufacturedSprings& springs,
                                    const reference_fem::ElasticMaterial& material = manufactured_material);

pbs::Positions exact_positions(const pbs::Positions& rest);  // [m], #V x 3

}  // namespace experiments

// The entry into the module lib/libpbskin_verification.so, which carries deal.II.
extern "C" const std::vector<experiments::VerificationProblem>* pbskin_verification_problems();
