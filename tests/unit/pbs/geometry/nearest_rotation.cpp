// Reference: the singular value decomposition, and the definition of the maximum. Tolerance: with u the unit roundoff,
// the entries of R go through 8 roundings, those of R^T M through 5 more and those of M / |M| through 4, so that the
// last correction sees R^T M with an error E of at most 17 u |M| sqrt(3), which the decomposition of the reference does
// not exceed. It turns the rotation by sqrt(2) |E| / (s_2 + s s_3), whose matrix differs by sqrt(2) times that; the
// rotation's own entries add 3 * 8 u.
#include "pbs/geometry/nearest_rotation.hpp"

#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using pbs::Vec3;

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, 3, 3>;

template <class Scalar>
class NearestRotationOf : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NearestRotationOf, Scalars);

// s_2 + sign(det M) s_3, by how much the maximum stands out.
double gap_of(const Eigen::Matrix3d& m)
{
    const Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(m).singularValues();
    return s(1) + std::copysign(s(2), m.determinant());
}

template <class Scalar>
double rotation_error(const Eigen::Matrix3d& m)
{
    const double of_product = test_support::rounding_error_in<Scalar>(17, std::sqrt(3.0) * m.norm());
    return 2.0 * of_product * 2.0 / gap_of(m) + test_support::rounding_error_in<Scalar>(3 * 8, 1.0);
}

template <class Scalar>
void expect_nearest(const Matrix<Scalar>& m)
{
    const Eigen::Matrix3d r = pbs::nearest_rotation(m).template cast<double>(), wide = m.template cast<double>();
    EXPECT_LT((r - pbs::nearest_rotation_by_svd(wide)).norm(), rotation_error<Scalar>(wide)) << wide;
}

template <class Scalar>
void expect_rotation(const Matrix<Scalar>& matrix)
{
    const Eigen::Matrix3d r = matrix.template cast<double>();
    EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(),
              test_support::rounding_error_in<Scalar>(2 * 3 * 8, 1.0))
        << r;
    EXPECT_GT(r.determinant(), 0.0);
}

// A matrix with these singular values, the last of which has the sign of the determinant.
Eigen::Matrix3d matrix_with(test_support::RandomPoints& random, const Vec3& s)
{
    return random.rigid_motion(0.0).linear() * s.asDiagonal() * random.rigid_motion(0.0).linear();
}

TYPED_TEST(NearestRotationOf, RandomMatricesOfBothSignsAndAllScales)
{
    test_support::RandomPoints random(41);
    int reflected = 0;
    for (int i = 0; i < 2000; ++i) {
        Eigen::Matrix3d m;
        for (double& entry : m.reshaped()) entry = random.number(-1.0, 1.0);
        const Matrix<TypeParam> scaled = (std::pow(10.0, random.number(-6.0, 6.0)) * m).cast<TypeParam>();
        reflected += m.determinant() < 0.0;
        expect_nearest<TypeParam>(scaled);
        expect_rotation<TypeParam>(pbs::nearest_rotation(scaled));
    }
    EXPECT_GT(reflected, 500);
}

// The smaller singular values fall towards zero, or towards each other in a reflection, beyond the point where the
// formulae refuse.
TYPED_TEST(NearestRotationOf, NearlySingularMatrices)
{
    test_support::RandomPoints random(42);
    for (double gap = 1.0; gap > 4.0 * std::numeric_limits<TypeParam>::epsilon(); gap *= 0.3)
        for (int i = 0; i < 50; ++i) {
            const double share = random.number(0.0, 1.0);
            expect_nearest<TypeParam>(
                matrix_with(random, {1.0, 0.5 * gap * (1.0 + share), 0.5 * gap * (1.0 - share)}).cast<TypeParam>());
            expect_nearest<TypeParam>(matrix_with(random, {1.0 + gap, share + gap, -share}).cast<TypeParam>());
            expect_nearest<TypeParam>(
                matrix_with(random, {1.0 + share * gap, 1.0 + share * gap, -1.0}).cast<TypeParam>());
        }
}

