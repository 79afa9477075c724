#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/xpbd_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/support/xpbd_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace {

using pbs::Positions;
using pbs::XpbdOptions;
using pbs::XpbdSolver;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);

Positions stepped(const Positions& lbs, const Positions& bind_points, const XpbdOptions& options)
{
    XpbdSolver solver(bent.mesh, bent.binding.distance, {}, options);
    EXPECT_EQ(solver.advance(lbs, bind_points, 0.01).outcome, pbs::Outcome::finished);
    return solver.positions();
}

const XpbdOptions codes[] = {
    {.order = pbs::Order::plain, .precision = pbs::Precision::f32},   {.order = pbs::Order::plain, .precision = pbs::Precision::f64},
    {.order = pbs::Order::ordered, .precision = pbs::Precision::f32}, {.order = pbs::Order::ordered, .precision = pbs::Precision::f64},
    {.order = pbs::Order::grouped, .precision = pbs::Precision::f32}, {.order = pbs::Order::grouped, .precision = pbs::Precision::f64}};

// Each of 24 iterations may add a rounding of the 1 m half length in each of the some 20 constraints at a vertex.
TEST(XpbdSolver, RestStaysAtRest)
{
    const Positions still = stepped(bent.mesh.rest, bent.binding.rest_point, {});
    EXPECT_LT((still - bent.mesh.rest).cwiseAbs().maxCoeff(), test_support::rounding_error(24 * 20, 1.0));
}

// The same in the precision of the projections; the packed code rounds six volumes and their rest value apart, which is as much again.
TEST(XpbdSolver, RestStaysAtRestInEveryCode)
{
    for (const XpbdOptions& code : codes) {
        const double error_m = (stepped(bent.mesh.rest, bent.binding.rest_point, code) - bent.mesh.rest).cwiseAbs().maxCoeff();
        const bool f32 = code.precision == pbs::Precision::f32;
        const int roundings = 2 * 24 * 20;
        EXPECT_LT(error_m, f32 ? test_support::rounding_error_in<float>(roundings, 1.0) : test_support::rounding_error(roundings, 1.0));
    }
}

// Reference: the same order in double precision, within the rounding of a step (xpbd_rounding.hpp).
TEST(XpbdSolver, FloatAgreesWithDouble)
{
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped}) {
        const XpbdOptions f32{.order = order, .precision = pbs::Precision::f32}, f64{.order = order};
        const double difference_m =
            (stepped(bent.lbs, bent.bind_points, f32) - stepped(bent.lbs, bent.bind_points, f64)).cwiseAbs().maxCoeff();
        EXPECT_LT(difference_m, test_support::xpbd_rounding_m(bent, f32)) << int(order);
        EXPECT_GT(difference_m, 0.0) << int(order);
    }
}

TEST(XpbdSolver, FloatKeepsItsDigitsFarFromTheOrigin)
{
    const pbs::Vec3 far(1000.0, -2000.0, 500.0);  // the spacing of floats there is 1e-4 m
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped}) {
        const XpbdOptions f32{.order = order, .precision = pbs::Precision::f32};
        const Positions there = stepped(bent.lbs.rowwise() + far.transpose(), bent.bind_points.rowwise() + far.transpose(), f32);
        const double rounding_m = test_support::xpbd_rounding_m(bent, f32) + test_support::rounding_error(3, far.norm());
        EXPECT_LT(((there.rowwise() - far.transpose()) - stepped(bent.lbs, bent.bind_points, f32)).cwiseAbs().maxCoeff(), rounding_m);
    }
}

// Nothing is integrated, so the substeps have no other state than the positions.
TEST(XpbdSolver, PackedSmallStepsAreNearPlainOnes)
{
    const XpbdOptions plain{.iterations = 1, .substeps = 24};
    for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped}) {
        XpbdOptions packed = plain;
        packed.order = order;
        const Positions expected = stepped(bent.lbs, bent.bind_points, plain), found = stepped(bent.lbs, bent.bind_points, packed);
        EXPECT_LT((found - expected).norm(), 0.1 * (expected - bent.lbs).norm()) << "another order, another limit";
    }
}

TEST(XpbdSolver, RestoresTheVolumeThatBlendingLost)
{
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(stepped(bent.lbs, bent.bind_points, {.poisson = 0.49})), 0.5 * lost(bent.lbs));
}

// Reference: one bind constraint per vertex, one spring per edge, one volume constraint per tet, in each iteration of each substep.
TEST(XpbdSolver, CountsItsProjections)
{
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(), vertices = bent.mesh.rest.rows();
    const pbs::WorkCounters expected{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)};
    for (XpbdOptions options : codes) {
        options.iterations = 3;
        options.substeps = 2;
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, options);
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).work, expected);
    }
}

