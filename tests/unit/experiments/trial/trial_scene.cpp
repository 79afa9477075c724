// The scene that is made of a model. Reference: the contract of scene files, by reading the scene again, and the options by hand.
#include "experiments/trial/trial.hpp"

#include "pbs/character/clip.hpp"
#include "pbs/character/model_character.hpp"
#include "tests/support/rigged_gltf.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace experiments;
namespace fs = std::filesystem;

// A chain of joints, each of which turns by 90 degrees in the second of three frames.
std::string write_clip(const test_support::ScratchFolder& folder, const std::vector<std::string>& joints)
{
    const std::string file = folder / "clip.bvh";
    std::ofstream out(file);
    std::string closing, rows[3];
    out << "HIERARCHY\n";
    for (const std::string& joint : joints) {
        out << (closing.empty() ? "ROOT " : "JOINT ") << joint << "\n{\nOFFSET 1 0 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n";
        closing += "}\n";
        for (int frame = 0; frame < 3; ++frame) rows[frame] += frame == 1 ? "90 0 0 " : "0 0 0 ";
    }
    out << "End Site\n{\nOFFSET 1 0 0\n}\n" << closing << "MOTION\nFrames: 3\nFrame Time: 0.1\n";
    for (const std::string& row : rows) out << row << "\n";
    return file;
}

class TrialSceneTest : public testing::Test {
protected:
    TrialOptions options_for(const std::string& file) const
    {
        TrialOptions options;
        options.model = file;
        options.folder = (folder.path() / "out").string();
        return options;
    }

    // The scene as `pbskin run` reads it.
    Scene read(const TrialOptions& options) const
    {
        fs::create_directories(options.folder);
        const std::string file = (fs::path(options.folder) / "scene.toml").string();
        std::ofstream(file) << trial_scene(options).text;
        return read_scene(file, {});
    }

    test_support::ScratchFolder folder;
};

TEST_F(TrialSceneTest, IsASceneOfTheModelAndItsFirstAnimation)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    options.frames = 11;
    options.vertices = 321;
    const Scene scene = read(options);
    EXPECT_TRUE(fs::equivalent(scene.character.model_file, options.model));
    EXPECT_EQ(scene.character.vertices, 321);
    EXPECT_EQ(scene.character.model_scale, 1.0);
    EXPECT_TRUE(scene.motion.of_model);
    EXPECT_EQ(scene.motion.animation, "Bend");
    EXPECT_DOUBLE_EQ(scene.motion.rate_hz, 5.0);  // 11 frames in two seconds
    std::vector<std::string> names;
    for (const DeformerSpec& spec : scene.deformers) names.push_back(spec.name);
    EXPECT_EQ(names, (std::vector<std::string>{"lbs", "dqs", "lbs_paper", "delta_mush", "pbs", "nh_p1"}));
    EXPECT_EQ(scene.reference, "nh_p1");
    EXPECT_TRUE(scene.output.writes(7));
    EXPECT_TRUE(trial_scene(options).remarks.empty());
}

TEST_F(TrialSceneTest, AShortMotionHasNoMoreFramesThanThirtyPerSecond)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}, 0.5f));
    EXPECT_EQ(read(options).motion.rate_hz, 30.0);
    options.frames = 2;
    EXPECT_EQ(read(options).motion.rate_hz, 2.0);
}

TEST_F(TrialSceneTest, TakesTheAnimationThatIsNamed)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend", "Wave"}));
    EXPECT_NE(trial_scene(options).remarks.at(0).find("it has 2 animations; Bend is taken"), std::string::npos);
    options.animation = "Wave";
    EXPECT_TRUE(trial_scene(options).remarks.empty());
    EXPECT_EQ(read(options).motion.animation, "Wave");
    options.animation = "Walk";
    expect_input_error([&] { trial_scene(options); }, options.model + ": animation = Walk: ", "expected one of Bend, Wave");
}

