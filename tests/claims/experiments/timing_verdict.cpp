// C10 is judged from what the study `timing` measures: other times reverse the verdict. The claim is that of claims.toml, and the times are
// made up.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/studies/timing/frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::VerdictKind;
using namespace experiments;

std::vector<TimingRow> timed(const std::string& body, const std::string& model, double median_ms, double upper_ms)
{
    FrameTiming timing{.variant = "plain", .precision = "f64"};
    timing.total_wall_ms = {median_ms, 0.9 * median_ms, upper_ms, 9};
    timing.total_ms = {1.0, 1.0, 1.0, 9};  // processor time is not judged
    FrameTiming quicker{.variant = "ordered", .precision = "f32"}, slower{.variant = "plain", .precision = "f32"};
    quicker.total_wall_ms = {1.0, 1.0, 1.0, 9};
    slower.total_wall_ms = {1e3, 1e3, 1e3, 9};  // neither are these
    return timing_rows({.name = body, .body = body, .model = model}, {timing, quicker, slower});
}

VerdictKind verdict(const std::vector<std::vector<TimingRow>>& meshes)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    const auto claim = std::find_if(claims.begin(), claims.end(), [](const analysis::Claim& of) { return of.id == "C10"; });
    analysis::Records records;
    for (const auto& rows : meshes)
        for (const auto& measurement : timing_measurements(rows)) records.measurements.push_back(measurement);
    return judge(*claim, records).kind;
}

TEST(TimingVerdict, TurnsWithTheTimes)
{
    EXPECT_EQ(verdict({timed("man", "Man", 5.0, 6.0), timed("lady", "Lady", 6.0, 7.0)}), VerdictKind::reproduced);
    EXPECT_EQ(verdict({timed("man", "Man", 5.0, 6.0), timed("lady", "Lady", 60.0, 70.0)}), VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict({timed("man", "Man", 50.0, 60.0), timed("lady", "Lady", 60.0, 70.0)}), VerdictKind::not_reproduced);
}

TEST(TimingVerdict, ALateQuartileIsNoWholeSuccess)
{
    EXPECT_EQ(verdict({timed("man", "Man", 30.0, 32.0), timed("lady", "Lady", 6.0, 7.0)}), VerdictKind::reproduced);
    EXPECT_EQ(verdict({timed("man", "Man", 30.0, 40.0), timed("lady", "Lady", 6.0, 7.0)}), VerdictKind::reproduced_only_for);
}

TEST(TimingVerdict, IsOfTableOnesSizesAlone)
{
    EXPECT_EQ(verdict({timed("human", "", 5.0, 6.0)}), VerdictKind::not_computable);
}

}  // namespace
