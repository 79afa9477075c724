// Reference: exact Dirichlet data, which springs approach with an error of order 1/q, and rigid translation, which the finite element space
// contains and the springs therefore reproduce without strain.
#include "reference_fem/linear_elasticity.hpp"

#include "tests/support/solve_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const double young_pa = 1e5, cell_m = 0.125;
const pbs::TetMesh bar =
    test_support::jittered(test_support::structured_bar({0, -0.25, -0.25}, {2, 0.25, 0.25}, {16, 4, 4}), Vec3::Constant(cell_m), 0.25);

bool at_an_end(const Vec3& x)
{
    return x(0) < cell_m + 1e-3 || x(0) > 2.0 - cell_m - 1e-3;
}

// Whole tets within about one cell of the ends, as the skeleton prescribes them.
std::vector<int> end_tets()
{
    std::vector<int> tets;
    for (int t = 0; t < bar.tets.rows(); ++t) {
        const auto corners = bar.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [](int v) { return at_an_end(bar.rest.row(v)); })) tets.push_back(t);
    }
    return tets;
}

// The positions of all nodes of the end tets: their corners, and for quadratic tets the midpoints of their edges.
Positions end_nodes(int element_order)
{
    std::set<std::array<double, 3>> points;
    for (const int t : end_tets())
        for (int a = 0; a < 4; ++a)
            for (int b = a; b < (element_order == 1 ? a + 1 : 4); ++b) {
                const Vec3 middle = (bar.rest.row(bar.tets(t, a)) + bar.rest.row(bar.tets(t, b))) / 2.0;
                points.insert({middle(0), middle(1), middle(2)});
            }
    Positions nodes(points.size(), 3);
    Eigen::Index next = 0;
    for (const auto& point : points) nodes.row(next++) << point[0], point[1], point[2];
    return nodes;
}

// The far end turned by 10 degrees about the axis and pulled.
Positions posed(const Positions& points)
{
    const Eigen::AngleAxisd turn(10.0 * std::acos(-1.0) / 180.0, Vec3::UnitX());
    Positions targets = points;
    for (auto point : targets.rowwise())
        if (point(0) > 1.0) point = (turn * Vec3(point.transpose()) + Vec3(0.05, 0, 0)).transpose();
    return targets;
}

class SpringAttachment : public testing::TestWithParam<int> {};

TEST_P(SpringAttachment, ApproachesExactDirichletDataWithOneOverQ)
{
    const int order = GetParam();
    LinearElasticity exact(bar, {.element_order = order, .young_pa = young_pa}, {Positions(0, 3), {}, end_tets()});
    ASSERT_TRUE(exact.solve(Positions(0, 3), posed(bar.rest)).finite);
    const double size = (exact.positions() - bar.rest).norm();

    const Positions nodes = end_nodes(order);
    std::vector<double> errors;
    for (const double q : {1e2, 1e3, 1e4}) {
        const Eigen::VectorXd stiffness = Eigen::VectorXd::Constant(nodes.rows(), q * young_pa * cell_m);
        LinearElasticity tied(bar, {.element_order = order, .young_pa = young_pa}, {nodes, stiffness, {}});
        ASSERT_TRUE(tied.solve(posed(nodes), bar.rest).finite);
        errors.push_back((tied.positions() - exact.positions()).norm() / size);
        RecordProperty("relative_error_at_q_" + std::to_string(static_cast<int>(q)), std::to_string(errors.back() * 1e6) + "e-6");
    }
    // error = c / q (1 - d / q + ...), where d, of order 10, is the stiffness of the flesh at a tied node over E h. The ratio of two errors
    // whose q differ by a factor of ten is 10 to within d / q of the softer.
    EXPECT_NEAR(errors[0] / errors[1], 10.0, 1.0);
    EXPECT_NEAR(errors[1] / errors[2], 10.0, 0.1);
    EXPECT_LT(errors[2], 1e-4);
}

TEST_P(SpringAttachment, RepeatsARigidTranslation)
{
    const Positions nodes = end_nodes(1);
    const Attachment attachment{nodes, Eigen::VectorXd::Constant(nodes.rows(), 1e4 * young_pa * cell_m), {}};
    const LinearOptions options{.element_order = GetParam(), .young_pa = young_pa};
    LinearElasticity fem(bar, options, attachment);
    const Eigen::RowVector3d shift(3.0, -2.0, 1.0);
    ASSERT_TRUE(fem.solve(nodes.rowwise() + shift, bar.rest).finite);
    const test_support::SolveRounding rounding = test_support::rounding_of(fem, bar, options, attachment);
    EXPECT_LT((fem.positions() - (bar.rest.rowwise() + shift)).norm(), rounding.error_m());
    EXPECT_LT(rounding.relative(), 1e-5) << "a bound that would let an error of a percent pass proves nothing";
    EXPECT_LT(fem.strain_energy_j(), rounding.energy_j());
}

// The reaction of all springs carries the weight: translations are in the space, so equilibrium of forces is exact.
TEST_P(SpringAttachment, ReactionsCarryTheWeight)
{
    const Positions nodes = end_nodes(1);
    const double k = 1e3 * young_pa * cell_m, density = 1000.0;
    const Vec3 gravity(1.0, -2.0, -9.81);
    const LinearOptions options{.element_order = GetParam(), .young_pa = young_pa, .density_kg_m3 = density, .gravity_m_s2 = gravity};
    const Attachment attachment{nodes, Eigen::VectorXd::Constant(nodes.rows(), k), {}};
    LinearElasticity fem(bar, options, attachment);
    ASSERT_TRUE(fem.solve(nodes, bar.rest).finite);
    const Vec3 reaction = k * (nodes - fem.spring_points_deformed()).colwise().sum().transpose();
    const Vec3 weight = density * 0.5 * gravity;  // 2 x 0.5 x 0.5 m^3
    // The force that the residual leaves over, and the rounding of stretches, which are differences of positions of 2 m.
    const test_support::SolveRounding rounding = test_support::rounding_of(fem, bar, options, attachment);
    const double of_stretches = k * 2.0 * std::numeric_limits<double>::epsilon() * std::sqrt(3.0 * nodes.rows());
    const double bound_n = rounding.force_n(static_cast<int>(fem.displacement().size()) / 3) + of_stretches;
    EXPECT_LT((reaction + weight).norm(), bound_n);
    EXPECT_LT(bound_n, 1e-4 * weight.norm()) << "a bound that would let an error of a percent pass proves nothing";
}

// If gravity is given at the solve instead of in the options, nothing else changes.
TEST_P(SpringAttachment, GravityMayTurnBetweenFrames)
{
    const Positions nodes = end_nodes(1);
    const Attachment attachment{nodes, Eigen::VectorXd::Constant(nodes.rows(), 1e3 * young_pa), {}};
    const Vec3 gravity(0, 0, -9.81);
    LinearElasticity fixed(bar, {.element_order = GetParam(), .gravity_m_s2 = gravity}, attachment);
    LinearElasticity given(bar, {.element_order = GetParam()}, attachment);
    fixed.solve(nodes, bar.rest);
    given.solve(nodes, bar.rest, gravity);
    EXPECT_EQ(fixed.positions(), given.positions());
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, SpringAttachment, testing::Values(1, 2));

}  // namespace
