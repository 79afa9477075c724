// Reference: Algorithm 1's fixed points and limits by theory; outcomes by definition.
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/step_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace pbs_solver_tests {
namespace {

using pbs::Outcome;
using pbs::PbsOptions;
using pbs::PbsSolver;
using pbs::Positions;
using pbs::StepSummary;
using pbs::Vec3;
using test_support::rounding_error_in;
using test_support::TwoBoneLimb;

const TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);

// One step in double with changed options.
template <typename Change>
test_support::Stepped stepped(Change change)
{
    PbsOptions options;
    options.precision = pbs::Precision::f64;
    change(options);
    return test_support::stepped(limb, options);
}

// Volumes alone can all be satisfied (as in the rest pose), so their error has no floor and keeps falling with the
// iterations.
TEST(PbsSolver, VolumeAloneGoesOnConverging)
{
    const auto change_after = [](int iterations) {
        const Positions after =
            stepped([&](PbsOptions& o) { o.k_stretch = o.k_bind = 0.0, o.iterations = iterations; }).positions;
        return (pbs::tet_volumes(after, limb.mesh.tets) - pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets))
            .cwiseAbs()
            .sum();
    };
    double previous = change_after(0);
    for (const int iterations : {100, 500, 2500}) {
        const double change = change_after(iterations);
        EXPECT_LT(change, previous / 3.0) << iterations;
        previous = change;
    }
}

TEST(PbsSolver, BindAloneIsExactAfterOneIteration)
{
    const Positions positions =
        stepped([](PbsOptions& o) { o.k_stretch = o.k_volume = 0.0, o.iterations = 1; }).positions;
    for (int v = 0; v < positions.rows(); ++v) {  // the rounding of a projection, and four of the length
        const pbs::BindConstraint<double> bind{v, limb.binding.distance(v), 1.0};
        const Vec3 point = limb.bind_points.row(v);
        const double rounding_m = test_support::rounding_of<double>(bind, point, limb.lbs.row(v)).step;
        EXPECT_NEAR((positions.row(v).transpose() - point).norm(), bind.rest_distance,
                    rounding_m + rounding_error_in<double>(4, bind.rest_distance));
    }
}

TEST(PbsSolver, RecordsEachIteration)
{
    const auto [summary, positions] = stepped([](PbsOptions& o) { o.record_iterations = true; });
    ASSERT_EQ(summary.history.size(), 24u);
    EXPECT_EQ(summary.iterations, 24);
    EXPECT_LT(summary.history.back().volume_rms, summary.history.front().volume_rms);
    EXPECT_GT(summary.seconds, 0.0);
    EXPECT_EQ(positions, stepped([](PbsOptions&) {}).positions);
}

TEST(PbsSolver, StopsAtTheResidualOrSaysThatItDidNotConverge)
{
    const StepSummary summary = stepped([](PbsOptions& o) { o.stop_residual = 0.2; }).summary;
    EXPECT_EQ(summary.outcome, Outcome::finished);
    EXPECT_LT(summary.iterations, 24);
    EXPECT_TRUE(summary.history.empty());
    const StepSummary edges_alone = stepped([](PbsOptions& o) { o.stop_residual = 0.2, o.k_volume = 0.0; }).summary;
    const Eigen::Index projections = limb.mesh.rest.rows() + pbs::edges_of(limb.mesh.tets).rows();
    EXPECT_EQ(edges_alone.work, (pbs::WorkCounters{.projections = edges_alone.iterations * projections}));
    const StepSummary unreached = stepped([](PbsOptions& o) { o.stop_residual = 1e-12; }).summary;
    EXPECT_EQ(unreached.outcome, Outcome::not_converged);
    EXPECT_EQ(unreached.iterations, 24);
    EXPECT_STREQ(pbs::to_string(unreached.outcome), "not_converged");
}

