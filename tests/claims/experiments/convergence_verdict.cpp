// The verdicts on C03 and C12 follow from the values that the convergence study writes, and change when the paths behind them are altered.
// Reference: the rules in experiments/verdicts/claims.toml.
#include "experiments/studies/convergence/convergence_case.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::VerdictKind;
using experiments::ConvergencePaths;
using test_support::path_by;
using test_support::starts_at_rates;

VerdictKind kind_for(const std::string& id, const std::vector<ConvergencePaths>& paths)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), "claims.toml");
    const auto claim = std::find_if(claims.begin(), claims.end(), [&](const analysis::Claim& entry) { return entry.id == id; });
    return analysis::judge(*claim, {.measurements = experiments::convergence_values({paths, false, ""})}).kind;
}

// The volume converges after one iteration from LBS and after two from all other initial guesses, so only the residual decides.
ConvergencePaths by_residual(const std::vector<double>& rates)
{
    ConvergencePaths paths = starts_at_rates(1780, rates);
    for (std::size_t start = 0; start < paths.paths.size(); ++start)
        for (auto& look : paths.paths[start].looks) look.volume_abs_change_pct = look.iteration < (start ? 2 : 1) ? 1.0 : 0.0;
    return paths;
}

TEST(LbsIsTheBetterStart, ReproducedWhereEveryOtherTakesLonger)
{
    EXPECT_EQ(kind_for("C03", {by_residual({0.8, 0.9, 0.95, 0.85})}), VerdictKind::reproduced);
}

TEST(LbsIsTheBetterStart, FlipsWithTheRateOfOneStart)
{
    EXPECT_EQ(kind_for("C03", {by_residual({0.8, 0.7, 0.95, 0.85})}), VerdictKind::reproduced_only_for);
}

TEST(LbsIsTheBetterStart, FlipsWithAnotherOrderOfTheSamePose)
{
    EXPECT_EQ(kind_for("C03", {by_residual({0.8, 0.9, 0.95, 0.85}), by_residual({0.92, 0.9, 0.95, 0.85})}),
              VerdictKind::reproduced_only_for);
}

TEST(LbsIsTheBetterStart, NotReproducedWhereItIsTheSlowest)
{
    ConvergencePaths paths = by_residual({0.95, 0.8, 0.8, 0.8});
    paths.paths[0] = path_by(1000, [](int n) { return n < 500 ? 2.0 : 1.0; });  // late by volume too
    EXPECT_EQ(kind_for("C03", {paths}), VerdictKind::not_reproduced);
}

TEST(LbsIsTheBetterStart, FlipsWhereNeitherStartArrivesInAnotherOrder)
{
    ConvergencePaths lost = by_residual({0.8, 0.9, 0.95, 0.85});
    for (auto& path : lost.paths)
        for (auto& look : path.looks) look.volume_abs_change_pct = 1.0;
    EXPECT_EQ(kind_for("C03", {by_residual({0.8, 0.9, 0.95, 0.85}), lost}), VerdictKind::reproduced_only_for);
}

TEST(LbsIsTheBetterStart, TwistsAreNotJudged)
{
    ConvergencePaths twist = by_residual({0.8, 0.9, 0.95, 0.85});
    twist.twist = true;
    EXPECT_EQ(kind_for("C03", {twist}), VerdictKind::not_computable);
}

TEST(TwentyFourIterationsSuffice, OfTheLimbAreNotJudged)
{
    ConvergencePaths limb = by_residual({0.89, 0.9, 0.9, 0.9});
    limb.character = false;
    EXPECT_EQ(kind_for("C12", {limb}), VerdictKind::not_computable);
}

TEST(TwentyFourIterationsSuffice, FlipsWhereThePathIsLonger)
{
    EXPECT_EQ(kind_for("C12", {by_residual({0.88, 0.9, 0.9, 0.9})}), VerdictKind::reproduced);           // ceil(log 0.05 / log 0.88) = 24
    EXPECT_EQ(kind_for("C12", {by_residual({0.89, 0.9, 0.9, 0.9})}), VerdictKind::reproduced_only_for);  // 26; by volume 1
}

TEST(TwentyFourIterationsSuffice, FlipsWithAnotherOrderOfTheSamePose)
{
    EXPECT_EQ(kind_for("C12", {by_residual({0.88, 0.9, 0.9, 0.9}), by_residual({0.89, 0.9, 0.9, 0.9})}), VerdictKind::reproduced_only_for);
}

TEST(TwentyFourIterationsSuffice, NotReproducedWhereNeitherToleranceIsReached)
{
    ConvergencePaths paths = by_residual({0.999, 0.5, 0.5, 0.5});
    for (auto& look : paths.paths[0].looks) look.volume_abs_change_pct = 0.51;
    EXPECT_EQ(kind_for("C12", {paths}), VerdictKind::not_reproduced);
}

}  // namespace
