// The step of the published code. Reference: the rules in author_solver.hpp, by hand.
#include "pbs/author/author_solver.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

namespace {

// First-fit colouring over all kinds of constraints together.

// Two tets that share the face 1, 2, 3.
const pbs::TetMesh two_tets{pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
                            pbs::Tets{{0, 1, 2, 3}, {4, 2, 1, 3}}};
const pbs::Skeleton one_bone = {{{"bone", -1, {0, 0, -1}, {0, 0, 2}}}};

TEST(AuthorGroups, EdgesAreListedAsTheyFirstAppear)
{
    EXPECT_EQ(pbs::edges_by_appearance(two_tets.tets),
              (pbs::Edges{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}, {2, 4}, {1, 4}, {3, 4}}));
}

// The vertices of each constraint, by tets, vertices and edges.
std::vector<std::vector<int>> vertices_of(const pbs::AuthorGroup& group)
{
    std::vector<std::vector<int>> vertices;
    for (const auto& constraint : group.volume)
        vertices.emplace_back(constraint.vertex.begin(), constraint.vertex.end());
    for (const auto& constraint : group.bind) vertices.push_back({constraint.vertex});
    for (const auto& constraint : group.stretch)
        vertices.emplace_back(constraint.vertex.begin(), constraint.vertex.end());
    return vertices;
}

// Tet 0 leaves vertex 4 free in group 0, and tet 1 leaves vertex 0 free in group 1. The binds of 4 and 0 join these
// groups; the others open group 2. The edges 0-1, 0-2 and 0-3 open groups 3 to 5, which their opposite edges 2-3, 1-3
// and 1-2 join. Vertex 4 is still free there, but the other end of each of its edges is not: each of them opens a group
// of its own.
TEST(AuthorGroups, EachConstraintJoinsTheFirstGroupWithoutItsVertices)
{
    std::vector<std::vector<std::vector<int>>> found;
    for (const pbs::AuthorGroup& group :
         pbs::author_groups(two_tets, pbs::bind_to_nearest_bone(two_tets.rest, one_bone)))
        found.push_back(vertices_of(group));
    const decltype(found) expected = {{{0, 1, 2, 3}, {4}},
                                      {{4, 2, 1, 3}, {0}},
                                      {{1}, {2}, {3}},
                                      {{0, 1}, {2, 3}},
                                      {{0, 2}, {1, 3}},
                                      {{0, 3}, {1, 2}},
                                      {{2, 4}},
                                      {{1, 4}},
                                      {{3, 4}}};
    EXPECT_EQ(found, expected);
}

TEST(AuthorGroups, ShareNoVertexAndHoldEachConstraintOnce)
{
    const auto body = test_support::two_bone_limb({8, 2, 2}, {0, 0, 1}, 0.0);
    Eigen::Index constraints = 0;
    for (const pbs::AuthorGroup& group : pbs::author_groups(body.mesh, body.binding)) {
        std::set<int> used;
        for (const std::vector<int>& vertices : vertices_of(group)) {
            for (const int vertex : vertices) EXPECT_TRUE(used.insert(vertex).second) << vertex;
            ++constraints;
        }
    }
    EXPECT_EQ(constraints,
              body.mesh.tets.rows() + body.mesh.rest.rows() + pbs::edges_by_appearance(body.mesh.tets).rows());
}

TEST(AuthorGroups, RestDataAreThoseOfTheMesh)
{
    pbs::TetMesh inverted = two_tets;
    std::swap(inverted.tets(0, 0), inverted.tets(0, 1));
    const auto groups = pbs::author_groups(inverted, pbs::bind_to_nearest_bone(inverted.rest, one_bone));
    EXPECT_EQ(groups[0].volume[0].rest_volume, 1.0 / 6.0);  // absolute
    EXPECT_EQ(groups[3].stretch[0].rest_length, 1.0);
    EXPECT_EQ(groups[1].bind[0].distance, 0.0);
    EXPECT_EQ(groups[2].bind[0].distance, 1.0);
}

// Eq. 2 as the published code reads it.

using pbs::Vec3;

// A root along x with three children. Two start at its tail, one at its middle; one child has a sibling at its own
// head.
const pbs::Skeleton skeleton = {{{"root", -1, Vec3(0, 0, 0), Vec3(6, 0, 0)},
                                 {"up", 0, Vec3(6, 0, 0), Vec3(6, 6, 0)},
                                 {"down", 0, Vec3(6, 0, 0), Vec3(6, -6, 0)},
                                 {"middle", 0, Vec3(3, 0, 4), Vec3(3, 0, 10)},
                                 {"point", 1, Vec3(20, 20, 20), Vec3(20, 20, 20)}}};

