// Reference: the solvers themselves, stepped until the flesh hangs still. The load is so small that displacements are
// 1e-5 of an edge. The second order is proportional to it, so that twice the load shows how large it is. The distance
// that remains when stepping stops follows from the changes per step. The limb has vertices on its bones, d = 0. The
// other reference is theory: a step of the position based solver does not depend on dt, so its stiffness scales with 1
// / dt^2; that of converged XPBD is the material's.
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using namespace experiments;

LoadedBody limb(RestOfBody rest)
{
    static const pbs::Character character =
        test_support::character_of(test_support::two_bone_limb({10, 4, 4}, pbs::Vec3::UnitZ(), 0.0));
    return jiggling_flesh(character, rest);
}

// How far a state of rest carries the load, relative to one step without constraints: |g + x / dt^2| / |g| and <g, x> /
// (dt^2 |g|^2), in the inner product of the masses.
struct Reach {
    double norm = 0.0, along_load = 0.0, mass_ratio = 0.0;
};

Reach reach(const LoadedBody& body, const StiffnessSetting& setting, const pbs::RestingState& rest)
{
    const double step_s = setting.step_s();
    double load = 0.0, sum = 0.0, work = 0.0, heaviest = 0.0, lightest = std::numeric_limits<double>::infinity();
    for (Eigen::Index v = 0; v < body.mass_kg.size(); ++v) {
        if (!body.zone[static_cast<std::size_t>(v)]) continue;
        const double mass = body.mass_kg(v);
        const pbs::Vec3 x = rest.displacement.row(v) / (step_s * step_s);
        load += mass, sum += mass * (body.direction + x).squaredNorm(), work += mass * body.direction.dot(x);
        heaviest = std::max(heaviest, mass), lightest = std::min(lightest, mass);
    }
    return {std::sqrt(sum / load), work / load, heaviest / lightest};
}

// The relative error of a stiffness by the residual r of (I - S) x = S g dt^2, for |r| <= residual dt^2 |g| and S
// symmetric in the inner product of the masses. (I - S)^-1 g = g + x / dt^2, so that the mean displacement <g, x> is in
// error by <g, (I - S)^-1 r>, at most |g + x / dt^2| |r|. Norms with the masses exceed others by the root of the
// largest mass over the smallest.
double solve_error(const LoadedBody& body, const StiffnessSetting& setting, const pbs::RestingState& rest)
{
    const Reach of = reach(body, setting, rest);
    return rest.residual * std::sqrt(of.mass_ratio) * of.norm / of.along_load;
}

double stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    const pbs::RestingState rest = rest_near_rest(body, setting);
    EXPECT_TRUE(rest.converged);
    return effective_stiffness_n_m(body, rest.displacement, 1.0);
}

// The relative error of a mean displacement that changed by less than 1e-6 of itself in each of 25 steps. Where S has
// the eigenvalue s, steps have the factor s +- i sqrt(s (1 - s)), and 1 - s is the square of its distance from one: an
// oscillation by the angle theta = sqrt(1 - s) per step, which damping only makes smaller. Its amplitude A is largest
// where it turns in the middle of the 25 steps: the change at their ends is A theta sin(12.5 theta). The softest mode
// has at least half of the load, so that 1 / (1 - s) is at most twice the reach.
double stopping_error(const LoadedBody& body, const StiffnessSetting& setting, const pbs::RestingState& rest)
{
    const double theta = 1.0 / std::sqrt(2.0 * reach(body, setting, rest).norm), quarter = EIGEN_PI / 2.0;
    return 1e-6 / (theta * std::sin(std::min(12.5 * theta, quarter)));
}

double stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2)
{
    const SteppedBody still = step_until_still(body, setting, gravity_m_s2);
    EXPECT_TRUE(still.converged);
    return effective_stiffness_n_m(body, still.displacement, gravity_m_s2);
}

