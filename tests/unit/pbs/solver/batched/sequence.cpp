// The contract of the packed projections of Algorithm 1 and of XPBD. Reference: the plain projection of the same
// constraints in the sequence of the program, since the kernels project in exactly that order. Tolerance: the rounding
// of the iterations (step_rounding.hpp). Another sequence exceeds it by far, which AnotherSequenceIsFarOff confirms.
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/projection.hpp"
#include "tests/support/step_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace sequence_tests {
namespace {

using namespace test_support;
using pbs::Order;
using pbs::Positions;
using pbs::Vec3;

// Which classes of constraints there are.
enum class Part { all, bind, stretch, volume };

// One iteration of one class, with held vertices and masses of their own.
template <typename S>
struct Pbs {
    using Scalar = S;
    static constexpr Part parts[] = {Part::bind, Part::stretch, Part::volume};
    static constexpr double far_off = 100.0;                                                 // in roundings
    static inline const TwoBoneLimb limb = two_bone_limb({170, 4, 4}, Vec3::UnitZ(), 40.0);  // 4,275 vertices, one slab

    static pbs::PbsOptions options(Order order, Part part)
    {
        pbs::PbsOptions options;
        options.order = order;
        options.precision = sizeof(S) == 4 ? pbs::Precision::f32 : pbs::Precision::f64;
        options.masses = pbs::Masses::lumped;
        options.iterations = 1;
        const auto k = [part](Part own, double k) { return part == own || part == Part::all ? k : 0.0; };
        options.k_bind = k(Part::bind, 0.7), options.k_stretch = k(Part::stretch, 0.7),
        options.k_volume = k(Part::volume, 1.0);
        if (part == Part::bind) options.bind_to = pbs::BindTo::blended_position;
        return options;
    }
    static auto constraints(Part part, const std::vector<bool>& held)
    {
        return pbs::make_constraint_set<S>(limb.mesh, limb.binding.distance, {}, options(Order::ordered, part), held);
    }
    static auto projection(Order order, Part part, const pbs::ConstraintSet<S>& constraints)
    {
        return pbs::make_projection<S>(constraints, limb.mesh.tets, options(order, part));
    }
    static void begin(pbs::Projection<S>&) {}
    static double rounding_m(Order order, Part part) { return 2.0 * step_rounding_m(limb, options(order, part)); }
};

// One substep of three iterations.
template <typename S>
struct Xpbd {
    using Scalar = S;
    static constexpr Part parts[] = {Part::all};
    static constexpr double far_off = sizeof(S) == 4 ? 2.0 : 100.0;
    static inline const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 60.0);  // 208 vertices

    static pbs::XpbdOptions options(Order order)
    {
        return {
            .iterations = 3, .order = order, .precision = sizeof(S) == 4 ? pbs::Precision::f32 : pbs::Precision::f64};
    }
    static pbs::XpbdConstraints constraints(Part, const std::vector<bool>& held)
    {
        return make_xpbd_constraints(limb.mesh, limb.binding.distance, {}, held);
    }
    static auto projection(Order order, Part, const pbs::XpbdConstraints& constraints)
    {
        return make_xpbd_projection(constraints, limb.mesh.tets, options(order));
    }
    static void begin(pbs::XpbdProjection& projection) { projection.begin_substep(0.01); }
    static double rounding_m(Order order, Part) { return step_rounding_m(limb, options(order)); }
};

template <typename Method>
class Sequence : public testing::Test {
protected:
    using Scalar = typename Method::Scalar;

    static auto constraints(Part part, const std::vector<bool>& held = {}) { return Method::constraints(part, held); }

