// A displacement that is affine in x has a constant stress, needs no body force and lies in both finite element spaces: the solver must
// return it on any mesh, from displacements and from tractions on the boundary (B. Irons, A. Razzaque, 1972).

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

VerificationRow row_of(const Effort& effort, const std::string& data, const BoundaryValueProblem& problem, const VectorField& exact)
{
    const int n = problem.element_order == 1 ? 5 : 3;
    const pbs::TetMesh mesh = jittered_cube(n, 0.45);
    const BoundaryValueSolution solution = solve(mesh, solver_material(effort, material), problem);
    double largest = 0.0;
    for (const auto& point : mesh.rest.rowwise()) largest = std::max(largest, exact(point.transpose()).norm());
    return {.problem = "patch_test",
            .quantity = {"nodal_error_from_" + data, "largest nodal error over largest displacement, from " + data},
            .elements = elements_of(problem.element_order),
            .material = linear_material(material.poisson),
            .mesh = text_of({n, n, n}) + " jittered",
            .h_m = 1.0 / n,
            .dofs = solution.space->dofs(),
            .value = solution.largest_nodal_error(exact) / largest,
            .unit = "1",
            .source = "closed form: an affine displacement is its own finite element solution",
            .low = 0.0,
            .high = rounding_bound(spectrum(solution, material)),
            .bound_from = rounding_bound_text};
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

// A bar along x, held at x = 0 as the closed form moves there, under its own weight w [N/m^3] along x: sigma_xx = w (L - x) and nothing
// else. The displacement is quadratic, so P2 tets return it to rounding (S. Timoshenko, J. Goodier, Theory of elasticity, art. 96).

namespace own_weight {

using pbs::Vec3;

const ElasticMaterial material{1.0e5, 0.3};
constexpr double length_m = 1.0, weight_n_m3 = 9810.0;

Vec3 exact(const Vec3& point)
{
    const double x = point.x(), y = point.y() - 0.5, z = point.z() - 0.5, slope = weight_n_m3 / material.young_pa, nu = material.poisson;
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
    return {{.problem = "own_weight",
             .quantity = {"nodal_error", "largest nodal error over largest displacement"},
             .elements = elements_of(2),
             .material = linear_material(material.poisson),
             .mesh = text_of({n, n, n}) + " jittered",
             .h_m = 1.0 / n,
             .dofs = solution.space->dofs(),
             .value = solution.largest_nodal_error(exact) / exact({length_m, 0.0, 0.0}).norm(),
             .unit = "1",
             .source = "closed form: bar hanging under its own weight (Timoshenko and Goodier, Theory of elasticity, art. 96)",
             .low = 0.0,
             .high = rounding_bound(spectrum(solution, material)),
             .bound_from = rounding_bound_text}};
}

// u_i = sin(a_i . x + phi_i), whose body force follows by hand. Order p elements converge with h^(p+1) in L2 and h^p in the H1 seminorm
// (S. Brenner, R. Scott, The mathematical theory of finite element methods, Springer 2008, ch. 5).

namespace manufactured {

using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};
const Eigen::Matrix3d a = (Eigen::Matrix3d() << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6).finished();  // row i: a_i
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

VerificationRow row_of(const RowQuantity& quantity, int element_order, int n, int dofs, double relative_error)
{
    return {.problem = "manufactured_solution",
            .quantity = quantity,
            .elements = elements_of(element_order),
            .material = linear_material(material.poisson),
            .mesh = text_of({n, n, n}) + " jittered",
            .h_m = 1.0 / n,
            .dofs = dofs,
            .value = relative_error,
            .unit = "1",
            .source = "closed form: u_i = sin(a_i . x + phi_i) with the body force that belongs to it"};
}

void judge_order(VerificationRow& row, const VerificationRow& coarser, double order)
{
    row.observed_order = order_between(coarser.value, row.value);
    row.expected_order = order;
    row.bound_from =
        "order of interpolation (Brenner and Scott 2008, ch. 5) within 0.1: on jittered meshes the constants of two differ by "
        "a few percent, some 0.05 in the order";
}

// Meshes of n, 2n, ... cells a side; the order of the finest two is judged.
VerificationRows ladder(const Effort& effort, int element_order, int coarsest, int levels)
{
    VerificationRows rows;
    for (int level = 0; level < levels; ++level) {
        const int n = coarsest << level;
        const BoundaryValueSolution solution = solve(jittered_cube(n, 0.25), solver_material(effort, material),
                                                     {.body_force = body_force, .displacement = exact, .element_order = element_order});
        const int dofs = solution.space->dofs();
        const ErrorNorms error = solution.errors(exact, exact_gradient);
        const ErrorNorms whole = error_norms(*solution.space, Eigen::VectorXd::Zero(dofs), exact, exact_gradient);
        rows.push_back(row_of({"error_l2", "error in L2 over that of the solution"}, element_order, n, dofs, error.l2 / whole.l2));
        rows.push_back(row_of({"error_h1_seminorm", "error in the H1 seminorm over that of the solution"}, element_order, n, dofs,
                              error.h1_seminorm / whole.h1_seminorm));
    }
    const std::size_t last = rows.size();
    judge_order(rows[last - 2], rows[last - 4], element_order + 1);
    judge_order(rows[last - 1], rows[last - 3], element_order);
    return rows;
}

}  // namespace manufactured

VerificationRows manufactured_solution_rows(const Effort& effort)
{
    using namespace manufactured;
    VerificationRows rows = ladder(effort, 1, 4, effort.full ? 4 : 3);
    for (const auto& row : ladder(effort, 2, 2, effort.full ? 4 : 3)) rows.push_back(row);
    return rows;
}

}  // namespace reference_fem
