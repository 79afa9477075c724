// The contract of a step, by PBS and by XPBD in every order and precision. References: rest, the counts of constraints,
// the same order in double, and outcomes by definition. Tolerances: the rounding of a step (step_rounding.hpp).
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/step_rounding.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace steps_tests {
namespace {

using namespace test_support;
using pbs::Order;
using pbs::Outcome;
using pbs::Positions;
using pbs::Precision;

const TwoBoneLimb bent = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0),
                  straight = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0);

enum class Method { pbs, xpbd };

class Step : public testing::TestWithParam<std::tuple<Method, Order, Precision>> {
protected:
    const bool is_pbs = std::get<0>(GetParam()) == Method::pbs, f32 = std::get<2>(GetParam()) == Precision::f32;

    // f(options) for those of the method.
    template <typename F>
    static auto with_options(const F& f, int iterations = 24, Precision precision = std::get<2>(GetParam()))
    {
        const auto with = [&](auto options) {
            options.order = std::get<1>(GetParam());
            options.precision = precision;
            options.iterations = iterations;
            return f(options);
        };
        return std::get<0>(GetParam()) == Method::pbs ? with(pbs::PbsOptions()) : with(pbs::XpbdOptions());
    }
    static Positions stepped(const TwoBoneLimb& limb = bent, int iterations = 24, const std::vector<bool>& held = {},
                             Precision precision = std::get<2>(GetParam()))
    {
        const Stepped after = with_options(
            [&](const auto& options) { return test_support::stepped(limb, options, held); }, iterations, precision);
        EXPECT_EQ(after.summary.outcome, Outcome::finished);
        return after.positions;
    }
    // Between two steps in float [m].
    double rounding_m() const
    {
        return (is_pbs ? 2.0 : 1.0) *
               with_options([](const auto& options) { return step_rounding_m(bent, options); }, 24, Precision::f32);
    }
};
INSTANTIATE_TEST_SUITE_P(Codes, Step,
                         testing::Combine(testing::Values(Method::pbs, Method::xpbd),
                                          testing::Values(Order::plain, Order::ordered),
                                          testing::Values(Precision::f32, Precision::f64)));

// Each of 24 iterations may add a rounding of the 1 m half length, of XPBD in each of the some 20 constraints at a
// vertex; packed code may round a * b + c once where the rest data are rounded twice. Plain PBS in double returns the
// bits.
TEST_P(Step, RestStaysAtRest)
{
    const bool plain = std::get<1>(GetParam()) == Order::plain;
    const double roundings = is_pbs ? (f32 ? 24 : plain ? 0 : 2 * 24) : (plain && !f32 ? 1 : 2) * 24 * 20;
    const Positions still = stepped(straight);
    ASSERT_EQ(straight.lbs, straight.mesh.rest);
    EXPECT_LE((still - straight.mesh.rest).cwiseAbs().maxCoeff(),
              f32 ? rounding_error_in<float>(roundings, 1.0) : rounding_error(roundings, 1.0));
}

TEST_P(Step, FloatAgreesWithDouble)
{
    if (f32) return;
    const double difference_m = (stepped(bent, 24, {}, Precision::f32) - stepped()).cwiseAbs().maxCoeff();
    EXPECT_LT(difference_m, is_pbs ? rounding_m() / 2.0 : rounding_m());
    EXPECT_GT(difference_m, 0.0);
}

// The spacing of floats there is 1e-4 m. In double, a coordinate goes through three roundings where it is far.
TEST_P(Step, FloatKeepsItsDigitsFarFromTheOrigin)
{
    if (!f32) return;
    const Eigen::RowVector3d far(1000.0, -2000.0, 500.0);
    TwoBoneLimb moved = bent;
    moved.lbs.rowwise() += far;
    moved.bind_points.rowwise() += far;
    EXPECT_LT(((stepped(moved).rowwise() - far) - stepped()).cwiseAbs().maxCoeff(),
              rounding_m() + rounding_error(3, far.norm()));
}

TEST_P(Step, RestoresTheVolumeThatBlendingLost)
{
    const auto lost = [](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets))
            .cwiseAbs()
            .sum();
    };
    EXPECT_LT(lost(stepped()), 0.5 * lost(bent.lbs));
}

