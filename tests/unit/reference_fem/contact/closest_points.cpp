// Reference: distances known by hand in every region of both kinds of pairs, calculus (eps sweeps of distance and
// gradient), and invariance under rigid motion, mirroring, exchange and scale.
#include "reference_fem/contact/closest_points.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/Geometry>

#include <random>

namespace {

using namespace reference_fem;
using pbs::Vec3;

struct Region {
    const char* name;
    PairKind kind;
    FourPoints points;
    double distance_m;
    int parameters;
};

FourPoints columns(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    FourPoints points;
    points << a, b, c, d;
    return points;
}

// The triangle 0, e_x, e_y, and the edge from -e_x to e_x.
const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
FourPoints over_triangle(const Vec3& point)
{
    return columns(point, o, x, y);
}
FourPoints over_edge(const Vec3& one, const Vec3& other)
{
    return columns(one, other, -x, x);
}

const std::vector<Region> regions = {
    {"face", PairKind::point_triangle, over_triangle({0.2, 0.3, 0.5}), 0.5, 2},
    {"face from below", PairKind::point_triangle, over_triangle({0.2, 0.3, -0.5}), 0.5, 2},
    {"edge ab", PairKind::point_triangle, over_triangle({0.4, -0.3, 0.4}), 0.5, 1},
    {"edge bc", PairKind::point_triangle, over_triangle({1.0, 0.8, 0.1}), std::sqrt(0.33), 1},
    {"edge ca", PairKind::point_triangle, over_triangle({-0.3, 0.4, 0.4}), 0.5, 1},
    {"corner a", PairKind::point_triangle, over_triangle({-0.2, -0.1, 0.2}), 0.3, 0},
    {"corner b", PairKind::point_triangle, over_triangle({1.2, -0.1, 0.2}), 0.3, 0},
    {"corner c", PairKind::point_triangle, over_triangle({-0.1, 1.2, 0.2}), 0.3, 0},
    {"inside of both edges", PairKind::edge_edge, over_edge({0.2, -1, 0.3}, {0.2, 1, 0.3}), 0.3, 2},
    {"end of the first edge", PairKind::edge_edge, over_edge({0.2, 0.4, 0.3}, {0.2, 1, 0.3}), 0.5, 1},
    {"end of the second edge", PairKind::edge_edge, over_edge({1.4, -1, 0.3}, {1.4, 1, 0.3}), 0.5, 1},
    {"two ends", PairKind::edge_edge, over_edge({1.2, 0.1, 0.2}, {2, 1, 1}), 0.3, 0},
};

class ClosestPointsIn : public testing::TestWithParam<Region> {};

TEST_P(ClosestPointsIn, HaveTheDistanceKnownByHand)
{
    const ClosestPoints closest = closest_points(GetParam().kind, GetParam().points);
    EXPECT_NEAR(closest.distance_m, GetParam().distance_m, test_support::rounding_error(20, 2.0));
    EXPECT_EQ(closest.parameters, GetParam().parameters);
    EXPECT_NEAR(closest.weights.sum(), 0.0, test_support::rounding_error(4, 2.0));
    EXPECT_EQ(closest.offset, GetParam().points * closest.weights);
}

// The second region on the other side of the boundary would spoil the order, so that the sweep stays within a fiftieth
// of the size.
TEST_P(ClosestPointsIn, HaveTheSlopesAndCurvaturesOfTheirDistance)
{
    const auto& [name, kind, points, distance_m, parameters] = GetParam();
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    const auto random = [&] {
        return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(12, [&] { return entry(generator); }));
    };
    const Eigen::VectorXd at = points.reshaped(), along = random(), across = random();
    const auto shaped = [](const Eigen::VectorXd& v) -> FourPoints { return v.reshaped(3, 4); };
    const auto gradient = [&, kind = kind](const Eigen::VectorXd& v) {
        return distance_gradient(closest_points(kind, shaped(v)));
    };
    constexpr double size = 0.02;
    test_support::expect_slope_by_eps_sweep(
        [&, kind = kind](const Eigen::VectorXd& v) { return closest_points(kind, shaped(v)).distance_m; }, at, along,
        gradient(at).dot(along), size);
    const FourPointHessian hessian = distance_hessian(closest_points(kind, points), points);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& v) { return gradient(v).dot(across); }, at,
                                            along, across.dot(hessian * along), size);
    EXPECT_LE((hessian - hessian.transpose()).norm(), test_support::rounding_error(30, hessian.norm()));
}

TEST_P(ClosestPointsIn, MoveWithARigidMotionAMirrorAndAScale)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const double distance_m = closest_points(GetParam().kind, GetParam().points).distance_m;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const Eigen::Matrix3d& map : {turn, Eigen::Matrix3d(-turn)}) {
            const FourPoints moved = (scale * map * GetParam().points).colwise() + Vec3(scale * Vec3(1, -2, 3));
            EXPECT_NEAR(closest_points(GetParam().kind, moved).distance_m, scale * distance_m,
                        test_support::rounding_error(60, scale * 6.0));
        }
}

