// C11 from a small limb's held flesh, with XPBD's multipliers kept and forgotten. Reference: with its multipliers the
// stiffness is the material's, whatever the iterations and the time step. Without them a single constraint of inverse
// masses w is reduced to 1 / (1 + a) of its error, a = w dt^2 / alpha, in every iteration, so n iterations hang with K
// = ((1 + a)^n - 1) / dt^2:
//   twice the iterations   (1 + a)^n + 1 times as stiff: two and more
//   half the time step     4 ((1 + a / 4)^n - 1) / ((1 + a)^n - 1) times: one and less
// The same holds for every mode of a body with one rate per iteration. Rigid constraints, with infinite a, do not
// depend on the time step and are four times as stiff at half of it, so "one and less" is for flesh without bind
// constraints.
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiffness_tests {
namespace {

using namespace analysis;
using namespace experiments;

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
