// Frames that broke down. Reference: the vertices and tets that were broken, by hand.
#include "experiments/run/broken_frames.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace {

using namespace experiments;

// The record is read back with the same words. A step before the frame's own is named.
TEST(BrokenFrame, NamesTheFirstVertexThatIsNotFiniteOrElseTheWorstTet)
{
    const pbs::Positions finite = pbs::Positions::Random(4, 3);
    pbs::Positions two_not_finite = finite;
    two_not_finite(3, 0) = std::numeric_limits<double>::infinity();
    two_not_finite(2, 1) = std::numeric_limits<double>::quiet_NaN();
    const struct {
        int frame;
        pbs::Outcome outcome;
        pbs::Positions positions;
        std::vector<double> ratios;
        int step;
        std::string text;
        nlohmann::json record;
    } rows[] = {
        {5,
         pbs::Outcome::not_finite,
         two_not_finite,
         {std::nan("")},
         -1,
         "not finite in frame 5: first at vertex 2, 2 not finite",
         {{"frame", 5}, {"what", "not_finite"}, {"first_vertex", 2}, {"vertices_not_finite", 2}}},
        {7,
         pbs::Outcome::finished,
         finite,
         {1.0, 0.0, -0.25, 0.5},
         -1,
         "inverted in frame 7: worst tet 2 of volume ratio -0.25, 2 inverted",
         {{"frame", 7}, {"what", "inverted"}, {"worst_tet", 2}, {"volume_ratio", -0.25}, {"inverted_tets", 2}}},
        {0,
         pbs::Outcome::not_converged,
         finite,
         {1.0, 0.9},
         -1,
         "not converged in frame 0: worst tet 1 of volume ratio 0.9, 0 inverted",
         {{"frame", 0}, {"what", "not_converged"}, {"worst_tet", 1}, {"volume_ratio", 0.9}, {"inverted_tets", 0}}},
        {2,
         pbs::Outcome::not_finite,
         finite,
         {1.0, 0.9},
         7,
         "not finite in frame 2 (in step 7, before it): worst tet 1 of volume ratio 0.9, 0 inverted",
         {{"frame", 2},
          {"what", "not_finite"},
          {"step", 7},
          {"worst_tet", 1},
          {"volume_ratio", 0.9},
          {"inverted_tets", 0}}}};
    for (const auto& [frame, outcome, positions, ratios, step, text, record] : rows) {
        BrokenFrame broken =
            broken_frame(frame, outcome, positions, Eigen::VectorXd::Map(ratios.data(), std::ssize(ratios)));
        broken.step = step;
        EXPECT_EQ(text_of(broken), text);
        EXPECT_EQ(nlohmann::json(broken), record);
        EXPECT_EQ(text_of(record.get<BrokenFrame>()), text);
    }
    EXPECT_EQ(broken_frame(0, pbs::Outcome::not_converged, pbs::Positions(0, 3), Eigen::VectorXd()).tet, -1)
        << "without tets there is none";
}

BrokenFrame broken(int frame, const std::string& what)
{
    return {.frame = frame, .what = what, .tet = 3, .volume_ratio = -0.5, .inverted_tets = 2};
}

TEST(BrokenFrames, NoneOfARunWithoutBreakdowns)
{
    const BrokenFrames none;
    EXPECT_EQ(none.breakdown(), "");
    EXPECT_EQ(none.bad_frame(31), "");
    EXPECT_EQ(none.record(31).at("broken_frames"), nlohmann::json::object());
}

// A negative control is expected to break down. The counts of a deformer with bad frames are those of all its frames
// that broke down.
TEST(BrokenFrames, TheFirstUnexpectedOneIsNamedWithTheCountsOfItsDeformer)
{
    BrokenFrames frames;
    frames.add("linear", broken(0, "inverted"), true);
    frames.add("linear", broken(1, "not_finite"), true);
    EXPECT_EQ(frames.breakdown() + frames.bad_frame(31), "") << "both are expected";
    frames.add("snh", broken(2, "not_converged"), false);
    frames.add("nh", broken(2, "inverted"), false);
    frames.add("pbs", broken(3, "not_finite"), false);
    frames.add("snh", broken(4, "not_finite"), false);
    EXPECT_EQ(frames.breakdown(), "pbs is not finite in frame 3: worst tet 3 of volume ratio -0.5, 2 inverted");
    EXPECT_EQ(frames.bad_frame(31),
              "pose not reached: snh is not converged in frame 2: worst tet 3 of volume ratio -0.5, 2 inverted; "
              "1 of 31 frames of nh, 2 of 31 frames of snh broke down");
    const nlohmann::json record = frames.record(31);
    EXPECT_EQ(record.at("breakdowns"), nlohmann::json::parse(R"({"linear": [1], "pbs": [3], "snh": [4]})"));
    EXPECT_EQ(record.at("not_converged"), nlohmann::json::parse(R"({"snh": [2]})"));
    EXPECT_EQ(record.at("broken_frames").at("linear").size(), 2);
    EXPECT_EQ(frames.frames_with(pbs::Outcome::not_finite).at("pbs"), std::vector{3});
}

}  // namespace
