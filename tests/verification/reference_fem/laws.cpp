// Reference: theory that every hyperelastic law obeys. Stress is the derivative of the energy and the tangent that of the stress (central
// differences with an error of O(eps^2)). The tangent is symmetric. A rotation of the body after the deformation changes nothing, nor, for
// an isotropic law, one before it. For small strain all laws agree with linear elasticity to second order of the energy, so they differ by
// third order.
#include "tests/support/eps_sweep.hpp"
#include "tests/support/law_points.hpp"

#include <Eigen/LU>

namespace {

using namespace test_support;
using reference_fem::Lame;
using reference_fem::Tangent;

using Vector9 = Eigen::Matrix<double, 9, 1>;

const Lame lame{.lambda_pa = 7e4, .mu_pa = 4e4};
const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();

Eigen::Matrix3d unstacked(const Eigen::VectorXd& x)
{
    return Eigen::Map<const Eigen::Matrix3d>(x.data());
}

Vector9 stacked(const Eigen::Matrix3d& matrix)
{
    return Eigen::Map<const Vector9>(matrix.data());
}

// A hundred roundings of the largest term of a law, which is of degree six in F.
double rounding(const Eigen::Matrix3d& f)
{
    return 100.0 * std::numeric_limits<double>::epsilon() * (lame.lambda_pa + lame.mu_pa) * std::pow(1.0 + f.squaredNorm(), 3);
}

// Large rotations and stretches, and inversions if the law is defined for them.
std::vector<Eigen::Matrix3d> states(const NamedModel& model)
{
    RandomPoints random(7);
    std::vector<Eigen::Matrix3d> all;
    for (int i = 0; i < 5; ++i) all.push_back(random_stretch(random));
    for (int i = 0; i < 5 && model.through_inversion; ++i) all.push_back(random_inversion(random));
    return all;
}

class NonlinearLaw : public testing::TestWithParam<NamedModel> {};

// With lambda = 0 the sweep tests only the shape. Together with lambda it tests the dilatation, of which elements may take the mean.
TEST_P(NonlinearLaw, StressIsTheDerivativeOfTheEnergy)
{
    const auto law = constitutive_law(GetParam().model, lame);
    RandomPoints random(8);
    for (const double lambda : {0.0, law->lambda_pa()})
        for (const Eigen::Matrix3d& f : states(GetParam())) {
            const Eigen::Matrix3d direction = random_matrix(random, 1.0);
            const Eigen::Matrix3d stress = first_piola_kirchhoff(law->evaluate(f, Derivatives::first), lambda);
            expect_slope_by_eps_sweep(
                [&](const Eigen::VectorXd& x) { return energy_density(law->evaluate(unstacked(x), Derivatives::none), lambda); },
                stacked(f), stacked(direction), stress.cwiseProduct(direction).sum(), 0.1);
        }
}

TEST_P(NonlinearLaw, TangentIsTheDerivativeOfTheStress)
{
    const auto law = constitutive_law(GetParam().model, lame);
    RandomPoints random(9);
    for (const double lambda : {0.0, law->lambda_pa()})
        for (const Eigen::Matrix3d& f : states(GetParam())) {
            const Vector9 direction = stacked(random_matrix(random, 1.0)), component = stacked(random_matrix(random, 1.0));
            const auto stress_component = [&](const Eigen::VectorXd& x) {
                return component.dot(stacked(first_piola_kirchhoff(law->evaluate(unstacked(x), Derivatives::first), lambda)));
            };
            const double slope = component.dot(reference_fem::tangent(law->evaluate(f, Derivatives::second), lambda) * direction);
            expect_slope_by_eps_sweep(stress_component, stacked(f), direction, slope, 0.1);
        }
}

// For a quadratic energy, differences are exact for any step.
TEST(LinearLaw, DifferencesAreExactAtAnyStep)
{
    const LawPoint linear(Model::linear, lame);
    RandomPoints random(10);
    for (const double step : {1e-3, 1.0, 1e3}) {
        const Eigen::Matrix3d f = random_stretch(random), d = step * random_matrix(random, 1.0);
        const double tolerance = rounding(identity) * step * (1.0 + step);
        EXPECT_NEAR(linear.energy(f + d) - linear.energy(f - d), 2.0 * linear.stress(f).cwiseProduct(d).sum(), tolerance);
        EXPECT_LE((stacked(linear.stress(f + d) - linear.stress(f)) - linear.tangent(f) * stacked(d)).norm(),
                  rounding(identity) * (1.0 + step));
    }
}

TEST_P(EveryLaw, TangentIsSymmetric)
{
    for (const Eigen::Matrix3d& f : states(GetParam())) {
        const Tangent tangent = LawPoint(GetParam().model, lame).tangent(f);
        EXPECT_LE((tangent - tangent.transpose()).norm(), rounding(f));
    }
}

// psi(Q F) = psi(F), P(Q F) = Q P(F), and the tangent rotates with both.
TEST_P(NonlinearLaw, IsIndifferentToTheFrame)
{
    const LawPoint point(GetParam().model, lame);
    RandomPoints random(11);
    for (const Eigen::Matrix3d& f : states(GetParam())) {
        const Eigen::Matrix3d q = random_rotation(random), d = random_matrix(random, 1.0);
        EXPECT_NEAR(point.energy(q * f), point.energy(f), rounding(f));
        EXPECT_LE((point.stress(q * f) - q * point.stress(f)).norm(), rounding(f));
        const Vector9 expected = stacked(q * unstacked(point.tangent(f) * stacked(d)));
        EXPECT_LE((point.tangent(q * f) * stacked(q * d) - expected).norm(), rounding(f));
    }
}

// psi(F Q) = psi(F), P(F Q) = P(F) Q.
TEST_P(NonlinearLaw, IsIsotropic)
{
    const LawPoint point(GetParam().model, lame);
    RandomPoints random(12);
    for (const Eigen::Matrix3d& f : states(GetParam())) {
        const Eigen::Matrix3d q = random_rotation(random);
        EXPECT_NEAR(point.energy(f * q), point.energy(f), rounding(f));
        EXPECT_LE((point.stress(f * q) - point.stress(f) * q).norm(), rounding(f));
    }
}

// The negative control. Linear elasticity is isotropic only under a rotation of body and frame together. It interprets a rotation by a as
// the strain diag(cos a - 1, cos a - 1, 0), with the energy 2 (lambda + mu) (1 - cos a)^2.
TEST(LinearLaw, IsIsotropicButNotIndifferentToTheFrame)
{
    const LawPoint linear(Model::linear, lame);
    RandomPoints random(13);
    const Eigen::Matrix3d f = random_stretch(random), q = random_rotation(random);
    EXPECT_NEAR(linear.energy(q * f * q.transpose()), linear.energy(f), rounding(f));
    for (const double angle : {0.1, 1.0, 3.0}) {
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, random.point(1.0).normalized()).toRotationMatrix();
        const double fictitious = 2.0 * (lame.lambda_pa + lame.mu_pa) * std::pow(1.0 - std::cos(angle), 2);
        EXPECT_NEAR(linear.energy(turn), fictitious, rounding(identity));
        EXPECT_GT(fictitious, 10.0 * rounding(identity));
    }
}