TEST_P(ClosestPointsIn, DoNotDependOnTheOrderOfCornersAndEnds)
{
    FourPoints exchanged = GetParam().points;
    exchanged.col(2).swap(exchanged.col(3));
    EXPECT_NEAR(closest_points(GetParam().kind, exchanged).distance_m, GetParam().distance_m,
                test_support::rounding_error(20, 2.0));
}

INSTANTIATE_TEST_SUITE_P(EveryRegion, ClosestPointsIn, testing::ValuesIn(regions), [](const auto& region) {
    std::string name = region.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

TEST(ClosestPoints, OfATriangleWithoutAreaAreThoseOfItsEdges)
{
    EXPECT_NEAR(closest_points(PairKind::point_triangle, columns({1.5, 0.3, 0.4}, o, x, 2.0 * x)).distance_m, 0.5,
                test_support::rounding_error(20, 2.0));
    EXPECT_NEAR(closest_points(PairKind::point_triangle, columns(z, o, o, o)).distance_m, 1.0, 0.0);
}

TEST(ClosestPoints, OfParallelAndOfShortEdgesAreAtTheirEnds)
{
    EXPECT_NEAR(closest_points(PairKind::edge_edge, over_edge({-0.5, 0.3, 0.4}, {0.5, 0.3, 0.4})).distance_m, 0.5,
                test_support::rounding_error(20, 2.0));
    EXPECT_NEAR(closest_points(PairKind::edge_edge, over_edge({2, 0.3, 0.4}, {4, 0.3, 0.4})).distance_m,
                std::sqrt(1.25), test_support::rounding_error(20, 2.0));
    EXPECT_NEAR(closest_points(PairKind::edge_edge, over_edge(z, z)).distance_m, 1.0, 0.0);
}

TEST(EdgeCross, HasTheSlopesAndCurvaturesOfTheSquaredCrossProduct)
{
    const FourPoints points = columns({0.1, 0.2, 0.3}, {1, 0.4, -0.2}, {-0.3, 0.5, 0.7}, {0.2, -0.6, 0.9});
    const Eigen::VectorXd at = points.reshaped(), along = Eigen::VectorXd::LinSpaced(12, -1.0, 0.9).array().sin() * 2.0,
                          across = at.reverse();
    const auto cross = [](const Eigen::VectorXd& v) { return edge_cross(FourPoints(v.reshaped(3, 4))); };
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& v) { return cross(v).squared_m4; }, at, along,
                                            cross(at).gradient.dot(along), 1.0);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& v) { return cross(v).gradient.dot(across); }, at,
                                            along, across.dot(cross(at).hessian * along), 1.0);
}

TEST(SafeShare, LeavesATenthOfTheDistanceOfAPairThatMeetsHeadOn)
{
    FourPoints step = FourPoints::Zero();
    step.col(0) = Vec3(0, 0, -2.0);  // from a height of 0.5: it meets after a quarter
    EXPECT_NEAR(safe_share(PairKind::point_triangle, over_triangle({0.2, 0.3, 0.5}), step, 1.0), 0.225, 0.225 * 1e-3);
}

TEST(SafeShare, IsWholeForAStepThatLeadsApartOrThatMovesAllPoints)
{
    FourPoints step = FourPoints::Zero();
    step.col(0) = Vec3(0, 0, 5.0);
    EXPECT_EQ(safe_share(PairKind::point_triangle, over_triangle({0.2, 0.3, 0.5}), step, 1.0), 1.0);
    step.colwise() = Vec3(3, 1, -7);
    EXPECT_EQ(safe_share(PairKind::point_triangle, over_triangle({0.2, 0.3, 0.5}), step, 1.0), 1.0);
    EXPECT_EQ(safe_share(PairKind::edge_edge, over_edge({0.2, -1, 0.3}, {0.2, 1, 0.3}), step, 0.5), 0.5);
}

// 300 random pairs whose ends cross. The distance along the way, at 200 places up to the share, never falls below a
// tenth of the first.
TEST(SafeShare, KeepsATenthOfTheDistanceEverywhereOnTheWay)
{
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    for (int pair = 0; pair < 300; ++pair) {
        const PairKind kind = pair % 2 == 0 ? PairKind::point_triangle : PairKind::edge_edge;
        const FourPoints points = FourPoints::NullaryExpr([&] { return entry(generator); }),
                         step = 3.0 * FourPoints::NullaryExpr([&] { return entry(generator); });
        const double share = safe_share(kind, points, step, 1.0), first = closest_points(kind, points).distance_m;
        EXPECT_GT(share, 0.0);
        for (int place = 0; place <= 200; ++place)
            EXPECT_GE(closest_points(kind, points + place / 200.0 * share * step).distance_m,
                      0.1 * first * (1.0 - 1e-9))
                << pair;
    }
}

}  // namespace
