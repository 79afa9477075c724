// Reference: stiffnesses that are powers of what is varied, so that ratios and exponents are known.
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace stiffness_ratios_tests {
namespace {

using namespace experiments;

// The rounding error of a ratio per doubling, (stiffness ratio)^(log 2 / log(x ratio)). The exponent is at most 1 and
// goes through five roundings, of two logarithms and their quotient, and through those of the x ratio over the least
// logarithm here, that of 1.9; the power goes through two, and through those of the stiffness ratio.
double doubling_error(double ratio, double roundings_of_stiffnesses, double roundings_of_x)
{
    const double roundings_of_exponent = 5.0 + roundings_of_x / std::log(1.9);
    return test_support::rounding_error(
        roundings_of_exponent * std::abs(std::log(ratio)) + 2.0 + roundings_of_stiffnesses, ratio);
}

StiffnessRow row(int iterations, double stiffness_n_m)
{
    StiffnessRow row;
    row.body = "limb";
    row.load = "zone";
    row.vertices = 600;
    row.setting.iterations = iterations;
    row.stiffness_n_m = stiffness_n_m;
    row.converged = true;
    return row;
}

std::vector<StiffnessRow> squares()
{
    std::vector<StiffnessRow> rows;
    for (const int n : {3, 6, 12, 24, 48, 96}) rows.push_back(row(n, 7.0 * n * n));
    return rows;
}

TEST(StiffnessRatios, OfASquareIsFourForADoubling)
{
    const auto ratios = stiffness_ratios(squares(), Varied::iterations);
    ASSERT_EQ(ratios.size(), 1u);
    EXPECT_EQ(ratios[0].claim, "C11");
    EXPECT_EQ(ratios[0].quantity, "stiffness_ratio_at_twice_iterations");
    EXPECT_EQ(text_of(ratios[0].of),
              "limb, pbs, vertices 600, k_stretch 0.2, iterations 12 to 48, time_step 0.01 s, load zone");
    for (const double value : {ratios[0].value, ratios[0].low, ratios[0].high})
        EXPECT_NEAR(value, 4.0, doubling_error(4.0, 1, 0));
    const auto exponents = stiffness_exponents(squares(), Varied::iterations);
    std::vector<double> iterations, stiffnesses;
    for (const StiffnessRow& row : squares())
        iterations.push_back(row.setting.iterations), stiffnesses.push_back(row.stiffness_n_m);
    EXPECT_NEAR(exponents.number(0, "exponent"), 2.0, test_support::exponent_error(iterations, stiffnesses, 2.0, 0));
    EXPECT_EQ(exponents.number(0, "first"), 3.0);
    EXPECT_EQ(exponents.number(0, "last"), 96.0);
}

TEST(StiffnessRatios, SpreadOverDoublingsAndOrders)
{
    std::vector<StiffnessRow> rows = {row(12, 1.0), row(24, 3.0), row(48, 6.0), row(12, 1.0), row(24, 5.0)};
    rows[3].setting.order_seed = rows[4].setting.order_seed = 1;
    const auto ratio = stiffness_ratios(rows, Varied::iterations).at(0);
    EXPECT_NEAR(ratio.value, std::sqrt(6.0), doubling_error(std::sqrt(6.0), 1 + 1, 0));
    EXPECT_NEAR(ratio.low, 2.0, doubling_error(2.0, 1, 0));
    EXPECT_NEAR(ratio.high, 5.0, doubling_error(5.0, 1, 0));
}

TEST(StiffnessRatios, LeavesOutWhatDidNotConvergeOrHangsUpwards)
{
    std::vector<StiffnessRow> rows = squares();
    rows[3].converged = false;
    rows[3].stiffness_n_m = 1e6;
    rows[5].stiffness_n_m = -1.0;
    EXPECT_NEAR(stiffness_ratios(rows, Varied::iterations).at(0).high, 4.0, doubling_error(4.0, 1, 0));
    EXPECT_EQ(stiffness_exponents(rows, Varied::iterations).integer(0, "left_out"), 2);
    for (StiffnessRow& all : rows) all.converged = false;
    EXPECT_TRUE(stiffness_ratios(rows, Varied::iterations).empty());
    EXPECT_EQ(stiffness_exponents(rows, Varied::iterations).rows(), 0);
}

TEST(StiffnessRatios, OfHalfTheTimeStepAndOfMeshesThatAreNotQuiteTwiceEachOther)
{
    std::vector<StiffnessRow> steps, meshes;
    for (const double step_ms : {20.0, 10.0, 5.0}) {
        steps.push_back(row(24, 1.0 / (step_ms * step_ms)));
        steps.back().setting.time_step_ms = step_ms;
    }
    const auto ratio = stiffness_ratios(steps, Varied::time_step).at(0);
    EXPECT_EQ(ratio.quantity, "stiffness_ratio_at_half_time_step");
    // squares and quotients, quotients of milliseconds
    EXPECT_NEAR(ratio.value, 4.0, doubling_error(4.0, 2 * 2 + 1, 2 * 2 + 1));
    EXPECT_EQ(text_of(ratio.of),
              "limb, pbs, vertices 600, k_stretch 0.2, iterations 24, time_step 0.02 to 0.005 s, load zone");
    for (const int vertices : {310, 590, 1205}) {
        meshes.push_back(row(24, 1.0 / vertices));
        meshes.back().vertices = vertices;
    }
    const auto of_meshes = stiffness_ratios(meshes, Varied::resolution).at(0);
    for (const double value : {of_meshes.low, of_meshes.high}) EXPECT_NEAR(value, 0.5, doubling_error(0.5, 2 + 1, 1));
}

// The second series of meshes widens the range alone: ratio and exponent are those of the wanted meshes.
TEST(StiffnessRatios, AreThoseOfTheWantedMeshes)
{
    std::vector<StiffnessRow> meshes;
    for (const int vertices : {330, 660, 1320}) {
        meshes.push_back(row(24, 1.0 / (double(vertices) * vertices)));
        meshes.back().mesh = "tenth_finer";
        meshes.back().vertices = vertices;
    }
    for (const int vertices : {300, 600, 1200}) {
        meshes.push_back(row(24, 1.0 / vertices));
        meshes.back().vertices = vertices;
    }
    const auto ratio = stiffness_ratios(meshes, Varied::resolution).at(0);
    EXPECT_NEAR(ratio.value, 0.5, doubling_error(0.5, 2, 0));
    EXPECT_NEAR(ratio.low, 0.25, doubling_error(0.25, 4, 0));
    EXPECT_NEAR(
        stiffness_exponents(meshes, Varied::resolution).number(0, "exponent"), -1.0,
        test_support::exponent_error({300.0, 600.0, 1200.0}, {1.0 / 300.0, 1.0 / 600.0, 1.0 / 1200.0}, -1.0, 1));
}

// All five run at the same settings, and none is mistaken for another.
TEST(StiffnessRatios, TellTheMethodsApart)
{
    std::vector<StiffnessRow> rows;
    const std::pair<Method, double> constant[] = {{Method::pbs, 0.0},
                                                  {Method::exponent, 1.0},
                                                  {Method::xpbd, 2.0},
                                                  {Method::xpbd_small_steps, 3.0},
                                                  {Method::xpbd_forgetting, 4.0}};
    for (const auto& [method, power] : constant)
        for (StiffnessRow of_method : squares()) {
            of_method.setting.method = method;
            of_method.stiffness_n_m = std::pow(of_method.setting.iterations, power);
            rows.push_back(of_method);
        }
    const auto ratios = stiffness_ratios(rows, Varied::iterations);
    ASSERT_EQ(ratios.size(), 5u);
    for (const auto& ratio : ratios) {
        EXPECT_NEAR(ratio.low, ratio.high, 2.0 * doubling_error(ratio.high, 2 * 2 + 1, 0));  // powers of two roundings
        EXPECT_EQ(ratio.of.deformer != "pbs", ratio.value > 1.5) << ratio.of.deformer;
    }
    std::set<std::string> deformers;
    for (const auto& ratio : ratios) deformers.insert(ratio.of.deformer);
    EXPECT_EQ(deformers, (std::set<std::string>{"pbs", "pbs_exponent", "xpbd", "xpbd_small_steps",
                                                "xpbd_forgetting_multipliers"}));
}

}  // namespace
}  // namespace stiffness_ratios_tests
