// C11 from a small limb's held flesh, with XPBD's multipliers kept and forgotten. Reference: with its multipliers the stiffness is the
// material's, whatever the iterations and the time step. Without them a single constraint of inverse masses w is reduced to 1 / (1 + a) of
// its error, a = w dt^2 / alpha, in every iteration, so n iterations hang with K = ((1 + a)^n - 1) / dt^2:
//   twice the iterations   (1 + a)^n + 1 times as stiff: two and more
//   half the time step     4 ((1 + a / 4)^n - 1) / ((1 + a)^n - 1) times: one and less
// The same holds for every mode of a body with one rate per iteration. Rigid constraints, with infinite a, do not depend on the time step
// and are four times as stiff at half of it, so "one and less" is for flesh without bind constraints.
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "tests/support/study_claims.hpp"

#include "analysis/verdicts/measurement.hpp"
#include "pbs/character/bodies.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using analysis::Measurement;
using analysis::VerdictKind;

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

// XPBD's values in place of those of the paper's solver: the control has to give this verdict.
std::vector<Measurement> control(Method method)
{
    std::vector<Measurement> measured;
    for (const Varied varied : {Varied::iterations, Varied::time_step})
        for (Measurement measurement : ratios(held_flesh(), method, varied)) {
            measurement.of.deformer = "pbs";
            measurement.of.load = "zone";
            measured.push_back(measurement);
        }
    measured.push_back({"C11", "stiffness_ratio_at_twice_resolution", measured.front().of, 1.0, 1.0, 1.0, "1"});  // not varied
    return measured;
}

VerdictKind verdict(const std::vector<Measurement>& measured)
{
    analysis::Records records;
    records.measurements = measured;
    return judge(test_support::claim("C11"), records).kind;
}

TEST(BrokenStiffness, ForgottenMultipliersTurnTheControl)
{
    EXPECT_EQ(verdict(control(Method::xpbd)), VerdictKind::reproduced);
    EXPECT_NE(verdict(control(Method::xpbd_forgetting)), VerdictKind::reproduced);
}

TEST(BrokenStiffness, ForgottenMultipliersAreStiffenedByIterations)
{
    for (const LoadedBody& flesh : {held_flesh(), without_bind(held_flesh())}) {
        const Measurement iterations = ratios(flesh, Method::xpbd_forgetting, Varied::iterations).at(0);
        EXPECT_GE(iterations.low, 2.0);
        EXPECT_EQ(iterations.quantity, "stiffness_ratio_at_twice_iterations");
        EXPECT_EQ(iterations.of.deformer, "xpbd_forgetting_multipliers");
    }
}

TEST(BrokenStiffness, ForgottenMultipliersAreSoftenedByShortSteps)
{
    // This is below the claim's bound as well, since a is not small.
    EXPECT_LT(ratios(without_bind(held_flesh()), Method::xpbd_forgetting, Varied::time_step).at(0).high, test_support::claim("C11").low);
}

}  // namespace