TEST(XpbdSolver, HeldVerticesStayToTheBit)
{
    std::vector<bool> held(bent.mesh.rest.rows(), false);
    held[5] = held[40] = true;
    for (const XpbdOptions& code : codes) {
        if (code.precision == pbs::Precision::f32) continue;  // positions are rounded
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, code, held);
        solver.advance(bent.lbs, bent.bind_points, 0.01);
        EXPECT_EQ(solver.positions().row(5), bent.lbs.row(5));
        EXPECT_EQ(solver.positions().row(40), bent.lbs.row(40));
    }
}

TEST(XpbdSolver, CollapsedToAPointStaysFinite)
{
    const Positions point = Positions::Zero(bent.mesh.rest.rows(), 3);
    for (const XpbdOptions& code : codes) stepped(point, bent.bind_points, code);
}

TEST(XpbdSolver, MirroredStaysFinite)
{
    const Positions mirrored = bent.lbs * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal();
    for (const XpbdOptions& code : codes) stepped(mirrored, bent.bind_points, code);
}

TEST(XpbdSolver, ReportsThatItIsNotFiniteAndRecovers)
{
    Positions broken = bent.lbs;
    broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
    for (const XpbdOptions& code : codes) {
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, code);
        EXPECT_EQ(solver.advance(broken, bent.bind_points, 0.01).outcome, pbs::Outcome::not_finite);
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).outcome, pbs::Outcome::finished);
        EXPECT_EQ(solver.positions(), stepped(bent.lbs, bent.bind_points, code));
    }
}

TEST(XpbdSolver, RefusesNumbersBelowOne)
{
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.substeps = 0}), pbs::InputError);
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.threads = 0}), pbs::InputError);
}

TEST(XpbdSolver, RefusesPoissonsRatiosThatSpringsCannotHave)
{
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.poisson = 0.2}), pbs::InputError);
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.poisson = 0.5}), pbs::InputError);
}

TEST(XpbdSolver, WithoutSubstepsOrIterationsItIsLbs)
{
    EXPECT_EQ(stepped(bent.lbs, bent.bind_points, {.iterations = 0}), bent.lbs);
}

// Reference: the plain projection of the same constraints in the sequence of the program, since the kernels project in exactly that order.
// Another sequence exceeds the tolerance in either precision, which AnotherSequenceIsFarOff confirms.

using namespace test_support;
using pbs::Order;
using pbs::Vec3;
using pbs::XpbdConstraints;

template <typename Scalar>
class BatchedXpbd : public testing::Test {
};
using ScalarsOfXpbd = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchedXpbd, ScalarsOfXpbd);

const TwoBoneLimb limb_of_xpbd = two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 60.0);  // 208 vertices
const Order packed_orders[] = {Order::ordered, Order::grouped};

XpbdConstraints constraints_of_limb(const std::vector<bool>& held = {})
{
    return make_xpbd_constraints(limb_of_xpbd.mesh, limb_of_xpbd.binding.distance, {}, held);
}

// The class in the sequence in which the program projects it.
template <typename Constraint, typename Scalar>
std::vector<pbs::Compliant<Constraint>> in_sequence(const std::vector<pbs::Compliant<Constraint>>& constraints,
                                                    const pbs::BatchProgram<Scalar>& program, const pbs::VertexOrder& order)
{
    const auto sorted = [](auto vertex) {
        std::sort(vertex.begin(), vertex.end());
        return std::vector<int>(vertex.begin(), vertex.end());
    };
    std::map<std::vector<int>, pbs::Compliant<Constraint>> by_vertices;
    for (const auto& compliant : constraints) by_vertices.emplace(sorted(compliant.constraint.vertex), compliant);
    std::vector<pbs::Compliant<Constraint>> sequence;
    program.for_each_constraint([&](const auto& vertex, Scalar, Scalar) {
        std::vector<int> old;
        for (const int v : vertex) old.push_back(order.old_of_new[v]);
        sequence.push_back(by_vertices.at(sorted(old)));
    });
    return sequence;
}

template <typename Scalar>
XpbdConstraints in_sequence_of(Order order, XpbdConstraints constraints)
{
    const auto batched = pbs::make_batched_constraints<Scalar>(constraints, limb_of_xpbd.mesh.tets, order);
    constraints.stretch = in_sequence(constraints.stretch, batched.stretch, batched.order);
    constraints.volume = in_sequence(constraints.volume, batched.volume, batched.order);
    return constraints;
}

