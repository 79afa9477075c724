// Reference: textbook stresses of each law, derived by hand from its energy in principal stretches or in shear, by formulas that no source
// file contains. J. Bonet, R. Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, chapter 6; R. Ogden, Non-Linear Elastic
// Deformations.
#include "tests/support/law_points.hpp"

#include <functional>
#include <map>

namespace {

using namespace test_support;
using reference_fem::Lame;

const Lame lame{.lambda_pa = 7e4, .mu_pa = 4e4};
const double lambda = lame.lambda_pa, mu = lame.mu_pa, kappa = lambda + 2.0 / 3.0 * mu;

// A stress and its closed form go through at most a hundred roundings by eps / 2 (the invariants and cofactors of F, the sweeps of a Jacobi
// SVD) of terms no larger than (lambda + 2 mu) s^5, s the largest stretch or 1: the term J dJ/dF of a stress is of degree five in F. The
// Frobenius norm of nine such errors is three times as large.
double tolerance(double largest_stretch)
{
    const double largest_term = (lambda + 2.0 * mu) * std::pow(std::max(largest_stretch, 1.0), 5);
    return 3.0 * 100.0 * std::numeric_limits<double>::epsilon() / 2.0 * largest_term;
}

Eigen::Matrix3d diagonal(double a, double b, double c)
{
    return Eigen::Vector3d(a, b, c).asDiagonal();
}

// F = s I: P = p I.
TEST_P(EveryLaw, UniformDilation)
{
    const std::map<Model, std::function<double(double)>> pressure = {
        {Model::linear, [](double s) { return (2.0 * mu + 3.0 * lambda) * (s - 1.0); }},
        {Model::corotational, [](double s) { return (2.0 * mu + 3.0 * lambda) * (s - 1.0); }},
        {Model::stable_neo_hookean, [](double s) { return mu * s - mu * s * s + (lambda + mu) * (s * s * s - 1.0) * s * s; }},
        {Model::neo_hookean, [](double s) { return mu * (s - 1.0 / s) + 3.0 * lambda * std::log(s) / s; }},
        {Model::st_venant_kirchhoff, [](double s) { return s * (2.0 * mu + 3.0 * lambda) * (s * s - 1.0) / 2.0; }},
        {Model::isochoric_neo_hookean, [](double s) { return 0.5 * kappa * (std::pow(s, 3) - std::pow(s, -3)) * s * s; }}};
    for (const double s : {0.6, 1.0, 1.5}) {
        const Eigen::Matrix3d stress = LawPoint(GetParam().model, lame).stress(s * Eigen::Matrix3d::Identity());
        EXPECT_LE((stress - pressure.at(GetParam().model)(s) * Eigen::Matrix3d::Identity()).norm(), tolerance(s)) << s;
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
         [](double s) { return Pair((lambda + 2.0 * mu) * (s - 1.0), mu * (s - 1.0) * (s - 1.0) + lambda * s * (s - 1.0)); }},
        {Model::neo_hookean, [](double s) { return Pair(mu * (s - 1.0 / s) + lambda * std::log(s) / s, lambda * std::log(s)); }},
        {Model::st_venant_kirchhoff, [](double s) { return Pair((0.5 * lambda + mu) * s * (s * s - 1.0), 0.5 * lambda * (s * s - 1.0)); }},
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
        const double root = std::sqrt(4.0 + g * g), cosine = 2.0 / root, sine = g / root, pressure = lambda * (root - 2.0);
        p << 2.0 * mu * (1.0 - cosine) + pressure * cosine, 2.0 * mu * (g - sine) + pressure * sine, 0.0,  //
            (2.0 * mu - pressure) * sine, 2.0 * mu * (1.0 - cosine) + pressure * cosine, 0.0,              //
            0.0, 0.0, pressure;
    }
    return p;
}

