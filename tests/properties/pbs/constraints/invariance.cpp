// Reference: a projection depends only on lengths and volumes, so it commutes with rigid motions, renumbering, mirrors and changes of unit.
// Tolerances: the rounding of two projections, and that of the moved input, which a projection amplifies (projection_rounding.hpp).
#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "tests/support/motion_rounding.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace test_support;
using pbs::BindConstraint;
using pbs::StretchConstraint;
using pbs::Vec3;
using pbs::VolumeConstraint;

const CornerMasses<double> masses = {1.0, 2.0, 0.5, 3.0};
const VolumeConstraint<double> tet{{0, 1, 2, 3}, 0.3, 0.8};
const StretchConstraint<double> rod{{0, 1}, 0.3, 0.8};
const BindConstraint<double> tether{0, 0.3, 0.8};

// Two projections of which each adds `bound.step` to a vertex, where the input of one of them is in error by `of_input`.
double two_steps(const RoundingBound& bound, double of_input = 0.0)
{
    return 2.0 * bound.step + bound.growth * of_input;
}

// Four corners, as `distance` below compares them.
double tet_rounding(const Corners<double>& p)
{
    return 2.0 * two_steps(rounding_of(tet, masses, p));
}

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
        const Corners<double> p = noisy_corner(random, 0.4), there = mapped(move, p);
        const double of_motion = motion_error(1, stacked(there).cwiseAbs().maxCoeff() + std::sqrt(3.0));
        // The motion rounds the input of one side and the output of the other.
        const auto rounding = [&](const RoundingBound& bound) { return two_steps(bound, of_motion) + of_motion; };
        EXPECT_LT(distance(projected(tet, masses, there), mapped(move, projected(tet, masses, p))),
                  2.0 * rounding(rounding_of(tet, masses, there)));

        Vec3 p1 = p[0], p2 = p[1], moved_1 = move(p[0]), moved_2 = move(p[1]);
        project(rod, 1.0, 2.0, p1, p2);
        project(rod, 1.0, 2.0, moved_1, moved_2);
        EXPECT_LT((move(p1) - moved_1).norm() + (move(p2) - moved_2).norm(),
                  2.0 * rounding(rounding_of(rod, 1.0, 2.0, there[0], there[1])));

        Vec3 bound = p[2], moved_bound = move(p[2]);
        project(tether, 1.0, p[3], bound);
        project(tether, 1.0, move(p[3]), moved_bound);
        EXPECT_LT((move(bound) - moved_bound).norm(), rounding(rounding_of(tether, there[3], there[2])));
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
            EXPECT_LT(distance(q, {expected[a], expected[b], expected[c], expected[d]}), tet_rounding(p));
        }
        Vec3 p1 = p[0], p2 = p[1], q1 = p[1], q2 = p[0];
        project(rod, 1.0, 2.0, p1, p2);
        project(rod, 2.0, 1.0, q1, q2);
        EXPECT_LT((p1 - q2).norm() + (p2 - q1).norm(), 2.0 * two_steps(rounding_of(rod, 1.0, 2.0, p[0], p[1])));
    }
}

TEST(ProjectionInvariance, MirrorTurnsTheOrientationRound)
{
    RandomPoints random(43);
    const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
    for (int trial = 0; trial < 50; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.4), m = mapped(mirror, p), expected = mapped(mirror, projected(tet, masses, p));
        const Corners<double> q = projected(tet, {masses[0], masses[2], masses[1], masses[3]}, {m[0], m[2], m[1], m[3]});
        EXPECT_LT(distance({q[0], q[2], q[1], q[3]}, expected), tet_rounding(p));
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
    // A coordinate is multiplied by the size and rounded to Scalar.
    const auto rounding = [](const RoundingBound& bound, double size) {
        return (2.0 * bound.step + bound.growth * std::sqrt(3.0) * rounding_error_in<Scalar>(2, 1.2 * size)) / size;
    };
    RandomPoints random(44);
    for (const double size : {1e-6, 1e-3, 1e-2, 1.0, 1e3, 1e6}) {
        const Corners<double> p = noisy_corner(random, 0.2), expected = projected(tet, masses, p);
        Corners<Scalar> q;
        for (int i = 0; i < 4; ++i) q[i] = (size * p[i]).cast<Scalar>();
        const VolumeConstraint<Scalar> scaled_tet{{0, 1, 2, 3}, Scalar(0.3 * size * size * size), Scalar(0.8)};
        const CornerMasses<Scalar> w = {Scalar(1), Scalar(2), Scalar(0.5), Scalar(3)};
        Corners<Scalar> moved = projected(scaled_tet, w, q);
        for (int i = 0; i < 4; ++i) {
            EXPECT_LT((moved[i].template cast<double>() / size - expected[i]).norm(), rounding(rounding_of(scaled_tet, w, q), size))
                << size;
            EXPECT_GT((moved[i] - q[i]).template cast<double>().norm() / size, 1e-3) << size;
        }
        Vec3 p1 = p[0], p2 = p[1];
        project(rod, 1.0, 1.0, p1, p2);
        const StretchConstraint<Scalar> scaled_rod{{0, 1}, Scalar(0.3 * size), Scalar(0.8)};
        const double of_rod = rounding(rounding_of(scaled_rod, Scalar(1), Scalar(1), q[0], q[1]), size);
        project(scaled_rod, Scalar(1), Scalar(1), q[0], q[1]);
        EXPECT_LT((q[1].template cast<double>() / size - p2).norm(), of_rod) << size;

        Vec3 bound = p[2];
        project(tether, 1.0, p[3], bound);
        const BindConstraint<Scalar> scaled_tether{0, Scalar(0.3 * size), Scalar(0.8)};
        const double of_tether = rounding(rounding_of(scaled_tether, Vector(q[3]), q[2]), size);
        project(scaled_tether, Scalar(1), Vector(q[3]), q[2]);
        EXPECT_LT((q[2].template cast<double>() / size - bound).norm(), of_tether) << size;
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
        const CornerMasses<Scalar> w = {unit, 2 * unit, unit / 2, 3 * unit};
        const Corners<Scalar> moved = projected(same_tet, w, q);
        const RoundingBound bound = rounding_of(same_tet, w, q);
        const double rounding = 2.0 * bound.step + bound.growth * std::sqrt(3.0) * rounding_error_in<Scalar>(1, 1.2);
        for (int i = 0; i < 4; ++i) EXPECT_LT((moved[i].template cast<double>() - expected[i]).norm(), rounding) << unit;
    }
}

}  // namespace
