// Near incompressibility, nu up to 0.49999, in the formulations for it; P1, which locks, is the negative control.
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/linear_flesh.hpp"

#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

namespace {

using namespace reference_fem;
using pbs::Vec3;

const ElasticMaterial material{1.0, 0.4999};

struct Element {
    int order;
    Formulation formulation;
};
const Element taylor_hood{2, Formulation::taylor_hood}, mean_dilatation{2, Formulation::mean_dilatation},
    linear{1, Formulation::displacement};

// Manufactured: u = w + grad(phi) / lambda with w_i = sin(a_i . x + phase_i), a_ii = 0, so that div w = 0, and
// laplace(phi) = p = sin(b . x
// + c). Then lambda div u = p for any lambda, and f = -(1 + mu / lambda) grad p - mu laplace(u).
class KnownPressure {
public:
    double pressure(const Vec3& x) const { return std::sin(b_.dot(x) + 0.2); }
    Vec3 displacement(const Vec3& x) const { return Vec3(angles(x).array().sin()) - pressure_gradient(x) / scale(); }
    Eigen::Matrix3d gradient(const Vec3& x) const
    {
        const Eigen::Matrix3d of_w = Vec3(angles(x).array().cos()).asDiagonal() * a_;
        return of_w + pressure(x) / scale() * b_ * b_.transpose();
    }
    Vec3 body_force(const Vec3& x) const
    {
        const Vec3 laplacian = -a_.rowwise().squaredNorm().cwiseProduct(Vec3(angles(x).array().sin())) +
                               pressure_gradient(x) / lame_.lambda_pa;
        return -(1.0 + lame_.mu_pa / lame_.lambda_pa) * pressure_gradient(x) - lame_.mu_pa * laplacian;
    }

private:
    Vec3 angles(const Vec3& x) const { return a_ * x + Vec3(0.3, 1.1, -0.4); }
    Vec3 pressure_gradient(const Vec3& x) const { return b_ * std::cos(b_.dot(x) + 0.2); }
    double scale() const { return b_.squaredNorm() * lame_.lambda_pa; }

