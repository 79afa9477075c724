// Reference: value and gradient of pbs/constraints and the change of the multiplier by Eq. 18 of Macklin 2016, in the same precision.
// Tolerance: the rounding of a projection that removes all of the error (projection_rounding.hpp), once for each side; a compliance makes
// the correction smaller. The multiplier is at most what the rest value would give, so that the bound holds for its term too.
#include "pbs/solver/batched/pbs_kernels.hpp"

#include "tests/support/projection_cases.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace test_support;
using pbs::GroupKind;
using pbs::Vec3;

template <typename Scalar>
class CompliantKernels : public testing::Test {
};
using ScalarsOfKernels = testing::Types<float, double>;
TYPED_TEST_SUITE(CompliantKernels, ScalarsOfKernels);

const double powers_of_two_m[] = {1.0 / 1024.0, 1.0, 1024.0};  // so that products that must cancel do

// Sixteen constraints of one kind with vertices of their own.
template <typename Scalar, GroupKind kind>
struct SixteenCompliant {
    using Point = pbs::Vector3<Scalar>;
    static constexpr int vertices = pbs::GroupShape<kind>::vertices;

    alignas(64) Scalar xyzw[pbs::batch_size * vertices][4] = {};
    alignas(64) Scalar lambda[pbs::batch_size] = {};
    pbs::Batch<Scalar, kind> batch = {};
    Scalar dt2 = Scalar(0.25);

    SixteenCompliant()
    {
        for (int lane = 0; lane < pbs::batch_size; ++lane)
            for (int v = 0; v < vertices; ++v) batch.offset[v][lane] = 4 * (lane * vertices + v);
    }

    // rest: length or six volumes. spring: 1 / alpha of the length or of six volumes.
    void set(int lane, const std::vector<Vec3>& points, const std::vector<double>& w, double rest, double spring, double multiplier)
    {
        for (int v = 0; v < vertices; ++v) {
            for (int axis = 0; axis < 3; ++axis) xyzw[lane * vertices + v][axis] = Scalar(points[v](axis));
            xyzw[lane * vertices + v][3] = Scalar(w[v]);
        }
        batch.rest[0][lane] = Scalar(rest);
        batch.stiffness[0][lane] = Scalar(spring);
        lambda[lane] = Scalar(multiplier);
    }

    Point point(int lane, int v) const
    {
        const Scalar* p = xyzw[lane * vertices + v];
        return {p[0], p[1], p[2]};
    }
    Scalar w(int lane, int v) const { return xyzw[lane * vertices + v][3]; }
    void project() { pbs::project_compliant_batches<Scalar>(kind, &batch, 1, dt2, lambda, xyzw[0]); }
};

// Moves p. k: dt^2 / alpha of the constraint; lambda: its multiplier.
template <typename Scalar, typename Constraint, std::size_t count>
void project_by_eq_18(const Constraint& constraint, Scalar k, Scalar lambda, const std::array<Scalar, count>& w,
                      std::array<pbs::Vector3<Scalar>, count>& p)
{
    const auto [C, g] = std::apply([&](const auto&... x) { return std::pair{value(constraint, x...), gradient(constraint, x...)}; }, p);
    Scalar w_gradient2 = Scalar(0);
    for (std::size_t i = 0; i < count; ++i) w_gradient2 += w[i] * g[i].squaredNorm();
    if (!(w_gradient2 > Scalar(0))) return;
    const Scalar step = (-k * C - lambda) / (k * w_gradient2 + Scalar(1));
    for (std::size_t i = 0; i < count; ++i) p[i] += w[i] * step * g[i];
}

template <typename Scalar>
void expect_edges_as_plain(const SixteenCompliant<Scalar, GroupKind::edge>& before)
{
    auto groups = before;
    groups.project();
    for (int lane = 0; lane < pbs::batch_size; ++lane) {
        const std::array<Scalar, 2> w = {before.w(lane, 0), before.w(lane, 1)};
        std::array<pbs::Vector3<Scalar>, 2> p = {before.point(lane, 0), before.point(lane, 1)};
        const pbs::StretchConstraint<Scalar> edge{{0, 1}, before.batch.rest[0][lane], Scalar(1)};
        const double rounding_m = 2.0 * rounding_of(edge, w[0], w[1], p[0], p[1]).step;
        project_by_eq_18(edge, before.dt2 * before.batch.stiffness[0][lane], before.lambda[lane], w, p);
        for (int v = 0; v < 2; ++v)
            EXPECT_LE((groups.point(lane, v) - p[v]).cwiseAbs().maxCoeff(), w[v] > Scalar(0) ? rounding_m : 0.0) << lane << ' ' << v;
    }
}