TYPED_TEST(NearestRotationOf, MatricesOfRankTwo)
{
    test_support::RandomPoints random(43);
    for (int i = 0; i < 200; ++i)
        expect_nearest<TypeParam>(matrix_with(random, {1.0, random.number(0.1, 1.0), 0.0}).cast<TypeParam>());
}

// No rotation has a larger trace: the definition, without a decomposition.
TYPED_TEST(NearestRotationOf, NoOtherRotationIsNearer)
{
    test_support::RandomPoints random(44);
    for (int i = 0; i < 100; ++i) {
        Matrix<TypeParam> m;
        for (TypeParam& entry : m.reshaped()) entry = TypeParam(random.number(-1.0, 1.0));
        const Eigen::Matrix3d wide = m.template cast<double>(), r = pbs::nearest_rotation(m).template cast<double>();
        const double rounding = test_support::rounding_error_in<TypeParam>(8, 3.0 * wide.norm());
        for (int other = 0; other < 20; ++other)
            EXPECT_GE((r.transpose() * wide).trace() + rounding,
                      (random.rigid_motion(0.0).linear().transpose() * wide).trace());
    }
}

TYPED_TEST(NearestRotationOf, RotationsComeBack)
{
    test_support::RandomPoints random(45);
    for (int i = 0; i < 200; ++i) {
        const Matrix<TypeParam> r = random.rigid_motion(0.0).linear().cast<TypeParam>();
        EXPECT_LT((pbs::nearest_rotation(r) - r).norm(), rotation_error<TypeParam>(r.template cast<double>()));
    }
    // half turns, where w = 0
    for (const Vec3& turn : {Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1), Vec3(1, 1, 1)}) {
        const Matrix<TypeParam> r = turn.cast<TypeParam>().asDiagonal();
        EXPECT_LT((pbs::nearest_rotation(r) - r).norm(), rotation_error<TypeParam>(r.template cast<double>()));
    }
}

TYPED_TEST(NearestRotationOf, RankOneZeroAndPureReflectionHaveSomeRotationThatIsNearest)
{
    const Vec3 a(1, 2, 3), b(-2, 0.5, 1);
    const Matrix<TypeParam> rank_one = (a * b.transpose()).cast<TypeParam>(), zero = Matrix<TypeParam>::Zero(),
                            reflection = -Matrix<TypeParam>::Identity();
    for (const Matrix<TypeParam>& m : {rank_one, zero, reflection})
        expect_rotation<TypeParam>(pbs::nearest_rotation(m));
    EXPECT_EQ(pbs::nearest_rotation(zero), (Matrix<TypeParam>::Identity()));
    const double rounding = test_support::rounding_error_in<TypeParam>(3 * 17, a.norm() * b.norm());
    EXPECT_NEAR((pbs::nearest_rotation(rank_one).transpose() * rank_one).trace(), a.norm() * b.norm(), rounding);
    // s_1 + s_2 - s_3
    EXPECT_NEAR((pbs::nearest_rotation(reflection).transpose() * reflection).trace(), 1.0, rounding);
}

TYPED_TEST(NearestRotationOf, NotFiniteIsNoRotation)
{
    for (const TypeParam bad :
         {std::numeric_limits<TypeParam>::quiet_NaN(), std::numeric_limits<TypeParam>::infinity()}) {
        Matrix<TypeParam> m = Matrix<TypeParam>::Identity();
        m(1, 2) = bad;
        EXPECT_TRUE(pbs::nearest_rotation(m).array().isNaN().all());
    }
}

TYPED_TEST(NearestRotationOf, LargestAndSmallestNumbers)
{
    const double extreme = std::sqrt(double(std::numeric_limits<TypeParam>::max()));
    test_support::RandomPoints random(46);
    const Eigen::Matrix3d m = matrix_with(random, {2.0, 1.0, 0.5});
    for (const double scale : {1e-2 / extreme, 1e2 * extreme}) {  // whose squares underflow and overflow
        const Eigen::Matrix3d r =
            pbs::nearest_rotation(Matrix<TypeParam>((scale * m).cast<TypeParam>())).template cast<double>();
        EXPECT_LT((r - pbs::nearest_rotation_by_svd(m)).norm(), 2.0 * rotation_error<TypeParam>(m));
    }
}

}  // namespace
