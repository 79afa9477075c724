// The scene that is made of a model. Reference: the contract of scene files, by reading the scene again, and the
// options by hand.

#include "experiments/characters/model_character.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/trial/trial.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace {

using namespace experiments;
namespace fs = std::filesystem;

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
    EXPECT_TRUE(trial_scene(options).remarks.notes.empty());
}

TEST_F(TrialSceneTest, TakesTheFirstAnimationThatTurnsAJoint)
{
    const auto names_with = [](const std::string& model, const std::string& choice) {
        return std::vector<std::string>{model + ": it has 3 animations; " + choice};
    };
    TrialOptions options = options_for(test_support::write_rigged_gltf(
        folder, "arm.gltf", {"Take 001", "Take 001", "Bend"}, 2.0f, {0.0f, 6.0f, 90.0f}));
    EXPECT_EQ(read(options).motion.animation, "Take 001 (2)");
    const TrialScene made = trial_scene(options);
    EXPECT_EQ(made.remarks.notes,
              names_with(options.model,
                         "Take 001 (2) is taken, the first one that turns a joint by more than 5 degrees "
                         "(--animation NAME takes another one: Take 001, Bend)"));
    EXPECT_EQ(made.animations.at(2).at("name"), "Bend");
    EXPECT_EQ(made.animations.at(2).at("duration_s"), 2.0);
    // glTF's numbers are single precision
    EXPECT_NEAR(made.animations.at(2).at("largest_rotation_deg").get<double>(), 90.0, 1e-3);
    options.animation = "Take 001";
    EXPECT_EQ(read(options).motion.animation, "Take 001");
    EXPECT_TRUE(trial_scene(options).remarks.notes.empty());

    options = options_for(
        test_support::write_rigged_gltf(folder, "calm.gltf", {"Idle", "Breathe", "Blink"}, 2.0f, {0.0f, 4.0f, 2.0f}));
    EXPECT_EQ(trial_scene(options).remarks.notes,
              names_with(options.model,
                         "Breathe is taken, which moves most: none turns a joint by more than "
                         "5 degrees (--animation NAME takes another one: Idle, Blink)"));
}

TEST_F(TrialSceneTest, BendsAModelWhoseAnimationsMoveNothingUnlessOneIsNamed)
{
    TrialOptions options =
        options_for(test_support::write_rigged_gltf(folder, "still.gltf", {"Take", "Pose"}, 2.0f, {0.0f, 0.05f}));
    EXPECT_EQ(read(options).motion.joint, "elbow");
    EXPECT_NE(trial_scene(options).remarks.notes.at(0).find("no animation that moves a joint"), std::string::npos);
    options.animation = "Pose";
    EXPECT_EQ(read(options).motion.animation, "Pose");
}

TEST_F(TrialSceneTest, ReplacesOnlyTheTrialOfTheSameModel)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    EXPECT_EQ(earlier_trial_scene(options), "") << "no folder";
    const auto put = [&](const std::string& name, const std::string& text) {
        std::ofstream(fs::path(options.folder) / name) << text;
    };
    fs::create_directories(options.folder);
    put("notes.txt", "mine");
    EXPECT_EQ(earlier_trial_scene(options), "") << "files that no trial replaces";
    put("metrics.csv", "");
    expect_input_error([&] { earlier_trial_scene(options); },
                       options.folder + "/metrics.csv: ", "expected another folder (-o) for ");
    const std::string scene = trial_scene(options).text;
    put("scene.toml", scene);
    options.frames = 7;
    options.folder = fs::path(options.folder) / "." / "";
    EXPECT_EQ(earlier_trial_scene(options), scene) << "other options and another spelling of the folder";

    TrialOptions other = options;
    other.model = test_support::write_rigged_gltf(folder, "leg.gltf", {"Bend"});
    expect_input_error([&] { earlier_trial_scene(other); },
                       options.folder + "scene.toml: character.model = ../arm.gltf: ", other.model);
    put("scene.toml", scene + "# my own line\n");
    expect_input_error([&] { earlier_trial_scene(options); }, options.folder + "scene.toml: ", options.model);
}

