// Reference: a manufactured solution u_i = A sin(a_i . x + phi_i) of stable neo-Hookean flesh that is held by springs of the density k of a
// smooth attachment. The springs' targets lie a given offset c from the exact positions, so that the body force is f = -div P - k(x) c.
// Order p elements converge with h^(p+1) (Brenner and Scott, ch. 5) down to the error of the sample points, which grows with c: a small c
// serves the orders, and a large one shows whether the springs have the weight that the body force assumes. The tets are cut into eight
// as those of a reference are: the order that its four solutions show must be that of linear elements, and its bound must hold.
#include "analysis/nested_convergence.hpp"
#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/refinement.hpp"
#include "pbs/geometry/topology.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/dead_load.hpp"
#include "reference_fem/potentials/elastic_potential.hpp"
#include "reference_fem/potentials/spring_potential.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const double young_pa = 1.0, poisson = 0.3, spring_factor = 100.0;
const pbs::BoneCapsule capsule{{0.1, 0.5, 0.5}, {0.9, 0.5, 0.5}, 0.35, ""};
const Vec3 phase(0.3, 1.1, -0.4), small_offset(2e-6, -1e-6, 3e-6);
const double amplitude = 0.1;

Eigen::Matrix3d waves()
{
    Eigen::Matrix3d a;
    a << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6;
    return a;
}
const Eigen::Matrix3d wave_vectors = waves();  // row i: a_i

Vec3 exact(const Vec3& x)
{
    return amplitude * (wave_vectors * x + phase).array().sin();
}

Eigen::Matrix3d exact_gradient(const Vec3& x)
{
    return amplitude * (wave_vectors * x + phase).array().cos().matrix().asDiagonal() * wave_vectors;
}

double density(const Vec3& x)
{
    return spring_factor * young_pa / (capsule.radius_m * capsule.radius_m) *
           pbs::smooth_density(capsule, pbs::AttachmentKernel::biweight, 1.0, x);
}

// -div P - k c, where (div P)_i = sum_jkl dP_ij / dF_kl u_k,lj and u_k,lj = -A sin(a_k . x + phi_k) a_kl a_kj.
Vec3 body_force(const Vec3& x, const Vec3& offset)
{
    static const auto law = constitutive_law(Model::stable_neo_hookean, lame_parameters(young_pa, poisson));
    const Tangent slope = tangent(law->evaluate(Eigen::Matrix3d::Identity() + exact_gradient(x), Derivatives::second), law->lambda_pa());
    const Vec3 minus_sine = -exact(x);
    Vec3 divergence = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                    divergence(i) += slope(3 * j + i, 3 * l + k) * minus_sine(k) * wave_vectors(k, l) * wave_vectors(k, j);
    return -divergence - density(x) * offset;
}

struct Springs {
    Positions points, targets;
    Eigen::VectorXd stiffness;
};

Springs springs_of_bone(const Vec3& offset, double weight)
{
    constexpr int samples = 3;  // their error is a ninth of the default's
    Springs springs{pbs::sample_points(capsule, samples), {}, {}};
    springs.targets = springs.points;
    springs.stiffness.resize(springs.points.rows());
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const Vec3 point = springs.points.row(s);
        springs.targets.row(s) = (point + exact(point) + offset).transpose();
        springs.stiffness(s) = weight * density(point) * capsule.volume_m3() / static_cast<double>(springs.points.rows());
    }
    return springs;
}

struct Solution {
    Positions positions;  // vertices [m]
    double error = 0.0;   // in L2 over that of the exact displacement
};

// weight: of the springs, which is 1 where they are those of the body force.
Solution solve(const pbs::TetMesh& mesh, int element_order, const Vec3& offset = small_offset, double weight = 1.0)
{
    const Springs springs = springs_of_bone(offset, weight);
    const SimplexSpace space(mesh, element_order);
    const ElasticPotential flesh(space, Model::stable_neo_hookean, lame_parameters(young_pa, poisson), Formulation::displacement);
    const AttachedPoints points(mesh, space, springs.points, springs.stiffness);
    SpringPotential held(points);
    held.move_to(springs.targets);
    const DeadLoad load(load_vector(space, [&](const Vec3& x) { return body_force(x, offset); }));

    Eigen::VectorXd values(space.dofs());
    std::vector<bool> prescribed(space.dofs(), false);
    for (int node = 0; node < space.nodes(); ++node) {
        const Vec3 at = space.node_positions().row(node);
        values.segment<3>(3 * node) = exact(at);
        const bool on_surface = at.minCoeff() < 1e-12 || at.maxCoeff() > 1.0 - 1e-12;
        for (int c = 0; c < 3; ++c) prescribed[3 * node + c] = on_surface;
    }
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    NewtonMinimiser newton(space, prescribed, LinearSolver::cholmod);
    EXPECT_TRUE(newton.minimise({&flesh, &held, &load}, values, displacement, {}).converged());

    const double error = error_norms(space, displacement, exact, exact_gradient).l2;
    const double whole = error_norms(space, Eigen::VectorXd::Zero(space.dofs()), exact, exact_gradient).l2;
    return {mesh.rest + Eigen::Map<const Positions>(displacement.data(), mesh.rest.rows(), 3), error / whole};
}

