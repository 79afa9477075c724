// Ways of saving work. Reference: the same frames without them. A deformer that computes several frames at once on
// several threads changes no bit, and sleep on the human through a jump changes the pose by less than its tolerance.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/timing/timing.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

namespace {

using namespace experiments;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);

const pbs::Character character = test_support::character_of(limb);

// more than two batches for two threads, the last one not full
const std::vector<pbs::Pose> poses = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 90.0, 71, 0.01).steps;

std::vector<pbs::Positions> played(const pbs::PbsOptions& options, bool foreseen)
{
    DeformerSpec spec = default_spec("pbs");
    spec.options = options;
    spec.threads = options.threads;
    const auto deformer = make_deformer(spec);
    deformer->reset(character);
    if (foreseen) deformer->foresee(poses);
    std::vector<pbs::Positions> frames;
    for (const pbs::Pose& pose : poses) {
        EXPECT_EQ(deformer->advance(pose, 0.01).outcome, pbs::Outcome::finished);
        frames.push_back(deformer->positions());
    }
    return frames;
}

TEST(FramesAhead, AreThoseOfOneByOneToTheBit)
{
    for (const pbs::Order order : {pbs::Order::ordered})
        for (const pbs::Precision precision : {pbs::Precision::f32, pbs::Precision::f64}) {
            pbs::PbsOptions options;
            options.order = order;
            options.precision = precision;
            const auto one_by_one = played(options, true);
            options.threads = 2;
            EXPECT_EQ(played(options, true), one_by_one);
            EXPECT_EQ(played(options, false), one_by_one);
        }
}

// Deformers that depend on the previous frame, or are called frame by frame, do not work ahead; for them nothing
// changes either.
TEST(FramesAhead, LeaveOthersAlone)
{
    pbs::PbsOptions plain, sleeping, stopping, bound, of_regions, by_length;
    bound.bind_to = pbs::BindTo::blended_position;
    bound.k_bind = 0.1;
    of_regions.volume_of = pbs::VolumeOf::regions;
    by_length.k_stretch_length_m = 0.1;
    plain.order = pbs::Order::plain;
    sleeping.sleep = true;
    stopping.stop_residual = 0.2;
    for (pbs::PbsOptions options : {plain, sleeping, stopping, bound, of_regions, by_length}) {
        const auto one_by_one = played(options, false);
        options.threads = 2;
        EXPECT_EQ(played(options, true), one_by_one);
    }
}

const std::vector<std::string> jump = {"motion.start_s=1.5", "motion.duration_s=0.05"};

std::optional<Scene> human(const Variant& variant)
{
    try {
        return scene_of("human_01_01", jump, variant);
    } catch (const pbs::InputError&) {
        return std::nullopt;
    }
}

// A sleeping constraint is violated by at most the tolerance at the end of the frame. In each of the 24 iterations it
// would have moved a vertex by no more than that, in the worst case always in one direction.
TEST(SleepOnTheHuman, ChangesThePoseByLessThanItsTolerance)
{
    const auto awake = human({}), asleep = human({.overrides = {"pbs.sleep=true"}});
    if (!awake || !asleep) GTEST_SKIP() << "assimp-testmodels is not installed";
    const ResultChange change = change_between(*awake, *asleep);
    const double edge_m = test_support::mean_edge_m(pbs::make_character(awake->character).mesh);
    const pbs::PbsOptions& options = options_of<pbs::PbsOptions>(asleep->deformers.front());
    std::printf("largest change %.3g m, %.3g mean edges\n", change.distance_m, change.distance_m / edge_m);
    EXPECT_LT(change.distance_m, options.iterations * options.sleep_tolerance * edge_m);
    EXPECT_LT(change.volume_difference_pct, 0.05);  // a tenth of the bound of the claim
}

}  // namespace