void expect_as_stepped(const LoadedBody& body, const StiffnessSetting& setting)
{
    const pbs::RestingState rest = rest_near_rest(body, setting);
    ASSERT_TRUE(rest.converged);
    const double edge_m = 0.05, gravity_m_s2 = 1e-5 * edge_m / rest.displacement.cwiseAbs().maxCoeff();
    const double once = stepped_stiffness(body, setting, gravity_m_s2),
                 twice = stepped_stiffness(body, setting, 2.0 * gravity_m_s2);
    const double linear = effective_stiffness_n_m(body, rest.displacement, 1.0);
    // The second-order term grows with the load. It changes the sag per load as much from the first load to the second
    // as from none to the first, up to the stopping errors of both.
    const double of_stopping = stopping_error(body, setting, rest),
                 of_second_order = std::abs(twice / once - 1.0) + 2.0 * of_stopping;
    EXPECT_NEAR(once / linear, 1.0, of_second_order + of_stopping + solve_error(body, setting, rest));
}

TEST(RestingBody, HangsWhereTheSolversHang)
{
    for (const RestOfBody rest : {RestOfBody::projected, RestOfBody::held}) {
        for (const Method method : {Method::pbs, Method::exponent})
            expect_as_stepped(limb(rest), {.method = method, .k_stretch = 0.3, .iterations = 6});
        for (const Method method : {Method::xpbd, Method::xpbd_forgetting})
            for (const int iterations : {2, 12})
                expect_as_stepped(limb(rest), {.method = method, .iterations = iterations});
        expect_as_stepped(limb(rest), {.method = Method::xpbd_small_steps, .iterations = 4});
    }
}

// A step of the position based solver does not depend on dt, and dt^2 is a power of two of the other. A random order is
// repeatable.
TEST(RestingBody, HalfTheStepIsFourTimesTheStiffness)
{
    const LoadedBody body = limb(RestOfBody::projected);
    StiffnessSetting setting{.k_stretch = 0.3, .iterations = 6}, half = setting, random = setting;
    half.time_step_ms /= 2.0;
    random.order_seed = 1;
    const double whole = stiffness(body, setting), in_random_order = stiffness(body, random);
    EXPECT_DOUBLE_EQ(stiffness(body, half) / whole, 4.0);
    EXPECT_EQ(stiffness(body, random), in_random_order);
    EXPECT_NE(whole, in_random_order);
}

// The held vertices do not depend on the step. The state of rest therefore solves K x = M g, and K is proportional to
// Young's modulus. The tolerance is that of two linear solves plus the error of stopping. If 200 iterations leave at
// most half of the error, this error is at most the change by the last 200.
TEST(RestingBody, XpbdIteratedToTheEndKnowsNeitherIterationsNorStep)
{
    const LoadedBody body = limb(RestOfBody::held);
    struct Estimate {
        double stiffness_n_m, relative_error;
    };
    StiffnessSetting setting{.method = Method::xpbd, .iterations = 400};
    const auto estimate = [&] {
        const pbs::RestingState rest = rest_near_rest(body, setting);
        EXPECT_TRUE(rest.converged);
        const double stiffness_n_m = effective_stiffness_n_m(body, rest.displacement, 1.0);
        StiffnessSetting fewer = setting;
        fewer.iterations = setting.iterations / 2;
        const double iteration_error = std::abs(stiffness_n_m / stiffness(body, fewer) - 1.0);
        return Estimate{stiffness_n_m, solve_error(body, setting, rest) + iteration_error};
    };
    const Estimate once = estimate();
    const auto expect = [&](double ratio) {
        const Estimate other = estimate();
        EXPECT_NEAR(other.stiffness_n_m / once.stiffness_n_m, ratio,
                    ratio * (once.relative_error + other.relative_error));
    };
    setting.iterations = 800;
    expect(1.0);
    setting.time_step_ms /= 4.0;
    expect(1.0);
    setting.young_pa *= 2.0;  // of edges and tets; rigid bind constraints do not depend on it
    expect(2.0);
}

}  // namespace
