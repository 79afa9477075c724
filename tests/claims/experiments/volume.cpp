// C01 and C02 are judged from metrics.csv, frame by frame: if the frames of one body are altered, the verdicts change. Reference: the
// project's own claims.toml; the frames are invented.

#include "tests/support/broken_solver.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace {

using namespace test_support;
using analysis::VerdictKind;

// 200 frames of a clip around a mean change.
analysis::CaseRecord clip(const std::string& scene, const std::string& deformer, double change_pct)
{
    analysis::CaseRecord record;
    record.scene = scene;
    record.deformer = deformer;
    record.variant = "default";
    record.iterations = deformer == "pbs" ? 24 : 0;
    for (int frame = 0; frame < 200; ++frame) {
        record.frame.push_back(frame);
        record.time_s.push_back(0.04 * frame);
        record.volume_change_pct.push_back(change_pct * (1.0 + 0.05 * (frame % 5 - 2)));
        record.volume_abs_change_pct.push_back(std::abs(record.volume_change_pct.back()));
        record.inverted_tets.push_back(0.0);
    }
    return record;
}

VerdictKind verdict(const std::string& id, const std::vector<analysis::CaseRecord>& cases)
{
    analysis::Records records;
    records.cases = cases;
    return judge(claim(id), records).kind;
}

// The mean changes of two bodies, and the verdict on the mean loss by LBS of about 14 % (C01), or on the 0.5 % that PBS keeps (C02).
TEST(VolumeVerdict, TurnsWithTheBodies)
{
    using enum VerdictKind;
    struct TwoBodies {
        const char *claim, *deformer;
        double one_pct, other_pct;
        VerdictKind kind;
    };
    for (const auto& [claim, deformer, one_pct, other_pct, kind] :
         {TwoBodies{"C01", "lbs", -14.0, -13.0, reproduced}, TwoBodies{"C01", "lbs", -14.0, -8.0, reproduced_only_for},
          TwoBodies{"C01", "lbs", -6.0, 6.0, not_reproduced}, TwoBodies{"C02", "pbs", -0.3, 0.3, reproduced},
          TwoBodies{"C02", "pbs", -0.3, -2.0, reproduced_only_for}, TwoBodies{"C02", "pbs", -1.0, -2.0, not_reproduced}})
        EXPECT_EQ(verdict(claim, {clip("man_01_01", deformer, one_pct), clip("lady_01_01", deformer, other_pct)}), kind)
            << claim << " " << one_pct << " " << other_pct;
}

// C01 is about blending: no defect of the solver may change its verdict, value by value and to the bit, while the values measured for the
// solver change. A broken blend must change it. Reference: LBS does not depend on Algorithm 1; weights that bind every vertex to one bone
// distort only the tets across the joint, so a twist loses less.

analysis::Records limb_twist(Broken how, const std::string& weights = "paper")
{
    const experiments::Scene scene = experiments::read_scene(
        "limb_twist", {"character.vertices=400", "motion.frames=10", "output.frames_every=0", R"(reference.name="")",
                       R"(deformers.use=["lbs", "pbs"])", "skinning.weights=\"" + weights + "\""});
    experiments::StudyPlan plan;
    plan.runs.push_back({.name = "limb_twist", .scene = broken(scene, how), .cost_s = 1.0});
    return records_of(plan);
}

const std::vector<double>& volume_change_pct(const analysis::Records& records, const std::string& deformer)
{
    return std::find_if(records.cases.begin(), records.cases.end(), [&](const auto& one) { return one.deformer == deformer; })
        ->volume_change_pct;
}

double mean_loss_pct(const analysis::Records& records)
{
    const std::vector<double>& change = volume_change_pct(records, "lbs");
    return -std::accumulate(change.begin(), change.end(), 0.0) / static_cast<double>(change.size());
}

TEST(BrokenVolume, WhatIsSaidOfBlendingStaysAndABlendByOneBoneLosesLess)
{
    const analysis::Records sound = limb_twist(Broken::nothing), plain = limb_twist(Broken::nothing_in_plain_order);
    const analysis::Verdict whole = judge(claim("C01"), sound);
    ASSERT_FALSE(whole.cases.empty());
    for (const Broken how : every_broken) {
        const bool in_plain_order = sound_beside(how) == Broken::nothing_in_plain_order;
        const analysis::Records records = limb_twist(how);
        const analysis::Verdict verdict = judge(claim("C01"), records);
        EXPECT_EQ(verdict.kind, whole.kind) << name_of(how);
        EXPECT_EQ(verdict.within, whole.within) << name_of(how);
        EXPECT_EQ(verdict.cases.front().least, whole.cases.front().least) << name_of(how);
        EXPECT_EQ(verdict.cases.front().most, whole.cases.front().most) << name_of(how);
        EXPECT_EQ(volume_change_pct(records, "lbs"), volume_change_pct(sound, "lbs")) << name_of(how);
        EXPECT_NE(volume_change_pct(records, "pbs"), volume_change_pct(in_plain_order ? plain : sound, "pbs")) << name_of(how);
    }
    const double rigid_pct = mean_loss_pct(limb_twist(Broken::nothing, "rigid"));
    EXPECT_GT(rigid_pct, 0.0);
    EXPECT_LT(rigid_pct, mean_loss_pct(sound));
}

}  // namespace
