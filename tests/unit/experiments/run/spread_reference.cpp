// The reference with a budget of time: which frames it solves, from where, and what an interruption or a full budget
// leaves. Reference: the same deformer through the same poses in order, and the definition of the stride.
#include "experiments/run/spread_reference.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {

using namespace experiments;
using pbs::Outcome;

constexpr double endless_s = 1e6;

// A stand-in for the finite elements: it turns the bar rigidly with its second bone, counts its frames, and does not
// reach some of them.
struct Counts {
    std::vector<double> from;     // the displacement at which each frame began, by its largest component [m]
    std::vector<double> reached;  // and that at which those ended which were reached
    int advanced = 0, made_without_contact = 0;
};
Counts counts;
bool is_blocked_by_contact = false;
std::set<int> calls_in_vain;

class StandIn : public Deformer {
public:
    explicit StandIn(const DeformerSpec& spec) : has_contact_(options_of<FemOptions>(spec).contact)
    {
        counts.made_without_contact += !has_contact_;
    }
    void reset(const pbs::Character& character) override { rest_ = positions_ = character.mesh.rest; }
    pbs::StepSummary advance(const pbs::Pose& pose, double) override
    {
        counts.from.push_back((positions_ - rest_).cwiseAbs().maxCoeff());
        const bool fails = (has_contact_ && is_blocked_by_contact) || calls_in_vain.contains(counts.advanced) ||
                           (is_over_ && is_over_());
        ++counts.advanced;
        pbs::StepSummary summary;
        summary.outcome = fails ? Outcome::not_converged : Outcome::finished;
        if (fails) return summary;
        for (Eigen::Index v = 0; v < rest_.rows(); ++v)
            positions_.row(v) = (pose.back() * pbs::Vec3(rest_.row(v).transpose())).transpose();
        counts.reached.push_back((positions_ - rest_).cwiseAbs().maxCoeff());
        return summary;
    }
    const pbs::Positions& positions() const override { return positions_; }
    void continue_from(const pbs::Pose&, const pbs::Positions& positions) override { positions_ = positions; }
    void give_up_when(std::function<bool()> is_over) override { is_over_ = std::move(is_over); }

private:
    bool has_contact_;
    pbs::Positions rest_, positions_;
    std::function<bool()> is_over_;
};

DeformerSpec stand_in()
{
    static const bool registered = [] {
        add_deformer_kind({.name = "slow_stand_in", .meaning = "a stand-in", .make = [](const DeformerSpec& spec) {
                               return std::make_unique<StandIn>(spec);
                           }});
        return true;
    }();
    EXPECT_TRUE(registered);
    FemOptions options;
    options.model = reference_fem::Model::neo_hookean;
    return {.name = "nh", .kind = "slow_stand_in", .label = "nh", .options = options};
}

class SpreadReferenceOfABar : public testing::Test {
protected:
    SpreadReferenceOfABar() { counts = {}, is_blocked_by_contact = false, calls_in_vain.clear(); }

    std::vector<pbs::Pose> poses(int frames) const
    {
        return pbs::joint_sweep(bar.skeleton, 1, pbs::Vec3::UnitZ(), 40.0, frames, 0.01).steps;
    }

    // Which of the frames have a state, after all of them were asked for.
    std::vector<bool> played(SpreadReference& reference, const std::vector<pbs::Pose>& frames)
    {
        reference.reset(bar);
        reference.foresee(frames);
        std::vector<bool> have;
        for (const pbs::Pose& pose : frames) {
            reference.advance(pose, 0.0);
            have.push_back(reference.has_state());
        }
        return have;
    }

    const pbs::Character bar = test_support::bar_character({4, 1, 1});
    const test_support::ScratchFolder folder;
    const std::string file = folder / "reference_frames.cbor";
};

TEST(SpreadReference, GoesOnByAsManyFramesAsTheTimeThatIsLeftAsksFor)
{
    EXPECT_EQ(stride(60, 1.0, 120.0), 1);  // all fit
    EXPECT_EQ(stride(60, 2.0, 120.0), 1);  // exactly
    EXPECT_EQ(stride(60, 9.0, 100.0), 6);  // 5.4
    EXPECT_EQ(stride(60, 1e9, 1e-9), 60);  // at most to the end
    EXPECT_EQ(stride(0, 1.0, 1.0), 1);
}

