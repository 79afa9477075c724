// The contract of the kernels of Algorithm 1 and of XPBD: each projects as the plain form in pbs/constraints does,
// constraint by constraint, within the bounds of rounding (projection_rounding.hpp). For XPBD, the reference is value
// and gradient of pbs/constraints and the change of the multiplier by Eq. 18 of Macklin 2016; a compliance makes the
// correction smaller, and the multiplier is at most what the rest value would give, so that twice the rounding of a
// projection that removes all of the error bounds the difference.
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/sixteen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kernels_tests {
namespace {

using namespace test_support;
using pbs::Vec3;
using enum pbs::ConstraintKind;

// The corners of a tet, and the points that may follow around its first edge; any three neighbours in the ring make a
// well-shaped tet.
const Vec3 ring[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}, {-1, 0.1, 0.5}, {-0.3, -1, 0.5}};

struct TetShape {
    const char* name;
    std::array<Vec3, 4> corners;  // dyadic coordinates where products must cancel exactly
};
const TetShape tet_shapes[] = {
    {"flat", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}},
    {"a corner on the opposite face", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}}}},
    {"two corners coincide", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}}},
    {"three corners coincide", {{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}},
    {"a line", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, 0, 0}}}},
    {"a point", {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}},
    {"nearly flat", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-3}}}},
    {"a sliver", {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.01, 0}, {0.5, 0, 0.01}}}},
    {"a hundred times too large", {{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}}}},
    {"well shaped", {{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.4, 0.9}}}},
    {"mirrored", {{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.4, -0.9}}}},
};

// Moves p. k: dt^2 / alpha of the constraint; lambda: its multiplier.
template <typename Scalar, typename Constraint, std::size_t n>
void project_by_eq_18(const Constraint& constraint, Scalar k, Scalar lambda, const std::array<Scalar, n>& w,
                      std::array<pbs::Vector3<Scalar>, n>& p)
{
    const auto [C, g] = std::apply(
        [&](const auto&... x) {
            return std::pair{value(constraint, x...), gradient(constraint, x...)};
        },
        p);
    Scalar w_gradient2 = Scalar(0);
    for (std::size_t i = 0; i < n; ++i) w_gradient2 += w[i] * g[i].squaredNorm();
    if (!(w_gradient2 > Scalar(0))) return;
    const Scalar step = (-k * C - lambda) / (k * w_gradient2 + Scalar(1));
    for (std::size_t i = 0; i < n; ++i) p[i] += w[i] * step * g[i];
}

// Projects a constraint of one lane by its plain form.
template <std::size_t n, typename Scalar>
RoundingBound project_plainly(bool compliant, Sixteen<Scalar>& on, const typename Sixteen<Scalar>::Link& link, int lane)
{
    const Scalar rest = link.rest[lane], k = compliant ? Scalar(1) : link.k[lane], spring = Scalar(0.25) * link.k[lane];
    std::array<pbs::Vector3<Scalar>, n> p;
    std::array<Scalar, n> w;
    for (std::size_t i = 0; i < n; ++i) p[i] = on.p[lane][link.vertex[i]], w[i] = on.w[lane][link.vertex[i]];
    RoundingBound bound;
    if constexpr (n == 1) {
        const pbs::BindConstraint<Scalar> bind{0, rest, k};
        bound = rounding_of(bind, on.q[lane][link.vertex[0]], p[0]);
        project(bind, w[0], on.q[lane][link.vertex[0]], p[0]);
    } else if constexpr (n == 2) {
        const pbs::StretchConstraint<Scalar> edge{{0, 1}, rest, k};
        bound = rounding_of(edge, w[0], w[1], p[0], p[1]);
        compliant ? project_by_eq_18(edge, spring, link.lambda[lane], w, p) : project(edge, w[0], w[1], p[0], p[1]);
    } else {
        const pbs::VolumeConstraint<Scalar> tet{{0, 1, 2, 3}, rest, k};
        bound = rounding_of(tet, w, p);
        compliant ? project_by_eq_18(tet, 36 * spring, 6 * link.lambda[lane], w, p)
                  : project(tet, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]);
    }
    for (std::size_t i = 0; i < n; ++i) on.p[lane][link.vertex[i]] = p[i];
    return {(compliant ? 2.0 : 1.0) * bound.step, bound.growth};
}

