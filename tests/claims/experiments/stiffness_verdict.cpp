// C11 is judged by the values of the stiffness study, and other values give another verdict. Reference: the project's own claims.toml. The
// stiffnesses are invented; the values are those that the study computes from them.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using analysis::VerdictKind;
using namespace experiments;

// K = iterations^p, dt^-q, vertices^r, once per method.
std::vector<analysis::Measurement> measured(Method method, double p, double q, double r, const std::string& body = "limb",
                                            const std::string& load = "zone")
{
    std::vector<StiffnessRow> iterations, time_steps, resolutions;
    StiffnessRow row;
    row.body = body;
    row.load = load;
    row.vertices = 600;
    row.setting.method = method;
    row.converged = true;
    for (const double factor : {0.5, 1.0, 2.0}) {
        StiffnessRow other = row;
        other.setting.iterations = static_cast<int>(24 * factor);
        other.stiffness_n_m = std::pow(factor, p);
        iterations.push_back(other);
        other = row;
        other.setting.time_step_ms = 10.0 / factor;
        other.stiffness_n_m = std::pow(factor, q);
        time_steps.push_back(other);
        other = row;
        other.vertices = static_cast<int>(600 * factor);
        other.stiffness_n_m = std::pow(factor, r);
        resolutions.push_back(other);
    }
    std::vector<analysis::Measurement> all = stiffness_ratios(iterations, Varied::iterations);
    for (const auto& more : {stiffness_ratios(time_steps, Varied::time_step), stiffness_ratios(resolutions, Varied::resolution)})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

analysis::Verdict verdict(const std::vector<analysis::Measurement>& measurements)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    const auto claim = std::find_if(claims.begin(), claims.end(), [](const analysis::Claim& of) { return of.id == "C11"; });
    analysis::Records records;
    records.measurements = measurements;
    return judge(*claim, records);
}

TEST(StiffnessVerdict, TurnsWithTheFigures)
{
    EXPECT_EQ(verdict(measured(Method::pbs, 0.0, 0.0, 0.0)).kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict(measured(Method::pbs, 1.0, 2.0, -0.7)).kind, VerdictKind::not_reproduced);
    EXPECT_EQ(verdict(measured(Method::pbs, 0.0, 2.0, 0.0)).kind, VerdictKind::not_reproduced);  // each quantity needs a value that holds
    auto two_bodies = measured(Method::pbs, 0.0, 0.0, 0.0);
    for (const auto& other : measured(Method::pbs, 1.0, 2.0, -0.7, "human")) two_bodies.push_back(other);
    EXPECT_EQ(verdict(two_bodies).kind, VerdictKind::reproduced_only_for);
}

// Held flesh is not what the paper runs.
TEST(StiffnessVerdict, FleshHeldIsAControl)
{
    for (const char* load : {"zone_on_held", "cantilever"}) {
        auto both = measured(Method::pbs, 0.0, 0.0, 0.0);
        for (const auto& held : measured(Method::pbs, 1.0, 2.0, -0.7, "bar", load)) both.push_back(held);
        const analysis::Verdict judged = verdict(both);
        EXPECT_EQ(judged.kind, VerdictKind::reproduced);
        ASSERT_EQ(judged.controls.size(), 3u);
        for (const auto& held : judged.controls) EXPECT_EQ(held.of.load, load);
    }
}

TEST(StiffnessVerdict, IsOfThePaperAlone)
{
    auto both = measured(Method::pbs, 1.0, 2.0, -0.7);
    for (const auto& control : measured(Method::xpbd, 0.0, 0.0, 0.0)) both.push_back(control);
    const analysis::Verdict judged = verdict(both);
    EXPECT_EQ(judged.kind, VerdictKind::not_reproduced);
    EXPECT_EQ(judged.measurements.size(), 3u);
    EXPECT_EQ(judged.controls.size(), 3u);
}

TEST(StiffnessVerdict, NeedsFigures)
{
    EXPECT_EQ(verdict(measured(Method::xpbd, 0.0, 0.0, 0.0)).kind, VerdictKind::not_computable);
}

}  // namespace