TEST_P(EveryLaw, SimpleShear)
{
    for (const double g : {-0.5, 0.1, 1.5}) {
        Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
        f(0, 1) = g;
        const Eigen::Matrix3d stress = LawPoint(GetParam().model, lame).stress(f);
        const double stretch = std::abs(g) / 2.0 + std::sqrt(1.0 + g * g / 4.0);
        EXPECT_LE((stress - shear_stress(GetParam().model, g)).norm(), tolerance(stretch)) << stress << "\n\n"
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

class NeoHookeanLaw : public testing::TestWithParam<NamedModel> {};

// L. Treloar, The Physics of Rubber Elasticity: an incompressible neo-Hookean bar stretched to s carries mu (s - 1 / s^2) per unit of its
// initial cross-section. The pressure, of order mu, changes the volume of a compressible bar by order mu / lambda, and its force likewise:
// the difference from Treloar's falls a hundredfold if lambda grows a hundredfold. It is a series c x + d x^2 + ... in x = mu / lambda with
// coefficients of order one to ten (the pressure at s = 2 is 4 mu): below 1e-2 at x = 1e-3, and the ratio is 100 to within 100 d / c x = 1.
// Rounding of the stress, a hundred eps lambda, is 1e-4 of the smaller difference.
TEST_P(NeoHookeanLaw, TendsToTreloarsBarAsVolumeIsKept)
{
    for (const double s : {0.6, 1.3, 2.0}) {
        const auto difference = [&](double ratio) {
            const LawPoint point(GetParam().model, {.lambda_pa = ratio * mu, .mu_pa = mu});
            const double across = free_stretch_across(point, s);
            return (point.stress(diagonal(s, across, across))(0, 0) - mu * (s - 1.0 / (s * s))) / mu;
        };
        EXPECT_LT(std::abs(difference(1e3)), 1e-2) << s;
        EXPECT_NEAR(difference(1e3) / difference(1e5), 100.0, 1.0) << s;
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, NeoHookeanLaw, testing::Values(nonlinear_models[1], nonlinear_models[2], nonlinear_models[4]),
                         name_of_model);

// A known defect: St Venant-Kirchhoff, compressed with its sides held, carries (lambda / 2 + mu) (s^3 - s), with its maximum at s = 1 /
// sqrt 3 for any moduli. Under further compression it softens, and at s = 0 it has no resistance.
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

// With its sides free, E_22 = -nu E_11, it carries Young's modulus times (s^3 - s) / 2, with the same limit point. Tolerance: the rounding
// of the stress along the bar, and that of the stress across, which the bisection makes zero; its share in the force is below one.
TEST(StVenantKirchhoff, HasTheSameLimitPointUnderUniaxialStress)
{
    const LawPoint point(Model::st_venant_kirchhoff, lame);
    const double young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
    const auto force = [&](double s) {
        const double across = free_stretch_across(point, s);
        return point.stress(diagonal(s, across, across))(0, 0);
    };
    for (const double s : {0.4, 1.0 / std::sqrt(3.0), 0.8}) EXPECT_NEAR(force(s), young * (s * s * s - s) / 2.0, 2.0 * tolerance(1.0));
    EXPECT_LT(force(1.0 / std::sqrt(3.0)), force(0.4));
    EXPECT_LT(force(1.0 / std::sqrt(3.0)), force(0.8));
}

// No other law softens on the same path.
TEST(StVenantKirchhoff, IsAloneInGivingWay)
{
    for (const NamedModel& model : all_models()) {
        if (model.model == Model::st_venant_kirchhoff) continue;
        for (double s = 0.95; s > 0.04; s -= 0.05)
            EXPECT_GT(LawPoint(model.model, lame).tangent(diagonal(s, 1.0, 1.0))(0, 0), 0.5 * (lambda + 2.0 * mu)) << model.name << s;
    }
}

// M. Macklin, M. Mueller, A Constraint-based Formulation of Stable Neo-Hookean Materials, MIG 2021: mu / 2 (|F|^2 - 3) + lambda' / 2
// (J - alpha)^2 with alpha = 1 + mu / lambda', which has the small-strain limit of mu and lambda for lambda' = lambda + mu. The square
// completed, it is the energy of the code up to a constant; both go through fewer roundings than the stress, and terms of degree six.
TEST(StableNeoHookean, IsTheFormOfMacklinAndMueller)
{
    const double lambda_form = lambda + mu, alpha = 1.0 + mu / lambda_form;
    const auto form = [&](const Eigen::Matrix3d& f) {
        return mu / 2.0 * (f.squaredNorm() - 3.0) + lambda_form / 2.0 * (std::pow(f.determinant() - alpha, 2) - std::pow(1.0 - alpha, 2));
    };
    const LawPoint law(Model::stable_neo_hookean, lame);
    test_support::RandomPoints random(11);
    for (int trial = 0; trial < 20; ++trial)
        for (const Eigen::Matrix3d& f : {random_stretch(random), random_inversion(random)})
            EXPECT_NEAR(law.energy(f), form(f), 1.6 * tolerance(1.6)) << f;
}

}  // namespace
