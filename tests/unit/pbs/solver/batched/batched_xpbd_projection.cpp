// Reference: the plain projection of the same constraints in the sequence of the program, since the kernels project in exactly that order.
// Another sequence exceeds the tolerance in either precision, which AnotherSequenceIsFarOff confirms.
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/xpbd_solver.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/support/xpbd_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace {

using namespace test_support;
using pbs::Order;
using pbs::Positions;
using pbs::Vec3;
using pbs::XpbdConstraints;
using pbs::XpbdOptions;

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
