// Reference: theory that every hyperelastic law obeys. Stress is the derivative of the energy and the tangent that of
// the stress (central differences with an error of O(eps^2)). The tangent is symmetric. A rotation of the body after
// the deformation changes nothing, nor, for an isotropic law, one before it. For small strain all laws agree with
// linear elasticity to second order of the energy, so they differ by third order.
#include "tests/support/eps_sweep.hpp"
#include "tests/support/law_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>

#include <functional>
#include <map>

namespace {

using namespace test_support;
using reference_fem::Lame;
using reference_fem::Tangent;
using reference_fem::vec;

const Lame lame{.lambda_pa = 7e4, .mu_pa = 4e4};
const double lambda = lame.lambda_pa, mu = lame.mu_pa, kappa = lambda + 2.0 / 3.0 * mu;
const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();

Eigen::Matrix3d matrix_of(const Eigen::VectorXd& x)
{
    return Eigen::Map<const Eigen::Matrix3d>(x.data());
}

// A hundred roundings of the largest term of a law, which is of degree six in F.
double rounding(const Eigen::Matrix3d& f)
{
    return 100.0 * std::numeric_limits<double>::epsilon() * (lame.lambda_pa + lame.mu_pa) *
           std::pow(1.0 + f.squaredNorm(), 3);
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

class EveryLaw : public testing::TestWithParam<NamedModel> {};
class NonlinearLaw : public testing::TestWithParam<NamedModel> {};

// With lambda = 0 the sweep tests only the shape. Together with lambda it tests the dilatation, of which elements may
// take the mean.
TEST_P(NonlinearLaw, StressIsTheDerivativeOfTheEnergyAndTangentThatOfTheStress)
{
    const auto law = constitutive_law(GetParam().model, lame);
    RandomPoints random(8);
    for (const double lambda_pa : {0.0, law->lambda_pa()})
        for (const Eigen::Matrix3d& f : states(GetParam())) {
            const reference_fem::Vector9 direction = vec(random_matrix(random, 1.0)),
                                         component = vec(random_matrix(random, 1.0));
            const auto energy = [&](const Eigen::VectorXd& x) {
                return energy_density(law->evaluate(matrix_of(x), Derivatives::none), lambda_pa);
            };
            const auto stress = [&](const Eigen::VectorXd& x) {
                return component.dot(
                    vec(first_piola_kirchhoff(law->evaluate(matrix_of(x), Derivatives::first), lambda_pa)));
            };
            const auto response = law->evaluate(f, Derivatives::second);
            expect_slope_by_eps_sweep(energy, vec(f), direction,
                                      vec(first_piola_kirchhoff(response, lambda_pa)).dot(direction), 0.1);
            expect_slope_by_eps_sweep(stress, vec(f), direction,
                                      component.dot(reference_fem::tangent(response, lambda_pa) * direction), 0.1);
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
        EXPECT_NEAR(linear.energy(f + d) - linear.energy(f - d), 2.0 * linear.stress(f).cwiseProduct(d).sum(),
                    tolerance);
        EXPECT_LE((vec(linear.stress(f + d) - linear.stress(f)) - linear.tangent(f) * vec(d)).norm(),
                  rounding(identity) * (1.0 + step));
    }
}

TEST_P(EveryLaw, TangentIsSymmetricAndAtRestLinearElasticitys)
{
    const LawPoint point(GetParam().model, lame);
    for (const Eigen::Matrix3d& f : states(GetParam()))
        EXPECT_LE((point.tangent(f) - point.tangent(f).transpose()).norm(), rounding(f));
    EXPECT_LE((point.tangent(identity) - LawPoint(Model::linear, lame).tangent(identity)).norm(), rounding(identity));
}

// psi(Q F) = psi(F), P(Q F) = Q P(F), and the tangent rotates with both; psi(F Q) = psi(F), P(F Q) = P(F) Q.
TEST_P(NonlinearLaw, IsIndifferentToTheFrameAndIsotropic)
{
    const LawPoint point(GetParam().model, lame);
    RandomPoints random(11);
    for (const Eigen::Matrix3d& f : states(GetParam())) {
        const Eigen::Matrix3d q = random_rotation(random), d = random_matrix(random, 1.0);
        EXPECT_NEAR(point.energy(q * f), point.energy(f), rounding(f));
        EXPECT_LE((point.stress(q * f) - q * point.stress(f)).norm(), rounding(f));
        const reference_fem::Vector9 expected = vec(q * matrix_of(point.tangent(f) * vec(d)));
        EXPECT_LE((point.tangent(q * f) * vec(q * d) - expected).norm(), rounding(f));
        EXPECT_NEAR(point.energy(f * q), point.energy(f), rounding(f));
        EXPECT_LE((point.stress(f * q) - point.stress(f) * q).norm(), rounding(f));
    }
}

// The negative control. Linear elasticity is isotropic only under a rotation of body and frame together. It interprets
// a rotation by a as the strain diag(cos a - 1, cos a - 1, 0), with the energy 2 (lambda + mu) (1 - cos a)^2.
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

// psi(I + eps G) - psi_linear(I + eps G) = O(eps^3). At eps = 1e-5 the energy is 1e-10 of the moduli and the difference
// 1e-15. It is still visible, since the laws sum small terms, whose error is the rounding relative to themselves plus
// the rounding of 1 + eps, 1e-16 eps.
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
        for (const double eps : {1e-2, 1e-3, 1e-4})
            EXPECT_NEAR(std::log10(difference(eps) / difference(eps / 10.0)), 3.0, 0.1) << eps;
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, NonlinearLaw, testing::ValuesIn(nonlinear_models), name_of_model);
INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, testing::ValuesIn(all_models), name_of_model);

