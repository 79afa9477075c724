// Reference: the formulas of the laws, evaluated by hand, where a deformation gradient degenerates. mu = 1 and lambda =
// 2 (any unit). Comparisons are exact where every number is a small multiple of a power of two, so that nothing is
// rounded; the singular value decomposition of a diagonal matrix takes no rotation.

#include "reference_fem/laws/constitutive_law.hpp"
#include "tests/support/law_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace {

using namespace test_support;
using reference_fem::Lame;
using reference_fem::PointResponse;
using reference_fem::Tangent;

const Lame lame{.lambda_pa = 2.0, .mu_pa = 1.0};
const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity(), zero = Eigen::Matrix3d::Zero();

PointResponse respond(Model model, const Eigen::Matrix3d& f)
{
    return constitutive_law(model, lame)->evaluate(f, Derivatives::second);
}

class EveryLaw : public testing::TestWithParam<NamedModel> {};

TEST_P(EveryLaw, AtRestStoresNothing)
{
    const PointResponse response = respond(GetParam().model, identity);
    EXPECT_TRUE(response.defined);
    EXPECT_EQ(response.shape, 0.0);
    EXPECT_EQ(response.dilatation, 0.0);
    EXPECT_EQ(response.shape_gradient.norm(), 0.0);
}

TEST_P(EveryLaw, GivesTheSameWithFewerDerivatives)
{
    RandomPoints random(1);
    const Eigen::Matrix3d f = random_stretch(random);
    const auto law = constitutive_law(GetParam().model, lame);
    const PointResponse none = law->evaluate(f, Derivatives::none), first = law->evaluate(f, Derivatives::first),
                        second = law->evaluate(f, Derivatives::second);
    EXPECT_EQ(none.shape, second.shape);
    EXPECT_EQ(none.dilatation, second.dilatation);
    EXPECT_EQ(first.shape, second.shape);
    EXPECT_EQ(first.shape_gradient, second.shape_gradient);
    EXPECT_EQ(first.dilatation_gradient, second.dilatation_gradient);
}

TEST_P(EveryLaw, IsDefinedAndFiniteOrSaysNot)
{
    const Eigen::Matrix3d flat = diagonal(1.3, 0.8, 0.0), line = diagonal(1.3, 0.0, 0.0),
                          mirror = diagonal(1.0, 1.0, -1.0), point_mirror = -identity,
                          inside_out = diagonal(1.4, 1.1, -0.3);
    for (const Eigen::Matrix3d& f : {zero, flat, line, mirror, point_mirror, inside_out}) {
        const PointResponse response = respond(GetParam().model, f);
        EXPECT_EQ(response.defined, GetParam().through_inversion) << f;
        if (response.defined) {
            EXPECT_TRUE(all_finite(response)) << f;
        }
    }
    Eigen::Matrix3d broken = identity;
    broken(1, 2) = std::nan("");
    const LawPoint point(GetParam().model, lame);
    const PointResponse response = point.law->evaluate(broken, Derivatives::none);
    EXPECT_TRUE(!response.defined || !std::isfinite(energy_density(response, point.law->lambda_pa())));
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, testing::ValuesIn(all_models), name_of_model);

// psi, P and the tangent at F = 0, at reflections and of flat tets, by hand. St Venant-Kirchhoff gives way at zero,
// where its energy has a maximum, and is blind to mirrors; stable neo-Hookean flesh has a minimum there, resists
// mirrors and pushes a flat tet open. For the corotational law the choice of the rotation R among several is arbitrary;
// |F - R|^2 = |F|^2 + 3 - 2 tr S and tr S = s_1 + s_2 + s_3 do not depend on it.
TEST(DegenerateStates, HaveTheirEnergyStressAndTangent)
{
    struct Case {
        Model model;
        Eigen::Matrix3d f;
        double energy;
        std::optional<Eigen::Matrix3d> stress = {};
        std::optional<double> tangent = {};  // a multiple of the identity
    };
    const Eigen::Matrix3d mirror = diagonal(1.0, 1.0, -1.0), flat = diagonal(1.0, 1.0, 0.0);
    const std::vector<Case> all = {
        {Model::linear, zero, 3.0 + 9.0},                      // eps = -I
        {Model::linear, diagonal(-1.0, 1.0, 1.0), 4.0 + 4.0},  // eps = diag(-2, 0, 0)
        // E = -I / 2; -(mu + 3 lambda / 2) I
        {Model::st_venant_kirchhoff, zero, 0.75 + 9.0 / 4.0, zero, -4.0},
        {Model::st_venant_kirchhoff, mirror, 0.0, zero},  //
        // shape 0, lambda / 2; mu I
        {Model::stable_neo_hookean, zero, 1.0, zero, 1.0},
        {Model::stable_neo_hookean, mirror, 2.0 + 2.0 + 0.5 * 2.0 * 4.0},  // J - 1 = -2
        // |F|^2 - 3 = J - 1 = -1; -mu - mu - lambda
        {Model::stable_neo_hookean, flat, -0.5 + 1.0 + 0.5 + 1.0, diagonal(1.0, 1.0, -4.0)},
        {Model::corotational, zero, 3.0 + 9.0},
        {Model::corotational, mirror, 4.0 + 4.0},
        {Model::corotational, diagonal(2.0, 1.0, -1.0), 5.0 + 1.0}};  // |F|^2 + 3 - 4, (2 - 3)^2
    for (const Case& of : all) {
        const LawPoint law(of.model, lame);
        EXPECT_EQ(law.energy(of.f), of.energy) << static_cast<int>(of.model) << "\n" << of.f;
        if (!of.stress) continue;
        EXPECT_EQ(law.stress(of.f), *of.stress) << static_cast<int>(of.model) << "\n" << of.f;
        EXPECT_TRUE(!of.tangent || law.tangent(of.f) == *of.tangent * Tangent::Identity())
            << static_cast<int>(of.model);
    }
    // A change of this stretch by h changes |F|^2, -2 tr S and (tr S - 3)^2 by at most 2 h each. Their sum changes by
    // at most 6 h - 2 h^2, and 2 h^2 is larger than its rounding.
    for (const double side : {-1e-7, 1e-7})
        EXPECT_NEAR(LawPoint(Model::corotational, lame).energy(diagonal(2.0, 1.0, -1.0 + side)), 6.0,
                    6.0 * std::abs(side));
}

