// Parts that the verification problems share.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace reference_fem {

VerificationRows laws_rows(const Effort& effort);
VerificationRows patch_test_rows(const Effort& effort);
VerificationRows manufactured_solution_rows(const Effort& effort);
VerificationRows own_weight_rows(const Effort& effort);
VerificationRows cantilever_rows(const Effort& effort);
VerificationRows gravity_cantilever_rows(const Effort& effort);
VerificationRows torsion_rows(const Effort& effort);
VerificationRows thick_sphere_rows(const Effort& effort);
VerificationRows cooks_membrane_rows(const Effort& effort);
VerificationRows cooks_membrane_finite_strain_rows(const Effort& effort);
VerificationRows locking_rows(const Effort& effort);
VerificationRows twisted_beam_rows(const Effort& effort);
VerificationRows thick_plate_rows(const Effort& effort);
VerificationRows half_turn_rows(const Effort& effort);
VerificationRows dynamics_rows(const Effort& effort);
VerificationRows moving_skeleton_rows(const Effort& effort);
VerificationRows contact_rows(const Effort& effort);

// The material that the solver receives in place of `material`: the same, unless the effort asks for an error in
// lambda.
ElasticMaterial solver_material(const Effort& effort, const ElasticMaterial& material);

RowElements elements_of(int order, Formulation formulation = Formulation::displacement);
RowMaterial material_of(const std::string& law, double poisson);  // {"neo_hookean", 0.3}
RowMaterial linear_material(double poisson);                      // {"linear", 0.3}
std::string identifier_of(const std::string& words);              // Newmark, step 40 ms: newmark_step_40_ms
double order_between(double coarse, double fine);                 // of errors on two meshes, one twice as fine

// The fields that all rows of one solution have in common.
struct RowSolution {
    std::string problem;
    RowElements elements;
    RowMaterial material;
    std::string mesh;  // divisions
    double h_m;        // edge of a cell
    int dofs;
};

// The row of a value and its reference, both in `unit`; without bounds.
VerificationRow row_about(const RowSolution& solution, const RowQuantity& quantity, double value, double reference,
                          const std::string& unit, const std::string& source);
void bound(VerificationRow& row, std::optional<double> low, std::optional<double> high, const std::string& from);
void unbound(VerificationRow& row);
void expect_order(VerificationRow& row, double observed, double expected, const std::string& from);

// Rows of meshes of n, 2n, ... cells, each with the observed order of its difference from the reference.
VerificationRows ladder(const std::function<VerificationRow(int n)>& row_of, int coarsest, int levels);

// The value of a row whose solution was not reached.
inline constexpr double not_reached = std::numeric_limits<double>::quiet_NaN();

// R. MacNeal, R. Harder, A proposed standard set of problems to test finite element accuracy, Finite Elements in
// Analysis and Design 1 (1985) 3-20, Table 13: an element that is within 2 % of the reference is given an A.
inline constexpr double grade_a = 0.02;
inline const std::string grade_a_text = "within 2 %: grade A of MacNeal and Harder 1985";
void bound_by_grade_a(VerificationRow& row);

inline const std::string scheme_theory =
    "theory of the scheme: J. Chung, G. Hulbert, J. Appl. Mech. 60(2) (1993) 371-375";

// Meshes of boxes, bent and joined to the shapes of the benchmarks: no mesher, so that every run has the same tets.
using Divisions = std::array<int, 3>;  // cells along x, y, z

std::string text_of(const Divisions& divisions);  // 48 x 6 x 6

// A box of cells, each split into six tets about one diagonal (Kuhn). Corners [m].
pbs::TetMesh box_mesh(const pbs::Vec3& lower, const pbs::Vec3& upper, const Divisions& divisions);

// The unit cube of n^3 cells, its inner vertices moved at random by up to half of `share` of a cell along each axis.
pbs::TetMesh jittered_cube(int n, double share);

// Every vertex moved to map(vertex). Where the map mirrors a tet, two of its corners change places.
pbs::TetMesh mapped(pbs::TetMesh mesh, const std::function<pbs::Vec3(const pbs::Vec3&)>& map);

