// Reference: Algorithm 1's fixed points and limits by theory; outcomes by definition.
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/step_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Outcome;
using pbs::PbsOptions;
using pbs::PbsSolver;
using pbs::Positions;
using pbs::StepSummary;
using pbs::Vec3;
using test_support::rounding_error_in;
using test_support::TwoBoneLimb;

const TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);
const TwoBoneLimb straight = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 0.0);

PbsOptions in_double()
{
    PbsOptions options;
    options.precision = pbs::Precision::f64;
    return options;
}

Positions stepped(const TwoBoneLimb& limb, const PbsOptions& options)
{
    PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
    EXPECT_EQ(solver.advance(limb.lbs, limb.bind_points, 0.01).outcome, Outcome::finished);
    return solver.positions();
}

double volume_change(const TwoBoneLimb& limb, const Positions& positions)
{
    return (pbs::tet_volumes(positions, limb.mesh.tets) - pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets)).cwiseAbs().sum();
}

TEST(PbsSolver, RestPoseStaysAtRestExactly)
{
    ASSERT_EQ(straight.lbs, straight.mesh.rest);
    PbsOptions options = in_double();
    options.order = pbs::Order::plain;
    EXPECT_EQ(stepped(straight, options), straight.mesh.rest);
}

// Kernels may round a * b + c once where the rest data are rounded twice; each of 24 iterations may add a rounding of the 1 m half length.
TEST(PbsSolver, RestPoseStaysAtRestInEveryOrder)
{
    for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped}) {
        PbsOptions options = in_double();
        options.order = order;
        EXPECT_LT((stepped(straight, options) - straight.mesh.rest).cwiseAbs().maxCoeff(), rounding_error_in<double>(2 * 24, 1.0));
    }
}

TEST(PbsSolver, RestPoseStaysAtRestInFloat)
{
    // Positions and rest data are rounded to float, relative to the 1 m half length; each of 24 iterations may add a rounding.
    EXPECT_LT((stepped(straight, {}) - straight.mesh.rest).cwiseAbs().maxCoeff(), rounding_error_in<float>(24, 1.0));
}

TEST(PbsSolver, StartsAtTheRestPose)
{
    EXPECT_EQ(PbsSolver(bent.mesh, bent.binding.distance, {}, {}).positions(), bent.mesh.rest);
}

TEST(PbsSolver, ZeroIterationsLeaveTheLbsPositions)
{
    PbsOptions options = in_double();
    options.iterations = 0;
    EXPECT_EQ(stepped(bent, options), bent.lbs);
}

TEST(PbsSolver, ZeroStiffnessesLeaveTheLbsPositions)
{
    PbsOptions options = in_double();
    options.k_stretch = options.k_volume = options.k_bind = 0.0;
    EXPECT_EQ(stepped(bent, options), bent.lbs);
}

TEST(PbsSolver, ReducesTheVolumeErrorOfLbs)
{
    EXPECT_LT(volume_change(bent, stepped(bent, in_double())), 0.5 * volume_change(bent, bent.lbs));
}

// Volumes alone can all be satisfied (as in the rest pose), so their error has no floor and keeps falling with the iterations.
TEST(PbsSolver, VolumeAloneGoesOnConverging)
{
    PbsOptions options = in_double();
    options.k_stretch = options.k_bind = 0.0;
    double previous = volume_change(bent, bent.lbs);
    for (const int iterations : {100, 500, 2500}) {
        options.iterations = iterations;
        const double change = volume_change(bent, stepped(bent, options));
        EXPECT_LT(change, previous / 3.0) << iterations;
        previous = change;
    }
}

TEST(PbsSolver, BindAloneIsExactAfterOneIteration)
{
    PbsOptions options = in_double();
    options.k_stretch = options.k_volume = 0.0;
    options.iterations = 1;
    const Positions positions = stepped(bent, options);
    for (int v = 0; v < positions.rows(); ++v) {  // the rounding of a projection, and four of the length
        const pbs::BindConstraint<double> bind{v, bent.binding.distance(v), 1.0};
        const Vec3 point = bent.bind_points.row(v);
        const double rounding_m = test_support::rounding_of<double>(bind, point, bent.lbs.row(v)).step;
        EXPECT_NEAR((positions.row(v).transpose() - point).norm(), bind.rest_distance,
                    rounding_m + rounding_error_in<double>(4, bind.rest_distance));
    }
}

TEST(PbsSolver, FloatAgreesWithDouble)
{
    EXPECT_LT((stepped(bent, {}) - stepped(bent, in_double())).cwiseAbs().maxCoeff(), test_support::step_rounding_m(bent, {}));
}

