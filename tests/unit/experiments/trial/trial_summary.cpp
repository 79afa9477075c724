// The findings of a trial. Reference: records written by hand, evaluated by hand.
#include "experiments/trial/trial.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using namespace experiments;

const std::string metrics_header = "deformer,frame,volume_change_pct,inverted_tets,step_ms,error_joint_pct\n";
const std::string regions_header = "deformer,kind,bone,second_bone,rest_share_pct,change_pct\n";

class TrialSummary : public testing::Test {
protected:
    TrialSummary()
    {
        folder.file("run.json", R"({"character": {"model": {"file": "hero.glb"}, "tets": 7, "vertices": 5},
                                    "outcome": {"motion": {"largest_rotation_deg": 30.0}, "frames": 3, "warnings": ["one", "two"]}})");
        folder.file("metrics.csv", metrics_header + "lbs,0,-0.25,0,0.125,\nlbs,1,-4,3,0.5,8\nlbs,2,1.5,2,0.25,6\n" +
                                       "pbs,0,0,0,2,\npbs,1,-0.5,1,1,2\npbs,2,0.25,0,4,7\n");
        folder.file("regions.csv", regions_header + "lbs,joint,hips,knee,10,-0.5\npbs,joint,hips,knee,10,-0.25\n" +
                                       "lbs,joint,chest,arm,30,-1.5\npbs,joint,chest,arm,30,0.25\n" +
                                       "lbs,joint,hand,thumb,5,-0.125\npbs,joint,hand,thumb,5,0\nlbs,bone,hips,,90,-9\n");
    }

    nlohmann::json facts() const { return trial_facts(folder.path().string()); }

    test_support::ScratchFolder folder;
};

TEST_F(TrialSummary, TakesTheFactsFromTheRecords)
{
    const nlohmann::json found = facts();
    EXPECT_EQ(found.at("model"), (nlohmann::json{{"file", "hero.glb"}}));
    EXPECT_EQ(found.at("tets"), 7);
    EXPECT_EQ(found.at("frames"), 3);
    EXPECT_EQ(found.at("warnings"), (nlohmann::json{"one", "two"}));
    EXPECT_EQ(found.at("volume").at("lbs"), (nlohmann::json{{"lowest_pct", -4.0}, {"highest_pct", 1.5}, {"most_inverted_tets", 3}}));
    EXPECT_EQ(found.at("volume").at("pbs"), (nlohmann::json{{"lowest_pct", -0.5}, {"highest_pct", 0.25}, {"most_inverted_tets", 1}}));
    EXPECT_EQ(found.at("frame_ms"), (nlohmann::json{{"lbs", 0.25}, {"pbs", 2.0}}));
}

// The two joints where lbs loses most: -1.5 and -0.5 % of the body's volume, of parts with 30 and 10 % of it.
TEST_F(TrialSummary, JoinsTheTwoWorstJoints)
{
    const nlohmann::json joints = facts().at("joints");
    EXPECT_EQ(joints.at("names"), (nlohmann::json{"chest - arm", "hips - knee"}));
    EXPECT_EQ(joints.at("lbs_pct"), 100.0 * -2.0 / 40.0);
    EXPECT_EQ(joints.at("pbs_pct"), 0.0);
}

TEST_F(TrialSummary, CountsTheFramesThatCanBeCompared)
{
    EXPECT_EQ(facts().at("nearer"), (nlohmann::json{{"frames", 1}, {"of", 2}}));
    folder.file("metrics.csv", metrics_header + "lbs,0,0,0,1,\npbs,0,0,0,1,\n");
    EXPECT_TRUE(facts().at("nearer").is_null());
}

TEST_F(TrialSummary, SaysItInOneSentence)
{
    EXPECT_EQ(
        trial_sentence(facts()),
        "PBS changes the volume by -0.5 to +0.3 %, LBS by -4.0 to +1.5 %; at the joints chest - arm and hips - knee by +0.0 % instead of "
        "-5.0 % on average; it is closer to the finite elements in 1 of 2 frames; a frame takes 2 ms.");
}

TEST_F(TrialSummary, LeavesOutWhatTheRecordsDoNotHold)
{
    folder.file("metrics.csv", "deformer,frame,volume_change_pct,inverted_tets,step_ms\nlbs,0,-0.001,0,1\npbs,0,0.001,0,0.5\n");
    folder.file("regions.csv", regions_header);
    EXPECT_EQ(trial_sentence(facts()), "PBS changes the volume by +0.0 to +0.0 %, LBS by +0.0 to +0.0 %; a frame takes 0.5 ms.");
}

TEST_F(TrialSummary, FramesThatBrokeDownAreLeftOut)
{
    for (const std::string broken : {"", "nan"}) {
        folder.file("metrics.csv", metrics_header + "lbs,0,-1,0,1,\npbs,0,-2,0,1,\npbs,1," + broken + ",0,3," + broken + "\n");
        EXPECT_EQ(facts().at("volume").at("pbs").at("lowest_pct"), -2.0) << broken;
        EXPECT_TRUE(facts().at("nearer").is_null()) << broken;
    }
    folder.file("metrics.csv", metrics_header + "lbs,0,-1,0,1,\npbs,0,nan,0,1,\n");
    EXPECT_EQ(trial_sentence(facts()), "PBS or LBS broke down in every frame.");
}

}  // namespace
