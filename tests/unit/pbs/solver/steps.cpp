// The contract of a step, by PBS and by XPBD in every order and precision. References: rest, the counts of constraints, the same order in
// double, and outcomes by definition. Tolerances: the rounding of a step (step_rounding.hpp, xpbd_rounding.hpp).
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/xpbd_rounding.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <variant>

namespace {

using namespace test_support;
using pbs::Order;
using pbs::Outcome;
using pbs::Positions;
using pbs::Precision;

const TwoBoneLimb bent = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0), straight = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0);

enum class Method { pbs, xpbd };

class Step : public testing::TestWithParam<std::tuple<Method, Order, Precision>> {
protected:
    using Solver = std::variant<std::unique_ptr<pbs::PbsSolver>, std::unique_ptr<pbs::XpbdSolver>>;

    const bool is_pbs = std::get<0>(GetParam()) == Method::pbs, f32 = std::get<2>(GetParam()) == Precision::f32;

    static Solver make(const pbs::PbsOptions& options, const std::vector<bool>& held = {})
    {
        return std::make_unique<pbs::PbsSolver>(bent.mesh, bent.binding.distance, std::vector<bool>{}, options, held);
    }
    static Solver make(const pbs::XpbdOptions& options, const std::vector<bool>& held = {})
    {
        return std::make_unique<pbs::XpbdSolver>(bent.mesh, bent.binding.distance, std::vector<bool>{}, options, held);
    }
    template <typename Options>
    static Options with(Precision precision, int iterations = 24)
    {
        Options options;
        options.order = std::get<1>(GetParam());
        options.precision = precision;
        options.iterations = iterations;
        return options;
    }
    static Solver solver(int iterations = 24, const std::vector<bool>& held = {}, Precision precision = std::get<2>(GetParam()))
    {
        if (std::get<0>(GetParam()) == Method::pbs) return make(with<pbs::PbsOptions>(precision, iterations), held);
        return make(with<pbs::XpbdOptions>(precision, iterations), held);
    }
    static pbs::StepSummary advance(const Solver& solver, const Positions& lbs, const Positions& bind_points = bent.bind_points)
    {
        return std::visit([&](const auto& of_method) { return of_method->advance(lbs, bind_points, 0.01); }, solver);
    }
    static Positions positions(const Solver& solver)
    {
        return std::visit([](const auto& of_method) { return of_method->positions(); }, solver);
    }
    static Positions stepped(const Solver& solver, const Positions& lbs, const Positions& bind_points = bent.bind_points)
    {
        EXPECT_EQ(advance(solver, lbs, bind_points).outcome, Outcome::finished);
        return positions(solver);
    }
    // Between two steps in float [m].
    double rounding_m() const
    {
        return is_pbs ? 2.0 * step_rounding_m(bent, with<pbs::PbsOptions>(Precision::f32))
                      : xpbd_rounding_m(bent, with<pbs::XpbdOptions>(Precision::f32));
    }
};
INSTANTIATE_TEST_SUITE_P(Codes, Step,
                         testing::Combine(testing::Values(Method::pbs, Method::xpbd),
                                          testing::Values(Order::plain, Order::ordered, Order::grouped),
                                          testing::Values(Precision::f32, Precision::f64)));

// Each of 24 iterations may add a rounding of the 1 m half length, of XPBD in each of the some 20 constraints at a vertex; packed code may
// round a * b + c once where the rest data are rounded twice. Plain PBS in double returns the bits.
TEST_P(Step, RestStaysAtRest)
{
    const bool plain = std::get<1>(GetParam()) == Order::plain;
    const double roundings = is_pbs ? (f32 ? 24 : plain ? 0 : 2 * 24) : (plain && !f32 ? 1 : 2) * 24 * 20;
    const Positions still = stepped(solver(), straight.lbs, straight.bind_points);
    ASSERT_EQ(straight.lbs, straight.mesh.rest);
    EXPECT_LE((still - straight.mesh.rest).cwiseAbs().maxCoeff(),
              f32 ? rounding_error_in<float>(roundings, 1.0) : rounding_error(roundings, 1.0));
}

TEST_P(Step, FloatAgreesWithDouble)
{
    if (f32) return;
    const double difference_m = (stepped(solver(24, {}, Precision::f32), bent.lbs) - stepped(solver(), bent.lbs)).cwiseAbs().maxCoeff();
    EXPECT_LT(difference_m, is_pbs ? rounding_m() / 2.0 : rounding_m());
    EXPECT_GT(difference_m, 0.0);
}