// Reference: textbook stresses of each law, derived by hand from its energy in principal stretches or in shear, by
// formulas that no source file contains. J. Bonet, R. Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
// chapter 6; R. Ogden, Non-Linear Elastic Deformations. A stress and its closed form go through at most a hundred
// roundings by eps / 2 (the invariants and cofactors of F, the sweeps of a Jacobi SVD) of terms no larger than (lambda
// + 2 mu) s^5, s the largest stretch or 1: the term J dJ/dF of a stress is of degree five in F. The Frobenius norm of
// nine such errors is three times as large.
double tolerance(double largest_stretch)
{
    const double largest_term = (lambda + 2.0 * mu) * std::pow(std::max(largest_stretch, 1.0), 5);
    return 3.0 * 100.0 * std::numeric_limits<double>::epsilon() / 2.0 * largest_term;
}

// F = s I: P = p I. At s = 1e6 and 1e-5 the terms of p differ by up to 30 digits. There each of the three entries goes
// through at most a hundred roundings, of which 2/3 ln J, below 30, are those that J^(-2/3) amplifies. For lambda = 2
// mu the magnitudes of the terms add up to at most 2.5 p, where the parts of the isochoric law cancel: (kappa / 2 + 2
// mu) / s = 3.3 / s for p = 1.3 / s.
TEST_P(EveryLaw, UniformDilation)
{
    const Lame twice{.lambda_pa = 2.0, .mu_pa = 1.0};
    const auto hooke = [](double s, const Lame& l) { return (2.0 * l.mu_pa + 3.0 * l.lambda_pa) * (s - 1.0); };
    const std::map<Model, std::function<double(double, const Lame&)>> pressure = {
        {Model::linear, hooke},
        {Model::corotational, hooke},
        {Model::stable_neo_hookean,
         [](double s, const Lame& l) {
             return l.mu_pa * (s - s * s) + (l.lambda_pa + l.mu_pa) * (s * s * s - 1.0) * s * s;
         }},
        {Model::neo_hookean,
         [](double s, const Lame& l) { return l.mu_pa * (s - 1.0 / s) + 3.0 * l.lambda_pa * std::log(s) / s; }},
        {Model::st_venant_kirchhoff, [hooke](double s, const Lame& l) { return hooke(s, l) * s * (s + 1.0) / 2.0; }},
        {Model::isochoric_neo_hookean, [](double s, const Lame& l) {
             return 0.5 * (l.lambda_pa + 2.0 / 3.0 * l.mu_pa) * (std::pow(s, 5) - 1.0 / s);
         }}};
    for (const double s : {1e-5, 0.6, 1.0, 1.5, 1e6}) {
        const bool extreme = s < 0.5 || s > 2.0;
        const LawPoint point(GetParam().model, extreme ? twice : lame);
        const double expected = pressure.at(GetParam().model)(s, extreme ? twice : lame);
        const Eigen::Matrix3d f = s * identity;
        EXPECT_LE((point.stress(f) - expected * identity).norm(),
                  extreme ? std::sqrt(3.0) * rounding_error(100, 2.5 * std::abs(expected)) : tolerance(s))
            << s;
        EXPECT_TRUE(all_finite(point.law->evaluate(f, Derivatives::second))) << s;
    }
}

