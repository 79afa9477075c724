// Reference: the solvers themselves, stepped until the flesh hangs still. The load is so small that displacements are 1e-5 of an edge, so
// the second order is 1e-5. Stepping stops at a change of 1e-6 per step, which is divided by one minus the slowest rate, above 1/40 here.
// The limb has vertices on its bones, d = 0. The other reference is theory: a step of the position based solver does not depend on dt, so
// its stiffness scales with 1 / dt^2; that of converged XPBD is the material's.
#include "experiments/studies/stiffness/resting_body.hpp"

#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

LoadedBody limb(RestOfBody rest)
{
    static const pbs::Character character = test_support::character_of(test_support::two_bone_limb({10, 4, 4}, pbs::Vec3::UnitZ(), 0.0));
    return jiggling_flesh(character, rest);
}

double stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    const pbs::RestingState rest = rest_near_rest(body, setting);
    EXPECT_TRUE(rest.converged);
    return effective_stiffness_n_m(body, rest.displacement, 1.0);
}

void expect_as_stepped(const LoadedBody& body, const StiffnessSetting& setting)
{
    const pbs::RestingState rest = rest_near_rest(body, setting);
    ASSERT_TRUE(rest.converged);
    const double edge_m = 0.05, gravity_m_s2 = 1e-5 * edge_m / rest.displacement.cwiseAbs().maxCoeff();
    const SteppedBody still = step_until_still(body, setting, gravity_m_s2);
    ASSERT_TRUE(still.converged);
    const double linear = effective_stiffness_n_m(body, rest.displacement, 1.0);
    const double of_second_order = 1e-5, of_stopping = 1e-6 * 40.0;
    EXPECT_NEAR(effective_stiffness_n_m(body, still.displacement, gravity_m_s2), linear, (of_second_order + of_stopping) * linear);
}

TEST(RestingBody, HangsWhereThePositionBasedSolverHangs)
{
    for (const RestOfBody rest : {RestOfBody::projected, RestOfBody::held})
        for (const Method method : {Method::pbs, Method::exponent})
            expect_as_stepped(limb(rest), {.method = method, .k_stretch = 0.3, .iterations = 6});
}

TEST(RestingBody, HangsWhereXpbdHangs)
{
    for (const RestOfBody rest : {RestOfBody::projected, RestOfBody::held})
        for (const Method method : {Method::xpbd, Method::xpbd_forgetting})
            for (const int iterations : {2, 12}) expect_as_stepped(limb(rest), {.method = method, .iterations = iterations});
    expect_as_stepped(limb(RestOfBody::held), {.method = Method::xpbd_small_steps, .iterations = 4});
}

// A step of the position based solver does not depend on dt, and dt^2 is a power of two of the other.
TEST(RestingBody, HalfTheStepIsFourTimesTheStiffness)
{
    const LoadedBody body = limb(RestOfBody::projected);
    StiffnessSetting setting{.k_stretch = 0.3, .iterations = 6};
    const double whole = stiffness(body, setting);
    setting.time_step_ms /= 2.0;
    EXPECT_DOUBLE_EQ(stiffness(body, setting) / whole, 4.0);
}

// What is held does not move with the step, so the state of rest solves K x = M g, whose K is proportional to Young's modulus. The
// iterations have converged: after 100 of them, ten digits stay. Tolerance: that of the linear solves, 1e-7 of the right-hand side, times a
// condition number below 100 here.
TEST(RestingBody, XpbdIteratedToTheEndKnowsNeitherIterationsNorStep)
{
    const LoadedBody body = limb(RestOfBody::held);
    StiffnessSetting setting{.method = Method::xpbd, .iterations = 400};
    const double once = stiffness(body, setting), of_solves = 1e-7 * 100.0;
    setting.iterations = 800;
    EXPECT_NEAR(stiffness(body, setting) / once, 1.0, of_solves);
    setting.time_step_ms /= 4.0;
    EXPECT_NEAR(stiffness(body, setting) / once, 1.0, of_solves);
    setting.young_pa *= 2.0;  // of edges and tets; rigid bind constraints do not depend on it
    EXPECT_NEAR(stiffness(body, setting) / once, 2.0, 2.0 * of_solves);
}

TEST(RestingBody, ARandomOrderIsRepeatable)
{
    const LoadedBody body = limb(RestOfBody::projected);
    StiffnessSetting setting{.k_stretch = 0.3, .iterations = 3, .order_seed = 1};
    const double first = stiffness(body, setting);
    EXPECT_EQ(stiffness(body, setting), first);
    setting.order_seed = 0;
    EXPECT_NE(stiffness(body, setting), first);
}

}  // namespace