// One mesh of all; vertices closer than 1e-7 m are one.
pbs::TetMesh joined(const std::vector<pbs::TetMesh>& meshes);

// The two bars that more than one problem solves.
// Tip deflection under a shear of 1 N; P2 bounded by what the clamp may do (cantilever.cpp).
VerificationRow cantilever_row(const Effort& effort, double poisson, int element_order, Formulation formulation,
                               const Divisions& divisions);

// Torque of a cube of n^3 cells, without bounds (turned_bars.cpp).
VerificationRow torsion_row(const Effort& effort, double poisson, int element_order, Formulation formulation, int n);

// The panel of Cook's membrane: corners (0,0), (48,44), (48,60), (0,44) mm, 1 mm thick. Units: N and mm. Only the half
// above the middle plane z = 0 is modelled, where u_z = 0. The whole panel is thin and buckles sideways far below the
// load of the finite strain benchmark.
pbs::TetMesh membrane(int n);  // n x n x 1 cells, 0.5 mm thick

// Clamped on the left, a uniform shear [N/mm^2] on the right; plane strain: u_z held on the outer face, else it is
// free.
BoundaryValueProblem membrane_problem(double shear, bool plane_strain, int element_order);

// A bound on the effect of rounding on the solution of K u = f, computed from K. It is the tolerance of comparisons in
// which rounding is the only difference.
//   const Spectrum of_k = spectrum(stiffness, prescribed);
//   EXPECT_LT((ours - exact).norm(), rounding_bound(of_k) * exact.norm());
//
// A backward stable direct solver returns the exact solution of (K + E) u' = f with |E| <= c |K| (N. Higham, Accuracy
// and stability of numerical algorithms, 2nd ed., SIAM 2002: Theorem 10.4 for Cholesky, Theorem 9.4 for LU with a
// growth of 1), and forming f from prescribed values costs c |K| |u| again (Sec. 3.5). Hence, in the 2-norm over all
// unknowns (Theorem 7.2), with cond(K) = |K| |K^-1|,
//   |u' - u| <= c cond(K) |u|.
// c is the sum of up to 3 n + 1 roundings of one unit, n the number of unknowns. Roundings of random sign add up to the
// square root of their number (Sec. 2.8): sqrt(3 n + 1) times the unit roundoff eps / 2, which is below sqrt(n) eps.
// The extreme eigenvalues in magnitude of a symmetric matrix, definite or not.
struct Spectrum {
    int unknowns = 0;                      // n
    double largest = 0.0, smallest = 0.0;  // magnitudes of eigenvalues, in the matrix's unit
    double condition() const { return largest / smallest; }
};

// The same for the block of the unknowns that are not prescribed. By Lanczos' method on it and on its inverse (by a
// direct solver), in at most 60 steps each: lower bounds of cond(K), which agree with dense eigenvalues to six digits
// on the meshes of the tests.
Spectrum spectrum(const SparseMatrix& symmetric, const std::vector<bool>& prescribed);
// in the solution's own formulation
Spectrum spectrum(const BoundaryValueSolution& solution, const ElasticMaterial& material);

double rounding_bound(const Spectrum& spectrum);  // sqrt(n) eps cond(K), relative
inline const std::string rounding_bound_text =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) by eigenvalues of this very matrix";

// The first bending frequency of a clamped-free beam of square section by beam theory.
struct Beam {
    double length_m, depth_m, young_pa, poisson, density_kg_m3;
};

// omega = 1.875104^2 sqrt(E I / (rho A L^4)) [rad/s]: neither shear nor rotary inertia.
double bernoulli_euler_rad_s(const Beam& beam);

// With both (S. Timoshenko, Phil. Mag. 41, 1921), shear coefficient 10 (1 + nu) / (12 + 11 nu) (G. Cowper, J. Appl.
// Mech. 33, 1966).
double timoshenko_rad_s(const Beam& beam);

}  // namespace reference_fem