// F = diag(s, 1, 1): P = diag(along, across, across).
TEST_P(EveryLaw, UniaxialStrain)
{
    using Pair = std::pair<double, double>;
    const auto hooke = [](double s) { return Pair((lambda + 2.0 * mu) * (s - 1.0), lambda * (s - 1.0)); };
    const std::map<Model, std::function<Pair(double)>> along_across = {
        {Model::linear, hooke},
        {Model::corotational, hooke},
        {Model::stable_neo_hookean,  // along: the same straight line as Hooke's law
         [](double s) {
             return Pair((lambda + 2.0 * mu) * (s - 1.0), mu * (s - 1.0) * (s - 1.0) + lambda * s * (s - 1.0));
         }},
        {Model::neo_hookean,
         [](double s) { return Pair(mu * (s - 1.0 / s) + lambda * std::log(s) / s, lambda * std::log(s)); }},
        {Model::st_venant_kirchhoff,
         [](double s) { return Pair((0.5 * lambda + mu) * s * (s * s - 1.0), 0.5 * lambda * (s * s - 1.0)); }},
        {Model::isochoric_neo_hookean, [](double s) {
             const double deviator = mu * std::pow(s, -2.0 / 3.0) * (s * s - 1.0) / 3.0;
             return Pair(0.5 * kappa * (s - 1.0 / s) + 2.0 * deviator / s, 0.5 * kappa * (s * s - 1.0) - deviator);
         }}};
    for (const double s : {0.6, 1.0, 1.5}) {
        const auto [along, across] = along_across.at(GetParam().model)(s);
        const Eigen::Matrix3d stress = LawPoint(GetParam().model, lame).stress(diagonal(s, 1.0, 1.0));
        EXPECT_LE((stress - diagonal(along, across, across)).norm(), tolerance(s)) << s;
    }
}

// F = I + g e1 e2^T.
Eigen::Matrix3d shear_stress(Model model, double g)
{
    Eigen::Matrix3d p = Eigen::Matrix3d::Zero();
    p(0, 1) = p(1, 0) = mu * g;  // the neo-Hookean laws agree, since the volume does not change
    if (model == Model::st_venant_kirchhoff) {
        const double normal = 0.5 * lambda * g * g;  // S = lambda tr E I + 2 mu E, P = F S
        p(0, 0) = normal + mu * g * g;
        p(0, 1) += g * (normal + mu * g * g);
        p(1, 1) = normal + mu * g * g;
        p(2, 2) = normal;
    } else if (model == Model::isochoric_neo_hookean) {
        p.diagonal().setConstant(-mu * g * g / 3.0);
        p(1, 0) += mu * g * g * g / 3.0;
    } else if (model == Model::corotational) {  // R rotates by atan(g / 2), tr S = 1 + sqrt(4 + g^2)
        const double root = std::sqrt(4.0 + g * g), cosine = 2.0 / root, sine = g / root,
                     pressure = lambda * (root - 2.0);
        p << 2.0 * mu * (1.0 - cosine) + pressure * cosine, 2.0 * mu * (g - sine) + pressure * sine, 0.0,  //
            (2.0 * mu - pressure) * sine, 2.0 * mu * (1.0 - cosine) + pressure * cosine, 0.0,              //
            0.0, 0.0, pressure;
    }
    return p;
}

TEST_P(EveryLaw, SimpleShear)
{
    for (const double g : {-0.5, 0.1, 1.5}) {
        Eigen::Matrix3d f = identity;
        f(0, 1) = g;
        const Eigen::Matrix3d stress = LawPoint(GetParam().model, lame).stress(f);
        const double stretch = std::abs(g) / 2.0 + std::sqrt(1.0 + g * g / 4.0);
        EXPECT_LE((stress - shear_stress(GetParam().model, g)).norm(), tolerance(stretch))
            << stress << "\n\n"
            << shear_stress(GetParam().model, g);
    }
}

