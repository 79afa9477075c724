// Every constraint keeps these promises, whatever it measures. References: Eq. 3-4, 8 and 9 by hand, differences of the
// values for the gradients, and that a projection depends only on lengths and volumes: it commutes with rigid motions,
// renumbering, mirrors and changes of unit. Tolerances: the rounding of a projection, and of a moved input, which a
// projection amplifies (projection_rounding.hpp).
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
#include <numeric>

namespace constraint_contract_tests {
namespace {

using pbs::Vec3;
using test_support::RandomPoints;
using test_support::rounding_error;
using test_support::RoundingBound;
using test_support::stacked;
using Points = std::vector<Vec3>;
using Masses = std::vector<double>;  // inverse
template <typename Scalar>
using PointsOf = std::vector<pbs::Vector3<Scalar>>;

// Each has: sample, well-shaped points; rest, the constraint's own value at rest, in metres to the power `dimension`;
// order_in_mirror, of points that turn the orientation back; even_orders, in which the constraint is the same;
// rounding, that of one point in a projection; rounding_of_value, that of C.
template <typename S>
struct Stretch {
    using Scalar = S;
    using InDouble = Stretch<double>;
    static constexpr int dimension = 1;
    static inline const std::vector<int> order_in_mirror = {0, 1};
    static inline const std::vector<std::vector<int>> even_orders = {{1, 0}};
    pbs::StretchConstraint<S> constraint{{0, 1}, 1, 1};

    Points sample(RandomPoints& random) const
    {
        const Vec3 first = random.point(1.0);
        return {first, first + Vec3(2, 0, 0) + random.point(1.0)};
    }
    S& rest() { return constraint.rest_length; }
    void move(const Eigen::Affine3d&) {}
    S value(const PointsOf<S>& p) const { return pbs::value(constraint, p[0], p[1]); }
    Points gradient(const Points& p) const
    {
        const auto [g1, g2] = pbs::gradient(constraint, p[0], p[1]);
        return {g1, g2};
    }
    void project(const std::vector<S>& w, PointsOf<S>& p) const { pbs::project(constraint, w[0], w[1], p[0], p[1]); }
    RoundingBound rounding(const std::vector<S>& w, const PointsOf<S>& p) const
    {
        return test_support::rounding_of(constraint, w[0], w[1], p[0], p[1]);
    }
    double rounding_of_value() const { return rounding_error(10, 4.0); }
};

template <typename S>
struct Volume {
    using Scalar = S;
    using InDouble = Volume<double>;
    static constexpr int dimension = 3;
    static inline const std::vector<int> order_in_mirror = {0, 2, 1, 3};
    static inline const std::vector<std::vector<int>> even_orders = {{1, 2, 0, 3}, {1, 0, 3, 2}, {3, 1, 0, 2}};
    pbs::VolumeConstraint<S> constraint{{0, 1, 2, 3}, S(1.0 / 6.0), 1};

    Points sample(RandomPoints& random) const
    {
        const auto corners = test_support::noisy_corner(random, 0.3);
        return {corners.begin(), corners.end()};
    }
    S& rest() { return constraint.rest_volume; }
    void move(const Eigen::Affine3d&) {}
    S value(const PointsOf<S>& p) const { return pbs::value(constraint, p[0], p[1], p[2], p[3]); }
    Points gradient(const Points& p) const
    {
        const auto g = pbs::gradient(constraint, p[0], p[1], p[2], p[3]);
        return {g.begin(), g.end()};
    }
    void project(const std::vector<S>& w, PointsOf<S>& p) const
    {
        pbs::project(constraint, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]);
    }
    RoundingBound rounding(const std::vector<S>& w, const PointsOf<S>& p) const
    {
        return test_support::rounding_of(constraint, {w[0], w[1], w[2], w[3]}, {p[0], p[1], p[2], p[3]});
    }
    double rounding_of_value() const { return rounding_error(10, 2.0); }
};

// A box of 48 tets. A volume is a sum over the triangles, each with some twenty roundings of products of two edges and
// a distance, of at most 6 m^3 here.
struct Region {
    using Scalar = double;
    pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 2, 2});
    pbs::RegionVolumeConstraint<double> constraint =
        pbs::make_region_volume_constraint<double>(pbs::boundary_of(bar.tets), bar.rest, 1.0);

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
    RoundingBound rounding(const Masses& w, const Points&) const
    {
        return {rounding_error(double(w.size()) * 10.0, 2.5)};
    }
    double rounding_of_value() const { return rounding_error(20.0 * double(constraint.triangle.size()), 6.0); }
};

