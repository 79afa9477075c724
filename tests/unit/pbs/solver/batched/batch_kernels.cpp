// Reference: the plain form in pbs/constraints, constraint by constraint, within the bounds of rounding (projection_rounding.hpp).
#include "tests/support/projection_cases.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/sixteen_groups.hpp"

#include <functional>
#include <string>

namespace {

using namespace test_support;
using pbs::GroupKind;
using pbs::Vec3;

template <typename Scalar>
class BatchKernels : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BatchKernels, Scalars);

// Sixteen groups near rest, each with its own masses; bit v of a lane's `pinned` marks vertex v as pinned.
template <typename Scalar, GroupKind kind>
SixteenGroups<Scalar, kind> noisy_groups(RandomPoints& random, double size_m, double k, double noise, int pinned_of_lane_0 = 0)
{
    using Shape = pbs::GroupShape<kind>;
    SixteenGroups<Scalar, kind> groups;
    for (int lane = 0; lane < pbs::batch_size; ++lane) {
        const int pinned = pinned_of_lane_0 + lane;
        for (int v = 0; v < Shape::vertices; ++v) {
            const double w = pinned_of_lane_0 >= 0 && (pinned >> v & 1) ? 0.0 : random.number(0.2, 5.0);
            groups.set_vertex(lane, v, size_m * (ring[v] + random.point(noise)), w);
        }
        for (int c = 0; c < Shape::constraints; ++c) {
            const auto& join = Shape::joins[c];
            const Vec3 x0 = ring[join[0]];
            if constexpr (pbs::of_edges<kind>)
                groups.set_constraint(lane, c, size_m * (ring[join[1]] - x0).norm(), k);
            else
                groups.set_constraint(lane, c,
                                      std::pow(size_m, 3) / 6 * (ring[join[1]] - x0).cross(ring[join[2]] - x0).dot(ring[join[3]] - x0), k);
        }
    }
    return groups;
}

template <typename F>
void for_each_kind(F f)
{
    for (int kind = 0; kind <= static_cast<int>(GroupKind::tet_fan_3); ++kind) {
        SCOPED_TRACE("kind " + std::to_string(kind));
        pbs::with_kind(GroupKind(kind), f);
    }
}

TYPED_TEST(BatchKernels, EveryKindAsItsConstraintsOneAfterTheOther)
{
    for_each_kind([](auto kind) {
        RandomPoints random(31);
        for (const double size_m : sizes_m)
            for (const double k : stiffnesses)
                for (const double noise : {0.0, 0.01, 0.2}) {
                    SCOPED_TRACE(testing::Message() << "size " << size_m << " k " << k << " noise " << noise);
                    noisy_groups<TypeParam, kind()>(random, size_m, k, noise, -1).expect_as_plain();
                }
    });
}

// All sixteen combinations of up to four pinned vertices in one batch; those of five and six vertices in more batches.
TYPED_TEST(BatchKernels, EveryCombinationOfPinnedVertices)
{
    for_each_kind([](auto kind) {
        RandomPoints random(32);
        for (int pinned = 0; pinned < 1 << pbs::GroupShape<kind()>::vertices; pinned += pbs::batch_size)
            noisy_groups<TypeParam, kind()>(random, 1.0, 1.0, 0.2, pinned).expect_as_plain();
    });
}

// z is mirrored: volumes have the wrong sign, and the projections pass through flat states.
TYPED_TEST(BatchKernels, MirroredGroups)
{
    for_each_kind([](auto kind) {
        RandomPoints random(33);
        for (const double size_m : sizes_m) {
            auto groups = noisy_groups<TypeParam, kind()>(random, size_m, 0.3, 0.02, -1);
            for (int lane = 0; lane < pbs::batch_size; ++lane)
                for (int v = 0; v < pbs::GroupShape<kind()>::vertices; ++v) groups.vertex(lane, v)[2] *= -1;
            groups.expect_as_plain();
        }
    });
}

TYPED_TEST(BatchKernels, DegenerateTets)
{
    RandomPoints random(34);
    for (const TetShape& shape : degenerate_tets)
        for (const double size_m : sizes_m)
            for (const double k : stiffnesses) {
                SCOPED_TRACE(testing::Message() << shape.name << " size " << size_m << " k " << k);
                SixteenGroups<TypeParam, GroupKind::tet> groups;
                for (int lane = 0; lane < pbs::batch_size; ++lane) {  // each lane pins different vertices
                    for (int v = 0; v < 4; ++v)
                        groups.set_vertex(lane, v, size_m * shape.corners[v], lane >> v & 1 ? 0.0 : random.number(0.2, 5.0));
                    groups.set_constraint(lane, 0, std::pow(size_m, 3) / 6, k);
                }
                groups.expect_as_plain();
            }
}