template <typename Scalar>
void expect_tets_as_plain(const SixteenCompliant<Scalar, GroupKind::tet>& before)
{
    auto groups = before;
    groups.project();
    for (int lane = 0; lane < pbs::batch_size; ++lane) {
        std::array<Scalar, 4> w;
        std::array<pbs::Vector3<Scalar>, 4> p;
        for (int v = 0; v < 4; ++v) w[v] = before.w(lane, v), p[v] = before.point(lane, v);
        const pbs::VolumeConstraint<Scalar> tet{{0, 1, 2, 3}, before.batch.rest[0][lane] / 6, Scalar(1)};
        const double rounding_m = 2.0 * rounding_of(tet, w, p).step;
        project_by_eq_18(tet, 36 * before.dt2 * before.batch.stiffness[0][lane], 6 * before.lambda[lane], w, p);
        for (int v = 0; v < 4; ++v)
            EXPECT_LE((groups.point(lane, v) - p[v]).cwiseAbs().maxCoeff(), w[v] > Scalar(0) ? rounding_m : 0.0) << lane << ' ' << v;
    }
}

TYPED_TEST(CompliantKernels, Edges)
{
    RandomPoints random(51);
    for (const double size_m : powers_of_two_m)
        for (const double length : {0.0, 1e-3, 0.9, 1.0, 100.0})
            for (const double stiffness : {1e-3, 1.0, 1e6}) {  // k w: from soft to nearly rigid
                SCOPED_TRACE(testing::Message() << "size " << size_m << " length " << length << " stiffness " << stiffness);
                SixteenCompliant<TypeParam, GroupKind::edge> groups;
                for (int lane = 0; lane < pbs::batch_size; ++lane) {
                    const Vec3 first = random.point(size_m), along = random.point(1.0).normalized();
                    const std::vector<double> w = {lane & 1 ? 0.0 : random.number(0.2, 5.0), lane & 2 ? 0.0 : random.number(0.2, 5.0)};
                    const double multiplier = 0.25 * stiffness * size_m * random.number(-1.0, 1.0);
                    groups.set(lane, {first, first + length * size_m * along}, w, size_m, stiffness, multiplier);
                }
                expect_edges_as_plain(groups);
            }
}

// The stiffness of six times the volume relative to 1 / (w size^4), where half of the error is removed.
TYPED_TEST(CompliantKernels, TetsOfEveryShape)
{
    RandomPoints random(52);
    std::vector<TetShape> shapes(std::begin(degenerate_tets), std::end(degenerate_tets));
    shapes.push_back({"well shaped", {{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.4, 0.9}}}});
    shapes.push_back({"mirrored", {{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.4, -0.9}}}});
    for (const TetShape& shape : shapes)
        for (const double size_m : powers_of_two_m)
            for (const double relative : {1e-3, 1.0, 1e3}) {
                SCOPED_TRACE(testing::Message() << shape.name << " size " << size_m << " stiffness " << relative);
                SixteenCompliant<TypeParam, GroupKind::tet> groups;
                const double rest = std::pow(size_m, 3), stiffness = relative / std::pow(size_m, 4);
                for (int lane = 0; lane < pbs::batch_size; ++lane) {
                    std::vector<Vec3> points;
                    std::vector<double> w;
                    for (int v = 0; v < 4; ++v) {
                        points.push_back(size_m * shape.corners[v]);
                        w.push_back(lane >> v & 1 ? 0.0 : random.number(0.2, 5.0));
                    }
                    groups.set(lane, points, w, rest, stiffness, 0.25 * stiffness * rest * random.number(-1.0, 1.0));
                }
                expect_tets_as_plain(groups);
            }
}

