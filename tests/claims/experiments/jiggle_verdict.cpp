// C09 is judged from the values that the study of jiggle writes: if the responses behind them are altered, the verdict changes. Reference:
// the project's own claims.toml; flesh that swings like elastic flesh, with f proportional to sqrt(k) for any step and number of
// iterations.
#include "tests/support/jiggle_responses.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace {

using analysis::VerdictKind;
using experiments::JiggleSetting;
using experiments::MeasuredJiggle;
using test_support::creeping;
using test_support::swinging;

constexpr double width = 0.01;

std::vector<MeasuredJiggle> flesh(const std::function<double(const JiggleSetting&)>& hz)
{
    std::vector<MeasuredJiggle> measured;
    for (const JiggleSetting& setting : experiments::jiggle_settings()) measured.push_back(swinging(setting, hz(setting), width));
    return measured;
}

double elastic_hz(const JiggleSetting& setting)
{
    return 10.0 * std::sqrt(setting.k_stretch);
}

VerdictKind verdict(const std::vector<std::vector<MeasuredJiggle>>& bodies)
{
    analysis::Records records;
    for (std::size_t body = 0; body < bodies.size(); ++body)
        for (const auto& value : experiments::jiggle_values("body " + std::to_string(body), bodies[body]))
            records.measurements.push_back(value);
    return judge(test_support::claim("C09"), records).kind;
}

TEST(JiggleVerdict, EveryJudgedQuantityIsWrittenAndNoneUnknown)
{
    const analysis::Claim claim = test_support::claim("C09");
    std::set<std::string> known(claim.metrics.begin(), claim.metrics.end()), written;
    for (const auto& value : experiments::jiggle_values("limb", flesh(elastic_hz))) written.insert(value.quantity);
    for (const std::string& quantity : known) EXPECT_TRUE(written.contains(quantity)) << quantity;
    known.insert(claim.reported.begin(), claim.reported.end());
    for (const std::string& quantity : written) EXPECT_TRUE(known.contains(quantity)) << quantity;
}

TEST(JiggleVerdict, FleshSetByKStretchAloneIsReproduced)
{
    EXPECT_EQ(verdict({flesh(elastic_hz)}), VerdictKind::reproduced);
}

TEST(JiggleVerdict, OneSettingThatDoesNotSwingTurnsIt)
{
    auto measured = flesh(elastic_hz);
    for (MeasuredJiggle& one : measured)
        if (one.setting.iterations == 96) one = creeping(one.setting);
    EXPECT_EQ(verdict({measured}), VerdictKind::not_reproduced);
    EXPECT_EQ(verdict({measured, flesh(elastic_hz)}), VerdictKind::reproduced_only_for);
}

TEST(JiggleVerdict, OtherReadingsDoNotTurnIt)
{
    auto measured = flesh(elastic_hz);
    for (MeasuredJiggle& one : measured)
        if (!is_of_the_paper(one.setting)) one = creeping(one.setting);
    EXPECT_EQ(verdict({measured}), VerdictKind::reproduced);
    for (MeasuredJiggle& one : measured)
        if (!is_of_the_paper(one.setting)) {
            one = swinging(one.setting, 3.0);
            one.response.swing.damping_ratio = {-0.2, -0.3, -0.1};  // the amplitude grows
        }
    EXPECT_EQ(verdict({measured}), VerdictKind::reproduced);
}

TEST(JiggleVerdict, SwingingForEverTurnsIt)
{
    auto measured = flesh(elastic_hz);
    measured.front().response.swing.damping_ratio = {0.0, 0.0, 0.0};
    EXPECT_EQ(verdict({measured}), VerdictKind::reproduced_only_for);
    for (MeasuredJiggle& one : measured) one.response.swing.damping_ratio = {0.0, 0.0, 0.0};
    EXPECT_EQ(verdict({measured}), VerdictKind::not_reproduced);
}

TEST(JiggleVerdict, AFrequencyThatKStretchHardlyMovesTurnsIt)
{
    EXPECT_EQ(verdict({flesh([](const JiggleSetting& s) { return 14.0 + 0.3 * s.k_stretch; })}), VerdictKind::not_reproduced);
    EXPECT_EQ(verdict({flesh([](const JiggleSetting& s) { return 20.0 - 10.0 * std::sqrt(s.k_stretch); })}), VerdictKind::not_reproduced);
}

TEST(JiggleVerdict, AFrequencyPerStepTurnsIt)
{
    EXPECT_EQ(verdict({flesh([](const JiggleSetting& s) { return elastic_hz(s) * 0.01 / s.time_step_s; })}), VerdictKind::not_reproduced);
}

TEST(JiggleVerdict, AFrequencySetByIterationsTurnsIt)
{
    EXPECT_EQ(verdict({flesh([](const JiggleSetting& s) { return elastic_hz(s) * std::sqrt(s.iterations / 24.0); })}),
              VerdictKind::not_reproduced);
}

TEST(JiggleVerdict, NothingJudgedIsNoVerdict)
{
    EXPECT_EQ(verdict({}), VerdictKind::not_computable);
}

}  // namespace