TEST_F(TrialSceneTest, AShortMotionHasNoMoreFramesThanThirtyPerSecondAndOptionsReachTheScene)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}, 0.5f));
    EXPECT_EQ(read(options).motion.rate_hz, 30.0);
    options.frames = 2;
    options.scale = 0.01;
    options.reference = false;
    const Scene scene = read(options);
    EXPECT_EQ(scene.motion.rate_hz, 2.0);
    EXPECT_EQ(scene.character.model_scale, 0.01);
    EXPECT_TRUE(scene.reference.empty());
    EXPECT_EQ(scene.deformers.size(), 5u);
}

TEST_F(TrialSceneTest, FindsAnInstalledClipByItsName)
{
    TrialOptions options = options_for(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}));
    options.animation = "01_01.bvh";
    expect_input_error([&] { trial_scene(options); },
                       pbs::find_clip("01_01.bvh", "") + ": joints = ", "no joint has the name of a bone");
    options.animation = "01_01.bvh:";
    expect_input_error([&] { trial_scene(options); },
                       "--animation = 01_01.bvh:: ", "expected the name of an animation behind the colon");
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
    EXPECT_NEAR(scene.motion.axis.dot((elbow.tail - elbow.head).normalized()), 0.0,
                4 * std::numeric_limits<double>::epsilon());
    EXPECT_NEAR(scene.motion.axis.norm(), 1.0, 4 * std::numeric_limits<double>::epsilon());
    EXPECT_NE(trial_scene(options).remarks.notes.at(0).find("the joint elbow is bent by 60 degrees"),
              std::string::npos);
}