// If two stretches sum to 0 or nearly so, the energy has a ridge (2 mu + lambda (3 - tr S) > 0 times a concave kink).
// There the tangent is large, finite, symmetric and negative across the ridge, so that a check of definiteness cannot
// miss it. Entries across the diagonal are the same four products and sums, of which a compiler may fuse those of one.
TEST(DegenerateStates, CorotationalTangentStaysFiniteWhereTwoStretchesSumToZero)
{
    for (const Eigen::Matrix3d& f :
         {diagonal(2.0, 1.0, -1.0), diagonal(2.0, 1.0, -1.0 + 1e-12), diagonal(1.0, 0.0, 0.0)}) {
        const Tangent tangent = LawPoint(Model::corotational, lame).tangent(f);
        EXPECT_TRUE(tangent.allFinite());
        EXPECT_LE((tangent - tangent.transpose()).norm(), rounding_error(2 * 4, tangent.norm()));
        EXPECT_LT(Eigen::SelfAdjointEigenSolver<Tangent>(tangent).eigenvalues()(0), -1e6);
    }
}

TEST(IsochoricNeoHookean, HasNoVolumeTermOfItsOwn)
{
    const auto law = constitutive_law(Model::isochoric_neo_hookean, lame);
    EXPECT_FALSE(law->volume_term());
    EXPECT_EQ(law->lambda_pa(), 0.0);
    const PointResponse response = law->evaluate(diagonal(1.2, 0.9, 1.1), Derivatives::second);
    EXPECT_EQ(response.dilatation, 0.0);
    EXPECT_EQ(response.dilatation_gradient.norm(), 0.0);
    EXPECT_EQ(response.dilatation_hessian.norm(), 0.0);
}

// Reference: the definition of the polar decomposition, F = R S with R a rotation and S symmetric. For its derivative:
// R does not depend on the scale of F or on a stretch along its own axes, and rotates with F. Tolerances: Jacobi's
// method takes at most five sweeps of three pairs, each pair a rotation from the left and one from the right, so that
// an entry of R goes through 30 rotations of six roundings. Roundings of random sign add up to the square root of their
// number (N. Higham, Accuracy and stability of numerical algorithms, 2nd ed., SIAM 2002, Sec. 2.8); the Frobenius norm
// of nine entries is three times as large.

using namespace reference_fem;

// the error of R, and of U S V^T relative to F
const double of_rotations = 3.0 * rounding_error(std::sqrt(30.0 * 6.0), 1.0);

// The products and the determinant contain R twice or thrice in directions of norm one. The stretch contains both
// errors, and its asymmetry contains it twice.
void expect_polar(const Eigen::Matrix3d& f)
{
    const PolarDecomposition polar = polar_decomposition(f);
    const Eigen::Matrix3d stretch = polar.rotation.transpose() * f;
    EXPECT_LE((polar.rotation.transpose() * polar.rotation - Eigen::Matrix3d::Identity()).norm(), 2.0 * of_rotations);
    EXPECT_NEAR(polar.rotation.determinant(), 1.0, std::sqrt(3.0) * of_rotations);
    EXPECT_LE((stretch - stretch.transpose()).norm(), 4.0 * of_rotations * f.norm());
    EXPECT_NEAR(stretch.trace(), polar.stretches.sum(), std::sqrt(3.0) * 2.0 * of_rotations * f.norm());
    // singular values are sorted, and only the sign of the last one changes
    EXPECT_GE(polar.stretches(1) + polar.stretches(2), 0.0);
}

TEST(PolarDecomposition, IsARotationTimesASymmetricStretchAlsoWhereFDegenerates)
{
    RandomPoints random(2);
    for (int i = 0; i < 20; ++i) {
        expect_polar(random_stretch(random));
        expect_polar(random_inversion(random));
        expect_polar(random_rotation(random));
    }
    const Eigen::Matrix3d q = random_rotation(random);
    for (const Eigen::Vector3d& stretches :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(2, 1, 0), Eigen::Vector3d(1, 1, -1),
          Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1e8, 1, 1e-8)})
        expect_polar(q * stretches.asDiagonal());
}

// The derivative, of norm 2 / (s_2 + s_3), contains the axes twice, and its argument and what it is compared with
// contain R.
TEST(RotationDerivative, VanishesAlongStretchesAndFollowsSpins)
{
    RandomPoints random(4);
    for (const Eigen::Matrix3d& f : {random_stretch(random), random_inversion(random)}) {
        const PolarDecomposition polar = polar_decomposition(f);
        const Tangent derivative = rotation_derivative(polar);
        const Eigen::Matrix3d a = random_matrix(random, 1.0), symmetric = a + a.transpose(), skew = a - a.transpose();
        const double rounding = 4.0 * of_rotations * 2.0 / (polar.stretches(1) + polar.stretches(2));
        EXPECT_LE((derivative * vec(polar.rotation * symmetric)).norm(), rounding * symmetric.norm());
        EXPECT_LE((derivative * vec(skew * f) - vec(skew * polar.rotation)).norm(), rounding * skew.norm() * f.norm());
    }
}

}  // namespace
