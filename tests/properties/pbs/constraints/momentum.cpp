// Reference: Eq. 3-4. A projection moves points along gradients, which are perpendicular to rigid motions, so linear and angular momentum
// are conserved. Tolerances: a few roundings of terms of order one (masses and positions are of order one), in double and float.
#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace test_support;
using pbs::Vec3;

template <typename Scalar>
class Momentum : public testing::Test {
protected:
    using Vector = pbs::Vector3<Scalar>;

    // |sum m dp| and |sum r x m dp|, with r from an arbitrary centre, in double precision.
    void expect_conserved(const std::vector<Vector>& before, const std::vector<Vector>& after, const std::vector<Scalar>& w)
    {
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        double largest = 0.0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const Vec3 p = before[i].template cast<double>(), dp = after[i].template cast<double>() - p;
            linear += dp / w[i];
            angular += (p - centre).cross(dp / w[i]);
            largest = std::max(largest, dp.norm());
        }
        const double rounding = 100.0 * std::numeric_limits<Scalar>::epsilon();
        EXPECT_LT(linear.norm(), rounding);
        EXPECT_LT(angular.norm(), rounding);
        EXPECT_GT(largest, 1e-3) << "nothing moved, so nothing is shown";
    }

    std::vector<Scalar> masses(bool unit, int count)
    {
        std::vector<Scalar> w(count, Scalar(1));
        if (!unit)
            for (Scalar& inverse : w) inverse = Scalar(random.number(0.2, 5.0));
        return w;
    }

    RandomPoints random{31};
    const Vec3 centre = Vec3(0.3, -0.7, 0.2);
};

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Momentum, Precisions);

TYPED_TEST(Momentum, OfStretchIsConservedWithEqualAndUnequalMasses)
{
    using Vector = pbs::Vector3<TypeParam>;
    const pbs::StretchConstraint<TypeParam> rod{{0, 1}, TypeParam(0.3), TypeParam(0.7)};
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<TypeParam> w = this->masses(trial % 2 == 0, 2);
        const std::vector<Vector> before = {this->random.point(1.0).template cast<TypeParam>(),
                                            this->random.point(1.0).template cast<TypeParam>()};
        std::vector<Vector> after = before;
        project(rod, w[0], w[1], after[0], after[1]);
        this->expect_conserved(before, after, w);
    }
}

TYPED_TEST(Momentum, OfVolumeIsConservedWithEqualAndUnequalMasses)
{
    using Vector = pbs::Vector3<TypeParam>;
    const pbs::VolumeConstraint<TypeParam> tet{{0, 1, 2, 3}, TypeParam(0.4), TypeParam(0.9)};
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<TypeParam> w = this->masses(trial % 2 == 0, 4);
        std::vector<Vector> before;
        for (const Vec3& corner : noisy_corner(this->random, 0.2)) before.push_back(corner.template cast<TypeParam>());
        std::vector<Vector> after = before;
        project(tet, w[0], w[1], w[2], w[3], after[0], after[1], after[2], after[3]);
        this->expect_conserved(before, after, w);
    }
}

// Without the weights (Eq. 8-9 as printed), unequal masses lose momentum: the departure from the print is necessary.
TEST(MomentumUnweighted, IsLostWithUnequalMasses)
{
    Vec3 p1(0, 0, 0), p2(2, 0, 0);
    const double m1 = 1.0, m2 = 3.0;
    project(pbs::StretchConstraint<double>{{0, 1}, 1.0, 1.0}, 1.0, 1.0, p1, p2);
    EXPECT_GT(std::abs(m1 * p1.x() + m2 * (p2.x() - 2.0)), 0.5);
}

// The momentum of the vertex equals what the bone would receive as the heavy end of a rod between them (Eq. 8-9 at both ends), with 1e8
// times the vertex's mass. The two differ by that share of a momentum below 3, and the rounding of the bone's 1e-8 steps is as large: below
// 6e-8.
TEST(MomentumOfBind, IsTakenByTheBone)
{
    RandomPoints random(32);
    const double vertex = 0.8, bone = 1e-8 * vertex;  // inverse masses
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 p = random.point(1.0), q = random.point(1.0);
        Vec3 bound = p, heavy_q = q, rod_p = p;
        project(pbs::BindConstraint<double>{0, 0.3, 0.7}, vertex, q, bound);
        project(pbs::StretchConstraint<double>{{0, 1}, 0.3, 0.7}, vertex, bone, rod_p, heavy_q);
        const Vec3 given = (bound - p) / vertex, taken = (heavy_q - q) / bone;
        EXPECT_LT((given + taken).norm(), 1e-7);
        EXPECT_LT((bound - p).cross(q - p).norm(), 1e-14);
        EXPECT_GT(given.norm(), 1e-3) << trial;
    }
}

}  // namespace
