// Reference: claims.toml and the rules of analysis::judge_case.
#include "experiments/studies/ambiguity/judged_value.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace {

using analysis::Extent;
using experiments::judged;

TEST(JudgedValue, IsOfWhatAClaimIsJudgedByAlone)
{
    const auto values = judged({{"C09", "damping_ratio", {.body = "limb"}, 0.5, 0.5, 0.5, "1"},
                                {"C09", "frequency_hz", {.body = "limb"}, 14.0, 14.0, 14.0, "Hz"}});
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].quantity, "damping_ratio");
    EXPECT_EQ(values[0].extent, Extent::whole);
    EXPECT_EQ(judged({{"C09", "damping_ratio", {.body = "limb"}, 2.0, 2.0, 2.0, "1"}})[0].extent, Extent::none);
}

// A value of A and one of B belong together whether or not a tolerance was reached.
TEST(JudgedValue, KeepsABoundApartFromWhatItIsOf)
{
    const analysis::CaseKey of = {.body = "limb", .initial_guess = "rest_pose"};
    const auto values = judged({{"C03", "iterations_over_lbs_guess", of, 30.0, 30.0, 30.0, "1", "", analysis::Limit::at_least}});
    EXPECT_EQ(values[0].of, of);
    EXPECT_EQ(values[0].limit, analysis::Limit::at_least);
}

TEST(JudgedValue, LeavesOutWhatIsNotMeasured)
{
    const auto left_out = experiments::all_but("C12", {}, "why");
    ASSERT_EQ(left_out.size(), 1u);
    EXPECT_EQ(left_out[0].quantity, "iterations_to_tolerance");
    EXPECT_TRUE(experiments::all_but("C12", {"iterations_to_tolerance"}, "why").empty());
}

TEST(DigestOfClaims, IsAnotherWithAnotherBoundAndTheSameWithOtherWords)
{
    const analysis::Claim claim = experiments::claim_named("C09");
    const std::string digest = experiments::digest_of({claim});
    const auto changed = [&](const auto& change) {
        analysis::Claim other = claim;
        change(other);
        return experiments::digest_of({other});
    };
    EXPECT_NE(changed([](auto& c) { c.bounds.at(0).low -= 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.bounds.pop_back(); }), digest);
    EXPECT_NE(changed([](auto& c) { c.low -= 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.high += 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.share = 0.9; }), digest);
    EXPECT_NE(changed([](auto& c) { c.metrics.pop_back(); }), digest);
    EXPECT_EQ(changed([](auto& c) { c.statement += "!"; }), digest);
    EXPECT_NE(experiments::digest_of({claim, experiments::claim_named("C10")}), digest);
}

experiments::ReadMotion clip_of(double change_pct)
{
    experiments::ReadMotion moved;
    for (auto* record : {&moved.pbs, &moved.lbs})
        for (int frame = 0; frame < 100; ++frame) {
            record->scene = "walk";
            record->frame.push_back(frame);
            record->time_s.push_back(0.2 * frame);
            record->volume_change_pct.push_back(change_pct);
            record->volume_abs_change_pct.push_back(std::abs(change_pct));
            record->inverted_tets.push_back(0.0);
        }
    moved.pbs.iterations = 24;
    return moved;
}

TEST(JudgedValue, OfVolumeIsTheMeanOfC01AndTheShareOfC02)
{
    const auto values = judged(clip_of(-14.0));
    ASSERT_EQ(values.size(), 4u);
    EXPECT_EQ(values[0].quantity, "mean_volume_loss_pct");
    EXPECT_EQ(values[0].value, 14.0);
    EXPECT_EQ(values[0].extent, Extent::whole);
    EXPECT_EQ(values[2].quantity, "share_of_frames_by_volume_change_pct");
    EXPECT_EQ(values[2].value, 0.0);
    EXPECT_EQ(judged(clip_of(-0.25))[2].value, 1.0);
    EXPECT_EQ(judged(clip_of(-0.25))[2].extent, Extent::whole);
}

TEST(JudgedValue, OfAReadingThatBreaksDownDoesNotHold)
{
    for (const auto& value : judged(clip_of(std::numeric_limits<double>::quiet_NaN()))) EXPECT_EQ(value.extent, Extent::none);
}

TEST(JudgedValue, OfAnUnknownClaimIsRefused)
{
    EXPECT_THROW(experiments::claim_named("C99"), std::logic_error);
}

}  // namespace
