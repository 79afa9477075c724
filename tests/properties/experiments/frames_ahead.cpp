// Reference: the same frames one by one. A deformer that computes several frames at once on several threads changes no bit.
#include "experiments/deformers/registry.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);

const pbs::Character character = test_support::character_of(limb);

// more than two batches for two threads, the last one not full
const std::vector<pbs::Pose> poses = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 90.0, 71, 0.01).steps;

std::vector<pbs::Positions> played(const pbs::PbsOptions& options, bool foreseen)
{
    experiments::DeformerSpec spec = experiments::default_spec("pbs");
    spec.options = options;
    spec.threads = options.threads;
    const auto deformer = experiments::make_deformer(spec);
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
    for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped})
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

// Deformers that depend on the previous frame, or are called frame by frame, do not work ahead; for them nothing changes either.
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

}  // namespace
