// C01 and C02 are judged from metrics.csv, frame by frame: if the frames of some clips or controls are altered, the
// verdicts change. Reference: the project's own claims.toml; the frames are invented.

#include "experiments/deformers/deformer_options.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace {

using namespace test_support;
using analysis::VerdictKind;

// 200 frames of the clip 01_01 around a mean change.
analysis::CaseRecord clip(const std::string& body, const std::string& deformer, double change_pct,
                          const std::string& variant = "default")
{
    analysis::CaseRecord record;
    record.scene = body + "_01_01";
    record.place = {.body = body, .motion = "01_01"};
    record.deformer = deformer;
    record.variant = variant;
    if (deformer == "pbs_orders") record.order = "plain", record.precision = "f64";
    record.iterations = deformer.starts_with("pbs") ? 24 : 0;
    for (int frame = 0; frame < 200; ++frame) {
        record.frame.push_back(frame);
        record.time_s.push_back(0.04 * frame);
        record.volume_change_pct.push_back(change_pct * (1.0 + 0.05 * (frame % 5 - 2)));
        record.volume_abs_change_pct.push_back(std::abs(record.volume_change_pct.back()));
        record.inverted_tets.push_back(0.0);
    }
    return record;
}

// The frame of a twisted limb under LBS.
analysis::CaseRecord twisted(double change_pct)
{
    analysis::CaseRecord record = clip("limb", "lbs", change_pct);
    record.place = {.body = "limb", .motion = "twist"};
    record.angle_deg.assign(record.frame.size(), 150.0);
    return record;
}

// Six bodies, of which `wrong` have one change and the others another one; and what the controls lose.
struct SixBodies {
    const char *claim, *deformer, *variant;
    double change_pct, wrong_pct;
    double must_fail_pct, must_hold_pct;
};

VerdictKind verdict(const SixBodies& of, int wrong)
{
    analysis::Records records;
    for (const char* body : {"a", "b", "c", "d", "e", "f"}) {
        records.cases.push_back(clip(body, of.deformer, wrong-- > 0 ? of.wrong_pct : of.change_pct, of.variant));
        for (const char* control : {"lbs", "dqs", "pbs", "nh_p1"})
            if (control != std::string(of.deformer)) records.cases.push_back(clip(body, control, of.must_fail_pct));
    }
    records.cases.push_back(clip("a", "nh_p2_nu_049", of.must_hold_pct));
    records.cases.push_back(twisted(of.must_hold_pct));
    return judge(claim(of.claim), records).kind;
}

// Theory: a control that fails in 6 of 6 cases gives q = 1/8, by which chance reaches 4 of 6 with a probability of
// 0.003.
TEST(VolumeVerdict, TurnsWithTheBodiesAndTheControls)
{
    using enum VerdictKind;
    for (const SixBodies& of : {SixBodies{"C01", "lbs", "default", -14.0, -8.0, -0.5, -14.0},
                                SixBodies{"C02a", "pbs_orders", "default", -0.3, -2.0, -8.0, 0.1},
                                SixBodies{"C02b", "pbs_orders", "jiggle", 0.3, -2.0, -8.0, 0.1}}) {
        for (const auto& [wrong, kind] : {std::pair(0, holds), {2, mixed}, {3, fails}, {6, fails}})
            EXPECT_EQ(verdict(of, wrong), kind) << of.claim << ", " << wrong;
        SixBodies all_lose = of, none_holds = of;
        all_lose.must_fail_pct = of.change_pct;
        none_holds.must_hold_pct = -50.0;
        EXPECT_EQ(verdict(all_lose, 0), inconclusive) << of.claim << ": what must fail holds";
        EXPECT_EQ(verdict(none_holds, 0), inconclusive) << of.claim << ": what must hold fails";
    }
}

TEST(VolumeVerdict, EachClipHasTheDeformersOfItsClaims)
{
    for (const experiments::StudyRun& run : experiments::volume_study().plan(true).runs) {
        if (run.beside || run.scene.motion.clip.empty()) continue;
        const auto has = [&](const std::string& name, const std::string& variant) {
            return std::ranges::any_of(run.scene.deformers, [&](const experiments::DeformerSpec& spec) {
                const auto* pbs = experiments::options_if<pbs::PbsOptions>(spec);
                return spec.name == name && spec.variant == variant &&
                       (name != "pbs_orders" ||
                        (pbs->order == pbs::Order::plain && pbs->precision == pbs::Precision::f64));
            });
        };
        for (const char* name : {"lbs", "dqs", "pbs", "pbs_orders", "pbs_author"})
            EXPECT_TRUE(has(name, "default")) << run.name << ", " << name;
        for (const char* name : {"pbs", "pbs_orders"}) EXPECT_TRUE(has(name, "jiggle")) << run.name << ", " << name;
    }
}

// C01 is about blending: no defect of the solver may change the values of LBS, to the bit, while those of the solver
// change. A broken blend must change them. Reference: LBS does not depend on Algorithm 1; weights that bind every
// vertex to one bone distort only the tets across the joint, so a twist loses less.

analysis::Records limb_twist(Broken how, const std::string& weights = "paper")
{
    const experiments::Scene scene = experiments::read_scene(
        "limb_twist", {"character.vertices=400", "motion.frames=7", "output.frames_every=0", R"(reference.name="")",
                       R"(deformers.use=["lbs", "pbs"])", "skinning.weights=\"" + weights + "\""});
    experiments::StudyPlan plan;
    plan.runs.push_back({.name = "limb_twist", .scene = broken(scene, how), .motion = "twist", .cost_s = 1.0});
    return records_of(plan);
}

const std::vector<double>& volume_change_pct(const analysis::Records& records, const std::string& deformer)
{
    return std::find_if(records.cases.begin(), records.cases.end(),
                        [&](const auto& one) { return one.deformer == deformer; })
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
    const analysis::Claim c01 = claim("C01");
    const auto control =
        std::ranges::find(c01.others, "LBS on the limb twisted by 150 deg", &analysis::Selection::name);
    const auto loss_at_150_deg = [&](const analysis::Records& records) {
        std::vector<analysis::Measurement> measured;
        for (const analysis::CaseRecord& record : records.cases)
            std::ranges::move(frame_measurements(record), std::back_inserter(measured));
        return judged(c01, *control, measured).cases.at(0).value;
    };
    EXPECT_GT(loss_at_150_deg(sound), 0.0);
    for (const Broken how : every_broken) {
        const bool in_plain_order = sound_beside(how) == Broken::nothing_in_plain_order;
        const analysis::Records records = limb_twist(how);
        EXPECT_EQ(loss_at_150_deg(records), loss_at_150_deg(sound)) << name_of(how);
        EXPECT_EQ(volume_change_pct(records, "lbs"), volume_change_pct(sound, "lbs")) << name_of(how);
        EXPECT_NE(volume_change_pct(records, "pbs"), volume_change_pct(in_plain_order ? plain : sound, "pbs"))
            << name_of(how);
    }
    const double rigid_pct = mean_loss_pct(limb_twist(Broken::nothing, "rigid"));
    EXPECT_GT(rigid_pct, 0.0);
    EXPECT_LT(rigid_pct, mean_loss_pct(sound));
}

}  // namespace