TEST(AuthorWeights, OfEachPartOfABone)
{
    struct Case {
        const char* name;
        Vec3 vertex;
        std::map<int, double> expected;  // by bone
    };
    const Case cases[] = {
        {"the middle belongs to the bone alone", {3.0, 0.1, 0.0}, {{0, 1.0}}},
        {"the head of a root belongs to the root alone", {0.5, 0.1, 0.0}, {{0, 1.0}}},
        {"before the head of a root", {-1.0, 0.1, 0.0}, {{0, 1.0}}},
        {"the tail is shared with all children, wherever they start",
         {5.5, 0.0, 0.1},
         {{0, 0.25}, {1, 0.25}, {2, 0.25}, {3, 0.25}}},
        {"the head is shared with the parent, not with siblings", {6.0, 0.5, 0.1}, {{1, 0.5}, {0, 0.5}}},
        {"the head of the child at the middle", {3.0, 0.0, 4.5}, {{3, 0.5}, {0, 0.5}}},
        {"a tail without children belongs to the bone alone", {6.0, -5.9, 0.0}, {{2, 1.0}}},
        {"a bone without length is its head", {20.0, 20.0, 21.0}, {{4, 0.5}, {1, 0.5}}},
    };
    for (const auto& [name, vertex, expected] : cases) {
        const pbs::Positions rest = vertex.transpose();
        const pbs::Weights weights = pbs::author_weights(pbs::bind_to_nearest_bone(rest, skeleton), skeleton);
        std::map<int, double> by_bone;
        for (int entry = weights.first[0]; entry < weights.first[1]; ++entry)
            by_bone[weights.bone[entry]] = weights.weight[entry];
        EXPECT_EQ(by_bone, expected) << name;
    }
}

using pbs::AuthorOptions;
using pbs::AuthorSolver;
using pbs::Positions;
using test_support::rounding_error;

const test_support::TwoBoneLimb body = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);
constexpr int constraints_at_a_vertex = 50;

AuthorSolver solver_with(const AuthorOptions& options)
{
    return {body.mesh, body.skeleton, body.binding, options};
}

pbs::Pose moved(const Vec3& offset_m)
{
    return pbs::Pose(2, Eigen::Isometry3d(Eigen::Translation3d(offset_m)));
}

Positions rest_moved(const Vec3& offset_m)
{
    return body.mesh.rest.rowwise() + offset_m.transpose();
}

double largest(const Positions& difference)
{
    return difference.cwiseAbs().maxCoeff();
}

// Each iteration may add a rounding of the 1 m half length in each constraint at a vertex.
TEST(AuthorSolver, RestStaysAtRest)
{
    AuthorSolver solver = solver_with({});
    EXPECT_EQ(solver.positions(), body.mesh.rest);
    EXPECT_EQ(solver.advance(moved(Vec3::Zero())).iterations, 12);
    EXPECT_LT(largest(solver.positions() - body.mesh.rest), rounding_error(12 * constraints_at_a_vertex, 1.0));
}

TEST(AuthorSolver, WithoutIterationsTheFirstFrameIsLbs)
{
    AuthorSolver solver = solver_with({.iterations = 0});
    solver.advance(body.pose);
    Positions lbs;
    pbs::linear_blend_skinning(body.mesh.rest, pbs::author_weights(body.binding, body.skeleton), body.pose, lbs);
    EXPECT_LT(largest(solver.positions() - lbs), rounding_error(20, 2.0));  // blends of another order of operations
}

TEST(AuthorSolver, RestoresVolumeThatBlendingLost)
{
    const auto lost = [](const Positions& positions) {
        return pbs::tet_volumes(body.mesh.rest, body.mesh.tets).sum() -
               pbs::tet_volumes(positions, body.mesh.tets).sum();
    };
    const pbs::Pose twisted = pbs::joint_sweep(body.skeleton, 1, Vec3::UnitX(), 90.0, 2, 0.01).steps.back();
    AuthorSolver blended = solver_with({.iterations = 0}), projected = solver_with({});
    blended.advance(twisted), projected.advance(twisted);
    EXPECT_GT(lost(blended.positions()), 0.0);
    EXPECT_LT(lost(projected.positions()), 0.5 * lost(blended.positions()));
}