// One bind constraint per vertex, one of its length per edge, one of its volume per tet, in each iteration of each
// substep.
TEST_P(Step, CountsItsProjections)
{
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(),
                       vertices = bent.mesh.rest.rows();
    const auto work = []<typename Options>(Options options) {
        if constexpr (std::is_same_v<Options, pbs::XpbdOptions>) options.iterations = 3, options.substeps = 2;
        return test_support::stepped(bent, options).summary.work;
    };
    EXPECT_EQ(with_options(work, 6),
              (pbs::WorkCounters{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)}));
}

TEST_P(Step, WithoutIterationsItIsLbs)
{
    EXPECT_LE((stepped(bent, 0) - bent.lbs).cwiseAbs().maxCoeff(), f32 ? rounding_error_in<float>(2, 1.2) : 0.0);
}

TEST_P(Step, HeldVerticesStayToTheBit)
{
    if (f32) return;  // positions are rounded
    std::vector<bool> held(bent.mesh.rest.rows(), false);
    held[5] = held[40] = true;
    const Positions after = stepped(bent, 24, held);
    for (const int v : {5, 40}) EXPECT_EQ(after.row(v), bent.lbs.row(v));
    EXPECT_NE(after.row(41), bent.lbs.row(41));
}

TEST_P(Step, CollapsedAndMirroredStayFinite)
{
    stepped(blended_to(bent, 0.0 * bent.lbs));
    stepped(blended_to(bent, bent.lbs * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal()));
}

// Nothing jiggles, so that a step depends on nothing before it, and a second one repeats to the bit.
TEST_P(Step, RemembersNothingAndRecoversFromWhatIsNotFinite)
{
    Positions broken = bent.lbs;
    broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
    with_options([&]<typename Options>(const Options& options) {
        SolverOf<Options> used(bent.mesh, bent.binding.distance, {}, options);
        EXPECT_EQ(used.positions(), bent.mesh.rest);
        EXPECT_EQ(used.advance(straight.lbs, straight.bind_points, 0.01).outcome, Outcome::finished);
        EXPECT_EQ(used.advance(broken, bent.bind_points, 0.01).outcome, Outcome::not_finite);
        EXPECT_EQ(used.advance(bent.lbs, bent.bind_points, 0.01).outcome, Outcome::finished);
        EXPECT_EQ(used.positions(), stepped());
    });
}

using pbs::XpbdOptions;
using pbs::XpbdSolver;

// Nothing is integrated, so the substeps have no other state than the positions. Another order has another limit.
TEST(XpbdSolver, PackedSmallStepsAreNearPlainOnes)
{
    XpbdOptions options{.iterations = 1, .substeps = 24};
    const Positions expected = test_support::stepped(bent, options).positions;
    for (const Order order : {Order::ordered}) {
        options.order = order;
        EXPECT_LT((test_support::stepped(bent, options).positions - expected).norm(),
                  0.1 * (expected - bent.lbs).norm());
    }
}

// Positions are the only state, so that two substeps are two steps of half the length.
TEST(XpbdSolver, ASubstepIsAStepThatBeginsWhereTheLastOneEnded)
{
    for (const Order order : {Order::plain, Order::ordered}) {
        XpbdSolver halves(bent.mesh, bent.binding.distance, {}, {.iterations = 3, .order = order});
        halves.advance(bent.lbs, bent.bind_points, 0.005);
        halves.advance(Positions(halves.positions()), bent.bind_points, 0.005);
        EXPECT_EQ(test_support::stepped(bent, XpbdOptions{.iterations = 3, .substeps = 2, .order = order}).positions,
                  halves.positions());
    }
}

TEST(XpbdSolver, RefusesNumbersBelowOneAndPoissonsRatiosThatSpringsCannotHave)
{
    for (const XpbdOptions& options : {XpbdOptions{.substeps = 0}, {.threads = 0}, {.poisson = 0.2}, {.poisson = 0.5}})
        EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, options), pbs::InputError);
}

}  // namespace
}  // namespace steps_tests