TEST_F(TrialSceneTest, NamesOfAnyCharactersAreKept)
{
    for (const std::string name :
         {"a \"b\" c.gltf", "it's #1.gltf", "back\\slash.gltf", "\xc3\xbc \xe6\xbc\xa2 \xf0\x9f\x98\x80.gltf",
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
    options.frames = 1;
    expect_input_error([&] { trial_scene(options); }, "--frames = 1: ", "expected at least 2");
    const TrialOptions latin_1 = options_for(test_support::write_rigged_gltf(folder, "caf\xe9.gltf", {"Bend"}));
    expect_input_error([&] { trial_scene(latin_1); }, "", "expected a name in UTF-8");
}

// The findings of a trial. Reference: records written by hand, evaluated by hand.

const std::string metrics_header = "deformer,frame,volume_change_pct,inverted_tets,step_ms,error_joint_pct\n";
const std::string regions_header = "deformer,kind,bone,second_bone,rest_share_pct,change_pct\n";

class TrialSummary : public testing::Test {
protected:
    TrialSummary()
    {
        folder.file("run.json", R"({"character": {"model": {"file": "hero.glb"}, "tets": 7, "vertices": 5},
                                    "outcome": {"motion": {"largest_rotation_deg": 30.0}, "frames": 3,
                                                "warnings": ["one", "two"],
                                                "notes": ["three"]}})");
        folder.file("bones_rest.csv", "bone,parent\nhips,\nknee,hips\nchest,hips\narm,chest\nhand,arm\nthumb,hand\n");
        folder.file("metrics.csv", metrics_header + "lbs,0,-0.25,0,0.125,\nlbs,1,-4,3,0.5,8\nlbs,2,1.5,2,0.25,6\n" +
                                       "pbs,0,0,0,2,\npbs,1,-0.5,1,1,2\npbs,2,0.25,0,4,7\n");
        folder.file("regions.csv",
                    regions_header + "lbs,joint,hips,knee,10,-0.5\npbs,joint,hips,knee,10,-0.25\n" +
                        "lbs,joint,chest,arm,30,-1.5\npbs,joint,chest,arm,30,0.25\n" +
                        "lbs,joint,hand,thumb,5,-0.125\npbs,joint,hand,thumb,5,0\nlbs,bone,hips,,90,-9\n" +
                        // they touch, but are no joint
                        "lbs,joint,hips,hand,5,-9\npbs,joint,hips,hand,5,-9\n");
    }

    nlohmann::json facts() const { return trial_facts(folder.path().string()); }

    test_support::ScratchFolder folder;
};

TEST_F(TrialSummary, TakesTheFactsFromTheRecordsAndSaysThemInOneSentence)
{
    const nlohmann::json found = facts();
    EXPECT_EQ(found.at("model"), (nlohmann::json{{"file", "hero.glb"}}));
    EXPECT_EQ(found.at("tets"), 7);
    EXPECT_EQ(found.at("frames"), 3);
    EXPECT_EQ(found.at("warnings"), (nlohmann::json{"one", "two"}));
    EXPECT_EQ(found.at("notes"), nlohmann::json{"three"});
    EXPECT_EQ(found.at("volume").at("lbs"),
              (nlohmann::json{{"lowest_pct", -4.0}, {"highest_pct", 1.5}, {"most_inverted_tets", 3}}));
    EXPECT_EQ(found.at("volume").at("pbs"),
              (nlohmann::json{{"lowest_pct", -0.5}, {"highest_pct", 0.25}, {"most_inverted_tets", 1}}));
    EXPECT_EQ(found.at("frame_ms"), (nlohmann::json{{"lbs", 0.25}, {"pbs", 2.0}}));
    // The two joints where lbs loses most: -1.5 and -0.5 % of the body's volume, of parts with 30 and 10 % of it.
    const nlohmann::json& joints = found.at("joints");
    EXPECT_EQ(joints.at("names"), (nlohmann::json{"chest - arm", "hips - knee"}));
    EXPECT_EQ(joints.at("lbs_pct"), 100.0 * -2.0 / 40.0);
    EXPECT_EQ(joints.at("pbs_pct"), 0.0);
    EXPECT_EQ(trial_sentence(found),
              "PBS is nearest to FEM (4.5 % at the joints, in 1 of 2 frames), LBS next (7 %). LBS turns up to 3 tets "
              "(43 %) inside out, PBS "
              "1 (14 %). At the joints chest - arm and hips - knee, PBS changes the volume by +0.0 % on average, LBS "
              "by -5.0 %. On "
              "hero.glb, PBS changes the volume by -0.5 to +0.3 %, where LBS changes it by -4.0 to +1.5 %, and takes 2 "
              "ms per frame "
              "instead of 0.25 ms.");
}

TEST_F(TrialSummary, RanksTheMethodsAndLeavesOutWhatTheRecordsDoNotHold)
{
    const nlohmann::json pbs = {{"deformer", "pbs"}, {"median_pct", 4.5}, {"nearest_in", 1}},
                         lbs = {{"deformer", "lbs"}, {"median_pct", 7.0}, {"nearest_in", 1}};
    EXPECT_EQ(facts().at("nearest"), (nlohmann::json{{"frames", 2}, {"place", "joints"}, {"methods", {pbs, lbs}}}));
    folder.file("metrics.csv", metrics_header + "lbs,0,0,0,1,\npbs,0,0,0,1,\n");
    EXPECT_TRUE(facts().at("nearest").is_null());
    folder.file("metrics.csv",
                "deformer,frame,volume_change_pct,inverted_tets,step_ms\nlbs,0,-0.001,0,1\npbs,0,0.001,0,0.5\n");
    folder.file("regions.csv", regions_header);
    EXPECT_EQ(trial_sentence(facts()),
              "On hero.glb, PBS changes the volume by less than 0.05 %, where LBS changes it by less than 0.05 %, and "
              "takes 0.5 ms per frame "
              "instead of 1 ms; which of the two is closer to elastic flesh was not measured.");
}

// The reference is no method. DQS has no error in frame 0, and there nobody is visibly away from the reference, so that
// the first decimals of rounding decide nothing; hundredths of one per cent, as in frame 2, are visible. Frame 3 does
// not count, since DQS failed there.
TEST_F(TrialSummary, RanksByTheMedianOverFramesInWhichAllHaveAnError)
{
    folder.file("regions.csv", regions_header);
    folder.file(
        "metrics.csv",
        metrics_header + "nh_p1,0,0,0,900,0\nlbs,0,0,0,1,1e-5\npbs,0,0,0,2,1e-6\ndelta_mush,0,0,0,1.5,1e-5\n" +
            "nh_p1,1,0,0,900,0\nlbs,1,-4,0,1,8\npbs,1,-0.4,0,2,2\ndelta_mush,1,0,0,1.5,1\ndqs,1,0,0,1,3\n" +
            "nh_p1,2,0,0,900,0\nlbs,2,0,0,1,0.06\npbs,2,0,0,2,0.03\ndelta_mush,2,0,0,1.5,0.02\ndqs,2,0,0,1,0.09\n" +
            "lbs,3,0,0,1,9\npbs,3,0,0,2,0.1\ndelta_mush,3,0,0,1.5,99\ndqs,3,0,0,1,nan\n");
    EXPECT_EQ(trial_sentence(facts()),
              "Delta mush is nearest to FEM (0.51 % at the joints, in 2 of 2 frames), PBS next (1 %). On hero.glb, PBS "
              "changes the volume by "
              "at most -0.4 %, where LBS changes it by at most -4.0 %, and takes 2 ms per frame instead of 1 ms.");
}

// Of 1,000 tets delta mush has 6 more than LBS, 0.6 %, in one of ten frames and in two of ten, and 5 more in all of
// them.
TEST_F(TrialSummary, AMethodIsExcludedForAShareOfTheBodyInATenthOfTheFrames)
{
    folder.file("run.json", R"({"character": {"model": {"file": "hero.glb"}, "tets": 1000, "vertices": 5},
                                "outcome": {"motion": {"largest_rotation_deg": 30.0}, "frames": 10,
                                            "warnings": [], "notes": []}})");
    folder.file("regions.csv", regions_header);
    const auto sentence_with = [&](int frames, int inverted) {
        std::string rows = metrics_header;
        for (int frame = 0; frame < 10; ++frame)
            rows += fmt::format("lbs,{0},-4,3,1,8\npbs,{0},-1,0,2,3\ndelta_mush,{0},0,{1},1.5,1\n", frame,
                                frame < frames ? inverted : 0);
        folder.file("metrics.csv", rows);
        return nearest_sentence(facts());
    };
    EXPECT_EQ(sentence_with(1, 9),
              "Delta mush is nearest to FEM (1 % at the joints, in 10 of 10 frames), PBS next (3 %). Delta mush turns "
              "up to 9 tets (0.9 %) "
              "inside out, LBS 3 (0.3 %). ");
    EXPECT_TRUE(sentence_with(10, 8).starts_with("Delta mush is nearest")) << "exactly 0.5 %";
    EXPECT_EQ(sentence_with(2, 9),
              "PBS is nearest to FEM (3 % at the joints, in 10 of 10 frames), LBS next (8 %). Delta mush turns up to 9 "
              "tets (0.9 %) inside "
              "out, LBS 3 (0.3 %). Excluded for inverted tets: delta mush. ");
    folder.file("metrics.csv", metrics_header + "lbs,0,-4,0,1,8\npbs,0,-1,9,2,3\ndelta_mush,0,0,9,1.5,1\n");
    EXPECT_TRUE(nearest_sentence(facts()).starts_with("LBS is nearest"));
    folder.file("metrics.csv", metrics_header + "lbs,0,-4,0,1,\npbs,0,-1,9,2,3\ndelta_mush,0,0,9,1.5,1\n");
    EXPECT_TRUE(nearest_sentence(facts()).starts_with(
        "No method is called nearest: each of them turns too many tets inside out. "));
}

