// Reference: closed forms of flat faces, calculus (eps sweeps), sums of force and moment, and the definition of a range
// and of a step that leaves nothing meeting.
#include "reference_fem/contact/contact_potential.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/eps_sweep.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>

#include <numbers>
#include <set>

namespace {

using namespace reference_fem;
using pbs::Vec3;

constexpr double range_m = 0.05, young_pa = 1e4;
const ContactOptions options{.range_m = range_m, .stiffness_pa = young_pa};

// Two blocks of 1 x 1 x 0.5 m, one above the other at a distance of 1 m, whose facing sides have 2 x 2 and n x n
// squares.
pbs::TetMesh two_blocks(int n)
{
    return joined({box_mesh({0, 0, 0}, {1, 1, 0.5}, {2, 2, 1}), box_mesh({0, 0, 1.5}, {1, 1, 2}, {n, n, 1})});
}

// Each node above the height above_m moves up by gap_m - 1 m. The two blocks, 1 m apart at rest, then have the distance
// gap_m.
Eigen::VectorXd brought_together(const SimplexSpace& space, double gap_m, double above_m = 1.0)
{
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    for (int n = 0; n < space.nodes(); ++n)
        if (space.node_positions()(n, 2) > above_m) displacement(3 * n + 2) = gap_m - 1.0;
    return displacement;
}

// The same, and turned by 0.3 rad about the vertical through (0.4, 0.6), so that no edges are parallel and no nodes
// opposite each other.
Eigen::VectorXd brought_together_askew(const SimplexSpace& space, double gap_m)
{
    Eigen::VectorXd displacement = brought_together(space, gap_m);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
    for (int n = 0; n < space.nodes(); ++n) {
        const Vec3 arm = space.node_positions().row(n).transpose() - Vec3(0.4, 0.6, 0.0);
        if (arm.z() > 1.0) displacement.segment<3>(3 * n) += turn * arm - arm;
    }
    return displacement;
}

Eigen::VectorXd random_dofs(int size, double magnitude, unsigned seed)
{
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> entry(-magnitude, magnitude);
    return Eigen::VectorXd::NullaryExpr(size, [&] { return entry(generator); });
}

Eigen::VectorXd gradient_of(const Potential& potential, const Eigen::VectorXd& displacement)
{
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(displacement.size());
    potential.add_gradient(displacement, gradient);
    return gradient;
}

Vec3 force_on(const Eigen::VectorXd& gradient, const SimplexSpace& space, bool upper)
{
    Vec3 force = Vec3::Zero();
    for (int n = 0; n < space.nodes(); ++n)
        if ((space.node_positions()(n, 2) > 1.0) == upper) force -= gradient.segment<3>(3 * n);
    return force;
}

TEST(Barrier, HasItsSlopesAndEndsAtItsRange)
{
    const auto at = [](const Eigen::VectorXd& d) { return barrier(d(0), range_m); };
    const Eigen::VectorXd d = Eigen::VectorXd::Constant(1, 0.4 * range_m), one = Eigen::VectorXd::Ones(1);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& v) { return at(v).value; }, d, one, at(d).first,
                                            0.2 * range_m);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& v) { return at(v).first; }, d, one, at(d).second,
                                            0.2 * range_m);
    EXPECT_EQ(barrier(range_m, range_m).value, 0.0);
    EXPECT_EQ(barrier(range_m, range_m).first, 0.0);
    EXPECT_TRUE(std::isinf(barrier(0.0, range_m).value));
}

struct Blocks {
    int element_order, squares;
};
class FlatFaces : public testing::TestWithParam<Blocks> {
protected:
    const SimplexSpace space{two_blocks(GetParam().squares), GetParam().element_order};
    const ContactPotential contact{space, options};
};

