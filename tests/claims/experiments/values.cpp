// Claims that are judged from few values: the paper's printed ones (C13 to C15) and the effort of a set-up (C17). If
// the values are altered, the verdicts change. Reference: Euler's formula, sums and quotients of Table 1, derivatives
// of Eq. 11; frames that are made up.
#include "experiments/studies/setup/body_setup.hpp"
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

// 100 frames of a body.
std::vector<analysis::Measurement> body(const std::string& name, const std::vector<std::string>& changed = {})
{
    analysis::CsvTable metrics({"volume_change_pct", "inverted_tets"});
    for (int frame = 0; frame < 100; ++frame) metrics.add_row({-0.1 * (frame % 7), 0});
    const nlohmann::json run = {{"cost", {{"cpu_seconds", {{"character", 3.0}, {"motion", 0.25}, {"set_up", 0.5}}}}}};
    return experiments::setup_measurements({.body = name, .deformer = "pbs"}, metrics, run, changed);
}

// The verdict on this body and six others that run as they are, the fewest that a coin hardly reaches, with the
// control.
VerdictKind of_setup(std::vector<analysis::Measurement> values)
{
    const auto add = [&](const std::vector<analysis::Measurement>& more) {
        values.insert(values.end(), more.begin(), more.end());
    };
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) add(body(name));
    for (const char* name : {"open_surface", "without_bones"})
        add(not_set_up({.body = name, .deformer = "pbs_unsuitable"}));
    return verdict_from("C17", values).kind;
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
    EXPECT_EQ(of_setup(body("ring", changed_for(0))), VerdictKind::holds);
    EXPECT_EQ(of_setup(body("ring", changed_for(1))), VerdictKind::not_shown);
    EXPECT_EQ(of_setup(body("ring", changed_for(3))), VerdictKind::not_shown);
}

}  // namespace