TYPED_TEST(BatchKernels, DegenerateEdges)
{
    RandomPoints random(35);
    for (const double length : {0.0, 1e-3, 1.0, 100.0})
        for (const double size_m : sizes_m)
            for (const double k : stiffnesses) {
                SCOPED_TRACE(testing::Message() << "length " << length << " size " << size_m << " k " << k);
                SixteenGroups<TypeParam, GroupKind::edge> groups;
                for (int lane = 0; lane < pbs::batch_size; ++lane) {
                    const Vec3 first = random.point(size_m), along = random.point(1.0).normalized();
                    groups.set_vertex(lane, 0, first, lane & 1 ? 0.0 : random.number(0.2, 5.0));
                    groups.set_vertex(lane, 1, first + length * size_m * along, lane & 2 ? 0.0 : random.number(0.2, 5.0));
                    groups.set_constraint(lane, 0, size_m, k);
                }
                groups.expect_as_plain();
            }
}

// A NaN remains NaN and stays in its lane; every other lane has the same bits as without it.
TYPED_TEST(BatchKernels, NotANumberStaysInItsLane)
{
    for_each_kind([](auto kind) {
        RandomPoints random(36);
        auto clean = noisy_groups<TypeParam, kind()>(random, 1.0, 0.3, 0.1, -1), sick = clean;
        for (int lane = 3; lane < pbs::batch_size; lane += 5) sick.vertex(lane, 1)[0] = std::numeric_limits<TypeParam>::quiet_NaN();
        clean.project();
        sick.project();
        for (int lane = 0; lane < pbs::batch_size; ++lane)
            for (int v = 0; v < pbs::GroupShape<kind()>::vertices; ++v) {
                if (lane % 5 != 3) {
                    EXPECT_EQ(sick.position(lane, v), clean.position(lane, v)) << "lane " << lane;
                }
                if (lane % 5 == 3 && v == 1) {
                    EXPECT_TRUE(std::isnan(sick.vertex(lane, v)[0])) << "lane " << lane;
                }
            }
    });
}

// The input of lanes without a group: no mass, no rest length, no stiffness, at the origin.
TYPED_TEST(BatchKernels, DummiesStayZero)
{
    for_each_kind([](auto kind) {
        SixteenGroups<TypeParam, kind()> groups;
        groups.project();
        EXPECT_EQ(pbs::sum_squared_errors<TypeParam>(kind(), &groups.batch(), 1, groups.memory()), 0.0);
        for (int i = 0; i < 4 * pbs::batch_size * pbs::GroupShape<kind()>::vertices; ++i) EXPECT_EQ(groups.memory()[i], TypeParam(0));
    });
}

// l / l0 - 1 or V / V0 - 1 of constraint c, by its plain form.
template <typename Scalar, GroupKind kind>
double plain_error(SixteenGroups<Scalar, kind>& groups, int lane, int c)
{
    const auto p = [&](int i) { return groups.position(lane, pbs::GroupShape<kind>::joins[c][i]); };
    const Scalar rest = groups.rest(lane, c);
    if constexpr (pbs::of_edges<kind>)
        return value(pbs::StretchConstraint<Scalar>{{}, rest, 1}, p(0), p(1)) / rest;
    else
        return value(pbs::VolumeConstraint<Scalar>{{}, rest, 1}, p(0), p(1), p(2), p(3)) / rest;
}

// (l / l0 - 1)^2 and (V / V0 - 1)^2, by the plain form in the same precision: some twenty roundings of sums of positive terms, and those of
// C itself, whose two parts may cancel.
TYPED_TEST(BatchKernels, SumsOfSquaredErrors)
{
    constexpr double eps = std::numeric_limits<TypeParam>::epsilon();
    for_each_kind([](auto kind) {
        using Groups = pbs::GroupShape<kind()>;
        RandomPoints random(37);
        for (const double size_m : sizes_m) {
            auto groups = noisy_groups<TypeParam, kind()>(random, size_m, 0.3, 0.2, -1);
            double expected = 0.0, rounding = 0.0;
            for (int lane = 0; lane < pbs::batch_size; ++lane)
                for (int c = 0; c < Groups::constraints; ++c) {
                    const double error = plain_error<TypeParam, kind()>(groups, lane, c);
                    expected += error * error;
                    rounding += 20 * eps * (std::abs(error) + 1) * (std::abs(error) + 1);
                }
            EXPECT_NEAR(pbs::sum_squared_errors<TypeParam>(kind(), &groups.batch(), 1, groups.memory()), expected, rounding);
        }
    });
}

// |l / l0 - 1| and |V / V0 - 1| of every group: the largest of its constraints' plain values, up to the rounding of the sums above.
TYPED_TEST(BatchKernels, LargestErrorOfEachGroup)
{
    constexpr double eps = std::numeric_limits<TypeParam>::epsilon();
    for_each_kind([](auto kind) {
        RandomPoints random(40);
        auto groups = noisy_groups<TypeParam, kind()>(random, 1.0, 0.3, 0.2, -1);
        TypeParam errors[pbs::batch_size];
        pbs::largest_errors<TypeParam>(kind(), &groups.batch(), 1, groups.memory(), errors);
        for (int lane = 0; lane < pbs::batch_size; ++lane) {
            double expected = 0.0;
            for (int c = 0; c < pbs::GroupShape<kind()>::constraints; ++c)
                expected = std::max(expected, std::abs(plain_error<TypeParam, kind()>(groups, lane, c)));
            EXPECT_NEAR(errors[lane], expected, 20 * eps * (expected + 1)) << "lane " << lane;
        }
    });
}