double rms(const Positions& one, const Positions& other)
{
    return (one - other).norm() / std::sqrt(static_cast<double>(one.rows()));
}

// Errors C h^p (1 + c h) show an order that differs from p by c h / (2 ln 2), half as much on meshes twice as fine. The order of the finest
// two is therefore within 0.1 (jittered meshes: their constants differ by a few per cent) or closer than that of the coarser two by
// nearly a half.
void expect_order(int element_order, int coarsest)
{
    const double order = element_order + 1;
    pbs::TetMesh mesh = test_support::jittered_cube(coarsest);
    std::vector<double> errors;
    for (int level = 0; level < 3; ++level) {
        errors.insert(errors.begin(), solve(mesh, element_order).error);
        mesh = pbs::refine(mesh).mesh;
    }
    const double coarser = std::abs(std::log2(errors[2] / errors[1]) - order), finer = std::abs(std::log2(errors[1] / errors[0]) - order);
    testing::Test::RecordProperty("order_differs_by", std::to_string(finer));
    EXPECT_LT(finer, std::max(0.1, 0.6 * coarser));
}

// The four solutions of a reference. The error of the finest, which stands for the limit, changes the two distances of the linear ones by
// at most itself.
TEST(ManufacturedAttachment, NestedSolutionsShowTheOrderAndBoundTheError)
{
    const pbs::TetMesh mesh = test_support::jittered_cube(4), fine = pbs::refine(mesh).mesh;
    const Eigen::Index common = mesh.rest.rows();
    const auto solved = [&](const pbs::TetMesh& on, int element_order) -> Positions {
        return solve(on, element_order).positions.topRows(common);
    };
    const Positions finest = solved(fine, 2), quadratic = solved(mesh, 2), linear_refined = solved(fine, 1), linear = solved(mesh, 1);
    Positions exact_positions = mesh.rest;
    for (Eigen::Index v = 0; v < common; ++v) exact_positions.row(v) += exact(mesh.rest.row(v)).transpose();

    const auto order = analysis::nested_order({rms(linear, finest), rms(linear_refined, finest), rms(quadratic, finest)}, 2.0);
    const double true_order = std::log2(rms(linear, exact_positions) / rms(linear_refined, exact_positions)),
                 error = rms(finest, exact_positions);
    const double uncertainty =
        std::log2((1.0 + error / rms(linear, exact_positions)) / (1.0 - error / rms(linear_refined, exact_positions)));
    EXPECT_NEAR(order.observed, true_order, uncertainty);
    EXPECT_TRUE(order.reliable);
    EXPECT_LT(error, order.bound(rms(quadratic, finest)));
    EXPECT_LT(order.bound(rms(quadratic, finest)), rms(linear_refined, exact_positions));  // the bound is not met by being large
    EXPECT_LT(rms(analysis::extrapolated(finest, quadratic, order.order + 1.0), exact_positions), error);
    testing::Test::RecordProperty("observed_order", std::to_string(order.observed));
}

TEST(ManufacturedAttachment, LinearTetsConvergeWithOrderTwo)
{
    expect_order(1, 4);
}

TEST(ManufacturedAttachment, QuadraticTetsConvergeWithOrderThree)
{
    expect_order(2, 2);
}

// Springs of twice or half the weight pull with another force than the body force balances. Where they are stiff, the flesh then moves by
// the offset times 1 / 2 or 1; right ones leave only the error of the elements and of the sample points.
TEST(ManufacturedAttachment, SpringsOfAnotherWeightLeaveAnotherForce)
{
    const Vec3 large_offset(0.02, -0.01, 0.03);
    const pbs::TetMesh mesh = test_support::jittered_cube(8);
    const double right = solve(mesh, 1, large_offset).error;
    for (const double weight : {0.5, 2.0}) EXPECT_GT(solve(mesh, 1, large_offset, weight).error, 3.0 * right) << weight;
}

}  // namespace
