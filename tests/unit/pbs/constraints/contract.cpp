// What every constraint promises, whatever it measures. References: Eq. 8 and 9 by hand, and differences of the values for the gradients.
// Tolerances: the rounding of a projection (projection_rounding.hpp).
#include "pbs/constraints/region_volume.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using pbs::Vec3;
using test_support::RandomPoints;
using test_support::rounding_error;
using Points = std::vector<Vec3>;
using Masses = std::vector<double>;  // inverse

// Each has: sample, well-shaped points; rest, the constraint's own value at rest; rounding_m, that of one point in a projection;
// rounding_of_value, that of C.
struct Stretch {
    static constexpr bool keeps_momentum = true;
    pbs::StretchConstraint<double> constraint{{0, 1}, 1.0, 1.0};

    Points sample(RandomPoints& random) const
    {
        const Vec3 first = random.point(1.0);
        return {first, first + Vec3(2, 0, 0) + random.point(1.0)};
    }
    double& rest() { return constraint.rest_length; }
    double value(const Points& p) const { return pbs::value(constraint, p[0], p[1]); }
    Points gradient(const Points& p) const
    {
        const auto [g1, g2] = pbs::gradient(constraint, p[0], p[1]);
        return {g1, g2};
    }
    void project(const Masses& w, Points& p) const { pbs::project(constraint, w[0], w[1], p[0], p[1]); }
    double rounding_m(const Masses& w, const Points& p) const { return test_support::rounding_of(constraint, w[0], w[1], p[0], p[1]).step; }
    double rounding_of_value() const { return rounding_error(10, 4.0); }
};

struct Volume {
    static constexpr bool keeps_momentum = true;
    pbs::VolumeConstraint<double> constraint{{0, 1, 2, 3}, 1.0 / 6.0, 1.0};

    Points sample(RandomPoints& random) const
    {
        const auto corners = test_support::noisy_corner(random, 0.3);
        return {corners.begin(), corners.end()};
    }
    double& rest() { return constraint.rest_volume; }
    double value(const Points& p) const { return pbs::value(constraint, p[0], p[1], p[2], p[3]); }
    Points gradient(const Points& p) const
    {
        const auto g = pbs::gradient(constraint, p[0], p[1], p[2], p[3]);
        return {g.begin(), g.end()};
    }
    void project(const Masses& w, Points& p) const { pbs::project(constraint, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]); }
    double rounding_m(const Masses& w, const Points& p) const
    {
        return test_support::rounding_of(constraint, {w[0], w[1], w[2], w[3]}, {p[0], p[1], p[2], p[3]}).step;
    }
    double rounding_of_value() const { return rounding_error(10, 2.0); }
};

// A box of 48 tets. A volume is a sum over the triangles, each with some twenty roundings of products of two edges and a distance, of at
// most 6 m^3 here.
struct Region {
    static constexpr bool keeps_momentum = true;
    pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
    pbs::RegionVolumeConstraint<double> constraint = pbs::make_region_volume_constraint<double>(pbs::boundary_of(bar.tets), bar.rest, 1.0);

    Points sample(RandomPoints& random) const
    {
        Points p;
        for (const int v : constraint.vertex) p.push_back(Vec3(bar.rest.row(v)) + random.point(0.2));
        return p;
    }
    double& rest() { return constraint.rest_volume; }
    double value(const Points& p) const { return pbs::value(constraint, p); }
    Points gradient(const Points& p) const { return pbs::gradient(constraint, p); }
    void project(const Masses& w, Points& p) const
    {
        Points g;
        pbs::project(constraint, w, p, g);
    }
    double rounding_m(const Masses& w, const Points&) const { return rounding_error(double(w.size()) * 10.0, 2.5); }
    double rounding_of_value() const { return rounding_error(20.0 * double(constraint.triangle.size()), 6.0); }
};

// To a point q of a bone of infinite mass, which takes the momentum.
struct Bind {
    static constexpr bool keeps_momentum = false;
    pbs::BindConstraint<double> constraint{0, 2.0, 1.0};
    Vec3 q = Vec3(1, 1, 1);

    Points sample(RandomPoints& random) const { return {q + Vec3(2, 0, 0) + random.point(1.0)}; }
    double& rest() { return constraint.rest_distance; }
    double value(const Points& p) const { return pbs::value(constraint, p[0], q); }
    Points gradient(const Points& p) const { return {pbs::gradient(constraint, p[0], q)}; }
    void project(const Masses& w, Points& p) const { pbs::project(constraint, w[0], q, p[0]); }
    double rounding_m(const Masses&, const Points& p) const { return test_support::rounding_of(constraint, q, p[0]).step; }
    double rounding_of_value() const { return rounding_error(10, 4.0); }
};

// A constraint to a position, as BindTo::blended_position has it, is one of distance zero.
struct BindToPosition : Bind {
    BindToPosition() { constraint.rest_distance = 0.0; }
};

Eigen::VectorXd stacked(const Points& p)
{
    return Eigen::VectorXd::Map(p.front().data(), 3 * Eigen::Index(p.size()));
}

Points unstacked(const Eigen::VectorXd& x)
{
    Points p;
    for (Eigen::Index i = 0; i < x.size(); i += 3) p.emplace_back(x.segment<3>(i));
    return p;
}