TEST(PbsSolver, RefusesWrongSizes)
{
    PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    EXPECT_THROW(solver.advance(limb.lbs.topRows(3), limb.bind_points, 0.01), pbs::InputError);
    EXPECT_THROW(solver.advance(limb.lbs, limb.bind_points.topRows(3), 0.01), pbs::InputError);
}

// Reference: PbsSolver, one pose at a time. The two share their order of projection and their arithmetic, so the only
// difference is, with unequal masses, the rounding of k / (w1 + w2).

using pbs::Order;
using pbs::PosesSolver;
using pbs::Precision;

Positions alone(const PbsOptions& options, const Positions& lbs, int steps = 1, const std::vector<bool>& zone = {},
                const std::vector<bool>& held = {})
{
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, zone, options, held);
    for (int step = 0; step < steps; ++step) solver.advance(lbs, limb.bind_points, 0.01);
    return solver.positions();
}

class Poses : public testing::TestWithParam<std::tuple<Order, Precision>> {
protected:
    Poses() { std::tie(base.order, base.precision) = GetParam(); }

    PbsOptions base;
};

// Twenty poses: more than a block, with the last one not full.
TEST_P(Poses, OfManyParametersEqualEachAloneToTheBit)
{
    std::vector<PbsOptions> options(20, base);
    for (int i = 0; i < 20; ++i) {
        options[i].iterations = 2 * i;
        options[i].k_stretch = 0.05 * i;
        options[i].k_volume = 1.0 - 0.03 * i;
    }
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
    for (const pbs::StepSummary& step : solver.advance({limb.lbs}, {limb.bind_points}, 0.01))
        EXPECT_EQ(step.work, work);
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
    const double rounding = f32 ? test_support::rounding_error_in<float>(24 * 20, 1.0)
                                : test_support::rounding_error_in<double>(24 * 20, 1.0);
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
                         testing::Combine(testing::Values(Order::ordered),
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
    const auto build = [](void (*change)(PbsOptions&)) {
        std::vector<PbsOptions> options(2);
        change(options[1]);
        PosesSolver(limb.mesh, limb.binding.distance, {}, options);
    };
    using Change = void (*)(PbsOptions&);
    const Change refused[] = {[](PbsOptions& o) { o.order = Order::plain; },
                              [](PbsOptions& o) { o.precision = Precision::f64; },
                              [](PbsOptions& o) { o.masses = pbs::Masses::lumped; },
                              [](PbsOptions& o) { o.jiggle = pbs::Jiggle{}; },
                              [](PbsOptions& o) { o.stop_residual = 1e-3; },
                              [](PbsOptions& o) { o.sleep = true; },
                              [](PbsOptions& o) { o.class_order = pbs::ClassOrder::volume_stretch_bind; },
                              [](PbsOptions& o) { o.lbs_entry = pbs::LbsEntry::increment; },
                              [](PbsOptions& o) { o.bind_on_bone = pbs::BindOnBone::unbound; },
                              [](PbsOptions& o) { o.bind_to = pbs::BindTo::blended_position; },
                              [](PbsOptions& o) { o.volume_of = pbs::VolumeOf::regions; },
                              [](PbsOptions& o) { o.k_stretch_length_m = 0.1; },
                              [](PbsOptions& o) { o.k_volume = 2.0; }};
    EXPECT_NO_THROW(build([](PbsOptions& o) { o.k_bind = 0.0; }));
    for (const Change& change : refused) EXPECT_THROW(build(change), pbs::InputError) << &change - refused;
    EXPECT_THROW(PosesSolver(limb.mesh, limb.binding.distance, {}, {}), pbs::InputError);
    PosesSolver solver(limb.mesh, limb.binding.distance, {}, {3, PbsOptions{}});
    EXPECT_THROW(solver.advance({limb.lbs, limb.lbs}, {limb.bind_points}, 0.01), pbs::InputError);
    EXPECT_THROW(solver.advance({limb.mesh.rest.topRows(3)}, {limb.bind_points}, 0.01), pbs::InputError);
}

}  // namespace
}  // namespace pbs_solver_tests