// A kernel and its input. It is a value, so that each test is compiled once for each scalar, and not for each kernel.
template <typename Scalar>
struct Kernel {
    const char* name;
    bool one_body, compliant;
    int vertices;
    std::vector<std::vector<int>> links;  // the vertices of each constraint
    void (*project)(Sixteen<Scalar>&);
    // Batches of edges and tets alone have it. It returns the sum of squares of the errors l / l0 - 1 and V / V0 - 1,
    // and the largest in each lane.
    std::pair<double, std::array<Scalar, lanes>> (*errors)(const Sixteen<Scalar>&) = nullptr;
    RandomPoints random{31};

    // Compares positions after the kernel and after the plain form; masses and pinned vertices are equal to the bit.
    void expect_as_plain(const Sixteen<Scalar>& before) const
    {
        auto projected = before, plain = before;
        project(projected);
        for (int lane = 0; lane < lanes; ++lane) {
            double difference[most_vertices] = {};  // that the vertices may have [m]
            for (const auto& link : before.links) {
                const std::size_t n = link.vertex.size();
                const RoundingBound bound = n == 1   ? project_plainly<1>(compliant, plain, link, lane)
                                            : n == 2 ? project_plainly<2>(compliant, plain, link, lane)
                                                     : project_plainly<4>(compliant, plain, link, lane);
                double worst = 0.0;
                for (const int v : link.vertex) worst = std::max(worst, difference[v]);
                for (const int v : link.vertex) difference[v] = worst * bound.growth + bound.step;
            }
            for (int v = 0; v < vertices; ++v) {
                const double found = (projected.p[lane][v] - plain.p[lane][v]).cwiseAbs().maxCoeff();
                EXPECT_LE(found, before.w[lane][v] > 0 ? difference[v] : 0.0) << "lane " << lane << " vertex " << v;
                EXPECT_EQ(projected.w[lane][v], before.w[lane][v]);
            }
        }
    }

    // Bit v of `pinned` marks vertex v of the first lane; of batches, each lane has other pinned vertices. Poses share
    // their masses.
    void set_mass(Sixteen<Scalar>& on, int lane, int v, int pinned)
    {
        on.w[lane][v] = (one_body ? pinned : pinned + lane) >> v & 1 ? Scalar(0) : Scalar(random.number(0.2, 5.0));
        if (one_body) on.w[lane][v] = on.w[0][v];
    }

    // Stiffnesses from 0 to 1 inclusive; of XPBD, from soft to nearly rigid, in units in which 1 removes half of the
    // error.
    void set_link(typename Sixteen<Scalar>::Link& link, int c, double rest, double size_m)
    {
        const bool tet = link.vertex.size() == 4;
        for (int lane = 0; lane < lanes; ++lane) {
            link.rest[lane] = Scalar(rest);
            link.k[lane] = Scalar((5 * lane + 7 * (tet ? 2 : c % 2)) % lanes) / (lanes - 1);
            if (link.vertex.size() == 1) link.k[lane] = Scalar(5 * lane % lanes) / (lanes - 1);
            if (!compliant) continue;
            link.k[lane] = Scalar(std::pow(10.0, -3.0 + (tet ? 6.0 : 9.0) * lane / (lanes - 1)) /
                                  (tet ? std::pow(size_m, 4) : 1.0));
            link.lambda[lane] = Scalar(0.25 * link.k[lane] * (tet ? 6.0 : 1.0) * rest * random.number(-1.0, 1.0));
        }
    }

    // The ring at a different place in every lane, with noise.
    Sixteen<Scalar> noisy_ring(double size_m, double noise, int pinned = 0, double mirror = 1.0)
    {
        Sixteen<Scalar> on;
        for (int lane = 0; lane < lanes; ++lane)
            for (int v = 0; v < vertices; ++v) {
                on.p[lane][v] =
                    (size_m * (ring[v] + random.point(noise)).cwiseProduct(Vec3(1, 1, mirror))).template cast<Scalar>();
                on.q[lane][v] = (size_m * (ring[v] + random.point(0.5))).template cast<Scalar>();
                set_mass(on, lane, v, pinned);
            }
        for (const std::vector<int>& v : links) {
            on.links.push_back({v});
            double rest = 0.1 * v[0] * size_m;
            if (v.size() == 2) rest = size_m * (ring[v[1]] - ring[v[0]]).norm();
            if (v.size() == 4)
                rest = std::pow(size_m, 3) / 6 *
                       (ring[v[1]] - ring[v[0]]).cross(ring[v[2]] - ring[v[0]]).dot(ring[v[3]] - ring[v[0]]);
            set_link(on.links.back(), static_cast<int>(on.links.size()) - 1, rest, size_m);
        }
        return on;
    }