TEST(PbsSolver, FloatKeepsItsDigitsFarFromTheOrigin)
{
    const Vec3 far(1000.0, -2000.0, 500.0);  // the spacing of floats there is 1e-4 m
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, {});
    solver.advance(bent.lbs.rowwise() + far.transpose(), bent.bind_points.rowwise() + far.transpose(), 0.01);
    // Two steps in float; in double, three roundings of a coordinate where it is far.
    const double rounding_m = 2.0 * test_support::step_rounding_m(bent, {}) + rounding_error_in<double>(3, far.norm());
    EXPECT_LT(((solver.positions().rowwise() - far.transpose()) - stepped(bent, {})).cwiseAbs().maxCoeff(), rounding_m);
}

TEST(PbsSolver, NothingIsRememberedWhereNothingJiggles)
{
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, in_double());
    solver.advance(straight.lbs, straight.bind_points, 0.01);
    solver.advance(bent.lbs, bent.bind_points, 0.01);
    EXPECT_EQ(solver.positions(), stepped(bent, in_double()));
}

TEST(PbsSolver, RepeatsToTheBit)
{
    EXPECT_EQ(stepped(bent, {}), stepped(bent, {}));
}

TEST(PbsSolver, RecordsEachIteration)
{
    PbsOptions options = in_double();
    options.record_iterations = true;
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
    const StepSummary summary = solver.advance(bent.lbs, bent.bind_points, 0.01);
    ASSERT_EQ(summary.history.size(), 24u);
    EXPECT_EQ(summary.iterations, 24);
    EXPECT_LT(summary.history.back().volume_rms, summary.history.front().volume_rms);
    EXPECT_GT(summary.seconds, 0.0);
    EXPECT_EQ(solver.positions(), stepped(bent, in_double()));
}

// Reference: one bind constraint per vertex, one stretch constraint per edge, one volume constraint per tet, in each iteration.
TEST(PbsSolver, CountsItsProjections)
{
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(), vertices = bent.mesh.rest.rows();
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped}) {
        PbsOptions options = in_double();
        options.order = order;
        PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
        const pbs::WorkCounters expected{.tet_visits = 24 * tets, .projections = 24 * (vertices + edges + tets)};
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).work, expected);
    }
    PbsOptions options = in_double();
    options.stop_residual = 0.2;
    options.k_volume = 0.0;
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
    const StepSummary summary = solver.advance(bent.lbs, bent.bind_points, 0.01);
    EXPECT_EQ(summary.work, (pbs::WorkCounters{.projections = summary.iterations * (vertices + edges)}));
}

TEST(PbsSolver, StopsAtTheResidual)
{
    PbsOptions options = in_double();
    options.stop_residual = 0.2;
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
    const StepSummary summary = solver.advance(bent.lbs, bent.bind_points, 0.01);
    EXPECT_EQ(summary.outcome, Outcome::finished);
    EXPECT_LT(summary.iterations, 24);
    EXPECT_TRUE(summary.history.empty());
}

TEST(PbsSolver, SaysThatItDidNotConverge)
{
    PbsOptions options = in_double();
    options.stop_residual = 1e-12;
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
    const StepSummary summary = solver.advance(bent.lbs, bent.bind_points, 0.01);
    EXPECT_EQ(summary.outcome, Outcome::not_converged);
    EXPECT_EQ(summary.iterations, 24);
    EXPECT_STREQ(pbs::to_string(summary.outcome), "not_converged");
}

TEST(PbsSolver, SaysThatItIsNotFinite)
{
    Positions broken = bent.lbs;
    broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
    for (const pbs::Precision precision : {pbs::Precision::f32, pbs::Precision::f64}) {
        PbsOptions options;
        options.precision = precision;
        PbsSolver solver(bent.mesh, bent.binding.distance, {}, options);
        EXPECT_EQ(solver.advance(broken, bent.bind_points, 0.01).outcome, Outcome::not_finite);
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).outcome, Outcome::finished);  // it recovers in the next frame
    }
}

TEST(PbsSolver, RefusesWrongSizes)
{
    PbsSolver solver(bent.mesh, bent.binding.distance, {}, {});
    EXPECT_THROW(solver.advance(bent.lbs.topRows(3), bent.bind_points, 0.01), pbs::InputError);
    EXPECT_THROW(solver.advance(bent.lbs, bent.bind_points.topRows(3), 0.01), pbs::InputError);
}

// Reference: PbsSolver, one pose at a time. The two share their order of projection and their arithmetic, so the only difference is, with
// unequal masses, the rounding of k / (w1 + w2).

using pbs::Order;
using pbs::PosesSolver;
using pbs::Precision;

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
