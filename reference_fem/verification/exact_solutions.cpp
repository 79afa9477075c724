// A displacement that is affine in x has a constant stress, needs no body force and lies in both finite element spaces:
// the solver must return it on any mesh, from displacements and from tractions on the boundary (B. Irons, A. Razzaque,
// 1972).

#include "reference_fem/verification/problems.hpp"

namespace reference_fem {
namespace patch_test {

using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};

Vec3 affine(const Vec3& x)
{
    Eigen::Matrix3d gradient;
    gradient << 0.02, -0.03, 0.04, 0.06, 0.01, 0.02, -0.02, 0.05, -0.04;
    return Vec3(0.1, -0.05, 0.03) + gradient * x;
}

Vec3 stretched(const Vec3& x)
{
    return 0.01 * Vec3(x.x(), -material.poisson * x.y(), -material.poisson * x.z());
}

BoundaryValueProblem from_displacements(int element_order)
{
    return {.displacement = affine, .element_order = element_order};
}

// Rollers on three faces, a uniform tension of 0.01 E on the fourth.
BoundaryValueProblem from_tractions(int element_order)
{
    return {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
            .element_order = element_order,
            .tractions = {{[](const Vec3& centre) { return centre.x() > 1.0 - 1e-9; },
                           [](const Vec3&, const Vec3& normal) -> Vec3 { return 0.01 * material.young_pa * normal; }}}};
}

VerificationRow row_of(const Effort& effort, const std::string& data, const BoundaryValueProblem& problem,
                       const VectorField& exact)
{
    const int n = problem.element_order == 1 ? 5 : 3;
    const pbs::TetMesh mesh = jittered_cube(n, 0.45);
    const BoundaryValueSolution solution = solve(mesh, solver_material(effort, material), problem);
    double largest = 0.0;
    for (const auto& point : mesh.rest.rowwise()) largest = std::max(largest, exact(point.transpose()).norm());
    VerificationRow row =
        row_about({"patch_test", elements_of(problem.element_order), linear_material(material.poisson),
                   text_of({n, n, n}) + " jittered", 1.0 / n, solution.space->dofs()},
                  {"nodal_error_from_" + data, "largest nodal error over largest displacement, from " + data},
                  solution.largest_nodal_error(exact) / largest, 0.0, "1",
                  "closed form: an affine displacement is its own finite element solution");
    bound(row, 0.0, rounding_bound(spectrum(solution, material)), rounding_bound_text);
    return row;
}

}  // namespace patch_test

VerificationRows patch_test_rows(const Effort& effort)
{
    using namespace patch_test;
    VerificationRows rows;
    for (const int element_order : {1, 2}) {
        rows.push_back(row_of(effort, "displacements", from_displacements(element_order), affine));
        rows.push_back(row_of(effort, "tractions", from_tractions(element_order), stretched));
    }
    return rows;
}

// A bar along x, held at x = 0 as the closed form moves there, under its own weight w [N/m^3] along x: sigma_xx = w (L
// - x) and nothing else. The displacement is quadratic, so P2 tets return it to rounding (S. Timoshenko, J. Goodier,
// Theory of elasticity, art. 96).

namespace own_weight {

using pbs::Vec3;

const ElasticMaterial material{1.0e5, 0.3};
constexpr double length_m = 1.0, weight_n_m3 = 9810.0;

Vec3 exact(const Vec3& point)
{
    const double x = point.x(), y = point.y() - 0.5, z = point.z() - 0.5, slope = weight_n_m3 / material.young_pa,
                 nu = material.poisson;
    return {slope * (length_m * x - x * x / 2.0 - nu * (y * y + z * z) / 2.0), -nu * slope * (length_m - x) * y,
            -nu * slope * (length_m - x) * z};
}

}  // namespace own_weight

