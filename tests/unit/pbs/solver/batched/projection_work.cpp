// The operations of a projection are counted by a type of number that counts them, passed through pbs/constraints. Their operations beyond
// the count (they recompute what no frame changes) are listed one by one.
#include "pbs/solver/batched/projection_work.hpp"

#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "pbs/constraints/volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace {

int operations = 0;

struct Counted {
    double value = 0.0;

    constexpr Counted() = default;
    constexpr Counted(double v) : value(v) {}

    Counted operator-() const { return -value; }
    friend Counted operator+(Counted a, Counted b) { return ++operations, a.value + b.value; }
    friend Counted operator-(Counted a, Counted b) { return ++operations, a.value - b.value; }
    friend Counted operator*(Counted a, Counted b) { return ++operations, a.value * b.value; }
    friend constexpr Counted operator/(Counted a, Counted b)
    {
        if (!std::is_constant_evaluated()) ++operations;  // sixth<Scalar> is a constant
        return a.value / b.value;
    }
    Counted& operator+=(Counted b) { return *this = *this + b; }
    Counted& operator-=(Counted b) { return *this = *this - b; }
    Counted& operator*=(Counted b) { return *this = *this * b; }
    Counted& operator/=(Counted b) { return *this = *this / b; }
    auto operator<=>(const Counted&) const = default;
};
Counted sqrt(Counted a)
{
    return ++operations, std::sqrt(a.value);
}

}  // namespace

template <>
struct Eigen::NumTraits<Counted> : Eigen::NumTraits<double> {
    using Real = Counted;
    using NonInteger = Counted;
    using Nested = Counted;
};

namespace {

using pbs::BodySize;
using pbs::ConstraintClass;
using pbs::ProjectionLayout;
using Point = pbs::Vector3<Counted>;

template <typename Project>
int count(const Project& project)
{
    operations = 0;
    project();
    return operations;
}

TEST(ProjectionWork, StretchIsCountedOperationByOperation)
{
    Point p1(0.0, 0.0, 0.0), p2(1.0, 2.0, 3.0);
    const pbs::StretchConstraint<Counted> edge{{0, 1}, Counted(1.0), Counted(0.2)};
    const int done = count([&] { project(edge, Counted(1.0), Counted(1.0), p1, p2); });
    // w1 + w2; its product with the length; and k_s times the gradient before the masses: three products instead of one for each end.
    const int recomputed = 1 + 1 + 3 - 2;
    EXPECT_EQ(done, pbs::flops_of(ConstraintClass::stretch) + recomputed);
}

TEST(ProjectionWork, VolumeIsCountedOperationByOperation)
{
    Point p1(0.0, 0.0, 0.0), p2(1.0, 0.0, 0.0), p3(0.0, 1.0, 0.0), p4(0.1, 0.2, 1.5);
    const pbs::VolumeConstraint<Counted> tet{{0, 1, 2, 3}, Counted(0.1), Counted(1.0)};
    const Counted w(1.0);
    const int done = count([&] { project(tet, w, w, w, w, p1, p2, p3, p4); });
    // Sixths of C and of three gradients; the constants of the rounding; the negation of g1 does not count.
    const int recomputed = 1 + 3 * 3 + 2;
    EXPECT_EQ(done, pbs::flops_of(ConstraintClass::volume) + recomputed);
}

TEST(ProjectionWork, BindIsCountedOperationByOperation)
{
    Point p(1.0, 2.0, 3.0);
    const pbs::BindConstraint<Counted> bind{0, Counted(1.0), Counted(1.0)};
    const int done = count([&] { project(bind, Counted(1.0), Point(0.0, 0.0, 0.0), p); });
    const int recomputed = 1;  // w times the distance, which tests whether the vertex is pinned
    EXPECT_EQ(done, pbs::flops_of(ConstraintClass::bind) + recomputed);
}

// By hand, in f32: an edge has 2 indices, a length and a stiffness; each of 10 vertices goes in and out once for 50 edges.
TEST(ProjectionWork, BytesOfOnePose)
{
    const BodySize size{10, 50, 30};
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::stretch, {4, 1}, size), 16 + 2 * 16 * 10 / 50.0);
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::volume, {4, 1}, size), 24 + 2 * 16 * 10 / 30.0);
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::bind, {8, 1}, size), 40 + 2 * 32);
    EXPECT_DOUBLE_EQ(pbs::working_set_bytes({4, 1}, size), 50 * 16 + 30 * 24 + 10 * (20 + 16));
    EXPECT_DOUBLE_EQ(pbs::bytes_per_iteration({4, 1}, size), 50 * 16 + 30 * 24 + 10 * 20 + 3 * 2 * 16 * 10);
}

// Sixteen poses share the data of a constraint; each has its own positions (x, y, z) and bind points.
TEST(ProjectionWork, BytesOfManyPoses)
{
    const BodySize size{10, 50, 30};
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::stretch, {4, 16}, size), 28 / 16.0 + 2 * 12 * 10 / 50.0);
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::volume, {4, 16}, size), 40 / 16.0 + 2 * 12 * 10 / 30.0);
    EXPECT_DOUBLE_EQ(pbs::bytes_of(ConstraintClass::bind, {8, 16}, size), 16 / 16.0 + 24 + 2 * 24);
    EXPECT_DOUBLE_EQ(pbs::bytes_per_iteration({4, 16}, size), 50 * 28 + 30 * 40 + 10 * 8 + 16 * 10 * (12 + 3 * 2 * 12));
    EXPECT_DOUBLE_EQ(pbs::working_set_bytes({4, 16}, size), 50 * 28 + 30 * 40 + 10 * 8 + 16 * 10 * (12 + 12));
}

}  // namespace