    const Lame lame_ = lame_parameters(material.young_pa, material.poisson);
    const Eigen::Matrix3d a_{{0, 0.9, -1.6}, {-0.8, 0, 1.1}, {1.5, -1.2, 0}};
    const Vec3 b_{1.3, -0.9, 0.7};
};

struct Errors {
    double l2, h1, pressure;
};

Errors errors_on(int cells, const Element& element)
{
    const KnownPressure exact;
    const auto u = [&](const Vec3& x) { return exact.displacement(x); };
    const pbs::TetMesh mesh = test_support::jittered_cube(cells);
    const BoundaryValueSolution solution = solve(mesh, material,
                                                 {.body_force = [&](const Vec3& x) { return exact.body_force(x); },
                                                  .displacement = u,
                                                  .element_order = element.order,
                                                  .formulation = element.formulation});
    const ErrorNorms norms = solution.errors(u, [&](const Vec3& x) { return exact.gradient(x); });
    Eigen::VectorXd defect = solution.pressure_pa;
    for (Eigen::Index v = 0; v < defect.size(); ++v) defect(v) -= exact.pressure(mesh.rest.row(v));
    const double pressure =
        defect.size() == 0 ? 0.0 : std::sqrt(defect.dot(mass_matrix(SimplexSpace(mesh, 1), 1.0) * defect));
    return {norms.l2, norms.h1_seminorm, pressure};
}

// Reference: theory. Taylor-Hood's error is that of the best approximation of u by P2 and of p by P1, for any lambda:
// order 3 in L2, 2 in H1 and in the pressure (D. Boffi, F. Brezzi, M. Fortin, Mixed finite element methods and
// applications, Springer 2013, section 8.8; D. Boffi, SIAM J. Numer. Anal. 34, 1997). Tolerance: on jittered meshes the
// constants of two meshes differ by a few percent, 0.05 in the order. The error of the pressure is measured against its
// interpolation, whose own error has that order too.
TEST(NearIncompressible, TaylorHoodKeepsItsOrders)
{
    const Errors coarse = errors_on(4, taylor_hood), fine = errors_on(8, taylor_hood);
    EXPECT_NEAR(order_between(coarse.l2, fine.l2), 3.0, 0.1);
    EXPECT_NEAR(order_between(coarse.h1, fine.h1), 2.0, 0.1);
    EXPECT_NEAR(order_between(coarse.pressure, fine.pressure), 2.0, 0.1);
}

// Reference: theory, as above: constant pressures approximate with order 1, so H1 has order 1 and L2 order 2. The
// meshes are coarse for these orders: with an error C h^p (1 + c h + ...) an observed order is p - c' h, so two of
// them, on meshes twice as fine, extrapolate to p + O(h^2).
TEST(NearIncompressible, MeanDilatationOfQuadraticTetsHasOrdersTwoAndOne)
{
    const Errors errors[] = {errors_on(2, mean_dilatation), errors_on(4, mean_dilatation),
                             errors_on(8, mean_dilatation)};
    const double l2[] = {order_between(errors[0].l2, errors[1].l2), order_between(errors[1].l2, errors[2].l2)};
    const double h1[] = {order_between(errors[0].h1, errors[1].h1), order_between(errors[1].h1, errors[2].h1)};
    EXPECT_NEAR(2.0 * l2[1] - l2[0], 2.0, 0.1);
    EXPECT_NEAR(2.0 * h1[1] - h1[0], 1.0, 0.1);
}

// Reference: theory, as in the patch test: an affine displacement and its constant pressure are in the spaces.
// Tolerance: rounding of a direct solve, sqrt(n) eps cond(K).
TEST(NearIncompressible, TaylorHoodPassesThePatchTest)
{
    const Lame lame = lame_parameters(material.young_pa, material.poisson);
    const Eigen::Matrix3d gradient{{0.02, -0.03, 0.04}, {0.06, 0.02, 0.02}, {-0.02, 0.05, -0.04 + 1e-5}};
    const double pressure_pa = 1e-5 * lame.lambda_pa;
    const auto affine = [&](const Vec3& x) -> Vec3 { return gradient * x; };
    const pbs::TetMesh mesh = test_support::jittered_cube(3, 0.45);
    const BoundaryValueSolution solution =
        solve(mesh, material, {.displacement = affine, .formulation = Formulation::taylor_hood});

    const LinearFlesh flesh(*solution.space, lame, Formulation::taylor_hood);
    const std::vector<bool> prescribed = flesh.prescribed(solution.held);
    std::vector<int> free;
    for (int i = 0; i < flesh.unknowns(); ++i)
        if (!prescribed[i]) free.push_back(i);
    const double bound = rounding_bound(spectrum(solution, material));
    ASSERT_LT(bound, 1e-9) << "a bound that would let an error of a percent pass proves nothing";

    Eigen::VectorXd exact = flesh.on_unknowns(test_support::at_nodes(*solution.space, affine));
    exact.tail(flesh.pressures()).setConstant(pressure_pa / flesh.pressure_unit_pa());
    Eigen::VectorXd ours = flesh.on_unknowns(solution.displacement);
    ours.tail(flesh.pressures()) = solution.pressure_pa / flesh.pressure_unit_pa();
    EXPECT_LT((ours - exact)(free).norm(), bound * exact(free).norm());
}

// Mean deflection of the loaded face of the cantilever, 10 x 1 x 1 m, of the verification problem of that name, with
// its bounds.
VerificationRow cantilever(const Element& element, double nu, int cells)
{
    return cantilever_row({}, nu, element.order, element.formulation, {8 * cells, cells, cells});
}

TEST(NearIncompressible, TheCantileverBendsLikeTheBeamAtEveryPoissonRatio)
{
    for (const auto& [element, cells] : {std::pair(taylor_hood, 3), std::pair(mean_dilatation, 4)})
        for (const double nu : {0.3, 0.4999}) {
            const VerificationRow row = cantilever(element, nu, cells);
            EXPECT_TRUE(holds(row).value_or(false)) << row.value << " in " << *row.low << " to " << *row.high;
        }
}

// The negative control: a constraint on the volume of every tet leaves P1 almost no freedom to bend.
TEST(NearIncompressible, LinearTetsLock)
{
    const VerificationRow bends = cantilever(linear, 0.3, 3), locks = cantilever(linear, 0.4999, 3);
    EXPECT_GT(bends.value, 0.5 * bends.reference);
    EXPECT_LT(locks.value, 0.1 * locks.reference);
}

// Reference: theory. The solution is analytic in 1/2 - nu and its limit is the incompressible one, so its distance from
// the limit falls proportionally: (u(0.4999) - u(0.49999)) / (u(0.49999) - u(0.499999)) = 10 (1 + O(1e-4)). A matrix
// whose condition number grew with lambda, as that of mean dilatation does, would lose these differences, a millionth
// of u, to rounding.
TEST(NearIncompressible, TaylorHoodReachesTheIncompressibleLimitInProportion)
{
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = cantilever(taylor_hood, 0.5 - 1e-4 * std::pow(0.1, k), 2).value;
    EXPECT_NEAR((at[0] - at[1]) / (at[1] - at[2]), 10.0, 0.05);
}

// Reference: closed form. A bar on rollers under tension t is stretched uniformly: stress diag(t, 0, 0), so p = lambda
// t (1 - 2 nu) / E. Tolerance: rounding of a direct solve, in displacements, in the stress at a vertex and in the
// energy.
TEST(BarUnderTension, IsExactInEveryForm)
{
    const double tension_pa = 1.0e3;
    const pbs::TetMesh cube = test_support::jittered_cube(3);
    const Element quadratic{2, Formulation::displacement};
    for (const auto& [element, poisson] : {std::pair(linear, 0.3),
                                           {quadratic, 0.3},
                                           {taylor_hood, 0.4999},
                                           {mean_dilatation, 0.4999},
                                           {linear, 0.4999}}) {
        const ElasticMaterial material{2.0e5, poisson};
        const double strain = tension_pa / material.young_pa, energy_j = tension_pa * strain / 2.0;
        const auto exact = [&](const Vec3& x) -> Vec3 {
            return strain * x.cwiseProduct(Vec3(1.0, -material.poisson, -material.poisson));
        };
        const BoundaryValueSolution solution =
            solve(cube, material,
                  {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
                   .element_order = element.order,
                   .tractions = {{[](const Vec3& centre) { return centre.x() > 1.0 - 1e-9; },
                                  [&](const Vec3&, const Vec3& normal) -> Vec3 { return tension_pa * normal; }}},
                   .formulation = element.formulation});
        const test_support::SolveRounding rounding = test_support::rounding_of(solution, material);
        const double stress_bound_pa = rounding.stress_pa(lame_parameters(material.young_pa, material.poisson), cube);
        EXPECT_LT(rounding.relative(), poisson == 0.3 ? 1e-9 : 1.0)
            << "a bound that would let an error of a percent pass proves nothing";
        EXPECT_LT(stress_bound_pa, 1e-3 * tension_pa)
            << "a bound that would let an error of a percent pass proves nothing";
        EXPECT_LT(test_support::relative_error(solution, exact) * solution.displacement.norm(), rounding.error_m());
        EXPECT_LT((solution.displacement_at({1, 1, 1}) - exact({1, 1, 1})).norm(), rounding.error_m());
        for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0.33, 0.33, 0.66)})
            EXPECT_LT(
                (solution.stress_at(point, material) - Eigen::Matrix3d(Vec3(tension_pa, 0, 0).asDiagonal())).norm(),
                stress_bound_pa);
        EXPECT_NEAR(solution.work_of_load_j(), tension_pa * strain, rounding.error_m() * solution.load.norm());
        EXPECT_NEAR(solution.strain_energy_j(material), energy_j, rounding.energy_j(energy_j));
    }
}

}  // namespace