TEST_F(TrialSummary, NobodyIsNearestToADoubtfulReference)
{
    folder.file("metrics.csv", metrics_header + "lbs,1,-4,0,0.5,60\npbs,1,-0.5,0,1,51\n");
    EXPECT_EQ(facts().at("doubtful_reference"), "far_from_all");
    EXPECT_TRUE(nearest_sentence(facts()).starts_with(
        "No method is called nearest: the reference lies elsewhere, 51 % from the nearest"));
    folder.file(
        "metrics.csv",
        "deformer,frame,volume_change_pct,inverted_tets,step_ms,error_l2_pct\nlbs,1,-4,0,0.5,60\npbs,1,-0.5,0,1,51\n");
    EXPECT_EQ(facts().at("doubtful_reference"), "far_from_all") << "without joints";
    folder.file("metrics.csv", metrics_header + "lbs,1,-4,0,0.5,60\npbs,1,-0.5,0,1,50\n");
    EXPECT_TRUE(facts().at("doubtful_reference").is_null()) << "50 % is not above 50 %";
    const auto write_lag = [&](double degrees, int lagging) {
        folder.file("run.json",
                    fmt::format(R"({{"character": {{"model": {{"file": "hero.glb"}}, "tets": 7, "vertices": 5}},
            "outcome": {{"motion": {{}}, "frames": 3, "warnings": [], "notes": [],
                         "reference_lag": {{"largest_turn_deg": {}, "lagging_frames": {},
                                            "frames": 20, "bone": "upper", "frame": 2}}}}}})",
                                degrees, lagging));
    };
    write_lag(27.0, 2);
    EXPECT_TRUE(facts().at("doubtful_reference").is_null());
    write_lag(12.4, 3);
    EXPECT_TRUE(trial_sentence(facts()).starts_with(
        "No method is called nearest: in the reference, flesh that upper alone moves lags behind "
        "it by 12 degrees in frame 2. In 3 of 20 frames, 1 % of the body or more lag by more than 5 degrees. "));
}

