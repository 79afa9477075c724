// Reference: the enclosed volume of a sphere of triangles, and weights by hand. Repairs move no point, so that results
// are equal to the bit.

#include "experiments/rigs/rig_reader.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>

namespace {

using namespace pbs;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// A mesh whose points all follow one joint, and whose triangles have their own numbers as materials.
Rig rig_of(const Positions& points, const Triangles& triangles)
{
    RigMesh mesh{"ball", 0, points, triangles, {SkinJoint{.node = 0}}, {}};
    for (int p = 0; p <= points.rows(); ++p) mesh.skin.first.push_back(p);
    mesh.skin.bone.assign(static_cast<std::size_t>(points.rows()), 0);
    mesh.skin.weight.assign(static_cast<std::size_t>(points.rows()), 1.0);
    mesh.look.material.resize(static_cast<std::size_t>(triangles.rows()));
    std::iota(mesh.look.material.begin(), mesh.look.material.end(), 0);
    Rig rig;
    rig.file = "a.glb";
    rig.nodes.push_back({"root", -1, {}});
    rig.meshes.push_back(mesh);
    return rig;
}

template <typename Rows>
Rows stacked(const Rows& first, const Rows& second)
{
    Rows both(first.rows() + second.rows(), first.cols());
    both << first, second;
    return both;
}

Triangles reversed(const Triangles& triangles)
{
    return triangles(Eigen::all, std::vector<int>{2, 1, 0});
}

Triangles in_random_order(const Triangles& triangles)
{
    std::vector<int> order(static_cast<std::size_t>(triangles.rows()));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, std::mt19937(5));
    return triangles(order, Eigen::all);
}

// The ball without the triangles above this height.
Triangles below(const SurfaceMesh& ball, double height)
{
    std::vector<int> kept;
    for (int f = 0; f < ball.triangles.rows(); ++f)
        if (ball.points(ball.triangles.row(f), 2).maxCoeff() < height) kept.push_back(f);
    return ball.triangles(kept, Eigen::all);
}

class SecondSides : public testing::Test {
protected:
    // The mesh that is left of these triangles.
    RigMesh left_of(const Positions& points, const Triangles& triangles)
    {
        Rig rig = rig_of(points, triangles);
        leave_out_second_sides_and_unused_points(rig);
        remarks = rig.remarks;
        return rig.meshes[0];
    }

    void expect_one_side(const Positions& points, const Triangles& triangles, const Triangles& own)
    {
        const RigMesh mesh = left_of(points, triangles);
        EXPECT_EQ(mesh.triangles.rows(), own.rows());
        EXPECT_EQ(mesh.points.rows(), ball.points.rows());
        EXPECT_NEAR(test_support::enclosed_volume(mesh.points, mesh.triangles),
                    test_support::enclosed_volume(ball.points, own), 1e-14);
        ASSERT_FALSE(remarks.empty());
        EXPECT_EQ(
            remarks[0],
            std::to_string(own.rows()) + " of " + std::to_string(2 * own.rows()) +
                " triangles of mesh ball are the second side of others, with their corners in the reverse order; they "
                "are left out");
    }

    const SurfaceMesh ball = test_support::icosphere(1.0, 2);
    std::vector<std::string> remarks;
};

TEST_F(SecondSides, OfAClosedBodyAreLeftOutInAnyOrder)
{
    const Triangles inward = reversed(ball.triangles), both = stacked(ball.triangles, inward);
    for (const Triangles& triangles : {both, stacked(inward, ball.triangles), in_random_order(both)})
        expect_one_side(ball.points, triangles, ball.triangles);
    const auto points = static_cast<int>(ball.points.rows());
    expect_one_side(stacked(ball.points, ball.points), stacked(ball.triangles, Triangles(inward.array() + points)),
                    ball.triangles);
}

TEST_F(SecondSides, OfABodyWithASmallOpeningAreLeftOut)
{
    const Triangles open = below(ball, 0.98);
    ASSERT_LT(open.rows(), ball.triangles.rows());
    const RigMesh mesh = left_of(ball.points, stacked(open, reversed(open)));
    EXPECT_EQ(mesh.triangles.rows(), open.rows());
    std::vector<int> materials(static_cast<std::size_t>(open.rows()));
    std::iota(materials.begin(), materials.end(), 0);
    EXPECT_EQ(mesh.look.material, materials);
}

TEST_F(SecondSides, OfAPartOfABodyAreLeftOutWhicheverComesFirst)
{
    const Triangles bowl = below(ball, 0.0);
    EXPECT_EQ(left_of(ball.points, stacked(ball.triangles, reversed(bowl))).triangles, ball.triangles);
    EXPECT_EQ(left_of(ball.points, stacked(reversed(bowl), ball.triangles)).triangles, ball.triangles);
}

TEST_F(SecondSides, OfASheetStay)
{
    const Triangles bowl = below(ball, 0.0), bowl_twice = stacked(bowl, reversed(bowl));
    EXPECT_EQ(left_of(ball.points, bowl_twice).triangles.rows(), bowl_twice.rows());
    const Triangles twice_the_same = stacked(ball.triangles, ball.triangles);
    EXPECT_EQ(left_of(ball.points, twice_the_same).triangles.rows(), twice_the_same.rows());
    EXPECT_TRUE(remarks.empty());
}