// Without projections, a body that moves by u(n) is at y(n) = u(n) + y(n - 1) - y(n - 2): motion counts twice. A single
// jolt then rings between 0 and 2 with period 6. The small further motion keeps the poses different; after 12 frames it
// amounts to 14 / 1024 at most.
TEST(AuthorSolver, CountsMotionTwice)
{
    AuthorSolver solver = solver_with({.iterations = 0, .time_step_s = 0.125});
    double last = 0.0, before_last = 0.0;
    for (int frame = 1; frame <= 12; ++frame) {
        const double u = 1.0 + frame / 1024.0, expected = u + (frame == 1 ? 0.0 : last - before_last);
        solver.advance(moved({u, 0.0, 0.0}));
        EXPECT_LT(largest(solver.positions() - rest_moved({expected, 0.0, 0.0})), rounding_error(20 * frame, 4.0))
            << frame;
        before_last = last, last = expected;
        const int phase = frame % 6;
        EXPECT_NEAR(expected,
                    phase == 0 || phase == 5   ? 0.0
                    : phase == 2 || phase == 3 ? 2.0
                                               : 1.0,
                    14.0 / 1024.0)
            << frame;
    }
}

TEST(AuthorSolver, GravityMovesEveryParticleByGHSquaredAndTheTimeStepCancelsWithoutIt)
{
    AuthorSolver solver = solver_with({.iterations = 0, .gravity_m_s2 = {0.0, -9.81, 0.0}});
    solver.advance(moved(Vec3::Zero()));
    EXPECT_LT(largest(solver.positions() - rest_moved({0.0, -0.0981, 0.0})), rounding_error(20, 1.0));
    // powers of two are exact
    AuthorSolver one = solver_with({.time_step_s = 0.125}), other = solver_with({.time_step_s = 0.5});
    for (AuthorSolver* each : {&one, &other}) {
        each->advance(body.pose);
        each->advance(moved({0.0, 0.5, 0.0}));
    }
    EXPECT_EQ(one.positions(), other.positions());
}

TEST(AuthorSolver, DoesNotStepAPoseThatEqualsTheLastOneAndReportsOneThatIsNotFinite)
{
    AuthorSolver solver = solver_with({});
    solver.advance(body.pose);
    const Positions before = solver.positions();
    EXPECT_EQ(solver.advance(body.pose).iterations, 0);
    EXPECT_EQ(solver.positions(), before);
    EXPECT_EQ(solver.advance(moved(Vec3::Zero())).iterations, 12);
    EXPECT_NE(solver.positions(), before);
    EXPECT_EQ(solver.advance(moved({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0})).outcome,
              pbs::Outcome::not_finite);
}

// The threshold for a unit of 100 m is 100 m^4. No tet of the limb, 2 m long, has faces of 1 m^2, so that its squared
// gradients add up to less than 4 x 2^2 m^4. Volume constraints are then left out, whatever their stiffness is.
TEST(AuthorSolver, TheUnitOfLengthDecidesWhichTetsAreLeftOut)
{
    const auto bent_with = [](double length_unit_m, double k_volume) {
        AuthorSolver solver =
            solver_with({.length_unit_m = length_unit_m, .k_volume_inverted = k_volume, .k_volume = k_volume});
        solver.advance(body.pose);
        return solver.positions();
    };
    EXPECT_EQ(bent_with(100.0, 1.0), bent_with(100.0, 0.0));
    EXPECT_NE(bent_with(0.01, 1.0), bent_with(0.01, 0.0));
}

TEST(AuthorSolver, RefusesOptionsOutOfRangeAndOtherBindings)
{
    for (const AuthorOptions& options :
         {AuthorOptions{.iterations = -1}, AuthorOptions{.time_step_s = 0.0}, AuthorOptions{.length_unit_m = 0.0},
          AuthorOptions{.k_compression = 1.1}, AuthorOptions{.k_stretch = -0.1},
          AuthorOptions{.k_volume_inverted = 6.1}, AuthorOptions{.k_volume = std::numeric_limits<double>::quiet_NaN()}})
        EXPECT_THROW(solver_with(options), pbs::InputError);
    const pbs::BoneBinding of_fewer = pbs::bind_to_nearest_bone(body.mesh.rest.topRows(3), body.skeleton);
    EXPECT_THROW(AuthorSolver(body.mesh, body.skeleton, of_fewer, {}), pbs::InputError);
}

}  // namespace
