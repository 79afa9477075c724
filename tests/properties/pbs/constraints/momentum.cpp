// Reference: Eq. 3-4. A projection moves points along gradients, which are perpendicular to rigid motions, so linear and angular momentum
// are conserved. Tolerances: the rounding of a projection (projection_rounding.hpp), in double and float.
#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace test_support;
using pbs::Vec3;

template <typename Scalar>
class Momentum : public testing::Test {
protected:
    using Vector = pbs::Vector3<Scalar>;

    // |sum m dp| and |sum r x m dp|, with r from an arbitrary centre, in double precision. `step` is the rounding of a vertex [m].
    void expect_conserved(const std::vector<Vector>& before, const std::vector<Vector>& after, const std::vector<Scalar>& w, double step)
    {
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        double largest = 0.0, of_linear = 0.0, of_angular = 0.0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const Vec3 p = before[i].template cast<double>(), dp = after[i].template cast<double>() - p;
            linear += dp / w[i];
            angular += (p - centre).cross(dp / w[i]);
            largest = std::max(largest, dp.norm());
            of_linear += step / w[i];
            of_angular += (p - centre).norm() * step / w[i];
        }
        EXPECT_LT(linear.norm(), of_linear);
        EXPECT_LT(angular.norm(), of_angular);
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
        this->expect_conserved(before, after, w, rounding_of(rod, w[0], w[1], before[0], before[1]).step);
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
        const double step = rounding_of(tet, {w[0], w[1], w[2], w[3]}, {before[0], before[1], before[2], before[3]}).step;
        this->expect_conserved(before, after, w, step);
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
// times the vertex's mass. The two differ by that share of the momentum, and by the rounding of the vertex and of the bone, whose step of
// 1e-8 is rounded with its position.
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
        const double of_vertex = rounding_of(pbs::BindConstraint<double>{0, 0.3, 0.7}, q, p).step;
        const double of_bone = std::sqrt(3.0) * rounding_error(1, q.cwiseAbs().maxCoeff());
        EXPECT_LT((given + taken).norm(), bone / vertex * given.norm() + of_bone / bone + 2.0 * of_vertex / vertex);
        // The cross product of what is parallel goes through five roundings.
        EXPECT_LT((bound - p).cross(q - p).norm(), (of_vertex + rounding_error(5, (bound - p).norm())) * (q - p).norm());
        EXPECT_GT(given.norm(), 1e-3) << trial;
    }
}

}  // namespace