TEST_F(SecondSides, PointsWithoutATriangleAreLeftOutWithTheirWeightsAndTheirLook)
{
    const Positions far = Positions::Constant(1200, 3, 30.0);
    Rig rig = rig_of(stacked(far, ball.points), ball.triangles.array() + 1200);
    RigMesh& mesh = rig.meshes[0];
    mesh.look.numbers = decltype(mesh.look.numbers)::Zero(mesh.points.rows(), 3);
    mesh.look.numbers.bottomRows(ball.points.rows()) = ball.points.cast<float>();
    mesh.joints.push_back({.node = 0});
    for (std::size_t p = 0; p < mesh.skin.bone.size(); ++p) mesh.skin.bone[p] = p < 1200 ? 1 : 0;
    leave_out_second_sides_and_unused_points(rig);
    EXPECT_EQ(mesh.points, ball.points);
    EXPECT_EQ(mesh.triangles, ball.triangles);
    EXPECT_EQ(mesh.look.numbers, ball.points.cast<float>());
    EXPECT_EQ(mesh.skin.vertices(), ball.points.rows());
    EXPECT_EQ(std::ranges::count(mesh.skin.bone, 1), 0);
    EXPECT_EQ(rig.remarks,
              std::vector<std::string>{"1,200 of 1,362 points of mesh ball are left out; no triangle uses them"});
}

// A ball of 642 points, whose weights of a second joint are the heights of the points.
class WeightsOfNeighbours : public testing::Test {
protected:
    WeightsOfNeighbours()
    {
        mesh.name = "ball";
        mesh.points = ball.points;
        mesh.triangles = ball.triangles;
        for (Eigen::Index p = 0; p < ball.points.rows(); ++p) shares.push_back({{0, 1.0 - height(p)}, {1, height(p)}});
    }

    double height(Eigen::Index point) const { return 0.5 + 0.5 * ball.points(point, 2); }
    void spoil(std::size_t point) { shares[point] = {{0, 0.5}, {1, not_a_number}}; }

    double mean_height_around(int point) const
    {
        std::set<int> around;
        for (const auto& triangle : ball.triangles.rowwise())
            if ((triangle.array() == point).any()) around.insert(triangle.begin(), triangle.end());
        around.erase(point);
        double sum = 0.0;
        for (const int neighbour : around) sum += height(neighbour);
        return sum / static_cast<double>(around.size());
    }

    std::vector<std::vector<JointShare>> filled() { return with_weights_of_neighbours(shares, mesh, "a.glb", remarks); }

    const SurfaceMesh ball = test_support::icosphere(1.0, 3);
    RigMesh mesh;
    std::vector<std::vector<JointShare>> shares;
    std::vector<std::string> remarks;
};

TEST_F(WeightsOfNeighbours, AreTheirMean)
{
    EXPECT_EQ(filled().at(0).size(), 2u);
    EXPECT_TRUE(remarks.empty());
    spoil(7);
    shares[20][0].weight = std::numeric_limits<double>::infinity();
    const auto made = filled();
    for (const int point : {7, 20}) {
        ASSERT_EQ(made[point].size(), 2u);
        EXPECT_NEAR(made[point][1].weight, mean_height_around(point), 1e-15);  // six numbers below one
        EXPECT_NEAR(made[point][0].weight, 1.0 - mean_height_around(point), 1e-15);
    }
    EXPECT_EQ(made[8][1].weight, height(8));
    EXPECT_EQ(remarks,
              std::vector<std::string>{
                  "the weights of 2 of 642 points of mesh ball are no finite numbers; they take those of their "
                  "neighbours"});
}

TEST_F(WeightsOfNeighbours, AreThoseOfAnotherPointAtThePlace)
{
    mesh.points = stacked(ball.points, Positions(ball.points.topRows(10)));
    for (int p = 0; p < 10; ++p) shares.push_back(shares[p]);
    spoil(3);
    spoil(645);  // the copy of the first one
    spoil(644);  // the copy of a sound point
    const auto made = filled();
    EXPECT_EQ(made[644][1].weight, height(2));
    EXPECT_NEAR(made[3][1].weight, mean_height_around(3), 1e-15);
    EXPECT_EQ(made[645][1].weight, made[3][1].weight);
}

TEST_F(WeightsOfNeighbours, ReachThePointsInTheMiddleOfSeveral)
{
    std::set<int> around;
    for (const auto& triangle : ball.triangles.rowwise())
        if ((triangle.array() == 0).any()) around.insert(triangle.begin(), triangle.end());
    ASSERT_LE(around.size(), 6u);  // a corner of the icosahedron and its neighbours
    for (const int point : around) spoil(static_cast<std::size_t>(point));
    for (const auto& own : filled())
        EXPECT_TRUE(std::ranges::all_of(own, [](const JointShare& share) { return share.weight <= 1.0; }));
}

TEST_F(WeightsOfNeighbours, AreNoneOfMoreThanAHundredthOfThePointsOrOfAPartWithoutAny)
{
    for (std::size_t p = 0; p < 7; ++p) spoil(p);
    expect_input_error([&] { filled(); }, "a.glb: mesh ball, weights = 7 of 642 points: ", "expected at most 1 %");
    shares.resize(642);
    mesh.points = stacked(ball.points, Positions(Positions::Identity(3, 3) * 5.0));
    mesh.triangles = stacked(ball.triangles, Triangles{{642, 643, 644}});
    for (std::size_t p = 0; p < 7; ++p) shares[p] = shares[10];
    for (std::size_t p = 642; p < 645; ++p) shares.push_back({{0, not_a_number}});
    expect_input_error([&] { filled(); },
                       "a.glb: mesh ball, weights = 3 of 645 points: ", "point 642 has no neighbour with weights");
}

}  // namespace
