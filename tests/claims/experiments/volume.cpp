// The study of C01 and C02 has the deformers of its claims. C01 is about blending: no defect of the solver changes the
// values of LBS. Reference: the project's own claims.toml.

#include "experiments/deformers/deformer_options.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace {

using namespace test_support;

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
