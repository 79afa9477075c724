// Reference: PbsSolver, one pose at a time. The two share their order of projection and their arithmetic, so the only difference is, with
// unequal masses, the rounding of k / (w1 + w2).
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Order;
using pbs::PbsOptions;
using pbs::PbsSolver;
using pbs::PosesSolver;
using pbs::Positions;
using pbs::Precision;
using pbs::Vec3;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);

PbsOptions with(Order order, Precision precision)
{
    PbsOptions options;
    options.order = order;
    options.precision = precision;
    return options;
}

// Twenty poses: more than a block, with the last one not full.
std::vector<PbsOptions> twenty(const PbsOptions& base)
{
    std::vector<PbsOptions> poses(20, base);
    for (int i = 0; i < 20; ++i) {
        poses[i].iterations = 2 * i;
        poses[i].k_stretch = 0.05 * i;
        poses[i].k_volume = 1.0 - 0.03 * i;
    }
    return poses;
}

Positions alone(const PbsOptions& options, const Positions& lbs, int steps = 1, const std::vector<bool>& zone = {},
                const std::vector<bool>& held = {})
{
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, zone, options, held);
    for (int step = 0; step < steps; ++step) solver.advance(lbs, limb.bind_points, 0.01);
    return solver.positions();
}

class Poses : public testing::TestWithParam<std::tuple<Order, Precision>> {
protected:
    PbsOptions base = with(std::get<0>(GetParam()), std::get<1>(GetParam()));
};

TEST_P(Poses, OfManyParametersEqualEachAloneToTheBit)
{
    const std::vector<PbsOptions> options = twenty(base);
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, options);
    solver.advance({limb.lbs}, {limb.bind_points}, 0.01);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(solver.positions(i), alone(options[i], limb.lbs)) << i;
}

TEST_P(Poses, CountTheWorkOfEachAlone)
{
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, {base, base});
    PbsSolver single(limb.mesh, limb.binding.distance, {}, base);
    const pbs::WorkCounters work = single.advance(limb.lbs, limb.bind_points, 0.01).work;
    EXPECT_GT(work.projections, work.tet_visits);
    for (const pbs::StepSummary& step : solver.advance({limb.lbs}, {limb.bind_points}, 0.01)) EXPECT_EQ(step.work, work);
}

TEST_P(Poses, OfManyFramesEqualEachAloneToTheBit)
{
    const std::vector<PbsOptions> options(3, base);
    std::vector<Positions> lbs(3, limb.lbs);
    lbs[1].array() += 100.0;
    lbs[2] = limb.mesh.rest;
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, options);
    solver.advance(lbs, {limb.bind_points}, 0.01);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(solver.positions(i), alone(options[i], lbs[i])) << i;
}

TEST_P(Poses, JiggleWithVelocitiesOfTheirOwn)
{
    std::vector<bool> zone(limb.mesh.rest.rows(), false);
    for (std::size_t i = zone.size() / 2; i < zone.size(); ++i) zone[i] = true;
    std::vector<PbsOptions> options(3, base);
    for (int i = 0; i < 3; ++i) {
        options[i].jiggle = pbs::Jiggle{0.1 + 0.3 * i};
        options[i].gravity_m_s2 = Vec3(0.0, -5.0 * i, 0.0);
    }
    PosesSolver solver(limb.mesh, limb.binding.distance, zone, options);
    for (int step = 0; step < 5; ++step) solver.advance({limb.lbs}, {limb.bind_points}, 0.01);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(solver.positions(i), alone(options[i], limb.lbs, 5, zone)) << i;
}

TEST_P(Poses, HeldVerticesAndUnequalMasses)
{
    base.masses = pbs::Masses::lumped;
    std::vector<bool> held(limb.mesh.rest.rows(), false);
    held[0] = held[7] = true;
    const std::vector<PbsOptions> options(2, base);
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, options, held);
    solver.advance({limb.lbs}, {limb.bind_points}, 0.01);
    const Positions expected = alone(base, limb.lbs, 1, {}, held);
    // Each of 24 iterations may add a rounding of the 1 m half length in each of the some 20 constraints at a vertex.
    const bool f32 = base.precision == Precision::f32;
    const double rounding =
        f32 ? test_support::rounding_error_in<float>(24 * 20, 1.0) : test_support::rounding_error_in<double>(24 * 20, 1.0);
    EXPECT_LT((solver.positions(1) - expected).cwiseAbs().maxCoeff(), rounding);
    EXPECT_EQ(solver.positions(1).row(7), expected.row(7));
}

TEST_P(Poses, ThreadsChangeNoBit)
{
    std::vector<PbsOptions> options(50, base);
    PosesSolver one(limb.mesh, limb.binding.distance, {}, options);
    options[0].threads = 4;
    PosesSolver four(limb.mesh, limb.binding.distance, {}, options);
    one.advance({limb.lbs}, {limb.bind_points}, 0.01);
    four.advance({limb.lbs}, {limb.bind_points}, 0.01);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(one.positions(i), four.positions(i)) << i;
}

INSTANTIATE_TEST_SUITE_P(Orders, Poses,
                         testing::Combine(testing::Values(Order::ordered, Order::grouped),
                                          testing::Values(Precision::f32, Precision::f64)));

TEST(PosesSolver, ANonFinitePoseSpoilsNoOther)
{
    std::vector<Positions> lbs(2, limb.lbs);
    lbs[0](3, 1) = std::nan("");
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, {2, PbsOptions{}});
    const auto summaries = solver.advance(lbs, {limb.bind_points}, 0.01);
    EXPECT_EQ(summaries[0].outcome, pbs::Outcome::not_finite);
    EXPECT_EQ(summaries[1].outcome, pbs::Outcome::finished);
    EXPECT_EQ(solver.positions(1), alone(PbsOptions{}, limb.lbs));
}

TEST(PosesSolver, RefusesWhatPosesCannotDifferIn)
{
    const auto build = [](auto change) {
        std::vector<PbsOptions> options(2);
        change(options[1]);
        PosesSolver(limb.mesh, limb.binding.distance, {}, options);
    };
    EXPECT_NO_THROW(build([](PbsOptions& o) { o.k_bind = 0.0; }));
    EXPECT_THROW(build([](PbsOptions& o) { o.order = Order::grouped; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.order = Order::plain; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.precision = Precision::f64; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.masses = pbs::Masses::lumped; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.jiggle = pbs::Jiggle{}; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.stop_residual = 1e-3; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.sleep = true; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.class_order = pbs::ClassOrder::volume_stretch_bind; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.lbs_entry = pbs::LbsEntry::increment; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.bind_on_bone = pbs::BindOnBone::unbound; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.bind_to = pbs::BindTo::blended_position; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.volume_of = pbs::VolumeOf::regions; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.k_stretch_length_m = 0.1; }), pbs::InputError);
    EXPECT_THROW(build([](PbsOptions& o) { o.k_volume = 2.0; }), pbs::InputError);
    EXPECT_THROW(PosesSolver(limb.mesh, limb.binding.distance, {}, {}), pbs::InputError);
}

TEST(PosesSolver, RefusesPosesOfAnotherNumber)
{
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, {3, PbsOptions{}});
    EXPECT_THROW(solver.advance({limb.lbs, limb.lbs}, {limb.bind_points}, 0.01), pbs::InputError);
    EXPECT_THROW(solver.advance({limb.mesh.rest.topRows(3)}, {limb.bind_points}, 0.01), pbs::InputError);
}

}  // namespace