// One substep of three iterations.
Positions projected(pbs::XpbdProjection& projection)
{
    Positions p = limb_of_xpbd.lbs;
    projection.load(p, limb_of_xpbd.bind_points, Vec3::Zero());
    projection.begin_substep(0.01);
    for (int i = 0; i < 3; ++i) {
        projection.project_bind_constraints();
        projection.project_stretch_constraints();
        projection.project_volume_constraints();
    }
    projection.store(Vec3::Zero(), p);
    return p;
}

template <typename Scalar>
XpbdOptions options_of(Order order)
{
    return {.iterations = 3, .order = order, .precision = sizeof(Scalar) == 4 ? pbs::Precision::f32 : pbs::Precision::f64};
}

template <typename Scalar>
std::unique_ptr<pbs::XpbdProjection> projection_of(Order order, const XpbdConstraints& constraints)
{
    return make_xpbd_projection(constraints, limb_of_xpbd.mesh.tets, options_of<Scalar>(order));
}

template <typename Scalar>
Positions by_batches(Order order, const XpbdConstraints& constraints = constraints_of_limb())
{
    return projected(*projection_of<Scalar>(order, constraints));
}

template <typename Scalar>
Positions one_by_one(Order order)
{
    return projected(*projection_of<Scalar>(Order::plain, in_sequence_of<Scalar>(order, constraints_of_limb())));
}

template <typename Scalar>
double rounding_of_three_iterations(Order order)
{
    return xpbd_rounding_m(limb_of_xpbd, options_of<Scalar>(order));
}

TYPED_TEST(BatchedXpbd, EqualsThePlainProjectionInTheSameSequence)
{
    for (const Order order : packed_orders) {
        const Positions found = by_batches<TypeParam>(order), expected = one_by_one<TypeParam>(order);
        EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), rounding_of_three_iterations<TypeParam>(order)) << int(order);
        EXPECT_GT((expected - limb_of_xpbd.lbs).cwiseAbs().maxCoeff(), 1e-3) << "nothing moved";
    }
}

TYPED_TEST(BatchedXpbd, AnotherSequenceIsFarOff)
{
    EXPECT_GT((by_batches<TypeParam>(Order::ordered) - one_by_one<TypeParam>(Order::grouped)).cwiseAbs().maxCoeff(),
              (std::is_same_v<TypeParam, float> ? 2.0 : 100.0) * rounding_of_three_iterations<TypeParam>(Order::ordered));
}

TEST(BatchedXpbdInFloat, IsNearDouble)
{
    for (const Order order : packed_orders)
        EXPECT_LT((by_batches<float>(order) - by_batches<double>(order)).cwiseAbs().maxCoeff(), rounding_of_three_iterations<float>(order));
}

TYPED_TEST(BatchedXpbd, ProjectsEachConstraintOnce)
{
    const XpbdConstraints constraints = constraints_of_limb();
    for (const Order order : packed_orders) {
        const XpbdConstraints sequence = in_sequence_of<TypeParam>(order, constraints);
        std::set<std::array<int, 2>> edges;
        std::set<std::array<int, 4>> tets;
        for (const auto& edge : sequence.stretch) edges.insert(edge.constraint.vertex);
        for (const auto& tet : sequence.volume) tets.insert(tet.constraint.vertex);
        EXPECT_EQ(sequence.stretch.size(), constraints.stretch.size());
        EXPECT_EQ(edges.size(), constraints.stretch.size());
        EXPECT_EQ(sequence.volume.size(), constraints.volume.size());
        EXPECT_EQ(tets.size(), constraints.volume.size());
    }
}

TYPED_TEST(BatchedXpbd, ASubstepForgetsTheMultipliers)
{
    for (const Order order : packed_orders) {
        const auto used = projection_of<TypeParam>(order, constraints_of_limb());
        const Positions first = projected(*used);
        EXPECT_EQ(projected(*used), first);
    }
}

TYPED_TEST(BatchedXpbd, HeldVerticesKeepTheirBits)
{
    std::vector<bool> held(limb_of_xpbd.lbs.rows());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = i % 3 == 0;
    const Positions before = limb_of_xpbd.lbs.cast<TypeParam>().template cast<double>();
    for (const Order order : packed_orders) {
        const Positions after = by_batches<TypeParam>(order, constraints_of_limb(held));
        for (Eigen::Index i = 0; i < after.rows(); ++i) EXPECT_EQ(after.row(i) == before.row(i), bool(held[i])) << i;
    }
}

}  // namespace
