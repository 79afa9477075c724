// C17 is judged from the measurements of the setup study: if they are altered, the verdict changes. Reference: the project's own
// claims.toml. The frames are invented, and the values are computed from them by the study's own functions.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/studies/setup/body_setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::VerdictKind;

// The 100 frames of a body, with an inverted tet in every n-th; n = 0: in none.
std::vector<analysis::Measurement> body(const std::string& name, int every, const std::vector<std::string>& changed = {})
{
    analysis::CsvTable metrics({"volume_change_pct", "inverted_tets"});
    for (int frame = 0; frame < 100; ++frame) metrics.add_row({-0.1 * (frame % 7), every && frame % every == 0 ? 1 : 0});
    const nlohmann::json run = {{"cost", {{"cpu_seconds", {{"character", 3.0}, {"motion", 0.25}, {"set_up", 0.5}}}}}};
    return experiments::setup_measurements({.body = name}, metrics, run, changed);
}

VerdictKind verdict(const std::vector<std::vector<analysis::Measurement>>& bodies)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    const auto claim = std::find_if(claims.begin(), claims.end(), [](const auto& one) { return one.id == "C17"; });
    analysis::Records records;
    for (const auto& measured : bodies) records.measurements.insert(records.measurements.end(), measured.begin(), measured.end());
    return judge(*claim, records).kind;
}

TEST(SetupVerdict, ABodyThatTurnsInsideOutIsNotAccommodated)
{
    EXPECT_EQ(verdict({body("human", 0), body("ring", 0)}), VerdictKind::reproduced);
    EXPECT_EQ(verdict({body("human", 0), body("frankie", 2)}), VerdictKind::reproduced_only_for);
}

// The keys that a body has changed if it runs with only those of `trial`, as the study finds them.
std::vector<std::string> changed_for(std::size_t trial)
{
    using namespace experiments;
    const auto tried = tried_setups(
        {"ring"}, [&](const BodySetup& setup) { return std::string(setup.further == further_keys().at(trial) ? "" : "not finite"); });
    return keys_changed(shared_scene(5.0).resolved, scene_of(tried.back().setup, 5.0).resolved);
}

TEST(SetupVerdict, ABodyThatNeedsAFurtherKeyFlipsIt)
{
    EXPECT_EQ(verdict({body("human", 0), body("ring", 0, changed_for(0))}), VerdictKind::reproduced);
    EXPECT_EQ(verdict({body("human", 0), body("ring", 0, changed_for(1))}), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict({body("ring", 0, changed_for(3))}), VerdictKind::not_reproduced);
}

TEST(SetupVerdict, ABodyThatNeverRunsFlipsIt)
{
    EXPECT_EQ(verdict({body("human", 0), experiments::not_set_up({.body = "ring"})}), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict({experiments::not_set_up({.body = "ring"})}), VerdictKind::not_reproduced);
}

TEST(SetupVerdict, NothingMeasuredIsNoVerdict)
{
    EXPECT_EQ(verdict({}), VerdictKind::not_computable);
}

}  // namespace