    // The first constraint alone, with these points, each pinned in another lane. rest: in units of the size.
    void expect_one_as_plain(const std::vector<Vec3>& points, double rest, double size_m, int pinned)
    {
        Sixteen<Scalar> on;
        on.links = {{links[0]}};
        for (const int v : links[0])
            for (int lane = 0; lane < lanes; ++lane) {
                on.p[lane][v] = (size_m * points[v]).template cast<Scalar>();
                set_mass(on, lane, v, pinned);
            }
        set_link(on.links[0], 0, rest * std::pow(size_m, points.size() - 1), size_m);
        expect_as_plain(on);
    }

    // XPBD has powers of two, so that products that must cancel do.
    std::vector<double> sizes_m() const
    {
        if (compliant) return {1.0 / 1024.0, 1.0, 1024.0};
        return {1e-6, 1e-3, 1.0, 1e3, 1e6};
    }
};

template <typename Of>
Kernel<typename Of::Scalar> kernel_of(const char* name)
{
    return {name, Of::one_body, Of::compliant, Of::vertices, Of::links(), [](auto& on) { Of::project(on); }};
}
template <typename S, pbs::ConstraintKind kind>
Kernel<S> batch_of(const char* name)
{
    auto kernel = kernel_of<Batched<S, kind>>(name);
    kernel.errors = [](const Sixteen<S>& on) {
        const auto batch = Batched<S, kind>::packed(on);
        std::array<S, lanes> largest;
        pbs::largest_errors<S>(kind, &batch.batch, 1, batch.xyzw[0], largest.data());
        return std::pair{pbs::sum_squared_errors<S>(kind, &batch.batch, 1, batch.xyzw[0]), largest};
    };
    return kernel;
}

// Each call returns them with the same random numbers.
template <typename S>
std::vector<Kernel<S>> kernels()
{
    return {batch_of<S, edge>("edge"),
            batch_of<S, tet>("tet"),
            kernel_of<Compliant<S, edge>>("compliant edge"),
            kernel_of<Compliant<S, tet>>("compliant tet"),
            kernel_of<BindBatches<S>>("bind batches"),
            kernel_of<Poses<S, 1>>("binds of poses"),
            kernel_of<Poses<S, 2>>("edges of poses"),
            kernel_of<Poses<S, 4>>("tets of poses")};
}

template <typename Scalar>
class KernelContract : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(KernelContract, Scalars);

TYPED_TEST(KernelContract, OneConstraintAfterTheOther)
{
    for (auto& kernel : kernels<TypeParam>())
        for (const double size_m : kernel.sizes_m())
            for (const double noise : {0.0, 0.01, 0.2}) {
                SCOPED_TRACE(testing::Message() << kernel.name << " size " << size_m << " noise " << noise);
                kernel.expect_as_plain(kernel.noisy_ring(size_m, noise));
            }
}

TYPED_TEST(KernelContract, EveryCombinationOfPinnedVertices)
{
    for (auto& kernel : kernels<TypeParam>())
        for (int pinned = 0; pinned < 1 << kernel.vertices; pinned += kernel.one_body ? 1 : lanes) {
            SCOPED_TRACE(testing::Message() << kernel.name << " pinned " << pinned);
            kernel.expect_as_plain(kernel.noisy_ring(1.0, 0.2, pinned));
        }
}

// z is mirrored: volumes have the wrong sign, and the projections pass through flat states.
TYPED_TEST(KernelContract, Mirrored)
{
    for (auto& kernel : kernels<TypeParam>())
        for (const double size_m : kernel.sizes_m()) {
            SCOPED_TRACE(testing::Message() << kernel.name << " size " << size_m);
            auto on = kernel.noisy_ring(size_m, 0.02, 0, -1.0);
            for (auto& link : on.links)
                if (!kernel.compliant) std::fill_n(link.k, lanes, 0.3);
            kernel.expect_as_plain(on);
        }
}

TYPED_TEST(KernelContract, DegenerateTetsAndEdges)
{
    for (auto& kernel : kernels<TypeParam>()) {
        const std::size_t corners = kernel.links[0].size();
        if (kernel.links.size() > 1 && !kernel.one_body) continue;  // its links are not one after the other in a lane
        for (const double size_m : kernel.sizes_m())
            for (int pinned = 0; pinned < (kernel.one_body ? 1 << corners : 1); ++pinned) {
                SCOPED_TRACE(testing::Message() << kernel.name << " size " << size_m << " pinned " << pinned);
                if (corners == 4)
                    for (const TetShape& shape : tet_shapes) {
                        SCOPED_TRACE(shape.name);
                        kernel.expect_one_as_plain({shape.corners.begin(), shape.corners.end()}, 1.0 / 6.0, size_m,
                                                   pinned);
                    }
                if (corners == 2)
                    for (const double length : {0.0, 1e-3, 0.9, 1.0, 100.0}) {
                        SCOPED_TRACE(length);
                        const Vec3 first = kernel.random.point(1.0);
                        kernel.expect_one_as_plain({first, first + length * kernel.random.point(1.0).normalized()}, 1.0,
                                                   size_m, pinned);
                    }
            }
    }
}