TEST_F(TrialSceneTest, AClipOfAnotherSkeletonIsRefusedBeforeThereAreTets)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    options.animation = write_clip(folder, {"a", "b"});
    expect_input_error([&] { trial_scene(options); }, options.animation + ": joints = a, b", "no joint has the name of a bone");
    options.animation = write_clip(folder, {"elbow", "a", "b"});
    expect_input_error([&] { trial_scene(options); }, options.animation + ": joints = 1 of 3 moving joints: ", "--allow-partial");
    options.allow_partial = true;
    EXPECT_NO_THROW(trial_scene(options));
    options.animation = "01_01.bvh";  // an installed clip, by name
    expect_input_error([&] { trial_scene(options); }, pbs::find_clip("01_01.bvh", "") + ": joints = ", "no joint has the name of a bone");
    EXPECT_FALSE(fs::exists(options.folder));
}

TEST_F(TrialSceneTest, BendsAModelWithoutAnimation)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {}));
    options.frames = 9;
    const Scene scene = read(options);
    EXPECT_EQ(scene.motion.joint, "elbow");
    EXPECT_EQ(scene.motion.angle_deg, 60.0);
    EXPECT_EQ(scene.motion.frames, 9);
    const auto model = pbs::read_model(options.model, "", 1.0);
    const pbs::Bone& elbow = model->body.skeleton.bones.at(1);
    EXPECT_NEAR(scene.motion.axis.dot((elbow.tail - elbow.head).normalized()), 0.0, 4 * std::numeric_limits<double>::epsilon());
    EXPECT_NEAR(scene.motion.axis.norm(), 1.0, 4 * std::numeric_limits<double>::epsilon());
    EXPECT_NE(trial_scene(options).remarks.at(0).find("the joint elbow is bent by 60 degrees"), std::string::npos);
}

TEST_F(TrialSceneTest, OptionsReachTheScene)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    options.scale = 0.01;
    options.reference = false;
    const Scene scene = read(options);
    EXPECT_EQ(scene.character.model_scale, 0.01);
    EXPECT_TRUE(scene.reference.empty());
    EXPECT_EQ(scene.deformers.size(), 5u);
}

TEST_F(TrialSceneTest, NamesOfAnyCharactersAreKept)
{
    for (const std::string name : {"a \"b\" c.gltf", "it's #1.gltf", "back\\slash.gltf", "\xc3\xbc \xe6\xbc\xa2 \xf0\x9f\x98\x80.gltf",
                                   "tab\t.gltf", "new\nline = 3.gltf", "delete\x7f.gltf"}) {
        TrialOptions options = options_for(test_support::write_rigged_gltf(folder, name, {name}));
        options.folder = (folder.path() / ("out of " + name)).string();
        const Scene scene = read(options);
        EXPECT_TRUE(fs::equivalent(scene.character.model_file, options.model)) << name;
        EXPECT_EQ(scene.motion.animation, name);
    }
}

TEST_F(TrialSceneTest, RefusesWhatNoSceneCanHold)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    for (const auto& [scale, shown] :
         {std::pair{0.0, "0"}, {-1.0, "-1"}, {std::nan(""), "nan"}, {INFINITY, "inf"}, {1e-300, "1e-300"}, {1e7, "1"}}) {
        options.scale = scale;
        expect_input_error([&] { trial_scene(options); }, std::string("--scale = ") + shown, "expected a number from 1e-6 to 1e6");
    }
    options.scale = 1.0;
    options.frames = 1;
    expect_input_error([&] { trial_scene(options); }, "--frames = 1: ", "expected at least 2");
    options.frames = 2;
    options.skeleton = folder / "none.toml";
    expect_input_error([&] { trial_scene(options); }, options.skeleton, "no such file");
    const TrialOptions latin_1 = options_for(test_support::write_rigged_gltf(folder, "caf\xe9.gltf", {"Bend"}));
    expect_input_error([&] { trial_scene(latin_1); }, "", "expected a name in UTF-8");
    expect_input_error([&] { trial_scene(options_for(folder / "none.gltf")); }, folder / "none.gltf", "no such file");
}

}  // namespace
