// C11 reports values of the stiffness study: those of PBS as the paper runs it. Reference: the project's own
// claims.toml. The stiffnesses are invented; the values are those that the study computes from them.

#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiffness_tests {
namespace {

using namespace analysis;
using namespace experiments;
using test_support::joined;

// K = iterations^p and dt^-q, of PBS at two settings of k_stretch.
std::vector<Measurement> measured(Method method, double p, double q, const std::string& body = "limb",
                                  const std::string& load = "zone")
{
    std::vector<StiffnessRow> iterations, time_steps;
    for (const double k_stretch : is_xpbd(method) ? std::vector{0.2} : std::vector{0.2, 0.9})
        for (const double factor : {0.5, 1.0, 2.0}) {
            StiffnessRow row{
                .body = body, .load = load, .vertices = 600, .setting = {.method = method, .k_stretch = k_stretch}};
            row.converged = true;
            StiffnessRow& more = iterations.emplace_back(row);
            more.setting.iterations = static_cast<int>(24 * factor);
            more.stiffness_n_m = std::pow(factor, p);
            StiffnessRow& shorter = time_steps.emplace_back(row);
            shorter.setting.time_step_ms = 10.0 / factor;
            shorter.stiffness_n_m = std::pow(factor, q);
        }
    return joined({stiffness_ratios(iterations, Varied::iterations), stiffness_ratios(time_steps, Varied::time_step)});
}

void expect_numbers(const Judged& judged, const std::vector<double>& numbers)
{
    ASSERT_EQ(judged.cases.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_DOUBLE_EQ(judged.cases[i].value, numbers[i]) << i;
}

// The sentence is a definition, whatever the values. They are the paper's solver's alone; XPBD in small steps is
// compared under the same load.
TEST(StiffnessVerdict, IsADefinitionWithTheValuesOfThePaperAlone)
{
    const Verdict verdict = test_support::verdict_from(
        "C11", joined({measured(Method::pbs, 1.0, 2.0), measured(Method::pbs, 2.0, 2.0, "human"),
                       measured(Method::exponent, 3.0, 2.0), measured(Method::pbs, 3.0, 2.0, "limb", "zone_on_held"),
                       measured(Method::pbs, 3.0, 2.0, "bar", "cantilever"), measured(Method::xpbd, 3.0, 2.0),
                       measured(Method::xpbd_small_steps, 0.0, 0.0),
                       measured(Method::xpbd_small_steps, 3.0, 0.0, "limb", "zone_on_held")}));
    EXPECT_EQ(verdict.kind, VerdictKind::definition);
    expect_numbers(verdict.own, {2.0, 2.0, 4.0, 4.0});
    ASSERT_EQ(verdict.others.size(), 2u);
    expect_numbers(verdict.others[0], {4.0, 4.0, 4.0, 4.0});
    expect_numbers(verdict.others[1], {1.0});
    EXPECT_TRUE(test_support::verdict_from("C11", measured(Method::xpbd, 1.0, 2.0)).own.cases.empty())
        << "the claim is on PBS";
}

// C11 from a small limb's held flesh, with XPBD's multipliers kept and forgotten. Reference: with its multipliers the
// stiffness is the material's, whatever the iterations and the time step. Without them a single constraint of inverse
// masses w is reduced to 1 / (1 + a) of its error, a = w dt^2 / alpha, in every iteration, so n iterations hang with K
// = ((1 + a)^n - 1) / dt^2:
//   twice the iterations   (1 + a)^n + 1 times as stiff: two and more
//   half the time step     4 ((1 + a / 4)^n - 1) / ((1 + a)^n - 1) times: one and less
// The same holds for every mode of a body with one rate per iteration. Rigid constraints, with infinite a, do not
// depend on the time step and are four times as stiff at half of it, so "one and less" is for flesh without bind
// constraints.

LoadedBody held_flesh()
{
    static const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 300, .surface = false});
    return jiggling_flesh(limb, RestOfBody::held);
}

LoadedBody without_bind(LoadedBody flesh)
{
    flesh.bind_distance.resize(0);
    return flesh;
}

std::vector<Measurement> ratios(const LoadedBody& flesh, Method method, Varied varied)
{
    std::vector<StiffnessRow> rows;
    for (const double factor : {0.5, 1.0, 2.0}) {
        StiffnessSetting setting{.method = method};
        if (varied == Varied::iterations) setting.iterations = static_cast<int>(setting.iterations * factor);
        if (varied == Varied::time_step) setting.time_step_ms /= factor;
        rows.push_back(linear_stiffness(flesh, setting));
        EXPECT_TRUE(rows.back().converged);
    }
    return stiffness_ratios(rows, varied);
}

// Within a tenth, by which the study's report tells a material's stiffness from one that changes.
TEST(BrokenStiffness, KeptMultipliersKeepTheStiffness)
{
    for (const Varied varied : {Varied::iterations, Varied::time_step})
        for (const Measurement& ratio : ratios(held_flesh(), Method::xpbd, varied)) {
            EXPECT_GE(ratio.low, 0.9);
            EXPECT_LE(ratio.high, 1.1);
        }
}

TEST(BrokenStiffness, ForgottenMultipliersAreStiffenedByIterationsAndSoftenedByShortSteps)
{
    for (const LoadedBody& flesh : {held_flesh(), without_bind(held_flesh())}) {
        const Measurement iterations = ratios(flesh, Method::xpbd_forgetting, Varied::iterations).at(0);
        EXPECT_GE(iterations.low, 2.0);
        EXPECT_EQ(iterations.quantity, "stiffness_ratio_at_twice_iterations");
        EXPECT_EQ(iterations.of.deformer, "xpbd_forgetting_multipliers");
    }
    // This is below one by more than a tenth, since a is not small.
    EXPECT_LT(ratios(without_bind(held_flesh()), Method::xpbd_forgetting, Varied::time_step).at(0).high, 0.9);
}

}  // namespace
}  // namespace stiffness_tests
