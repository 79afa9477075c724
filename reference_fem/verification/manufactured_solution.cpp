// u_i = sin(a_i . x + phi_i), whose body force follows by hand. Order p elements converge with h^(p+1) in L2 and h^p in the H1 seminorm
// (S. Brenner, R. Scott, The mathematical theory of finite element methods, Springer 2008, ch. 5).
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {
namespace {

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

}  // namespace

VerificationRows manufactured_solution_rows(const Effort& effort)
{
    VerificationRows rows = ladder(effort, 1, 4, effort.full ? 4 : 3);
    for (const auto& row : ladder(effort, 2, 2, effort.full ? 4 : 3)) rows.push_back(row);
    return rows;
}

}  // namespace reference_fem
