// Scenes as the combination of a file, --set and the defaults. Reference: the contract of scene files
// (experiments/scene/manual.md) and the options' own defaults.

#include "experiments/characters/model_character.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

const std::string motion = "[motion]\njoint = \"forearm\"\nangle_deg = 90\n";
// these keys have no default
const std::string stated = "[pbs]\nk_stretch = 0.2\nk_volume = 1.0\nk_bind = 1.0\ngravity_m_s2 = [0.0, 0.0, 0.0]\n";
const std::string smallest = "schema = 1\n[character]\nbody = \"limb\"\n" + motion + stated;

template <typename Options>
void expect_defaults(const std::string& deformers)
{
    const test_support::ScratchFolder folder;
    const auto read = read_scene(folder.file("scene.toml", smallest + deformers), {}).deformers.at(0);
    DeformerSpec untouched = read;
    untouched.options = Options{};  // `stated` has the same values where the scene has no default
    EXPECT_EQ(to_json(read), to_json(untouched));
}

TEST(Scene, DefaultsAreThoseOfTheOptions)
{
    expect_defaults<pbs::PbsOptions>("[deformers]\nuse = [\"pbs\"]\n");
    expect_defaults<FemOptions>("[deformers]\nuse = [\"fem\"]\n[[fem]]\n");
    EXPECT_EQ(experiments::scene_schema().find("motion.rate_hz")->default_json, "100.0");
}

TEST(Scene, EveryBuiltInSceneReads)
{
    for (const auto& scene : built_in_scenes()) {
        const Scene read = read_scene(scene.name, {});
        EXPECT_EQ(read.name, scene.name);
        EXPECT_FALSE(read.reference.empty());
        EXPECT_GE(read.deformers.size(), 4u);
    }
}

TEST(Scene, ReferencesKeepTheirOwnOptions)
{
    const Scene scene = read_scene("limb_twist", {"fem.1.poisson=0.3", "fem.young_pa=2e4"});
    ASSERT_EQ(scene.deformers[3].name, "fem_p1");
    EXPECT_EQ(options_of<FemOptions>(scene.deformers[3]).element_order, 1);
    EXPECT_EQ(options_of<FemOptions>(scene.deformers[4]).element_order, 2);
    EXPECT_DOUBLE_EQ(options_of<FemOptions>(scene.deformers[3]).poisson, 0.45);
    EXPECT_DOUBLE_EQ(options_of<FemOptions>(scene.deformers[4]).poisson, 0.3);
    EXPECT_DOUBLE_EQ(options_of<FemOptions>(scene.deformers[3]).young_pa, 2e4)
        << "a key of a list without an index is that of its first table";
}

TEST(Scene, OverridesWinOverTheFileAndABareWordIsAText)
{
    const Scene scene = read_scene(
        "limb_twist", {"pbs.iterations=96", "pbs.k_stretch=0.05", "deformers.use=[\"pbs\"]", "reference.name=\"\""});
    EXPECT_EQ(scene.deformers.size(), 1u);
    EXPECT_EQ(options_of<pbs::PbsOptions>(scene.deformers[0]).iterations, 96);
    EXPECT_DOUBLE_EQ(options_of<pbs::PbsOptions>(scene.deformers[0]).k_stretch, 0.05);
    EXPECT_EQ(options_of<pbs::PbsOptions>(read_scene("limb_twist", {"pbs.precision=f64"}).deformers[2]).precision,
              pbs::Precision::f64);
}

TEST(Scene, JiggleIsOffUnlessItsTableIsThere)
{
    EXPECT_FALSE(options_of<pbs::PbsOptions>(read_scene("limb_twist", {}).deformers[2]).jiggle);
    const auto jiggle =
        options_of<pbs::PbsOptions>(read_scene("limb_twist", {"pbs.jiggle.k_stretch=0.9"}).deformers[2]).jiggle;
    ASSERT_TRUE(jiggle);
    EXPECT_DOUBLE_EQ(jiggle->k_stretch, 0.9);
}

TEST(Scene, PathsAreRelativeToTheFile)
{
    const test_support::ScratchFolder folder;
    const std::string files =
        "schema = 1\n[character]\nmesh = \"meshes/arm.msh\"\nskeleton = \"/rigs/arm.skeleton.toml\"\n";
    const Scene scene = read_scene(folder.file("arm.toml", files + motion + stated), {"skinning.weights=weights.csv"});
    EXPECT_EQ(scene.character.mesh_file, folder / "meshes/arm.msh");
    EXPECT_EQ(scene.character.skeleton_file, "/rigs/arm.skeleton.toml");
    EXPECT_EQ(scene.character.weights_file, folder / "weights.csv");
}

