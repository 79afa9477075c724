// Reference: a projection depends only on lengths and volumes, so it commutes with rigid motions, renumbering, mirrors and changes of unit.
#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace test_support;
using pbs::BindConstraint;
using pbs::StretchConstraint;
using pbs::Vec3;
using pbs::VolumeConstraint;

constexpr double rounding = 1e-14;  // some tens of roundings of numbers of order one
const CornerMasses<double> masses = {1.0, 2.0, 0.5, 3.0};
const VolumeConstraint<double> tet{{0, 1, 2, 3}, 0.3, 0.8};
const StretchConstraint<double> rod{{0, 1}, 0.3, 0.8};
const BindConstraint<double> tether{0, 0.3, 0.8};

double distance(const Corners<double>& a, const Corners<double>& b)
{
    return (stacked(a) - stacked(b)).norm();
}

template <typename Map>
Corners<double> mapped(Map map, const Corners<double>& p)
{
    return {map(p[0]), map(p[1]), map(p[2]), map(p[3])};
}

TEST(ProjectionInvariance, RigidMotion)
{
    RandomPoints random(41);
    for (int trial = 0; trial < 50; ++trial) {
        const Eigen::Isometry3d motion = random.rigid_motion(1.0);
        const auto move = [&](const Vec3& p) -> Vec3 { return motion * p; };
        const Corners<double> p = noisy_corner(random, 0.4);
        EXPECT_LT(distance(projected(tet, masses, mapped(move, p)), mapped(move, projected(tet, masses, p))), rounding);

        Vec3 p1 = p[0], p2 = p[1], moved_1 = move(p[0]), moved_2 = move(p[1]);
        project(rod, 1.0, 2.0, p1, p2);
        project(rod, 1.0, 2.0, moved_1, moved_2);
        EXPECT_LT((move(p1) - moved_1).norm() + (move(p2) - moved_2).norm(), rounding);

        Vec3 bound = p[2], moved_bound = move(p[2]);
        project(tether, 1.0, p[3], bound);
        project(tether, 1.0, move(p[3]), moved_bound);
        EXPECT_LT((move(bound) - moved_bound).norm(), rounding);
    }
}

TEST(ProjectionInvariance, Permutation)
{
    RandomPoints random(42);
    const std::array<std::array<int, 4>, 3> even = {{{1, 2, 0, 3}, {1, 0, 3, 2}, {3, 1, 0, 2}}};
    for (int trial = 0; trial < 50; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.4), expected = projected(tet, masses, p);
        for (const auto& [a, b, c, d] : even) {
            const Corners<double> q = projected(tet, {masses[a], masses[b], masses[c], masses[d]}, {p[a], p[b], p[c], p[d]});
            EXPECT_LT(distance(q, {expected[a], expected[b], expected[c], expected[d]}), rounding);
        }
        Vec3 p1 = p[0], p2 = p[1], q1 = p[1], q2 = p[0];
        project(rod, 1.0, 2.0, p1, p2);
        project(rod, 2.0, 1.0, q1, q2);
        EXPECT_LT((p1 - q2).norm() + (p2 - q1).norm(), rounding);
    }
}

TEST(ProjectionInvariance, MirrorTurnsTheOrientationRound)
{
    RandomPoints random(43);
    const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
    for (int trial = 0; trial < 50; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.4), m = mapped(mirror, p), expected = mapped(mirror, projected(tet, masses, p));
        const Corners<double> q = projected(tet, {masses[0], masses[2], masses[1], masses[3]}, {m[0], m[2], m[1], m[3]});
        EXPECT_LT(distance({q[0], q[2], q[1], q[3]}, expected), rounding);
    }
}

// This detects an absolute threshold: one of 1e-6 would silently skip tets with edges of 0.01.
template <typename Scalar>
class ProjectionScale : public testing::Test {
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ProjectionScale, Precisions);

TYPED_TEST(ProjectionScale, FromAMicrometreToAThousandKilometres)
{
    using Scalar = TypeParam;
    using Vector = pbs::Vector3<Scalar>;
    const double few_roundings = 50.0 * std::numeric_limits<Scalar>::epsilon();
    RandomPoints random(44);
    for (const double size : {1e-6, 1e-3, 1e-2, 1.0, 1e3, 1e6}) {
        const Corners<double> p = noisy_corner(random, 0.2), expected = projected(tet, masses, p);
        Corners<Scalar> q;
        for (int i = 0; i < 4; ++i) q[i] = (size * p[i]).cast<Scalar>();
        const VolumeConstraint<Scalar> scaled_tet{{0, 1, 2, 3}, Scalar(0.3 * size * size * size), Scalar(0.8)};
        Corners<Scalar> moved = projected(scaled_tet, {Scalar(1), Scalar(2), Scalar(0.5), Scalar(3)}, q);
        for (int i = 0; i < 4; ++i) {
            EXPECT_LT((moved[i].template cast<double>() / size - expected[i]).norm(), few_roundings) << size;
            EXPECT_GT((moved[i] - q[i]).template cast<double>().norm() / size, 1e-3) << size;
        }
        Vec3 p1 = p[0], p2 = p[1];
        project(rod, 1.0, 1.0, p1, p2);
        project(StretchConstraint<Scalar>{{0, 1}, Scalar(0.3 * size), Scalar(0.8)}, Scalar(1), Scalar(1), q[0], q[1]);
        EXPECT_LT((q[1].template cast<double>() / size - p2).norm(), few_roundings) << size;

        Vec3 bound = p[2];
        project(tether, 1.0, p[3], bound);
        project(BindConstraint<Scalar>{0, Scalar(0.3 * size), Scalar(0.8)}, Scalar(1), Vector(q[3]), q[2]);
        EXPECT_LT((q[2].template cast<double>() / size - bound).norm(), few_roundings) << size;
    }
}

TYPED_TEST(ProjectionScale, OfTheMassesDoesNotMatter)
{
    using Scalar = TypeParam;
    RandomPoints random(45);
    const Corners<double> p = noisy_corner(random, 0.2), expected = projected(tet, masses, p);
    Corners<Scalar> q;
    for (int i = 0; i < 4; ++i) q[i] = p[i].cast<Scalar>();
    const VolumeConstraint<Scalar> same_tet{{0, 1, 2, 3}, Scalar(0.3), Scalar(0.8)};
    for (const Scalar unit : {Scalar(1e-6), Scalar(1), Scalar(1e6)}) {
        const Corners<Scalar> moved = projected(same_tet, {unit, 2 * unit, unit / 2, 3 * unit}, q);
        for (int i = 0; i < 4; ++i)
            EXPECT_LT((moved[i].template cast<double>() - expected[i]).norm(), 50.0 * std::numeric_limits<Scalar>::epsilon()) << unit;
    }
}

}  // namespace