// A NaN remains NaN and stays in its lane; every other lane has the same bits as without it.
TYPED_TEST(KernelContract, NotANumberStaysInItsLane)
{
    for (auto& kernel : kernels<TypeParam>()) {
        SCOPED_TRACE(kernel.name);
        auto clean = kernel.noisy_ring(1.0, 0.1), sick = clean;
        for (int lane = 3; lane < lanes; lane += 5) sick.p[lane][1](0) = std::numeric_limits<TypeParam>::quiet_NaN();
        if (kernel.one_body)
            std::fill_n(clean.w[0], lanes * most_vertices, 1), std::fill_n(sick.w[0], lanes * most_vertices, 1);
        kernel.project(clean);
        kernel.project(sick);
        for (int lane = 0; lane < lanes; ++lane)
            for (int v = 0; v < kernel.vertices; ++v)
                if (lane % 5 != 3) {
                    EXPECT_EQ(sick.p[lane][v], clean.p[lane][v]) << "lane " << lane;
                } else if (v == 1) {
                    EXPECT_TRUE(std::isnan(sick.p[lane][v](0))) << "lane " << lane;
                }
    }
}

// The input of lanes without a constraint: no mass, no rest value, no stiffness, at the origin. Their errors are
// zero.
TYPED_TEST(KernelContract, DummiesStayZero)
{
    for (const auto& kernel : kernels<TypeParam>()) {
        SCOPED_TRACE(kernel.name);
        Sixteen<TypeParam> dummies;
        for (const std::vector<int>& v : kernel.links) dummies.links.push_back({v});
        EXPECT_EQ(kernel.errors ? kernel.errors(dummies).first : 0.0, 0.0);
        kernel.project(dummies);
        for (int lane = 0; lane < lanes; ++lane)
            for (int v = 0; v < kernel.vertices; ++v) {
                EXPECT_EQ(dummies.p[lane][v], pbs::Vector3<TypeParam>::Zero());
                EXPECT_EQ(dummies.w[lane][v], TypeParam(0));
            }
        for (const auto& link : dummies.links)
            for (const TypeParam lambda : link.lambda) EXPECT_EQ(lambda, TypeParam(0));
    }
}

TYPED_TEST(KernelContract, BindOnTheBoneAndOnTheBindPoint)
{
    for (auto& kernel : kernels<TypeParam>()) {
        if (kernel.links[0].size() != 1) continue;
        SCOPED_TRACE(kernel.name);
        auto at_its_point = kernel.noisy_ring(1.0, 0.0), on_the_bone = kernel.noisy_ring(1.0, 0.5);
        for (auto& link : on_the_bone.links) std::fill_n(link.rest, lanes, 0);
        for (int lane = 0; lane < lanes; ++lane) std::copy_n(at_its_point.p[lane], most_vertices, at_its_point.q[lane]);
        kernel.expect_as_plain(at_its_point);
        kernel.expect_as_plain(on_the_bone);
    }
}

// By the plain form in the same precision: some twenty roundings of sums of positive terms, and those of C itself,
// whose two parts may cancel.
TYPED_TEST(KernelContract, ErrorsAreThoseOfThePlainForm)
{
    const double eps = std::numeric_limits<TypeParam>::epsilon();
    for (auto& kernel : kernels<TypeParam>())
        for (const double size_m : kernel.sizes_m()) {
            if (!kernel.errors) continue;
            SCOPED_TRACE(testing::Message() << kernel.name << " size " << size_m);
            const auto on = kernel.noisy_ring(size_m, 0.2);
            const auto [squares, largest] = kernel.errors(on);
            double expected = 0.0, rounding = 0.0;
            for (int lane = 0; lane < lanes; ++lane) {
                double worst = 0.0;
                for (const auto& link : on.links) {
                    const auto p = [&](int i) { return on.p[lane][link.vertex[i]]; };
                    const TypeParam rest = link.rest[lane];
                    const double error =
                        link.vertex.size() == 2
                            ? value(pbs::StretchConstraint<TypeParam>{{}, rest, 1}, p(0), p(1)) / rest
                            : value(pbs::VolumeConstraint<TypeParam>{{}, rest, 1}, p(0), p(1), p(2), p(3)) / rest;
                    expected += error * error;
                    rounding += 20 * eps * (std::abs(error) + 1) * (std::abs(error) + 1);
                    worst = std::max(worst, std::abs(error));
                }
                EXPECT_NEAR(largest[lane], worst, 20 * eps * (worst + 1)) << "lane " << lane;
            }
            EXPECT_NEAR(squares, expected, rounding);
        }
}