// Every node of a facing side, rim included, is pressed by the other side once. The areas of the nodes at the rim
// include a part of the sides of the block. The gap of 3 cm is a difference of places of 2 m, whose rounding it has
// some hundredfold, and the barrier changes by up to ten times as much: some 10,000 roundings in all.
TEST_P(FlatFaces, PressWithTheBarrierOncePerAreaOnAnyTwoMeshes)
{
    const double gap_m = 0.6 * range_m;  // edges press below half the range
    const Eigen::VectorXd together = brought_together(space, gap_m);
    double area_m2 = 0.0;
    for (int n = 0; n < space.nodes(); ++n)
        if (const double z = space.node_positions()(n, 2); z == 0.5 || z == 1.5)
            area_m2 += contact.surface().node_area(n) / 2.0;
    const Barrier b = barrier(gap_m, range_m);
    EXPECT_NEAR(contact.value(together), young_pa * area_m2 * b.value,
                test_support::rounding_error(1e4, young_pa * area_m2 * b.value));
    const Vec3 force = force_on(gradient_of(contact, together), space, true);
    EXPECT_NEAR(force.z(), -young_pa * area_m2 * b.first, test_support::rounding_error(1e4, young_pa * area_m2));
    // The upper face is tilted about its rim at x = 0, which stays above the rim of the lower face. All other places
    // are farther apart.
    Eigen::VectorXd tilted = together;
    for (int n = 0; n < space.nodes(); ++n)
        if (space.node_positions()(n, 2) > 1.0) tilted(3 * n + 2) += 0.01 * space.node_positions()(n, 0);
    for (const Eigen::VectorXd& state : {together, tilted})
        EXPECT_NEAR(contact.state(state).smallest_distance_m, gap_m, test_support::rounding_error(40, 2.0));
}

TEST_P(FlatFaces, DoNotPressBeyondTheRange)
{
    EXPECT_EQ(contact.value(brought_together(space, 1.0001 * range_m)), 0.0);
    EXPECT_EQ(contact.state(brought_together(space, 1.0001 * range_m)).pairs, 0);
}

TEST_P(FlatFaces, HaveForcesWithoutSumAndMoment)
{
    const Eigen::VectorXd folded = brought_together(space, 0.5 * range_m) + random_dofs(space.dofs(), 0.1 * range_m, 1);
    const Eigen::VectorXd gradient = gradient_of(contact, folded);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double forces = 0.0;
    for (int n = 0; n < space.nodes(); ++n) {
        const Vec3 of_node = gradient.segment<3>(3 * n),
                   at = space.node_positions().row(n).transpose() + folded.segment<3>(3 * n);
        force += of_node;
        moment += at.cross(of_node);
        forces += of_node.norm();
    }
    ASSERT_GT(forces, 0.0);
    EXPECT_LT(force.norm(), test_support::rounding_error(100, forces));
    // an offset of 0.01 m from places of 3 m
    EXPECT_LT(moment.norm(), test_support::rounding_error(100, 3.0 * forces) / 1e-2);
}

// A generic state: the nearest places change along no direction of the sweep, since the faces are tilted by random.
TEST_P(FlatFaces, HaveTheSlopesAndCurvaturesOfTheirEnergy)
{
    const Eigen::VectorXd at = brought_together_askew(space, 0.4 * range_m) +
                               random_dofs(space.dofs(), 0.1 * range_m, 1),
                          along = random_dofs(space.dofs(), 1.0, 2), across = random_dofs(space.dofs(), 1.0, 3);
    constexpr double size = 3e-4;
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& u) { return contact.value(u); }, at, along,
                                            gradient_of(contact, at).dot(along), size);
    NodalMatrix hessian(space);
    EXPECT_TRUE(hessian.couple(contact.couplings(at)));
    EXPECT_FALSE(hessian.couple(contact.couplings(at)));
    contact.add_hessian(at, Definiteness::as_it_is, hessian);
    test_support::expect_slope_by_eps_sweep(
        [&](const Eigen::VectorXd& u) { return gradient_of(contact, u).dot(across); }, at, along,
        across.dot(hessian.matrix() * along), size);
    hessian.set_zero();
    contact.add_hessian(at, Definiteness::projected, hessian);
    EXPECT_GE(along.dot(hessian.matrix() * along), 0.0);
}

// The step would take the upper block through the lower one.
TEST_P(FlatFaces, KeepATenthOfTheirDistanceInAnyStep)
{
    const Eigen::VectorXd apart = brought_together_askew(space, 0.5);
    const Eigen::VectorXd step = brought_together_askew(space, -0.5) - apart;
    const double largest = contact.largest_step(apart, step);
    EXPECT_NEAR(largest, 0.45, 1e-3);
    EXPECT_FALSE(contact.intersects(apart + largest * step));
    Eigen::VectorXd crossing = apart + 0.7 * step;
    crossing.head<3>().setConstant(std::nan(""));
    EXPECT_TRUE(contact.intersects(crossing)) << "where the corner at the origin has no place";
    EXPECT_EQ(contact.largest_step(apart, -step), 1.0);
    EXPECT_EQ(
        contact.largest_step(apart, Eigen::VectorXd::Constant(space.dofs(), std::numeric_limits<double>::quiet_NaN())),
        0.0);
}