TEST_F(TrialSummary, WhereBonesAreStretchedVolumeIsNotJudged)
{
    folder.file("run.json", R"({"character": {"model": {"file": "slime.glb"}, "tets": 7, "vertices": 5},
                                "outcome": {"motion": {"stretched_bones": [
                                                           {"bone": "top", "change_pct": 53.0, "frame": 7}]},
                                            "frames": 3, "warnings": [], "notes": []}})");
    EXPECT_EQ(facts().at("motion").at("stretched_bones").at(0).at("bone"), "top");
    EXPECT_EQ(trial_sentence(facts()),
              "PBS is nearest to FEM (4.5 % at the joints, in 1 of 2 frames), LBS next (7 %). LBS turns up to 3 tets "
              "(43 %) inside out, PBS "
              "1 (14 %). On slime.glb, PBS takes 2 ms per frame instead of 0.25 ms.");
}

// By hand: the root of (3^2 + 5^2) / 2 and of (3^2 + 4^2) / 2 mm, in the frames that both have.
TEST_F(TrialSummary, StatesTheShareOfTheSkinsDistanceThatPbsRemoves)
{
    const std::string header = "deformer,frame,volume_change_pct,inverted_tets,step_ms,skin_rms_mm,skin_rms_pct\n";
    folder.file("regions.csv", regions_header);
    folder.file("metrics.csv", header + "lbs,0,-1,0,1,3,1\npbs,0,-1,0,2,3,1\nlbs,1,-1,0,1,5,1\npbs,1,-1,0,2,4,1\n" +
                                   "lbs,2,-1,0,1,9,1\npbs,2,-1,0,2,nan,nan\n");
    const nlohmann::json skin = facts().at("skin");
    EXPECT_DOUBLE_EQ(skin.at("lbs_mm"), std::sqrt(17.0));
    EXPECT_DOUBLE_EQ(skin.at("pbs_mm"), std::sqrt(12.5));
    EXPECT_DOUBLE_EQ(skin.at("removed_pct"), 100.0 * (1.0 - std::sqrt(12.5 / 17.0)));
    const auto expect_words = [&](const std::string& words) {
        EXPECT_NE(trial_sentence(facts()).find(words), std::string::npos) << trial_sentence(facts());
    };
    expect_words(
        ", removes 14 % of the distance of LBS from elastic flesh (FEM; 3.5 mm instead of 4.1 mm over the skin of a "
        "body of 1.7 m), and");
    folder.file("metrics.csv", header + "lbs,0,-1,0,1,2,1\npbs,0,-1,0,2,3,1\n");
    expect_words(", adds 50 % to the distance of LBS from elastic flesh");
    folder.file("metrics.csv", header + "lbs,0,-1,0,1,2,1\npbs,0,-1,0,2,2.001,1\n");
    expect_words(", changes the distance of LBS from elastic flesh by less than 1 % (");
    folder.file("metrics.csv", header + "lbs,0,-1,0,1,2,0.009\npbs,0,-1,0,2,3,1\n");
    EXPECT_TRUE(facts().at("skin").is_null()) << "lbs is not visibly away";
    const auto with_errors = [&](const char* lbs_pct, const char* pbs_pct) {
        const std::string both =
            "deformer,frame,volume_change_pct,inverted_tets,step_ms,skin_rms_mm,skin_rms_pct,error_joint_pct\n";
        folder.file("metrics.csv", both + "lbs,0,-1,0,1,2,1," + lbs_pct + "\npbs,0,-1,0,2,3,1," + pbs_pct + "\n");
    };
    with_errors("8", "4");
    expect_words(
        "3 mm instead of 2 mm over the skin of a body of 1.7 m, although PBS is nearer than LBS at the joints), and");
    with_errors("4", "8");
    expect_words("3 mm instead of 2 mm over the skin of a body of 1.7 m), and");
}