TEST_P(NonlinearLaw, TangentAtRestIsLinearElasticitys)
{
    const Tangent difference = LawPoint(GetParam().model, lame).tangent(identity) - LawPoint(Model::linear, lame).tangent(identity);
    EXPECT_LE(difference.norm(), rounding(identity));
}

// psi(I + eps G) - psi_linear(I + eps G) = O(eps^3). At eps = 1e-5 the energy is 1e-10 of the moduli and the difference 1e-15. It is still
// visible, since the laws sum small terms, whose error is the rounding relative to themselves plus the rounding of 1 + eps, 1e-16 eps.
TEST_P(NonlinearLaw, LeavesLinearElasticityAtThirdOrder)
{
    const LawPoint point(GetParam().model, lame), linear(Model::linear, lame);
    RandomPoints random(14);
    for (int i = 0; i < 3; ++i) {
        const Eigen::Matrix3d g = random_matrix(random, 1.0);
        const auto difference = [&](double eps) {
            const Eigen::Matrix3d f = identity + eps * g;
            return std::abs(point.energy(f) - linear.energy(f));
        };
        for (const double eps : {1e-2, 1e-3, 1e-4}) EXPECT_NEAR(std::log10(difference(eps) / difference(eps / 10.0)), 3.0, 0.1) << eps;
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, NonlinearLaw, testing::ValuesIn(nonlinear_models), name_of_model);
INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, testing::ValuesIn(all_models()), name_of_model);

}  // namespace