// To the bit: what was searched before has no effect.
TEST_P(FlatFaces, HaveAnEnergyThatDoesNotDependOnTheStatesBefore)
{
    const Eigen::VectorXd at = brought_together(space, 0.5 * range_m) + random_dofs(space.dofs(), 0.1 * range_m, 1);
    const double value = contact.value(at);
    const ContactPotential used(space, options);
    for (const double gap_m : {1.0, 0.2, 0.06, 0.03}) used.value(brought_together(space, gap_m));
    used.largest_step(brought_together(space, 0.2), at - brought_together(space, 0.2));
    EXPECT_EQ(used.value(at), value);
}

INSTANTIATE_TEST_SUITE_P(OfTwoMeshes, FlatFaces,
                         testing::Values(Blocks{1, 2}, Blocks{1, 5}, Blocks{2, 2}, Blocks{2, 3}),
                         [](const auto& blocks) {
                             return "Order" + std::to_string(blocks.param.element_order) + "Squares" +
                                    std::to_string(blocks.param.squares);
                         });

// Two tets whose facing edges cross at right angles, 1 m apart at rest. All other pairs are farther apart than the
// range. An edge has a third of its two triangles, whose area is sqrt 2 m^2 each, and a pair of edges presses with half
// the mean of their areas. The roundings are those of flat faces.
TEST(ContactPotential, OfTwoEdgesThatCrossIsTheBarrierOnceForTheMeanOfTheirAreas)
{
    pbs::TetMesh tets{pbs::Positions(8, 3), pbs::Tets(2, 4)};
    tets.rest << -1, 0, 0, 1, 0, 0, 0, -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, -1, 0, 2, 1, 0, 2;
    tets.tets << 0, 1, 2, 3, 4, 5, 6, 7;
    const SimplexSpace space(tets, 1);
    const ContactPotential contact(space, options);
    const double gap_m = 0.4 * range_m, area_m2 = 2.0 * std::numbers::sqrt2 / 3.0;
    const ContactState state = contact.state(brought_together(space, gap_m, 0.5));
    EXPECT_EQ(state.pairs, 1);
    const double energy_j = young_pa / 2.0 * area_m2 * barrier(gap_m, range_m / 2.0).value;
    EXPECT_NEAR(state.energy_j, energy_j, test_support::rounding_error(1e4, energy_j));
}

TEST(ContactPotential, IsZeroAtRestHoweverLongItsRange)
{
    const pbs::TetMesh cube =
        test_support::jittered(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), {0.5, 0.5, 0.5}, 0.2);
    for (const int order : {1, 2}) {
        const SimplexSpace space(cube, order);
        const ContactPotential contact(space, {.range_m = 2.0, .stiffness_pa = 1.0});
        const Eigen::VectorXd rest = Eigen::VectorXd::Zero(space.dofs());
        EXPECT_EQ(contact.value(rest), 0.0);
        EXPECT_EQ(gradient_of(contact, rest).norm(), 0.0);
        EXPECT_FALSE(contact.intersects(rest));
    }
}

// A slit narrower than the range presses from half its width on, and its sides cannot meet.
TEST(ContactPotential, OfPartsThatAreNearAtRestHasHalfTheirDistanceAsItsRange)
{
    const double slit_m = range_m / 2.0;
    const SimplexSpace space(
        joined({box_mesh({0, 0, 0}, {1, 1, 0.5}, {2, 2, 1}), box_mesh({0, 0, 0.5 + slit_m}, {1, 1, 1.5}, {2, 2, 1})}),
        1);
    const ContactPotential contact(space, options);
    const auto closed_by = [&](double share) { return brought_together(space, 1.0 - share * slit_m, 0.51); };
    EXPECT_EQ(contact.value(closed_by(0.49)), 0.0);
    EXPECT_GT(contact.value(closed_by(0.51)), 0.0);
    EXPECT_NEAR(contact.largest_step(closed_by(0.0), closed_by(2.0)), 0.45, 1e-3);
}