    // The iterations, from positions that are exact in Scalar.
    static Positions projected(auto& projection, Part part)
    {
        Positions p = start();
        projection.load(p, Method::limb.bind_points, Vec3::Zero());
        Method::begin(projection);
        for (int i = 0; i < (part == Part::all ? 3 : 1); ++i) {
            projection.project_bind_constraints();
            projection.project_stretch_constraints();
            projection.project_volume_constraints();
        }
        projection.store(Vec3::Zero(), p);
        return p;
    }
    static Positions by_kernels(Part part, const auto& constraints)
    {
        return projected(*Method::projection(Order::ordered, part, constraints), part);
    }
    static Positions one_by_one(Part part)
    {
        return projected(*Method::projection(Order::plain, part, in_sequence(part)), part);
    }
    static Positions start() { return Method::limb.lbs.template cast<Scalar>().template cast<double>(); }

    // The constraints in the sequence of their projection.
    static auto in_sequence(Part part)
    {
        auto sequence = constraints(part);
        const auto batched = pbs::make_batched_constraints<Scalar>(sequence, Method::limb.mesh.tets);
        sequence.stretch = sorted(sequence.stretch, batched.stretch, batched.order);
        sequence.volume = sorted(sequence.volume, batched.volume, batched.order);
        return sequence;
    }

private:
    static const auto& vertices_of(const auto& constraint)
    {
        if constexpr (requires { constraint.compliance; })
            return constraint.constraint.vertex;
        else
            return constraint.vertex;
    }
    static std::vector<int> key(const auto& vertices)
    {
        std::vector<int> sorted(vertices.begin(), vertices.end());
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    }

    // Fails where a constraint is missing or is projected twice.
    template <typename Constraint>
    static std::vector<Constraint> sorted(const std::vector<Constraint>& constraints,
                                          const pbs::BatchProgram<Scalar>& program, const pbs::VertexOrder& order)
    {
        std::map<std::vector<int>, Constraint> by_vertices;
        for (const Constraint& constraint : constraints) by_vertices.emplace(key(vertices_of(constraint)), constraint);
        EXPECT_EQ(by_vertices.size(), constraints.size());
        std::vector<Constraint> sequence;
        program.for_each_constraint([&](const auto& vertex, Scalar, Scalar) {
            std::vector<int> old;
            for (const int v : vertex) old.push_back(order.old_of_new[v]);
            sequence.push_back(by_vertices.extract(key(old)).mapped());
        });
        EXPECT_TRUE(by_vertices.empty());
        return sequence;
    }
};
using Methods = testing::Types<Pbs<float>, Pbs<double>, Xpbd<float>, Xpbd<double>>;
TYPED_TEST_SUITE(Sequence, Methods);

TYPED_TEST(Sequence, EqualsThePlainProjectionInTheSameSequence)
{
    for (const Part part : TypeParam::parts) {
        const Positions found = this->by_kernels(part, this->constraints(part)), expected = this->one_by_one(part);
        EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), TypeParam::rounding_m(Order::ordered, part));
        EXPECT_GT((expected - this->start()).cwiseAbs().maxCoeff(), 1e-3) << "nothing moved";
    }
}

TYPED_TEST(Sequence, AnotherSequenceIsFarOff)
{
    for (const Part part : TypeParam::parts)
        if (part != Part::bind) {  // each of which moves its own vertex alone
            EXPECT_GT((this->by_kernels(part, this->constraints(part)) -
                       this->projected(*TypeParam::projection(Order::plain, part, this->constraints(part)), part))
                          .cwiseAbs()
                          .maxCoeff(),
                      TypeParam::far_off * TypeParam::rounding_m(Order::ordered, part));
        }
}

TYPED_TEST(Sequence, HeldVerticesKeepTheirBits)
{
    const Positions before = this->start();
    std::vector<bool> held(before.rows());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = i % 3 == 0;
    const Positions after = this->by_kernels(Part::all, this->constraints(Part::all, held));
    int moved = 0;
    for (Eigen::Index i = 0; i < after.rows(); ++i) {
        moved += after.row(i) != before.row(i);
        EXPECT_TRUE(!held[i] || after.row(i) == before.row(i)) << i;
    }
    EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace sequence_tests
