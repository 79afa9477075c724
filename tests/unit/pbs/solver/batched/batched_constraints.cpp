// Reference: the plain form in pbs/constraints, one constraint after the other in the order of the program, since the kernels project in
// exactly that order. Tolerance: the rounding of one iteration with one class of constraints, on both sides (step_rounding.hpp). Another
// order differs by a hundred times more, which BatchedConstraintsBite confirms.
#include "pbs/solver/batched/batched_projection.hpp"
#include "tests/support/step_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace {

using namespace test_support;
using pbs::Order;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Vec3;

template <typename Scalar>
class BatchedConstraints : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchedConstraints, Scalars);

const TwoBoneLimb limb = two_bone_limb({170, 4, 4}, Vec3::UnitZ(), 40.0);  // 4,275 vertices, several slabs
const Order orders[] = {Order::ordered, Order::grouped};

PbsOptions options_of(Order order)
{
    PbsOptions options;
    options.order = order;
    options.masses = pbs::Masses::lumped;
    options.k_stretch = 0.7;
    return options;
}

template <typename Scalar>
pbs::ConstraintSet<Scalar> constraints_of(const PbsOptions& options)
{
    std::vector<bool> held(limb.lbs.rows());
    for (Eigen::Index i = 0; i < limb.lbs.rows(); ++i) held[i] = limb.mesh.rest(i, 0) < -0.95;
    return pbs::make_constraint_set<Scalar>(limb.mesh, limb.binding.distance, {}, options, held);
}

// Positions in double, exact in Scalar.
template <typename Scalar>
Positions start()
{
    return limb.lbs.cast<Scalar>().template cast<double>();
}

template <typename Scalar>
Positions by_the_kernels(Order order, bool volumes)
{
    pbs::BatchedProjection<Scalar> projection(constraints_of<Scalar>(options_of(order)), limb.mesh.tets, options_of(order));
    Positions p = start<Scalar>();
    projection.load(p, limb.bind_points, Vec3::Zero());
    volumes ? projection.project_volume_constraints() : projection.project_stretch_constraints();
    projection.store(Vec3::Zero(), p);
    return p;
}

template <typename Scalar>
class OneAfterTheOther {
public:
    explicit OneAfterTheOther(Order order)
        : constraints(constraints_of<Scalar>(options_of(order))), batched(pbs::make_batched_constraints(constraints, limb.mesh.tets, order))
    {
        const Positions rows = start<Scalar>();
        for (Eigen::Index i = 0; i < rows.rows(); ++i) p.push_back(rows.row(i).transpose().cast<Scalar>());
    }

    Positions stretch() { return projected(batched.stretch); }
    Positions volume() { return projected(batched.volume); }

private:
    int old(int vertex) const { return batched.order.old_of_new[vertex]; }
    Scalar w(int vertex) const { return constraints.inverse_mass[vertex]; }

    void project_one(const std::array<int, 2>& vertex, Scalar rest, Scalar k_over_w)
    {
        const int i = old(vertex[0]), j = old(vertex[1]);
        project(pbs::StretchConstraint<Scalar>{{i, j}, rest, k_over_w * (w(i) + w(j))}, w(i), w(j), p[i], p[j]);
    }
    void project_one(const std::array<int, 4>& vertex, Scalar six_rest, Scalar k)
    {
        const int i = old(vertex[0]), j = old(vertex[1]), l = old(vertex[2]), m = old(vertex[3]);
        project(pbs::VolumeConstraint<Scalar>{{i, j, l, m}, six_rest / 6, k}, w(i), w(j), w(l), w(m), p[i], p[j], p[l], p[m]);
    }

    Positions projected(const pbs::BatchProgram<Scalar>& program)
    {
        program.for_each_constraint([&](const auto& vertex, Scalar rest, Scalar stiffness) { project_one(vertex, rest, stiffness); });
        Positions rows(p.size(), 3);
        for (std::size_t i = 0; i < p.size(); ++i) rows.row(i) = p[i].transpose().template cast<double>();
        return rows;
    }

    pbs::ConstraintSet<Scalar> constraints;
    pbs::BatchedConstraints<Scalar> batched;
    std::vector<pbs::Vector3<Scalar>> p;
};

double difference(const Positions& a, const Positions& b)
{
    return (a - b).cwiseAbs().maxCoeff();
}

template <typename Scalar>
double rounding_m(Order order, bool volumes)
{
    PbsOptions options = options_of(order);
    options.iterations = 1;
    options.precision = std::is_same_v<Scalar, float> ? pbs::Precision::f32 : pbs::Precision::f64;
    options.k_bind = 0.0;
    (volumes ? options.k_stretch : options.k_volume) = 0.0;
    return 2.0 * step_rounding_m(limb, options);
}

TYPED_TEST(BatchedConstraints, KernelsProjectInTheOrderTheProgramSays)
{
    for (const Order order : orders) {
        EXPECT_LT(difference(by_the_kernels<TypeParam>(order, false), OneAfterTheOther<TypeParam>(order).stretch()),
                  rounding_m<TypeParam>(order, false));
        EXPECT_LT(difference(by_the_kernels<TypeParam>(order, true), OneAfterTheOther<TypeParam>(order).volume()),
                  rounding_m<TypeParam>(order, true));
    }
}

TEST(BatchedConstraintsBite, AnotherOrderIsFarOff)
{
    EXPECT_GT(difference(by_the_kernels<float>(Order::ordered, false), OneAfterTheOther<float>(Order::grouped).stretch()),
              100.0 * rounding_m<float>(Order::ordered, false));
    EXPECT_GT(difference(by_the_kernels<float>(Order::ordered, true), OneAfterTheOther<float>(Order::grouped).volume()),
              100.0 * rounding_m<float>(Order::ordered, true));
}

}  // namespace