VerificationRows own_weight_rows(const Effort& effort)
{
    using namespace own_weight;
    const int n = 2;
    const BoundaryValueSolution solution = solve(jittered_cube(n, 0.25), solver_material(effort, material),
                                                 {.body_force = [](const Vec3&) -> Vec3 {
                                                      return {weight_n_m3, 0, 0};
                                                  },
                                                  .displacement = exact,
                                                  .held = [](const Vec3& x) { return x.x() < 1e-9; },
                                                  .element_order = 2});
    VerificationRow row = row_about(
        {"own_weight", elements_of(2), linear_material(material.poisson), text_of({n, n, n}) + " jittered", 1.0 / n,
         solution.space->dofs()},
        {"nodal_error", "largest nodal error over largest displacement"},
        solution.largest_nodal_error(exact) / exact({length_m, 0.0, 0.0}).norm(), 0.0, "1",
        "closed form: bar hanging under its own weight (Timoshenko and Goodier, Theory of elasticity, art. 96)");
    bound(row, 0.0, rounding_bound(spectrum(solution, material)), rounding_bound_text);
    return {row};
}

// u_i = sin(a_i . x + phi_i), whose body force follows by hand. Order p elements converge with h^(p+1) in L2 and h^p in
// the H1 seminorm (S. Brenner, R. Scott, The mathematical theory of finite element methods, Springer 2008, ch. 5).

namespace manufactured {

using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};
// row i: a_i
const Eigen::Matrix3d a = (Eigen::Matrix3d() << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6).finished();
const Vec3 phase(0.3, 1.1, -0.4);

Vec3 exact(const Vec3& x)
{
    return (a * x + phase).array().sin();
}

Eigen::Matrix3d exact_gradient(const Vec3& x)
{
    return (a * x + phase).array().cos().matrix().asDiagonal() * a;
}

// f = -(lambda + mu) grad(div u) - mu laplace(u).
Vec3 body_force(const Vec3& x)
{
    const double lambda = 15.0 / 26.0, mu = 5.0 / 13.0;  // E = 1, nu = 0.3, by hand
    const Vec3 sine = exact(x);
    const Vec3 gradient_of_divergence = -a.transpose() * a.diagonal().cwiseProduct(sine);
    const Vec3 laplacian = -a.rowwise().squaredNorm().cwiseProduct(sine);
    return -(lambda + mu) * gradient_of_divergence - mu * laplacian;
}

const std::string order_from =
    "order of interpolation (Brenner and Scott 2008, ch. 5) within 0.1: on jittered meshes the constants of two differ "
    "by "
    "a few percent, some 0.05 in the order";

// Meshes of n, 2n, ... cells a side; the order of the finest two is judged.
VerificationRows error_ladder(const Effort& effort, int element_order, int coarsest, int levels)
{
    VerificationRows rows;
    for (int level = 0; level < levels; ++level) {
        const int n = coarsest << level;
        const BoundaryValueSolution solution =
            solve(jittered_cube(n, 0.25), solver_material(effort, material),
                  {.body_force = body_force, .displacement = exact, .element_order = element_order});
        const int dofs = solution.space->dofs();
        const ErrorNorms error = solution.errors(exact, exact_gradient);
        const ErrorNorms whole = error_norms(*solution.space, Eigen::VectorXd::Zero(dofs), exact, exact_gradient);
        const auto add = [&](const std::string& key, const std::string& norm, double relative_error) {
            rows.push_back(
                row_about({"manufactured_solution", elements_of(element_order), linear_material(material.poisson),
                           text_of({n, n, n}) + " jittered", 1.0 / n, dofs},
                          {key, "error in " + norm + " over that of the solution"}, relative_error, 0.0, "1",
                          "closed form: u_i = sin(a_i . x + phi_i) with the body force that belongs to it"));
        };
        add("error_l2", "L2", error.l2 / whole.l2);
        add("error_h1_seminorm", "the H1 seminorm", error.h1_seminorm / whole.h1_seminorm);
    }
    const auto finest = rows.end() - 2, coarser = finest - 2;
    for (const int norm : {0, 1})
        expect_order(finest[norm], order_between(coarser[norm].value, finest[norm].value), element_order + 1 - norm,
                     order_from);
    return rows;
}

}  // namespace manufactured

VerificationRows manufactured_solution_rows(const Effort& effort)
{
    using namespace manufactured;
    VerificationRows rows = error_ladder(effort, 1, 4, effort.full ? 4 : 3);
    for (const auto& row : error_ladder(effort, 2, 2, effort.full ? 4 : 3)) rows.push_back(row);
    return rows;
}

}  // namespace reference_fem