// Two projections of an edge of stiffness k = 1 / w between two free points of mass 1 / w, by hand: d lambda = (-k C - lambda) / 3, and the
// edge becomes shorter by 2 w d lambda. C: 3, 1; lambda: 0, -1.
TYPED_TEST(CompliantKernels, TheMultiplierIsKept)
{
    SixteenCompliant<TypeParam, GroupKind::edge> groups;
    groups.dt2 = 1;
    groups.set(5, {{0, 0, 0}, {4, 0, 0}}, {1.0, 1.0}, 1.0, 1.0, 0.0);
    groups.project();
    EXPECT_EQ(groups.lambda[5], TypeParam(-1));
    EXPECT_EQ(groups.point(5, 1).x() - groups.point(5, 0).x(), TypeParam(2));
    groups.project();
    EXPECT_EQ(groups.lambda[5], TypeParam(-1)) << "C / alpha + lambda = 0: in equilibrium";
    EXPECT_EQ(groups.point(5, 1).x() - groups.point(5, 0).x(), TypeParam(2));
}

// An edge without length and a tet that is a point have no gradient. Their multipliers stay, as in plain code. Otherwise they would grow
// while the constraint cannot act, and move the vertices too far later.
TYPED_TEST(CompliantKernels, WithoutAGradientTheMultiplierStays)
{
    SixteenCompliant<TypeParam, GroupKind::edge> edges;
    SixteenCompliant<TypeParam, GroupKind::tet> tets;
    edges.set(2, {{1, 2, 3}, {1, 2, 3}}, {1.0, 1.0}, 1.0, 1.0, 0.5);
    tets.set(2, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {1.0, 1.0, 1.0, 1.0}, 1.0, 1.0, 0.5);
    edges.project();
    tets.project();
    EXPECT_EQ(edges.lambda[2], TypeParam(0.5));
    EXPECT_EQ(tets.lambda[2], TypeParam(0.5));
}

// A NaN remains NaN and stays in its lane; every other lane has the same bits as without it.
TYPED_TEST(CompliantKernels, NotANumberStaysInItsLane)
{
    SixteenCompliant<TypeParam, GroupKind::tet> clean;
    for (int lane = 0; lane < pbs::batch_size; ++lane)
        clean.set(lane, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1.0, 1.0, 1.0, 1.0}, 0.5, 1.0, 0.0);
    auto sick = clean;
    sick.xyzw[3 * 4 + 1][0] = std::numeric_limits<TypeParam>::quiet_NaN();
    clean.project();
    sick.project();
    EXPECT_TRUE(std::isnan(sick.point(3, 1).x()));
    for (int lane = 0; lane < pbs::batch_size; ++lane)
        for (int v = 0; lane != 3 && v < 4; ++v) EXPECT_EQ(sick.point(lane, v), clean.point(lane, v)) << lane;
}

// The input of lanes without a group: no mass, no rest value, no stiffness, at the origin.
TYPED_TEST(CompliantKernels, DummiesStayZero)
{
    for (int kind = 0; kind <= static_cast<int>(GroupKind::tet_fan_3); ++kind)
        pbs::with_kind(GroupKind(kind), [](auto of_kind) {
            using Shape = pbs::GroupShape<of_kind()>;
            alignas(64) TypeParam xyzw[pbs::batch_size * Shape::vertices][4] = {};
            alignas(64) TypeParam lambda[pbs::batch_size * Shape::constraints] = {};
            pbs::Batch<TypeParam, of_kind()> batch = {};
            for (int lane = 0; lane < pbs::batch_size; ++lane)
                for (int v = 0; v < Shape::vertices; ++v) batch.offset[v][lane] = 4 * (lane * Shape::vertices + v);
            pbs::project_compliant_batches<TypeParam>(of_kind(), &batch, 1, TypeParam(1), lambda, xyzw[0]);
            for (const auto& vertex : xyzw)
                for (const TypeParam number : vertex) EXPECT_EQ(number, TypeParam(0));
            for (const TypeParam number : lambda) EXPECT_EQ(number, TypeParam(0));
        });
}

}  // namespace