// The two sides of a cut touch at rest up to rounding, and half of their distance would be the range. These pairs would
// press once 0.7 of the distance is closed.
TEST(ContactPotential, LeavesOutPairsThatTouchAtRest)
{
    constexpr double long_range_m = 1.0, touching_m = 1e-6 * long_range_m;  // `joined` merges vertices within 1e-7 m
    const SimplexSpace space(joined({box_mesh({0, 0, 0}, {1, 1, 0.5}, {2, 2, 1}),
                                     box_mesh({0, 0, 0.5 + touching_m}, {1, 1, 1.5}, {2, 2, 1})}),
                             1);
    const ContactPotential contact(space, {.range_m = long_range_m, .stiffness_pa = young_pa});
    const Eigen::VectorXd opened = brought_together(space, 2.0, 0.5);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(space.dofs());
    EXPECT_EQ(contact.largest_step(rest, opened), 1.0);
    EXPECT_EQ(gradient_of(contact, -0.7 * touching_m * opened).norm(), 0.0);
}

TEST(NearPairs, AreThoseThatTryingAllPairsFinds)
{
    const SimplexSpace space(two_blocks(5), 1);
    const NearPairs near(space, range_m);
    const auto& [nodes, edges, triangles, node_area, edge_area] = near.surface();
    const Eigen::VectorXd askew =
        brought_together_askew(space, 0.2 * range_m) + random_dofs(space.dofs(), 0.1 * range_m, 1);
    const pbs::Positions place =
        space.node_positions() + Eigen::Map<const pbs::Positions>(askew.data(), space.nodes(), 3);
    for (const int axis : {0, 1, 2}) {  // the pairs are swept along the axis on which the body is longest
        pbs::Positions change =
            place(Eigen::all, std::array{axis, (axis + 1) % 3, (axis + 2) % 3}) - space.node_positions();
        change.col(axis) += 3.0 * (change + space.node_positions()).col(axis);
        const Eigen::VectorXd at = Eigen::VectorXd::Map(change.data(), change.size());
        std::vector<std::tuple<PairKind, int, int>> found, expected;
        for (const auto& pair : near.at(at)) found.push_back({pair.kind, pair.first, pair.second});
        const auto expect_if_near = [&](PairKind kind, int first, int second) {
            const std::array<int, 4> corners = near.nodes_of({kind, first, second});
            if (std::set<int>(corners.begin(), corners.end()).size() < 4) return;  // they have a node in common
            if (closest_points(kind, near.points_of(corners, at)).distance_m <= 3.0 * range_m)
                expected.push_back({kind, first, second});
        };
        for (const int node : nodes)
            for (std::size_t t = 0; t < triangles.size(); ++t) expect_if_near(PairKind::point_triangle, node, int(t));
        for (std::size_t one = 0; one < edges.size(); ++one)
            for (std::size_t other = one + 1; other < edges.size(); ++other)
                expect_if_near(PairKind::edge_edge, int(one), int(other));
        EXPECT_TRUE(expected.size() > 50 && found == expected)
            << found.size() << " pairs instead of " << expected.size();
    }
}

TEST(ContactPotential, IsTheSameForAMovedAndAMirroredBody)
{
    const pbs::TetMesh blocks = two_blocks(3);
    const SimplexSpace space(blocks, 1);
    const Eigen::VectorXd together =
        brought_together(space, 0.5 * range_m) + random_dofs(space.dofs(), 0.1 * range_m, 1);
    const double value = ContactPotential(space, options).value(together);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::Matrix3d mirror = Vec3(-1, 1, 1).asDiagonal();
    for (const Eigen::Matrix3d& map : {turn, mirror}) {
        const SimplexSpace moved(mapped(blocks, [&](const Vec3& p) { return Vec3(map * p); }), 1);
        Eigen::VectorXd displacement = together;
        for (int n = 0; n < space.nodes(); ++n) displacement.segment<3>(3 * n) = map * together.segment<3>(3 * n);
        EXPECT_NEAR(ContactPotential(moved, options).value(displacement), value, 1e-10 * value);
    }
}

TEST(ContactPotential, RefusesARangeOrAStiffnessThatIsNotPositive)
{
    const SimplexSpace space(two_blocks(2), 1);
    test_support::expect_refused("contact.range_m",
                                 [&] { ContactPotential(space, {.range_m = 0.0, .stiffness_pa = 1.0}); });
    test_support::expect_refused("contact.stiffness_pa",
                                 [&] { ContactPotential(space, {.range_m = 1.0, .stiffness_pa = -1.0}); });
}

}  // namespace