// Rules that a TOML file of bad inputs (tests/support/bad_scenes.toml) cannot break.
TEST(Scene, NamesThatAreNotUtf8AndKeysWithASpaceAreRefused)
{
    const test_support::ScratchFolder folder;
    const auto refusal = [&](const std::string& file, const std::vector<std::string>& overrides) {
        return test_support::refusal_of([&] { read_scene(folder.file(file, smallest + "[[fem]]\n"), overrides); });
    };
    EXPECT_EQ(refusal("limb.toml", {"character.mesh=li\xffmb.msh"}),
              "--set: character.mesh = li\\xffmb.msh: expected UTF-8");
    EXPECT_EQ(refusal("li\xffmb.toml", {}),
              folder / "li\\xffmb.toml: expected a file's name in UTF-8: it names the scene in all records");
    EXPECT_TRUE(refusal("limb.toml", {"fem. 0.poisson=0.3"}).starts_with("--set: fem. 0.poisson = 0.3: unknown key"));
}

TEST(Scene, WithoutATimeStepItDividesAFrameOfTheClip)
{
    const test_support::ScratchFolder folder;
    const std::string clip =
        "schema = 1\n[character]\nbody = \"human\"\n[motion]\nclip = \"01_01.bvh\"\nrate_hz = 30.0\n";
    EXPECT_DOUBLE_EQ(read_scene(folder.file("clip.toml", clip + stated), {}).motion.time_step_s, 1.0 / 120.0);
}

TEST(Scene, ReadsRefinementAndErrorBar)
{
    EXPECT_EQ(read_scene("limb_twist", {}).character.refinements, 0);
    EXPECT_EQ(read_scene("limb_twist", {}).error_bar, ErrorBar::none);
    const Scene scene = read_scene("limb_twist", {"character.refine=2", "reference.error_bar=both"});
    EXPECT_EQ(scene.character.refinements, 2);
    EXPECT_EQ(scene.error_bar, ErrorBar::both);
}

TEST(Scene, OutputNamesFrames)
{
    OutputSpec output;
    output.frames_every = 0;
    output.frames = {7};
    EXPECT_FALSE(output.writes(0));
    EXPECT_TRUE(output.writes(7));
    output.frames_every = 3;
    EXPECT_TRUE(output.writes(0));
    EXPECT_FALSE(output.writes(4));
}

TEST(Scene, EveryKeyIsDocumented)
{
    for (const auto& key : scene_schema().keys) {
        EXPECT_FALSE(key.meaning.empty()) << key.path();
        EXPECT_FALSE(key.rule().empty()) << key.path();
    }
}

// The motion of a scene with its remarks. Reference: clips and a model written here, whose joints and angles are known.

// A BVH chain of these joints; each turns by 30 degrees per frame about z, in three frames after a first one at rest.
std::string chain(const std::vector<std::string>& names)
{
    std::string text = "HIERARCHY\n", end, rows;
    for (const std::string& name : names) {
        const bool is_root = name == names.front();
        text += std::string(is_root ? "ROOT " : "JOINT ") + name + "\n{\nOFFSET " + (is_root ? "-1" : "1") +
                " 0 0\nCHANNELS " + (is_root ? "6 Xposition Yposition Zposition " : "3 ") +
                "Zrotation Xrotation Yrotation\n";
        end += "}\n";
    }
    for (const int angle_deg : {0, 0, 30, 60}) {
        rows += "-1 0 0";
        for (std::size_t joint = 0; joint < names.size(); ++joint) rows += " " + std::to_string(angle_deg) + " 0 0";
        rows += "\n";
    }
    return text + "End Site\n{\nOFFSET 1 0 0\n}\n" + end + "MOTION\nFrames: 4\nFrame Time: 0.01\n" + rows;
}

class MotionCase : public testing::Test {
protected:
    MotionCase() : character(test_support::bar_character({4, 1, 1})) {}

    CaseMotion made(const MotionSpec& spec) const { return make_case_motion(spec, character, "scene.toml"); }

    MotionSpec clip(const std::vector<std::string>& names) const
    {
        MotionSpec spec;
        spec.clip = folder.file("walk.bvh", chain(names));
        return spec;
    }

    pbs::Character character;
    test_support::ScratchFolder folder;
};

TEST_F(MotionCase, ASweepTurnsItsJointAndOneInWhichNothingTurnsIsRemarkedOn)
{
    MotionSpec sweep;
    sweep.joint = "forearm";
    sweep.angle_deg = 60.0;
    sweep.frames = 3;
    const CaseMotion motion = made(sweep);
    EXPECT_NEAR(motion.largest_rotation_deg, 60.0, 1e-10);
    EXPECT_EQ(motion.motion.frames(), 3);
    EXPECT_EQ(motion.time_zero, "rest pose, where the motion begins");
    EXPECT_TRUE(motion.remarks.empty());
    sweep.angle_deg = 0.05;
    sweep.frames = 2;  // about the axis of the bone
    EXPECT_EQ(
        made(sweep).remarks,
        (pbs::RemarkList{
            {pbs::Gravity::results_wrong,
             "scene.toml: no joint moves: the bones turn by at most 0.05 degrees and move by at most 0 % of the body's "
             "size"}}));
    sweep.angle_deg = 0.2;
    EXPECT_TRUE(made(sweep).remarks.empty());
    sweep.joint = "tail";
    expect_input_error([&] { made(sweep); }, "scene.toml: motion.joint = tail: ", "expected one of upper, forearm");
}