// PBS and LBS are farthest apart in frame 1: frame 2 of another pair, and a frame that broke down, do not count.
TEST_F(TrialSummary, EndsWithTheFrameInWhichPbsAndLbsDifferMost)
{
    const std::string header = "deformer,other,frame,rms_mm\n";
    EXPECT_TRUE(facts().at("widest_frame").is_null()) << "without distances";
    folder.file("distances.csv", header + "pbs,lbs,0,1\npbs,lbs,1,2\npbs,dqs,2,9\npbs,lbs,2,nan\n");
    EXPECT_EQ(facts().at("widest_frame"), 1);
    EXPECT_TRUE(trial_sentence(facts()).ends_with(" instead of 0.25 ms; look at frame 1, where the two differ most."));
    folder.file("distances.csv", header + "pbs,lbs,0,0\n");
    EXPECT_TRUE(facts().at("widest_frame").is_null()) << "they never differ";
}

TEST_F(TrialSummary, WithoutAJointErrorsAreThoseOfTheBodyAndWhereNothingDeformsNothingIsCompared)
{
    const std::string header =
        "deformer,frame,volume_change_pct,inverted_tets,step_ms,error_joint_pct,error_l2_pct,volume_abs_change_pct\n";
    folder.file("metrics.csv", header + "lbs,0,-1,0,1,nan,3,2\npbs,0,-2,0,1,nan,2,2\n");
    EXPECT_EQ(facts().at("nearest").at("place"), "body");
    EXPECT_TRUE(trial_sentence(facts()).starts_with(
        "PBS is nearest to FEM (2 % over the body, in 1 of 1 frames), LBS next (3 %). "));
    folder.file("metrics.csv", header + "lbs,0,0,0,1,nan,1e-9,1e-9\npbs,0,0,0,1,nan,1e-8,0.009\n");
    EXPECT_TRUE(facts().at("nearest").is_null());
    EXPECT_EQ(trial_sentence(facts()),
              "No flesh deforms: it rests or moves rigidly in every frame, so that there is nothing to compare.");
}

// The bound of one frame of four is not known, and the largest one is neither the first nor the last.
TEST_F(TrialSummary, StatesTheLargestBoundOfTheReferencesErrorAndItsTime)
{
    EXPECT_TRUE(facts().at("error_bar").is_null()) << "no column has the bounds";
    folder.file("run.json", R"({"character": {"model": {"file": "hero.glb"}, "tets": 7, "vertices": 5},
                                "cost": {"seconds": {"error_bar": 2.0, "error_bar_set_up": 0.5}},
                                "outcome": {"motion": {"largest_rotation_deg": 30.0}, "frames": 4,
                                            "warnings": [], "notes": []}})");
    folder.file(
        "metrics.csv",
        "deformer,frame,volume_change_pct,inverted_tets,step_ms,reference_error_joint_pct\n"
        "nh_p1,0,0,0,1,0.25\nnh_p1,1,0,0,1,0.75\nnh_p1,2,0,0,1,\nnh_p1,3,0,0,1,0.5\nlbs,0,-1,0,1,9\npbs,0,-2,0,1,9\n");
    EXPECT_EQ(facts().at("error_bar"),
              (nlohmann::json{{"frames", 3}, {"of", 4}, {"seconds", 2.5}, {"largest_pct", 0.75}}));
}

TEST_F(TrialSummary, FramesThatBrokeDownAreLeftOut)
{
    for (const std::string broken : {"", "nan"}) {
        folder.file("metrics.csv",
                    metrics_header + "lbs,0,-1,0,1,\npbs,0,-2,0,1,\npbs,1," + broken + ",0,3," + broken + "\n");
        EXPECT_EQ(facts().at("volume").at("pbs").at("lowest_pct"), -2.0) << broken;
        EXPECT_TRUE(facts().at("nearest").is_null()) << broken;
    }
    folder.file("metrics.csv", metrics_header + "lbs,0,-1,0,1,\npbs,0,nan,0,1,\n");
    EXPECT_EQ(trial_sentence(facts()), "PBS or LBS broke down in every frame.");
}

}  // namespace
