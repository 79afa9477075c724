// Reference: the contents written to run.json.
#include "experiments/verdicts/study_records.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::marked_frames;

class MarkedFrames : public testing::Test {
protected:
    std::string marks_of(const std::string& run_json)
    {
        std::filesystem::create_directories(scratch / "limb_bend");
        scratch.file("limb_bend/run.json", run_json);
        return marked_frames({scratch / "limb_bend"});
    }
    std::string refusal_of(const std::string& run_json)
    {
        try {
            return "accepted: " + marks_of(run_json);
        } catch (const pbs::InputError& error) {
            return error.what();
        }
    }

    test_support::ScratchFolder scratch;
};

TEST_F(MarkedFrames, EachDeformersFirstBrokenFrameIsNamed)
{
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "broken_frames": {
                  "pbs": [{"frame": 2, "what": "not_finite", "step": 7, "first_vertex": 17, "vertices_not_finite": 120}],
                  "nh_p1": [{"frame": 18, "what": "inverted", "worst_tet": 812, "volume_ratio": -0.04, "inverted_tets": 3},
                             {"frame": 19, "what": "not_converged", "worst_tet": 5, "volume_ratio": 0.5, "inverted_tets": 0}]}}})"),
              "     limb_bend: nh_p1 broke down in 2 of 31 frames (1 inverted, 1 not converged), the first inverted in frame 18: worst tet "
              "812 of volume ratio -0.04, 3 inverted\n"
              "     limb_bend: pbs broke down in 1 of 31 frames (1 not finite), the first not finite in frame 2 (in step 7, before it): "
              "first at vertex 17, 120 not finite\n");
}

TEST_F(MarkedFrames, OverlapsAndErrorsBelowTheReferences)
{
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "frames_with_overlap": 4, "largest_masked_share_pct": 6.25,
                                       "frames_below_reference_error": {"pbs": 2}}})"),
              "     limb_bend: the reference overlaps itself in 4 of 31 frames; errors leave out up to 6.2 % of the volume\n"
              "     limb_bend: the error of pbs at the joints is not above the reference's own in 2 of 31 frames\n");
}

TEST_F(MarkedFrames, WorkAndSoundRunsHaveNone)
{
    EXPECT_EQ(marks_of(R"({"outcome": {"finished": true, "breakdown": ""}})"), "");
    EXPECT_EQ(marks_of(R"({"outcome": {"frames": 31, "broken_frames": {}, "frames_with_overlap": 0}})"), "");
}

TEST_F(MarkedFrames, WhatSomebodyElseMadeOfARecordIsRefusedWithItsFile)
{
    const std::string refusal =
        scratch / "limb_bend/run.json" + ": expected a record as this program writes it: it was changed, or cut short";
    for (const char* text :
         {"", "{\"outcome\": ", "[]", R"({"outcome": 3})", R"({"outcome": {"frames_with_overlap": 4}})",
          R"({"outcome": {"frames_with_overlap": "four", "frames": 31}})", R"({"outcome": {"broken_frames": {"pbs": []}, "frames": 31}})",
          R"({"outcome": {"broken_frames": {"pbs": [{"frame": "two"}]}, "frames": 31}})"})
        EXPECT_EQ(refusal_of(text), refusal) << text;
}

}  // namespace
