// What LBS, DQS and both delta mushes promise beyond the contract of all deformers. Reference: the plain formulae, and
// the keys of scenes.
#include "experiments/deformers/registry.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

const char* const blends[] = {"lbs", "dqs", "delta_mush", "direct_delta_mush"};

const pbs::Character thin_bar = test_support::bar_character({12, 3, 3});
const pbs::Pose elbow = pbs::joint_sweep(thin_bar.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 2, 0.01).steps.back();

pbs::Positions posed(const DeformerSpec& spec, const pbs::Character& character)
{
    const std::unique_ptr<Deformer> deformer = make_deformer(spec);
    deformer->reset(character);
    EXPECT_EQ(deformer->advance(elbow, 0.01).outcome, pbs::Outcome::finished);
    return deformer->positions();
}

// The roundings of LBS, ten, are amplified by the rotations of the mushes, whose own bounds are tested with them. A
// hundred roundings of 1 m, 6e-6 m, are sufficient here; another formula in any part would differ by more, since the
// mesh of 2 m has edges of 0.1 m.
TEST(OwnPrecision, FloatsDifferByRounding)
{
    for (const char* kind : blends) {
        const DeformerSpec f64 = default_spec(kind);
        EXPECT_EQ(traits_of(f64).precision, "f64");
        DeformerSpec f32 = f64;
        if (auto* blend = std::any_cast<BlendOptions>(&f32.options)) blend->precision = pbs::Precision::f32;
        if (auto* mush = std::any_cast<pbs::DeltaMushOptions>(&f32.options))
            mush->precision = pbs::Precision::f32, mush->packed = true;
        if (auto* direct = std::any_cast<pbs::DirectDeltaMushOptions>(&f32.options))
            direct->precision = pbs::Precision::f32, direct->packed = true;
        EXPECT_EQ(traits_of(f32).precision, "f32") << kind;
        const pbs::Positions in_float = posed(f32, thin_bar), in_double = posed(f64, thin_bar);
        EXPECT_NE(in_float, in_double) << kind;
        EXPECT_LT((in_float - in_double).cwiseAbs().maxCoeff(), test_support::rounding_error_in<float>(100, 1.0))
            << kind;
    }
}

// The plain code blends the same sums in another order. See above for the bound.
TEST(OwnCode, ThePlainBlendDiffersFromThePackedOneByRounding)
{
    for (const char* kind : {"lbs", "dqs"}) {
        const DeformerSpec packed = default_spec(kind);
        DeformerSpec plain = packed;
        options_of<BlendOptions>(plain).packed = false;
        EXPECT_TRUE(traits_of(packed).packed) << kind;
        EXPECT_FALSE(traits_of(plain).packed) << kind;
        const pbs::Positions in_packed = posed(packed, thin_bar), in_plain = posed(plain, thin_bar);
        EXPECT_LT((in_packed - in_plain).cwiseAbs().maxCoeff(), test_support::rounding_error_in<double>(100, 1.0))
            << kind;
        const auto blended = kind == std::string("lbs") ? pbs::linear_blend_skinning : pbs::dual_quaternion_skinning;
        pbs::Positions expected;
        blended(thin_bar.mesh.rest, thin_bar.weights, elbow, expected);
        EXPECT_EQ(in_plain, expected) << kind;
    }
}

const std::string blended_scene = R"(schema = 1
[character]
body = "limb"
vertices = 400
[motion]
joint = "forearm"
angle_deg = 10
frames = 2
[deformers]
use = ["lbs", "lbs_smooth", "dqs_f32", "delta_mush", "direct_delta_mush"]
[[lbs]]
name = "lbs_smooth"
weights = "smooth"
[[dqs]]
name = "dqs_f32"
precision = "f32"
[delta_mush]
weights = "smooth"
precision = "f32"
[direct_delta_mush]
iterations = 3
kappa = 0.25
smoothing = "explicit"
)";

Scene scene_of_blends(const std::vector<std::string>& overrides = {})
{
    const test_support::ScratchFolder folder;
    return read_scene(folder.file("blends.toml", blended_scene), overrides);
}

TEST(OwnWeights, AreReadFromScenesWhichRefuseStepsThatContradictEachOther)
{
    const Scene scene = scene_of_blends();
    ASSERT_EQ(scene.deformers.size(), 5u);
    EXPECT_FALSE(scene.deformers[0].weights);
    EXPECT_EQ(scene.deformers[1].weights, pbs::WeightKind::smooth);
    EXPECT_EQ(scene.deformers[1].variant, "weights_smooth");
    EXPECT_FALSE(scene.deformers[2].weights);
    EXPECT_EQ(traits_of(scene.deformers[2]).precision, "f32");
    EXPECT_EQ(scene.deformers[3].weights, pbs::WeightKind::smooth);
    EXPECT_EQ(options_of<pbs::DeltaMushOptions>(scene.deformers[3]).precision, pbs::Precision::f32);
    EXPECT_TRUE(options_of<pbs::DeltaMushOptions>(scene.deformers[3]).packed) << "plain code has no f32";
    const auto& direct = options_of<pbs::DirectDeltaMushOptions>(scene.deformers[4]);
    EXPECT_EQ(direct.iterations, 3);
    EXPECT_EQ(direct.kappa, 0.25);
    EXPECT_EQ(direct.smoothing, pbs::MushSmoothing::explicit_steps);
    EXPECT_THROW(scene_of_blends({"direct_delta_mush.kappa=2"}), pbs::InputError);
    EXPECT_THROW(scene_of_blends({"direct_delta_mush.lambda=1.5"}), pbs::InputError);
    EXPECT_NO_THROW(scene_of_blends({"direct_delta_mush.lambda=1.5", "direct_delta_mush.smoothing=implicit"}));
}

}  // namespace