TEST_F(MotionCase, AClipWhoseJointsAllMatch)
{
    const CaseMotion motion = made(clip({"upper", "forearm"}));
    EXPECT_EQ(motion.clip_joints, 2);
    EXPECT_EQ(motion.matched_joints, 2);
    EXPECT_TRUE(motion.remarks.empty());
    // the forearm follows both joints; BVH's numbers are single precision
    EXPECT_NEAR(motion.largest_rotation_deg, 120.0, 1e-3);
}

TEST_F(MotionCase, AClipThatMatchesLessThanHalfIsRefusedUnlessItIsAllowed)
{
    MotionSpec walk = clip({"upper", "forearm", "a", "b", "c", "d", "e", "f", "g", "h"});
    expect_input_error([&] { made(walk); }, walk.clip + ": joints = 2 of 10 moving joints: ",
                       "expected at least one half to match a bone of the character: rename the joints as the bones or "
                       "as those of Mixamo "
                       "(motion.allow_partial = true in the scene, or --allow-partial of `pbskin try`, accepts fewer); "
                       "without a bone: a, "
                       "b, c, d, e, f and 2 others");
    walk.allow_partial = true;
    EXPECT_EQ(made(walk).matched_joints, 2);
    walk = clip({"upper", "forearm", "a", "b", "c"});
    expect_input_error([&] { made(walk); }, walk.clip + ": joints = 2 of 5 moving joints: ", "without a bone: a, b, c");
    walk.allow_partial = true;
    EXPECT_EQ(made(walk).matched_joints, 2);
    EXPECT_EQ(made(clip({"upper", "forearm", "a", "b"})).matched_joints, 2);  // one half is enough
    walk = clip({"upper", "a"});
    EXPECT_EQ(made(walk).remarks,
              (pbs::RemarkList{{pbs::Gravity::part_left_out,
                                walk.clip + ": 1 of 2 moving joints of the clip match a bone; without a bone: "
                                            "a; bones without a motion of their own: forearm"}}));
}

// The elbow is 2 m from the root in the file, and moved to another distance within a second.
TEST_F(MotionCase, BonesThatMoveApartAreNamedWithTheirFrame)
{
    MotionSpec spec;
    spec.of_model = true;
    spec.rate_hz = 10.0;
    for (const auto& [distance_m, change_pct] : {std::pair(3.2f, 60.0), {1.2f, -40.0}, {2.16f, 0.0}}) {
        test_support::GltfDocument gltf = test_support::two_joint_document();
        const int ways = gltf.put<float>("VEC3", {0, 2, 0, 0, distance_m, 0});
        gltf.json["animations"][0]["samplers"][0]["output"] = ways;
        gltf.json["animations"][0]["channels"][0]["target"]["path"] = "translation";
        character.artist = pbs::ArtistSkin{{}, pbs::read_model(folder.file("slime.gltf", gltf.text()), "", 1.0)};
        const CaseMotion motion = made(spec);
        ASSERT_EQ(motion.stretched.size(), change_pct != 0.0) << distance_m;
        if (motion.stretched.empty()) continue;
        EXPECT_EQ(motion.stretched[0].bone, "elbow");
        EXPECT_EQ(motion.stretched[0].frame, 10) << "the last one";
        EXPECT_NEAR(motion.stretched[0].change_pct, change_pct, 1e-4);  // glTF's numbers are single precision
        EXPECT_EQ(motion.remarks.at(0).gravity, pbs::Gravity::comparison_wrong);
        const std::string words = change_pct > 0.0 ? "elbow by +60 % in frame 10; " : "elbow by -40 % in frame 10; ";
        EXPECT_NE(motion.remarks[0].text.find(words), std::string::npos) << motion.remarks[0].text;
    }
}

TEST_F(MotionCase, AnAnimationOfTheModelAndARefusalOfAModelWithoutOne)
{
    const auto model = pbs::read_model(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}), "Bend", 1.0);
    character.artist = pbs::ArtistSkin{{}, model};
    MotionSpec spec;
    spec.of_model = true;
    spec.rate_hz = 10.0;
    spec.start_s = 0.5;
    EXPECT_EQ(made(spec).time_zero_s, 0.5);  // the animation begins at 0 s
    spec.start_s = 0.0;
    const CaseMotion motion = made(spec);
    EXPECT_NEAR(motion.largest_rotation_deg, 90.0, 1e-3);  // glTF's numbers are single precision
    EXPECT_EQ(motion.motion.frames(), 21);
    EXPECT_EQ(motion.clip_joints, 0);
    EXPECT_TRUE(motion.remarks.empty());

    const auto bare = pbs::read_model(test_support::write_rigged_gltf(folder, "bare.gltf", {}), "", 1.0);
    character.artist = pbs::ArtistSkin{{}, bare};
    expect_input_error([&] { made(spec); },
                       "scene.toml: motion.animation: ", "the model has no animation: expected a joint or a clip");
}

}  // namespace
