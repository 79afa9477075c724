// Reference: the registered deformer, which is the paper's own reading, and the functions that a reading names.
#include "experiments/studies/ambiguity/read_motion.hpp"

#include "experiments/deformers/registry.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::ReadDeformer;
using experiments::Reading;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(limb);

Reading own()
{
    return {.place = "", .name = "own", .baseline = "own", .options = {}};
}

pbs::Positions posed_by(const Reading& reading)
{
    ReadDeformer deformer(reading);
    deformer.reset(character);
    deformer.advance(limb.pose, 0.01);
    return deformer.positions();
}

TEST(ReadDeformer, OfThePapersReadingIsTheRegisteredOne)
{
    const auto registered = experiments::make_deformer(experiments::default_spec("pbs"));
    registered->reset(character);
    registered->advance(limb.pose, 0.01);
    EXPECT_EQ(posed_by(own()), registered->positions());
}

TEST(ReadDeformer, TakesTheReadingsWeightsAndBindPoints)
{
    Reading either = own(), anew = own();
    either.blended_bones = experiments::BlendedBones::either_end;
    anew.bind_point = experiments::BindPoint::reprojected;
    EXPECT_NE(posed_by(either), posed_by(own()));
    EXPECT_NE(posed_by(anew), posed_by(own()));
    EXPECT_EQ(experiments::bind_points_of(character, own(), limb.pose, limb.mesh.rest), pbs::posed_bind_points(limb.binding, limb.pose));
}

TEST(ReadDeformer, HasMemoryWhereParticlesAreIntegrated)
{
    Reading jiggling = own(), increment = own();
    jiggling.options.jiggle = pbs::Jiggle{};
    increment.options.lbs_entry = pbs::LbsEntry::increment;
    EXPECT_FALSE(ReadDeformer(own()).has_memory());
    EXPECT_TRUE(ReadDeformer(jiggling).has_memory());
    EXPECT_TRUE(ReadDeformer(increment).has_memory());
}

}  // namespace