// The transverse stretch at which a bar stretched to s has no transverse stress, by bisection.
double free_stretch_across(const LawPoint& point, double s)
{
    double low = 0.3, high = 2.5;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (low + high);
        (point.stress(diagonal(s, middle, middle))(1, 1) < 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// L. Treloar, The Physics of Rubber Elasticity: an incompressible neo-Hookean bar stretched to s carries mu (s - 1 /
// s^2) per unit of its initial cross-section. The pressure, of order mu, changes the volume of a compressible bar by
// order mu / lambda, and its force likewise: the difference from Treloar's falls a hundredfold if lambda grows a
// hundredfold. It is a series c x + d x^2 + ... in x = mu / lambda with coefficients of order one to ten (the pressure
// at s = 2 is 4 mu): below 1e-2 at x = 1e-3, and the ratio is 100 to within 100 d / c x = 1. Rounding of the stress, a
// hundred eps lambda, is 1e-4 of the smaller difference.
TEST(NeoHookeanLaws, TendToTreloarsBarAsVolumeIsKept)
{
    for (const NamedModel& model : {nonlinear_models[1], nonlinear_models[2], nonlinear_models[4]})
        for (const double s : {0.6, 1.3, 2.0}) {
            const auto difference = [&](double ratio) {
                const LawPoint point(model.model, {.lambda_pa = ratio * mu, .mu_pa = mu});
                const double across = free_stretch_across(point, s);
                return (point.stress(diagonal(s, across, across))(0, 0) - mu * (s - 1.0 / (s * s))) / mu;
            };
            EXPECT_LT(std::abs(difference(1e3)), 1e-2) << model.name << s;
            EXPECT_NEAR(difference(1e3) / difference(1e5), 100.0, 1.0) << model.name << s;
        }
}

// A known defect: St Venant-Kirchhoff, compressed with its sides held, carries (lambda / 2 + mu) (s^3 - s), with its
// maximum at s = 1 / sqrt 3 for any moduli. Under further compression it softens, and at s = 0 it has no resistance.
TEST(StVenantKirchhoff, HasALimitPointUnderUniaxialStrain)
{
    const double limit = 1.0 / std::sqrt(3.0);
    for (const Lame& moduli : {lame, Lame{0.0, 1.0}, Lame{1e3, 1.0}}) {
        const LawPoint point(Model::st_venant_kirchhoff, moduli);
        const double modulus = moduli.lambda_pa + 2.0 * moduli.mu_pa;
        // Some twenty roundings by eps / 2, of F and of terms no larger than the modulus.
        const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * modulus;
        EXPECT_NEAR(point.tangent(diagonal(limit, 1.0, 1.0))(0, 0), 0.0, rounding);
        EXPECT_GT(point.tangent(diagonal(limit + 0.01, 1.0, 1.0))(0, 0), 0.01 * modulus);
        EXPECT_LT(point.tangent(diagonal(limit - 0.01, 1.0, 1.0))(0, 0), -0.01 * modulus);
        EXPECT_NEAR(point.stress(diagonal(limit, 1.0, 1.0))(0, 0), -modulus / (3.0 * std::sqrt(3.0)), rounding);
    }
}

// With its sides free, E_22 = -nu E_11, it carries Young's modulus times (s^3 - s) / 2, with the same limit point.
// Tolerance: the rounding of the stress along the bar, and that of the stress across, which the bisection makes zero;
// its share in the force is below one. No other law softens under uniaxial strain.
TEST(StVenantKirchhoff, HasTheSameLimitPointUnderUniaxialStressAndIsAloneInGivingWay)
{
    const LawPoint point(Model::st_venant_kirchhoff, lame);
    const double young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    const auto force = [&](double s) {
        const double across = free_stretch_across(point, s);
        return point.stress(diagonal(s, across, across))(0, 0);
    };
    for (const double s : {0.4, 1.0 / std::sqrt(3.0), 0.8})
        EXPECT_NEAR(force(s), young * (s * s * s - s) / 2.0, 2.0 * tolerance(1.0));
    EXPECT_LT(force(1.0 / std::sqrt(3.0)), std::min(force(0.4), force(0.8)));
    for (const NamedModel& model : all_models)
        for (double s = 0.95; s > 0.04 && model.model != Model::st_venant_kirchhoff; s -= 0.05)
            EXPECT_GT(LawPoint(model.model, lame).tangent(diagonal(s, 1.0, 1.0))(0, 0), 0.5 * (lambda + 2.0 * mu))
                << model.name << s;
}

// M. Macklin, M. Mueller, A Constraint-based Formulation of Stable Neo-Hookean Materials, MIG 2021: mu / 2 (|F|^2 - 3)
// + lambda' / 2 (J - alpha)^2 with alpha = 1 + mu / lambda', which has the small-strain limit of mu and lambda for
// lambda' = lambda + mu. The square completed, it is the energy of the code up to a constant; both go through fewer
// roundings than the stress, and terms of degree six.
TEST(StableNeoHookean, IsTheFormOfMacklinAndMueller)
{
    const double lambda_form = lambda + mu, alpha = 1.0 + mu / lambda_form;
    const auto form = [&](const Eigen::Matrix3d& f) {
        return mu / 2.0 * (f.squaredNorm() - 3.0) +
               lambda_form / 2.0 * (std::pow(f.determinant() - alpha, 2) - std::pow(1.0 - alpha, 2));
    };
    const LawPoint law(Model::stable_neo_hookean, lame);
    test_support::RandomPoints random(11);
    for (int trial = 0; trial < 20; ++trial)
        for (const Eigen::Matrix3d& f : {random_stretch(random), random_inversion(random)})
            EXPECT_NEAR(law.energy(f), form(f), 1.6 * tolerance(1.6)) << f;
}

}  // namespace
