// Reference: weights that are a linear function of the place. They are reproduced on the surface, because they are linear in its triangles,
// and inside, because linear functions are harmonic.
#include "pbs/character/transferred_weights.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/unit_tet.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const TetMesh flesh = test_support::structured_bar({0, 0, 0}, {1, 0.5, 0.5}, {8, 4, 4});

// Of two bones: x on the second one, for points whose x is from 0 to 1.
Weights linear_weights(const Positions& points)
{
    Weights skin;
    skin.first = {0};
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        skin.bone.insert(skin.bone.end(), {0, 1});
        skin.weight.insert(skin.weight.end(), {1.0 - points(p, 0), points(p, 0)});
        skin.first.push_back(static_cast<int>(skin.bone.size()));
    }
    return skin;
}

double weight_in(const Weights& weights, int vertex, int bone)
{
    double sum = 0.0;
    for (int e = weights.first[std::size_t(vertex)]; e < weights.first[std::size_t(vertex) + 1]; ++e)
        if (weights.bone[std::size_t(e)] == bone) sum += weights.weight[std::size_t(e)];
    return sum;
}

// The term 1e-9 that keeps the system regular changes weights by less than 1e-6 in 8 cells, and 1e-6 is also where small ones are removed.
constexpr double transfer_tolerance = 3e-6;

TEST(TransferredWeights, LinearOnesOnTheTetsOwnSurfaceAreReproducedInTheFlesh)
{
    const Triangles boundary = boundary_of(flesh.tets);
    const TransferredWeights made = transfer_weights(flesh, flesh.rest, boundary, linear_weights(flesh.rest), 2);
    EXPECT_EQ(made.largest_distance_m, 0.0);
    ASSERT_EQ(made.weights.vertices(), flesh.rest.rows());
    for (int v = 0; v < flesh.rest.rows(); ++v) {
        EXPECT_NEAR(weight_in(made.weights, v, 1), flesh.rest(v, 0), transfer_tolerance) << v;
        EXPECT_NEAR(weight_in(made.weights, v, 0) + weight_in(made.weights, v, 1), 1.0, 1e-12) << v;
    }
}

TEST(TransferredWeights, ComeFromTheNearestPointOfACoarserSurface)
{
    // Two triangles at z = 2, 1.5 above the flesh, that cover it; the nearest point of (x, y, z) is (x, y, 2).
    const Positions sheet = (Positions(4, 3) << 0, 0, 2, 1, 0, 2, 1, 0.5, 2, 0, 0.5, 2).finished();
    const Triangles triangles = (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished();
    const TransferredWeights made = transfer_weights(flesh, sheet, triangles, linear_weights(sheet), 2);
    EXPECT_DOUBLE_EQ(made.largest_distance_m, 2.0) << "from the lower side";
    for (int v = 0; v < flesh.rest.rows(); ++v) EXPECT_NEAR(weight_in(made.weights, v, 1), flesh.rest(v, 0), transfer_tolerance) << v;
}

TEST(TransferredWeights, OfASurfaceThatFollowsOneBoneAreAllOnThatBone)
{
    const Triangles boundary = boundary_of(flesh.tets);
    Weights skin;
    for (int p = 0; p <= flesh.rest.rows(); ++p) skin.first.push_back(p);
    skin.bone.assign(std::size_t(flesh.rest.rows()), 2);
    skin.weight.assign(std::size_t(flesh.rest.rows()), 1.0);
    const Weights weights = transfer_weights(flesh, flesh.rest, boundary, skin, 4).weights;
    for (int v = 0; v < flesh.rest.rows(); ++v) {
        EXPECT_FALSE(weights.blended(v));
        EXPECT_EQ(weights.bone[std::size_t(weights.first[std::size_t(v)])], 2);
    }
}

// The unit tet carries one point in its middle.
EmbeddedSurface point_in_the_middle()
{
    EmbeddedSurface surface;
    surface.tet = Eigen::VectorXi::Zero(1);
    surface.barycentric.resize(1, 4);
    surface.barycentric.setConstant(0.25);
    return surface;
}

Weights two_weights(double second)
{
    Weights skin;
    skin.first = {0, 2};
    skin.bone = {0, 1};
    skin.weight = {1.0 - second, second};
    return skin;
}

TEST(CarriedWeight, IsTheOverlapOfTheArtistsWeightsAndThoseOfTheTets)
{
    const TetMesh tet = test_support::unit_tet();
    Weights in_tets;  // three corners follow bone 0, one follows bone 1: a quarter in the middle
    in_tets.first = {0, 1, 2, 3, 4};
    in_tets.bone = {0, 0, 0, 1};
    in_tets.weight = {1, 1, 1, 1};
    const auto share_pct = [&](double of_second) {
        return carried_weight(two_weights(of_second), in_tets, point_in_the_middle(), tet.tets, 3).share_pct();
    };
    EXPECT_DOUBLE_EQ(share_pct(0.25), 100.0);
    EXPECT_DOUBLE_EQ(share_pct(0.75), 50.0);
    in_tets.bone = {2, 2, 2, 2};
    EXPECT_EQ(share_pct(0.25), 0.0);
}

}  // namespace