TEST(SpreadReference, GivesAFrameAnEighthOfTheTimeThatIsLeftOrItsShareOfTheLastFrames)
{
    EXPECT_DOUBLE_EQ(share_of_frame(60, 0.0, 120.0), 15.0);
    EXPECT_DOUBLE_EQ(share_of_frame(8, 1.0, 80.0), 10.0);
    EXPECT_DOUBLE_EQ(share_of_frame(3, 0.0, 30.0), 10.0);
    EXPECT_DOUBLE_EQ(share_of_frame(0, 0.0, 30.0), 30.0);
    EXPECT_DOUBLE_EQ(share_of_frame(60, 1.0, 8.0), 3.0);  // as long as three of those that were reached
    EXPECT_DOUBLE_EQ(share_of_frame(60, 1.0, 2.0), 2.0);  // and not more than there is
}

TEST_F(SpreadReferenceOfABar, SolvesEveryFrameWhereTheTimeAllowsIt)
{
    const std::vector<pbs::Pose> frames = poses(5);
    SpreadReference reference(stand_in(), {.seconds = endless_s});
    EXPECT_EQ(played(reference, frames), std::vector<bool>(5, true));
    EXPECT_EQ(reference.outcome().solved, 5);
    EXPECT_TRUE(reference.outcome().not_reached.empty());
    const auto alone = make_deformer(stand_in());
    alone->reset(bar);
    alone->advance(frames.back(), 0.0);
    EXPECT_EQ(reference.positions(), alone->positions());
}

// An interruption then leaves frames of the whole motion.
TEST_F(SpreadReferenceOfABar, SolvesEveryFourthFrameFirst)
{
    SpreadReference reference(stand_in(), {.seconds = endless_s});
    played(reference, poses(20));
    ASSERT_EQ(counts.reached.size(), 20u);
    for (int k = 1; k < 5; ++k) EXPECT_GT(counts.reached[k], counts.reached[k - 1]);
    EXPECT_EQ(std::ranges::count_if(counts.reached, [&](double other) { return other > counts.reached[4]; }), 3)
        << "16 of 0 to 19";
}

TEST_F(SpreadReferenceOfABar, SolvesNothingWithoutTime)
{
    SpreadReference reference(stand_in(), {.seconds = 1e-12});
    const std::vector<bool> have = played(reference, poses(5));
    EXPECT_EQ(std::count(have.begin(), have.end(), true), 0);
    EXPECT_LE(counts.advanced, 1);
}

TEST_F(SpreadReferenceOfABar, TriesAFrameThatItDoesNotReachOnceMore)
{
    calls_in_vain = {2};
    SpreadReference reference(stand_in(), {.seconds = endless_s});
    EXPECT_EQ(played(reference, poses(5)), std::vector<bool>(5, true));
    EXPECT_EQ(counts.advanced, 6);
}

TEST_F(SpreadReferenceOfABar, NamesAFrameThatItReachesNeitherTimeAndTheFleshThatIsMostCompressed)
{
    calls_in_vain = {2, 5};
    SpreadReference reference(stand_in(), {.seconds = endless_s});
    EXPECT_EQ(played(reference, poses(5)), (std::vector<bool>{true, false, true, true, true}));
    EXPECT_EQ(reference.outcome().solved, 4);
    ASSERT_EQ(reference.outcome().not_reached.size(), 1u);
    EXPECT_EQ(reference.outcome().not_reached.front().frame, 1);
    EXPECT_GE(pbs::find_bone(bar.skeleton, reference.outcome().not_reached.front().bone), 0);
}

