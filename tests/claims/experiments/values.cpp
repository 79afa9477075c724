// Claims that are judged from few values: the paper's printed ones (C13 to C16), frame rates (C10) and the effort of a
// set-up (C17). If the values are altered, the verdicts change. Reference: Euler's formula, sums and quotients of Table
// 1, derivatives of Eq. 11; times and frames that are made up.
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/timing/timing.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace test_support;
using analysis::VerdictKind;
using namespace experiments;

const analysis::Records& print()
{
    static const analysis::Records records = records_of(experiments::audit_study().plan(false));
    return records;
}

TEST(AuditVerdict, ThePaperContradictsItselfExceptOnItsSizesAndAPrintThatIsMendedIsConsistent)
{
    analysis::Records mended = print();
    for (auto& value : mended.printed) value.printed = value.least;
    EXPECT_EQ(judge(claim("C13"), print()).kind, VerdictKind::holds);
    for (const char* id : {"C14", "C15"})
        EXPECT_EQ(judge(claim(id), print()).kind, VerdictKind::inconsistent_in_print) << id;
    for (const char* id : {"C13", "C14", "C15"}) {
        EXPECT_EQ(judge(claim(id), mended).kind, VerdictKind::holds) << id;
        analysis::Records one_wrong = mended;
        const auto first = std::find_if(one_wrong.printed.begin(), one_wrong.printed.end(),
                                        [&](auto& value) { return value.claim == id; });
        first->printed = first->least - 1.0;
        EXPECT_EQ(judge(claim(id), one_wrong).kind, VerdictKind::inconsistent_in_print) << id;
    }
    EXPECT_EQ(judge(claim("C13"), {}).kind, VerdictKind::not_computable);
}

TEST(AuditVerdict, WhatCannotBeTestedSaysWhy)
{
    const analysis::Verdict verdict = judge(claim("C16"), {});
    EXPECT_EQ(verdict.kind, VerdictKind::untestable);
    EXPECT_NE(verdict.claim.reason.find("no number"), std::string::npos) << verdict.claim.reason;
}

std::vector<analysis::Measurement> timed(const std::string& model, double ms, double lbs_ms = 0.02)
{
    FrameTiming timing{.variant = "plain", .precision = "f64"};
    timing.lbs_ms = {lbs_ms, lbs_ms, lbs_ms, 9};
    timing.total_wall_ms = {ms, 0.9 * ms, 1.1 * ms, 9};
    timing.total_ms = {1.0, 1.0, 1.0, 9};  // processor time is not judged
    FrameTiming quicker{.variant = "ordered", .precision = "f32"}, slower{.variant = "plain", .precision = "f32"};
    quicker.total_wall_ms = {1.0, 1.0, 1.0, 9};
    slower.total_wall_ms = {1e3, 1e3, 1e3, 9};  // neither are these
    TimingRow mesh{.mesh = "mesh", .body = "human", .model = model};
    mesh.is_refined = model.empty();
    return timing_measurements(timing_rows(mesh, {timing, quicker, slower}));
}

// The models of Table 1, of which the last one takes these milliseconds, and the control.
VerdictKind of_timing(double ms, double last_ms, const std::vector<analysis::Measurement>& control = timed("", 600.0),
                      double lbs_ms = 0.02)
{
    std::vector<std::vector<analysis::Measurement>> all = {control};
    for (const char* model : {"Man", "ManHQ", "bunny", "bunnyHQ"}) all.push_back(timed(model, ms, lbs_ms));
    all.push_back(timed("Lady", last_ms));
    return verdict_on("C10a", joined(all));
}

// The control fails in one case of one: q = 1 / 3, which reaches 5 of 5 cases with 1 / 243 and 4 with 11 / 243.
TEST(TimingVerdict, TurnsWithTheTimesOfTableOnesSizes)
{
    EXPECT_EQ(of_timing(5.0, 6.0), VerdictKind::holds);
    EXPECT_EQ(of_timing(5.0, 33.0), VerdictKind::holds) << "the median counts";
    EXPECT_EQ(of_timing(5.0, 60.0), VerdictKind::not_shown) << "chance";
    EXPECT_EQ(of_timing(50.0, 60.0), VerdictKind::fails);
    EXPECT_EQ(of_timing(5.0, 6.0, timed("", 20.0)), VerdictKind::inconclusive) << "the control runs in real time";
    EXPECT_EQ(of_timing(5.0, 6.0, {}), VerdictKind::inconclusive) << "no control";
    EXPECT_EQ(of_timing(5.0, 6.0, timed("", 600.0), 40.0), VerdictKind::inconclusive) << "LBS takes longer";
    EXPECT_EQ(verdict_on("C10a", joined({timed("Man", 5.0), timed("", 600.0)})), VerdictKind::inconclusive)
        << "one model";
}

// The 100 frames of a body, with an inverted tet in every n-th; n = 0: in none.
std::vector<analysis::Measurement> body(const std::string& name, int every,
                                        const std::vector<std::string>& changed = {})
{
    analysis::CsvTable metrics({"volume_change_pct", "inverted_tets"});
    for (int frame = 0; frame < 100; ++frame)
        metrics.add_row({-0.1 * (frame % 7), every && frame % every == 0 ? 1 : 0});
    const nlohmann::json run = {{"cost", {{"cpu_seconds", {{"character", 3.0}, {"motion", 0.25}, {"set_up", 0.5}}}}}};
    return experiments::setup_measurements({.body = name, .deformer = "pbs"}, metrics, run, changed);
}

// The verdict on this body and six others that run as they are, the fewest that a coin hardly reaches, with the
// control.
VerdictKind of_setup(const std::vector<analysis::Measurement>& one)
{
    std::vector<std::vector<analysis::Measurement>> all = {one};
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) all.push_back(body(name, 0));
    for (const char* name : {"open_surface", "without_bones"})
        all.push_back(not_set_up({.body = name, .deformer = "pbs_unsuitable"}));
    return verdict_on("C17", joined(all));
}

// Frames that turn inside out are shown only.
TEST(SetupVerdict, TurnsWithABodyThatNeverRunsAndNeedsTheControl)
{
    EXPECT_EQ(of_setup(body("ring", 0)), VerdictKind::holds);
    EXPECT_EQ(of_setup(body("ring", 2)), VerdictKind::holds);
    EXPECT_EQ(of_setup(not_set_up({.body = "ring", .deformer = "pbs"})), VerdictKind::not_shown);
    EXPECT_EQ(verdict_on("C17", body("ring", 0)), VerdictKind::inconclusive);
}

// The keys that a body has changed if it runs with only those of `trial`, as the study finds them.
std::vector<std::string> changed_for(std::size_t trial)
{
    const auto tried = tried_setups({"ring"}, [&](const BodySetup& setup) {
        return std::string(setup.further == further_keys().at(trial) ? "" : "not finite");
    });
    return keys_changed(shared_scene(5.0).resolved, scene_of(tried.back().setup, 5.0).resolved);
}

TEST(SetupVerdict, ABodyThatNeedsAFurtherKeyFlipsIt)
{
    EXPECT_EQ(of_setup(body("ring", 0, changed_for(0))), VerdictKind::holds);
    EXPECT_EQ(of_setup(body("ring", 0, changed_for(1))), VerdictKind::not_shown);
    EXPECT_EQ(of_setup(body("ring", 0, changed_for(3))), VerdictKind::not_shown);
}

}  // namespace
