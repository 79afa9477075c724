// Reference: lines 6-9 and 15-18 of Algorithm 1, free fall, and both readings of the point at which LBS enters.
#include "pbs/solver/particles.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Particles;
using pbs::Positions;

constexpr double dt_s = 0.01;
const Positions rest = (Positions(2, 3) << 0, 0, 0, 1, 0, 0).finished();

Positions moved_by(const pbs::Vec3& by)
{
    return rest.rowwise() + by.transpose();
}

pbs::PbsOptions by_increment(const pbs::Vec3& gravity_m_s2 = pbs::Vec3::Zero())
{
    pbs::PbsOptions options;
    options.lbs_entry = pbs::LbsEntry::increment;
    options.gravity_m_s2 = gravity_m_s2;
    return options;
}

TEST(Particles, StartAtTheirLbsPositionWhateverWasBefore)
{
    Particles particles(rest, {}, {});
    for (const double x : {0.3, -0.2}) {
        particles.predict(moved_by({x, 0, 0}), dt_s);
        EXPECT_EQ(particles.predicted(), moved_by({x, 0, 0}));
        particles.predicted().setConstant(7.0);
        particles.update(dt_s);
    }
}

TEST(Particles, ByIncrementFollowLbsWithoutGainingSpeed)
{
    Particles particles(rest, {}, by_increment());
    for (int step = 0; step < 4; ++step) {
        particles.predict(moved_by({0.25 * step, 0, 0}), dt_s);  // exact in binary
        EXPECT_EQ(particles.predicted(), moved_by({0.25 * step, 0, 0}));
        particles.update(dt_s);
        EXPECT_EQ(particles.velocities(), Positions::Zero(2, 3));
    }
}

TEST(Particles, ByIncrementKeepWhatProjectionsMadeOfThem)
{
    Particles particles(rest, {}, by_increment());
    particles.predict(rest, dt_s);
    particles.predicted().row(0) += Eigen::RowVector3d(0, 0.5, 0);
    particles.update(dt_s);
    particles.predict(moved_by({0.25, 0, 0}), dt_s);
    EXPECT_EQ(particles.predicted()(0, 0), 0.25);
    EXPECT_DOUBLE_EQ(particles.predicted()(0, 1), 0.5 + 0.5);  // and the same distance again due to its velocity
    EXPECT_EQ(particles.predicted().row(1), moved_by({0.25, 0, 0}).row(1));
}

// n steps of v += g dt, x += v dt: g dt^2 n (n + 1) / 2. Each step goes through six roundings, which the velocity
// repeats in every later one.
TEST(Particles, ByIncrementFallUnderGravity)
{
    Particles particles(rest, {}, by_increment({0, -9.81, 0}));
    for (int step = 1; step <= 10; ++step) {
        particles.predict(rest, dt_s);
        particles.update(dt_s);
        const double times = step * (step + 1) / 2.0, fall = 9.81 * dt_s * dt_s * times;
        EXPECT_NEAR(particles.positions()(1, 1), -fall, test_support::rounding_error(6 * times + 6, fall));
    }
}

}  // namespace