// The spacing of floats there is 1e-4 m. In double, a coordinate goes through three roundings where it is far.
TEST_P(Step, FloatKeepsItsDigitsFarFromTheOrigin)
{
    if (!f32) return;
    const Eigen::RowVector3d far(1000.0, -2000.0, 500.0);
    const Positions there = stepped(solver(), bent.lbs.rowwise() + far, bent.bind_points.rowwise() + far);
    EXPECT_LT(((there.rowwise() - far) - stepped(solver(), bent.lbs)).cwiseAbs().maxCoeff(), rounding_m() + rounding_error(3, far.norm()));
}

TEST_P(Step, RestoresTheVolumeThatBlendingLost)
{
    const auto lost = [](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(stepped(solver(), bent.lbs)), 0.5 * lost(bent.lbs));
}

// One bind constraint per vertex, one of its length per edge, one of its volume per tet, in each iteration.
TEST_P(Step, CountsItsProjections)
{
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(), vertices = bent.mesh.rest.rows();
    const pbs::WorkCounters expected{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)};
    EXPECT_EQ(advance(solver(6), bent.lbs).work, expected);
}

TEST_P(Step, WithoutIterationsItIsLbs)
{
    EXPECT_LE((stepped(solver(0), bent.lbs) - bent.lbs).cwiseAbs().maxCoeff(), f32 ? rounding_error_in<float>(2, 1.2) : 0.0);
}

TEST_P(Step, HeldVerticesStayToTheBit)
{
    if (f32) return;  // positions are rounded
    std::vector<bool> held(bent.mesh.rest.rows(), false);
    held[5] = held[40] = true;
    const Positions after = stepped(solver(24, held), bent.lbs);
    for (const int v : {5, 40}) EXPECT_EQ(after.row(v), bent.lbs.row(v));
    EXPECT_NE(after.row(41), bent.lbs.row(41));
}

TEST_P(Step, CollapsedAndMirroredStayFinite)
{
    stepped(solver(), 0.0 * bent.lbs);
    stepped(solver(), bent.lbs * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal());
}

// Nothing jiggles, so that a step depends on nothing before it, and a second one repeats to the bit.
TEST_P(Step, RemembersNothingAndRecoversFromWhatIsNotFinite)
{
    Positions broken = bent.lbs;
    broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
    const Solver used = solver();
    EXPECT_EQ(positions(used), bent.mesh.rest);
    stepped(used, straight.lbs, straight.bind_points);
    EXPECT_EQ(advance(used, broken).outcome, Outcome::not_finite);
    EXPECT_EQ(stepped(used, bent.lbs), stepped(solver(), bent.lbs));
}

using pbs::XpbdOptions;
using pbs::XpbdSolver;

// Nothing is integrated, so the substeps have no other state than the positions. Another order has another limit.
TEST(XpbdSolver, PackedSmallStepsAreNearPlainOnes)
{
    XpbdOptions options{.iterations = 1, .substeps = 24};
    const Positions expected = stepped_by_xpbd(bent, bent.lbs, options);
    for (const Order order : {Order::ordered, Order::grouped}) {
        options.order = order;
        EXPECT_LT((stepped_by_xpbd(bent, bent.lbs, options) - expected).norm(), 0.1 * (expected - bent.lbs).norm());
    }
}

// Reference: one bind constraint per vertex, one spring per edge, one volume constraint per tet, in each iteration of each substep.
TEST(XpbdSolver, CountsItsProjectionsInEachSubstep)
{
    const pbs::TetMesh& mesh = bent.mesh;
    const Eigen::Index tets = mesh.tets.rows(), edges = pbs::edges_of(mesh.tets).rows(), vertices = mesh.rest.rows();
    XpbdSolver solver(mesh, bent.binding.distance, {}, {.iterations = 3, .substeps = 2});
    EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).work,
              (pbs::WorkCounters{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)}));
}

TEST(XpbdSolver, RefusesNumbersBelowOneAndPoissonsRatiosThatSpringsCannotHave)
{
    for (const XpbdOptions& options : {XpbdOptions{.substeps = 0}, {.threads = 0}, {.poisson = 0.2}, {.poisson = 0.5}})
        EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, options), pbs::InputError);
}

}  // namespace
