// The file of solved frames. Reference: the frames that were added to it, to the bit, since nothing is rounded.
#include "experiments/run/solved_frames.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace {

using namespace experiments;

class SolvedFramesInAFile : public test_support::FolderTest {
protected:
    static constexpr double budget_s = 100.0;
    static constexpr Eigen::Index vertices = 3;
    const std::string path = folder / "reference_frames.cbor";

    static pbs::Pose pose(double height_m) { return {Eigen::Isometry3d(Eigen::Translation3d(0.0, height_m, 0.0))}; }

    static SolvedFrame frame(double height_m)
    {
        SolvedFrame frame{.positions = pbs::Positions::Constant(vertices, 3, height_m / 3.0),
                          .lowest_det_f = 0.1,
                          .tips = {{{1.0, 2.0, height_m}, 0.1}}};
        frame.step.seconds = 0.7;
        frame.step.iterations = 5;
        return frame;
    }

    // Adds frames of the heights to those that the file has.
    void keep(const std::vector<double>& heights_m)
    {
        SolvedFrames file(path, "1", budget_s);
        file.find({}, vertices);
        for (const double height_m : heights_m) file.add(pose(height_m), frame(height_m));
        file.write();
    }

    // How many of the poses are found.
    std::ptrdiff_t found(const std::string& key = "1", double seconds = budget_s)
    {
        const auto frames = SolvedFrames(path, key, seconds).find({pose(1.0), pose(2.0), pose(3.0)}, vertices);
        return std::ranges::count_if(frames, [](const auto& frame) { return frame.has_value(); });
    }
};

TEST_F(SolvedFramesInAFile, AreFoundWithAllThatTheyHave)
{
    keep({1.0, 2.0});
    const auto frames = SolvedFrames(path, "1", budget_s).find({pose(2.0), pose(3.0)}, vertices);
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_FALSE(frames[1]);
    ASSERT_TRUE(frames[0]);
    EXPECT_EQ(frames[0]->positions, frame(2.0).positions);
    EXPECT_EQ(frames[0]->lowest_det_f, 0.1);
    EXPECT_EQ(frames[0]->step.seconds, 0.7);
    EXPECT_EQ(frames[0]->step.iterations, 5);
    ASSERT_EQ(frames[0]->tips.size(), 1u);
    EXPECT_EQ(frames[0]->tips[0].at_rest, pbs::Vec3(1.0, 2.0, 2.0));
    EXPECT_EQ(frames[0]->tips[0].radius_m, 0.1);
}

TEST_F(SolvedFramesInAFile, StayWhereAnotherMotionAddsItsOwnAndAreNotThoseOfAnotherKey)
{
    keep({1.0, 2.0});
    keep({3.0});
    EXPECT_EQ(found("1"), 3);
    EXPECT_EQ(found("2"), 0);
}

TEST_F(SolvedFramesInAFile, WithoutContactAreNotThoseOfALargerBudget)
{
    SolvedFrames file(path, "1", budget_s);
    file.add(pose(1.0), frame(1.0));
    file.begin_without_contact({7, 9.0, "head"});
    file.add(pose(2.0), frame(2.0));
    file.write();
    EXPECT_EQ(found(), 1) << "the frame with contact is gone";
    EXPECT_EQ(found("1", 2.0 * budget_s), 0);
    SolvedFrames again(path, "1", budget_s);
    again.find({}, vertices);
    ASSERT_TRUE(again.with_contact());
    EXPECT_EQ(again.with_contact()->frame, 7);
    EXPECT_EQ(again.with_contact()->seconds, 9.0);
    EXPECT_EQ(again.with_contact()->bone, "head");
}

TEST_F(SolvedFramesInAFile, OfADamagedFileAreNone)
{
    std::ofstream(path, std::ios::binary) << "not CBOR";
    EXPECT_EQ(found(), 0);
    keep({1.0});
    EXPECT_EQ(found(), 1);
    const auto of_another_body = SolvedFrames(path, "1", budget_s).find({pose(1.0)}, vertices + 1);
    EXPECT_FALSE(of_another_body[0]);
}

}  // namespace