// To a point q of a bone of infinite mass, which takes the momentum.
template <typename S>
struct Bind {
    using Scalar = S;
    using InDouble = Bind<double>;
    static constexpr int dimension = 1;
    static inline const std::vector<int> order_in_mirror = {0};
    static inline const std::vector<std::vector<int>> even_orders = {};
    pbs::BindConstraint<S> constraint{0, 2, 1};
    pbs::Vector3<S> q = pbs::Vector3<S>(1, 1, 1);

    Points sample(RandomPoints& random) const { return {Vec3(3, 1, 1) + random.point(1.0)}; }
    S& rest() { return constraint.rest_distance; }
    void move(const Eigen::Affine3d& map) { q = (map * q.template cast<double>()).template cast<S>(); }
    S value(const PointsOf<S>& p) const { return pbs::value(constraint, p[0], q); }
    Points gradient(const Points& p) const { return {pbs::gradient(constraint, p[0], q)}; }
    void project(const std::vector<S>& w, PointsOf<S>& p) const { pbs::project(constraint, w[0], q, p[0]); }
    RoundingBound rounding(const std::vector<S>&, const PointsOf<S>& p) const
    {
        return test_support::rounding_of(constraint, q, p[0]);
    }
    double rounding_of_value() const { return rounding_error(10, 4.0); }
};

// A constraint to a position, as BindTo::blended_position has it, is one of distance zero.
struct BindToPosition : Bind<double> {
    BindToPosition() { constraint.rest_distance = 0.0; }
};

Points unstacked(const Eigen::VectorXd& x)
{
    Points p;
    for (Eigen::Index i = 0; i < x.size(); i += 3) p.emplace_back(x.segment<3>(i));
    return p;
}

template <typename Constraint, typename Scalar>
PointsOf<Scalar> projected_by(const Constraint& constraint, const std::vector<Scalar>& w, PointsOf<Scalar> p)
{
    constraint.project(w, p);
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
    Points projected(const Masses& w, const Points& p) const { return projected_by(constraint, w, p); }
    // Gives the constraint the rest value of these points.
    void rest_at(const Points& p)
    {
        constraint.rest() = 0.0;
        constraint.rest() = constraint.value(p);
    }

    Constraint constraint;
    RandomPoints random{3};
};
using Constraints = testing::Types<Stretch<double>, Volume<double>, Region, Bind<double>, BindToPosition>;
TYPED_TEST_SUITE(Contract, Constraints);