// Whichever vertex is NaN, in the first constraint or in the last, no error is below a tolerance. The result for the other lanes does not
// change.
TYPED_TEST(BatchKernels, AGroupThatIsNotANumberIsNeverSatisfied)
{
    for_each_kind([](auto kind) {
        for (const double sick : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (int v = 0; v < pbs::GroupShape<kind()>::vertices; ++v) {
                SCOPED_TRACE(testing::Message() << sick << " at vertex " << v);
                RandomPoints random(41);
                auto groups = noisy_groups<TypeParam, kind()>(random, 1.0, 0.3, 0.01, -1);
                TypeParam clean[pbs::batch_size], errors[pbs::batch_size];
                pbs::largest_errors<TypeParam>(kind(), &groups.batch(), 1, groups.memory(), clean);
                groups.vertex(3, v)[0] = TypeParam(sick);
                pbs::largest_errors<TypeParam>(kind(), &groups.batch(), 1, groups.memory(), errors);
                for (int lane = 0; lane < pbs::batch_size; ++lane) {
                    if (lane == 3)
                        EXPECT_FALSE(errors[lane] <= TypeParam(1));
                    else
                        EXPECT_EQ(errors[lane], clean[lane]) << "lane " << lane;
                }
            }
    });
}

struct OneBind {
    Vec3 p, q;
    double w, rest_m, k;
};

// Two batches of bind constraints with `of(vertex)`, projected by the kernel and by the plain form.
template <typename Scalar>
void expect_binds_as_plain(const std::function<OneBind(int)>& of)
{
    constexpr int count = 2 * pbs::batch_size;
    alignas(64) Scalar xyzw[count][4];
    pbs::BindBatch<Scalar> batches[2] = {};
    std::vector<pbs::Vector3<Scalar>> expected;
    std::vector<double> tolerance;
    double squares = 0.0, squared_terms = 0.0;
    for (int i = 0; i < count; ++i) {
        const auto [p, q, w, rest_m, k] = of(i);
        pbs::BindBatch<Scalar>& batch = batches[i / pbs::batch_size];
        const int lane = i % pbs::batch_size;
        for (int axis = 0; axis < 3; ++axis) xyzw[i][axis] = Scalar(p(axis));
        xyzw[i][3] = Scalar(w);
        batch.x[lane] = Scalar(q(0)), batch.y[lane] = Scalar(q(1)), batch.z[lane] = Scalar(q(2));
        batch.rest_distance[lane] = Scalar(rest_m);
        batch.stiffness[lane] = w > 0.0 ? Scalar(k) : Scalar(0);
        const pbs::BindConstraint<Scalar> bind{i, Scalar(rest_m), Scalar(k)};
        const pbs::Vector3<Scalar> posed = q.cast<Scalar>();
        expected.push_back(p.cast<Scalar>());
        tolerance.push_back(w > 0.0 ? rounding_of(bind, posed, expected[i]).step : 0.0);
        squares += std::pow(double(value(bind, expected[i], posed)), 2);
        squared_terms += std::pow((expected[i] - posed).norm() + rest_m, 2);
        project(bind, Scalar(w), posed, expected[i]);
    }
    // The two terms of an error go through some seven roundings, its square through twice as many and one, and the sum follows, twice.
    const double rounding = rounding_error_in<Scalar>(2 * (2 * 7 + 1 + count), squared_terms);
    EXPECT_NEAR(pbs::sum_squared_bind_errors<Scalar>(batches, 2, xyzw[0]), squares, rounding);
    pbs::project_bind_batches<Scalar>(batches, 2, xyzw[0]);
    for (int i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(xyzw[i][axis], expected[i](axis), tolerance[i]) << "vertex " << i;
}

TYPED_TEST(BatchKernels, Bind)
{
    for (const double k : stiffnesses) {
        RandomPoints random(38);
        expect_binds_as_plain<TypeParam>([&](int i) {
            const Vec3 q = random.point(1.0);
            return OneBind{q + random.point(0.5), q, i % 7 == 3 ? 0.0 : random.number(0.2, 5.0), random.number(0.1, 0.5), k};
        });
    }
}

TYPED_TEST(BatchKernels, BindOnTheBoneAndOnTheBindPoint)
{
    RandomPoints random(39);
    expect_binds_as_plain<TypeParam>([&](int i) {
        const Vec3 q = random.point(1.0);
        return OneBind{i % 2 ? q : Vec3(q + random.point(0.5)), q, 1.0, i % 4 < 2 ? 0.0 : 0.3, 1.0};
    });
}

}  // namespace