template <typename Constraint>
class Contract : public testing::Test {
protected:
    Points sample() { return constraint.sample(random); }
    Masses masses()
    {
        Masses w;
        for (std::size_t i = 0; i < sample().size(); ++i) w.push_back(random.number(0.25, 4.0));
        return w;
    }
    Points projected(const Masses& w, Points p) const
    {
        constraint.project(w, p);
        return p;
    }
    // Gives the constraint the rest value of these points.
    void rest_at(const Points& p)
    {
        constraint.rest() = 0.0;
        constraint.rest() = constraint.value(p);
    }

    Constraint constraint;
    RandomPoints random{3};
};
using Constraints = testing::Types<Stretch, Volume, Region, Bind, BindToPosition>;
TYPED_TEST_SUITE(Contract, Constraints);

TYPED_TEST(Contract, GradientByEpsSweep)
{
    for (int trial = 0; trial < 20; ++trial) {
        const Points p = this->sample();
        Points direction(p.size());
        for (Vec3& d : direction) d = this->random.point(1.0);
        test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& x) { return this->constraint.value(unstacked(x)); }, stacked(p),
                                                stacked(direction), stacked(this->constraint.gradient(p)).dot(stacked(direction)), 1.0);
    }
}

TYPED_TEST(Contract, ProjectionIsAStepAlongTheGradient)
{
    this->constraint.constraint.stiffness = 0.3;
    for (int trial = 0; trial < 20; ++trial) {
        const Masses w = this->masses();
        const Points p = this->sample(), g = this->constraint.gradient(p), moved = this->projected(w, p);
        double denominator = 0.0;
        for (std::size_t i = 0; i < p.size(); ++i) denominator += w[i] * g[i].squaredNorm();
        const double s = this->constraint.value(p) / denominator;  // Eq. 9
        for (std::size_t i = 0; i < p.size(); ++i)
            EXPECT_LT((moved[i] - (p[i] - 0.3 * s * w[i] * g[i])).norm(), 2.0 * this->constraint.rounding_m(w, p)) << i;  // Eq. 8
    }
}

// Next to a state at rest, what is left beyond the share 1 - k is of second order in the error. Its factor is below ten: no more than
// |H| / |g|^2, of volumes of edges up to 2 m over gradients of a sixth of an area.
TYPED_TEST(Contract, StiffnessIsTheShareOfTheErrorRemoved)
{
    if (std::is_same_v<TypeParam, BindToPosition>) return;  // no direction at rest
    Points p = this->sample();
    this->rest_at(p);
    for (Vec3& point : p) point += this->random.point(1e-5);
    const double before = this->constraint.value(p), rounding = 2.0 * this->constraint.rounding_of_value() / std::abs(before);
    for (const double k : {0.0, 0.25, 0.5, 1.0}) {
        this->constraint.constraint.stiffness = k;
        EXPECT_NEAR(this->constraint.value(this->projected(this->masses(), p)) / before, 1.0 - k, 10.0 * 1e-5 + rounding) << k;
    }
}

TYPED_TEST(Contract, PinnedPointsStay)
{
    const Points p = this->sample();
    Masses w = this->masses();
    for (std::size_t pinned = 0; pinned < w.size(); ++pinned) {
        Masses one_pinned = w;
        one_pinned[pinned] = 0.0;
        const Points moved = this->projected(one_pinned, p);
        for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(moved[i] == p[i], i == pinned) << i;
    }
    EXPECT_EQ(this->projected(Masses(p.size(), 0.0), p), p);
}

// A length has no direction there, and a volume no gradient. A region or a tet on a line has none either.
TYPED_TEST(Contract, CollapsedPointsStay)
{
    const std::size_t count = this->sample().size();
    const Points point(count, Vec3(1, 1, 1));
    EXPECT_EQ(this->projected(this->masses(), point), point);
    for (const Vec3& g : this->constraint.gradient(point)) EXPECT_EQ(g, Vec3::Zero());
    if (count < 4) return;
    Points line;
    for (std::size_t i = 0; i < count; ++i) line.push_back(double(i) * Vec3(1, 1, 1));
    EXPECT_EQ(this->projected(this->masses(), line), line);
}

TYPED_TEST(Contract, AtRestNothingMoves)
{
    const Points p = this->sample();
    this->rest_at(p);
    EXPECT_EQ(this->projected(this->masses(), p), p);
}

// Gradients of an invariant under shifts and turns add up to zero, and so do their moments; corrections w g with masses 1 / w then conserve
// both momenta. In float as well: properties/pbs/constraints/momentum.cpp.
TYPED_TEST(Contract, MomentumIsConserved)
{
    if (!TypeParam::keeps_momentum) return;
    double most_moved = 0.0;
    for (int trial = 0; trial < 20; ++trial) {
        const Points before = this->sample();
        const Masses w = this->masses();
        const Points after = this->projected(w, before);
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        double moved = 0.0, rounding = 0.0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            const Vec3 momentum = (after[i] - before[i]) / w[i];
            linear += momentum;
            angular += before[i].cross(momentum);
            moved += momentum.norm();
            rounding += 2.0 * this->constraint.rounding_m(w, before) / w[i];
        }
        most_moved = std::max(most_moved, moved);
        EXPECT_LT(linear.norm(), rounding);
        EXPECT_LT(angular.norm(), 4.0 * rounding);  // points are nearer than 4 m
    }
    EXPECT_GT(most_moved, 1e-2);
}

}  // namespace