TYPED_TEST(Contract, GradientByEpsSweep)
{
    for (int trial = 0; trial < 20; ++trial) {
        const Points p = this->sample();
        Points direction(p.size());
        for (Vec3& d : direction) d = this->random.point(1.0);
        test_support::expect_slope_by_eps_sweep(
            [&](const Eigen::VectorXd& x) { return this->constraint.value(unstacked(x)); }, stacked(p),
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
            // Eq. 8
            EXPECT_LT((moved[i] - (p[i] - 0.3 * s * w[i] * g[i])).norm(), 2.0 * this->constraint.rounding(w, p).step)
                << i;
    }
}

// Next to a state at rest, what is left beyond the share 1 - k is of second order in the error. Its factor is below
// ten: no more than |H| / |g|^2, of volumes of edges up to 2 m over gradients of a sixth of an area.
TYPED_TEST(Contract, StiffnessIsTheShareOfTheErrorRemoved)
{
    if (std::is_same_v<TypeParam, BindToPosition>) return;  // no direction at rest
    Points p = this->sample();
    this->rest_at(p);
    for (Vec3& point : p) point += this->random.point(1e-5);
    const double before = this->constraint.value(p),
                 rounding = 2.0 * this->constraint.rounding_of_value() / std::abs(before);
    for (const double k : {0.0, 0.25, 0.5, 1.0}) {
        this->constraint.constraint.stiffness = k;
        EXPECT_NEAR(this->constraint.value(this->projected(this->masses(), p)) / before, 1.0 - k,
                    10.0 * 1e-5 + rounding)
            << k;
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

template <typename Constraint>
class ContractInBothPrecisions : public Contract<Constraint> {
protected:
    using Scalar = typename Constraint::Scalar;

    std::vector<Scalar> rounded(const Masses& w) { return {w.begin(), w.end()}; }
    PointsOf<Scalar> rounded(const Points& p)
    {
        PointsOf<Scalar> result;
        for (const Vec3& point : p) result.push_back(point.template cast<Scalar>());
        return result;
    }

    // Compares a projection in double with the same one after a map of all points, which multiplies lengths by `size`,
    // rounds the moved points by `rounding` times their largest coordinate, and takes them in another order and the
    // masses in another unit.
    void expect_commutes(const Eigen::Affine3d& map, double size, double rounding, const std::vector<int>& order,
                         double unit_of_mass = 1.0)
    {
        typename Constraint::InDouble in_double;
        in_double.constraint.stiffness = 0.8;
        const Points p = this->sample(), expected = projected_by(in_double, w_, p);
        Points there;
        Masses w_there;
        double largest = 0.0, difference = 0.0, moved = 0.0;
        for (const int i : order) {
            there.push_back(map * p[i]);
            w_there.push_back(unit_of_mass * w_[i]);
            largest = std::max(largest, there.back().cwiseAbs().maxCoeff());
        }
        Constraint mapped;
        mapped.constraint.stiffness = Scalar(0.8);
        mapped.rest() = Scalar(in_double.rest() * std::pow(size, Constraint::dimension));
        mapped.move(map);
        const PointsOf<Scalar> before = rounded(there), after = projected_by(mapped, rounded(w_there), before);
        for (std::size_t i = 0; i < order.size(); ++i) {
            difference = std::hypot(difference, (after[i].template cast<double>() - map * expected[order[i]]).norm());
            moved = std::max(moved, (after[i] - before[i]).template cast<double>().norm());
        }
        const RoundingBound bound = mapped.rounding(rounded(w_there), before);
        const double of_map = rounding * largest;
        EXPECT_LT(difference, std::sqrt(double(order.size())) * (2.0 * bound.step + (bound.growth + 1.0) * of_map))
            << size;
        EXPECT_GT(moved, 1e-5 * size) << "nothing is shown by points that stay";
    }

    std::vector<int> file_order() const
    {
        std::vector<int> order(w_.size());
        std::iota(order.begin(), order.end(), 0);
        return order;
    }

    // > sqrt 3
    static constexpr double to_scalar =
        sizeof(Scalar) == 4 ? 1.8 * test_support::rounding_error_in<float>(1, 1.0) : 0.0;
    const Masses w_ = this->masses();
};
using InBothPrecisions =
    testing::Types<Stretch<float>, Volume<float>, Bind<float>, Stretch<double>, Volume<double>, Bind<double>>;
TYPED_TEST_SUITE(ContractInBothPrecisions, InBothPrecisions);

// The motion rounds the input, and the output of the other side, in double; moved points are rounded to Scalar.
TYPED_TEST(ContractInBothPrecisions, CommutesWithRigidMotions)
{
    const double rounding = test_support::motion_error(1, 2.0) + this->to_scalar;
    for (int trial = 0; trial < 50; ++trial)
        this->expect_commutes(Eigen::Affine3d(this->random.rigid_motion(1.0)), 1.0, rounding, this->file_order());
}

TYPED_TEST(ContractInBothPrecisions, CommutesWithRenumbering)
{
    for (int trial = 0; trial < 50; ++trial)
        for (const std::vector<int>& order : TypeParam::even_orders)
            this->expect_commutes(Eigen::Affine3d::Identity(), 1.0, this->to_scalar, order);
}

TYPED_TEST(ContractInBothPrecisions, AMirrorTurnsTheOrientationRound)
{
    for (int trial = 0; trial < 50; ++trial)
        this->expect_commutes(Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0)), 1.0, this->to_scalar,
                              TypeParam::order_in_mirror);
}

// This detects an absolute threshold: one of 1e-6 would silently skip tets with edges of 0.01. A coordinate is
// multiplied by the size and rounded to Scalar.
TYPED_TEST(ContractInBothPrecisions, CommutesWithScalesFromAMicrometreToAThousandKilometres)
{
    const double rounding = std::sqrt(3.0) * test_support::rounding_error_in<typename TypeParam::Scalar>(2, 1.0);
    for (const double size : {1e-6, 1e-3, 1e-2, 1.0, 1e3, 1e6})
        this->expect_commutes(Eigen::Affine3d(Eigen::Scaling(size)), size, rounding, this->file_order());
}

TYPED_TEST(ContractInBothPrecisions, TheUnitOfMassDoesNotMatter)
{
    const double rounding = std::sqrt(3.0) * test_support::rounding_error_in<typename TypeParam::Scalar>(1, 1.0);
    for (const double unit : {1e-6, 1.0, 1e6})
        this->expect_commutes(Eigen::Affine3d::Identity(), 1.0, rounding, this->file_order(), unit);
}

template <typename Constraint>
class Momentum : public ContractInBothPrecisions<Constraint> {
};
using InvariantConstraints = testing::Types<Stretch<float>, Volume<float>, Stretch<double>, Volume<double>, Region>;
TYPED_TEST_SUITE(Momentum, InvariantConstraints);

// Eq. 3-4. A projection moves points along gradients, which are perpendicular to rigid motions, so that corrections w g
// with masses 1 / w conserve linear and angular momentum, the latter about any centre. Equal and unequal masses.
TYPED_TEST(Momentum, IsConserved)
{
    const Vec3 centre(0.3, -0.7, 0.2);
    for (int trial = 0; trial < 50; ++trial) {
        const auto before = this->rounded(this->sample());
        const auto w = this->rounded(trial % 2 == 0 ? Masses(before.size(), 1.0) : this->masses());
        const auto after = projected_by(this->constraint, w, before);
        const double step = this->constraint.rounding(w, before).step;
        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        double largest = 0.0, of_linear = 0.0, of_angular = 0.0;
        for (std::size_t i = 0; i < w.size(); ++i) {
            const Vec3 p = before[i].template cast<double>(), dp = after[i].template cast<double>() - p;
            linear += dp / w[i];
            angular += (p - centre).cross(dp / w[i]);
            largest = std::max(largest, dp.norm());
            of_linear += step / w[i];
            of_angular += (p - centre).norm() * step / w[i];
        }
        EXPECT_LT(linear.norm(), of_linear);
        EXPECT_LT(angular.norm(), of_angular);
        EXPECT_GT(largest, 1e-5) << "nothing moved, so nothing is shown";
    }
}

// Without the weights (Eq. 8-9 as printed), unequal masses lose momentum: the departure from the print is necessary.
TEST(MomentumUnweighted, IsLostWithUnequalMasses)
{
    Vec3 p1(0, 0, 0), p2(2, 0, 0);
    const double m1 = 1.0, m2 = 3.0;
    project(pbs::StretchConstraint<double>{{0, 1}, 1.0, 1.0}, 1.0, 1.0, p1, p2);
    EXPECT_GT(std::abs(m1 * p1.x() + m2 * (p2.x() - 2.0)), 0.5);
}

}  // namespace
}  // namespace constraint_contract_tests