TEST_F(SpreadReferenceOfABar, GivesUpAfterFourFramesInVain)
{
    for (const int first : {0, 1}) {  // the frame at rest is reached, or not
        counts = {};
        calls_in_vain.clear();
        for (int call = first; call < 20; ++call) calls_in_vain.insert(call);
        DeformerSpec spec = stand_in();
        options_of<FemOptions>(spec).contact = false;
        SpreadReference reference(spec, {.seconds = endless_s});
        played(reference, poses(20));
        EXPECT_EQ(reference.outcome().solved, first);
        EXPECT_EQ(counts.advanced, first + 4);
        const auto remarks = remarks_on(reference.outcome(), "a.toml");
        ASSERT_EQ(remarks.size(), 2u);
        EXPECT_NE(remarks[1].text.find("after 4 frames that were not reached the others were not tried"),
                  std::string::npos)
            << remarks[1].text;
    }
}

TEST_F(SpreadReferenceOfABar, DoesWithoutContactWhereItHoldsTheFirstFramesUp)
{
    is_blocked_by_contact = true;
    SpreadReference reference(stand_in(), {.seconds = endless_s});
    EXPECT_EQ(played(reference, poses(5)), std::vector<bool>(5, true));
    ASSERT_TRUE(reference.outcome().with_contact);
    EXPECT_EQ(reference.outcome().with_contact->frame, 0);
    EXPECT_FALSE(reference.outcome().with_contact->bone.empty());
    EXPECT_EQ(counts.made_without_contact, 1);
    EXPECT_EQ(counts.advanced, 2 + 5);
}

// Every question of the clock takes half a second, and a frame that is reached asks four times, so that it takes one
// and a half.
TEST_F(SpreadReferenceOfABar, SpreadsTheFramesThatTheTimeAllowsOverTheMotion)
{
    double now_s = 0.0;
    SpreadReference reference(stand_in(), {.seconds = 20.0, .clock_s = [&] { return now_s += 0.5; }});
    const std::vector<bool> have = played(reference, poses(60));
    int largest_gap = 0, gap = 0;
    for (const bool is_solved : have) {
        gap = is_solved ? 0 : gap + 1;
        largest_gap = std::max(largest_gap, gap);
    }
    EXPECT_NEAR(reference.outcome().solved, 13, 1);  // 20 s / 1.5 s
    EXPECT_LE(largest_gap, 6) << "every fifth frame, and a few more in a second pass";
    EXPECT_LE(gap, 6) << "at the end of the motion, too";
    EXPECT_NEAR(reference.outcome().seconds, 20.0, 1.5);
    EXPECT_FALSE(reference.outcome().with_contact) << "frames without time are not held up by contact";
}

TEST_F(SpreadReferenceOfABar, DoesNotCountTheTimeWithContactForTheFramesWithoutIt)
{
    is_blocked_by_contact = true;
    double now_s = 0.0;  // a frame with contact takes ten seconds
    SpreadReference reference(stand_in(), {.seconds = 100.0, .clock_s = [&] {
                                               return now_s += counts.made_without_contact > 0 ? 0.5 : 5.0;
                                           }});
    const std::vector<bool> have = played(reference, poses(60));
    EXPECT_EQ(std::count(have.begin(), have.end(), true), 60);
}

TEST_F(SpreadReferenceOfABar, GoesOnFromTheFramesOfItsFile)
{
    const std::vector<pbs::Pose> frames = poses(5);
    const ReferenceBudget budget{.seconds = endless_s, .file = file, .key = "1"};
    SpreadReference first(stand_in(), budget);
    played(first, {frames.begin(), frames.begin() + 3});
    counts = {};
    SpreadReference again(stand_in(), budget);
    EXPECT_EQ(played(again, frames), std::vector<bool>(5, true));
    EXPECT_EQ(again.outcome().kept, 3);
    EXPECT_EQ(counts.advanced, 2);
    EXPECT_GT(counts.from.front(), 0.0) << "it continues from a kept frame";
}

TEST_F(SpreadReferenceOfABar, GoesOnWithoutContactFromTheFramesOfItsFile)
{
    is_blocked_by_contact = true;
    const ReferenceBudget budget{.seconds = endless_s, .file = file, .key = "1"};
    SpreadReference first(stand_in(), budget);
    played(first, poses(5));
    counts = {};
    SpreadReference again(stand_in(), budget);
    played(again, poses(5));
    EXPECT_EQ(again.outcome().kept, 5);
    EXPECT_TRUE(again.outcome().with_contact);
    EXPECT_EQ(counts.advanced, 0);
}

}  // namespace