// Whichever vertex is not finite, in the first constraint or in the last, its error is not below a
// tolerance. The errors of the other lanes do not change.
TYPED_TEST(KernelContract, AConstraintThatIsNotANumberIsNeverSatisfied)
{
    for (auto& kernel : kernels<TypeParam>()) {
        if (!kernel.errors) continue;
        const auto on = kernel.noisy_ring(1.0, 0.01);
        const auto clean = kernel.errors(on).second;
        for (const double sick : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (int v = 0; v < kernel.vertices; ++v) {
                SCOPED_TRACE(testing::Message() << kernel.name << ": " << sick << " at vertex " << v);
                auto with_sick = on;
                with_sick.p[3][v](0) = TypeParam(sick);
                auto errors = kernel.errors(with_sick).second;
                EXPECT_FALSE(errors[3] <= 1);
                errors[3] = clean[3];
                EXPECT_EQ(errors, clean);
            }
    }
}

// The two terms of an error go through some seven roundings, its square through twice as many and one, and the sum
// follows, twice.
TYPED_TEST(KernelContract, SumOfSquaredBindErrors)
{
    RandomPoints random(38);
    Sixteen<TypeParam> on;
    double squares = 0.0, squared_terms = 0.0;
    for (int v = 0; v < most_vertices; ++v) {
        on.links.push_back({{v}});
        for (int lane = 0; lane < lanes; ++lane) {
            on.q[lane][v] = random.point(1.0).template cast<TypeParam>();
            on.p[lane][v] = on.q[lane][v] + random.point(0.5).template cast<TypeParam>();
            on.links[v].rest[lane] = TypeParam(random.number(0.1, 0.5));
            const pbs::BindConstraint<TypeParam> bind{v, on.links[v].rest[lane], 1};
            squares += std::pow(double(value(bind, on.p[lane][v], on.q[lane][v])), 2);
            squared_terms += std::pow((on.p[lane][v] - on.q[lane][v]).norm() + bind.rest_distance, 2);
        }
    }
    const BindBatches<TypeParam> packed(on);
    const double rounding = rounding_error_in<TypeParam>(2 * (2 * 7 + 1 + most_vertices * lanes), squared_terms);
    EXPECT_NEAR(pbs::sum_squared_bind_errors<TypeParam>(packed.batches, most_vertices, packed.xyzw[0]), squares,
                rounding);
}

// Two projections of an edge of stiffness k = 1 / w between two free points of mass 1 / w, by hand: d lambda = (-k C -
// lambda) / 3, and the edge becomes shorter by 2 w d lambda. C: 3, 1; lambda: 0, -1. Afterwards C / alpha + lambda = 0:
// in equilibrium.
TYPED_TEST(KernelContract, TheMultiplierIsKept)
{
    Sixteen<TypeParam> on;
    on.p[5][1] = {4, 0, 0};
    on.links = {{{0, 1}}};
    on.w[5][0] = on.w[5][1] = on.links[0].rest[5] = on.links[0].k[5] = 1;
    for (int time = 0; time < 2; ++time) {
        Compliant<TypeParam, edge>::project(on, 1);
        EXPECT_EQ(on.links[0].lambda[5], TypeParam(-1)) << time;
        EXPECT_EQ(on.p[5][1].x() - on.p[5][0].x(), TypeParam(2)) << time;
    }
}

// An edge without length and a tet that is a point have no gradient. Their multipliers stay, as in plain code.
// Otherwise they would grow while the constraint cannot act, and move the vertices too far later.
TYPED_TEST(KernelContract, WithoutAGradientTheMultiplierStays)
{
    for (const std::vector<int>& vertex : {std::vector<int>{0, 1}, {0, 1, 2, 3}}) {
        Sixteen<TypeParam> on;
        for (const int v : vertex) on.p[2][v] = {1, 2, 3}, on.w[2][v] = 1;
        on.links = {{vertex}};
        on.links[0].rest[2] = on.links[0].k[2] = 1, on.links[0].lambda[2] = TypeParam(0.5);
        vertex.size() == 2 ? Compliant<TypeParam, edge>::project(on, 1) : Compliant<TypeParam, tet>::project(on, 1);
        EXPECT_EQ(on.links[0].lambda[2], TypeParam(0.5));
    }
}

}  // namespace
}  // namespace kernels_tests
