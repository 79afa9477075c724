// Reference: the definition on rows of cross-sections, and what diffusion conserves.
#include "pbs/skinning/weights.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using pbs::diffused_weights;

const test_support::TwoBoneLimb straight = test_support::two_bone_limb({16, 3, 3}, pbs::Vec3::UnitZ(), 0.0);

double diffused_weight(const pbs::Weights& weights, int vertex, int bone)
{
    for (int k = weights.first[vertex]; k < weights.first[vertex + 1]; ++k)
        if (weights.bone[k] == bone) return weights.weight[k];
    return 0.0;
}

// The largest difference of the forearm's weight between two ends of an edge.
double largest_jump(const pbs::Weights& weights)
{
    double largest = 0.0;
    for (Eigen::Index t = 0; t < straight.mesh.tets.rows(); ++t)
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                largest = std::max(largest, std::abs(diffused_weight(weights, straight.mesh.tets(t, a), 1) -
                                                     diffused_weight(weights, straight.mesh.tets(t, b), 1)));
    return largest;
}

TEST(DiffusedWeights, AreNotNegativeAndAddUpToOne)
{
    for (const int steps : {0, 1, 8, 100}) {
        const pbs::Weights weights = diffused_weights(straight.mesh, straight.weights, steps);
        ASSERT_EQ(weights.vertices(), straight.mesh.rest.rows());
        for (int v = 0; v < weights.vertices(); ++v) {
            double sum = 0.0;
            for (int k = weights.first[v]; k < weights.first[v + 1]; ++k) {
                EXPECT_GT(weights.weight[k], 0.0);
                sum += weights.weight[k];
            }
            EXPECT_NEAR(sum, 1.0, test_support::mean_error(3, 1.0));
        }
    }
}

TEST(DiffusedWeights, WithoutStepsAreTheGivenOnes)
{
    const pbs::Weights weights = diffused_weights(straight.mesh, straight.weights, 0);
    for (int v = 0; v < weights.vertices(); ++v)
        for (const int bone : {0, 1}) EXPECT_EQ(diffused_weight(weights, v, bone), diffused_weight(straight.weights, v, bone));
}

TEST(DiffusedWeights, OneStepGoesHalfWayToTheMeanOfTheNeighbours)
{
    pbs::TetMesh tet;
    tet.rest = (pbs::Positions(5, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 2, 2).finished();
    tet.tets = (pbs::Tets(1, 4) << 0, 1, 2, 3).finished();
    const pbs::Weights given = {{0, 1, 2, 3, 4, 5}, {0, 1, 1, 1, 0}, {1.0, 1.0, 1.0, 1.0, 1.0}};
    const pbs::Weights weights = diffused_weights(tet, given, 1);
    EXPECT_NEAR(diffused_weight(weights, 0, 0), 0.5, test_support::rounding_error(6, 1.0));
    EXPECT_NEAR(diffused_weight(weights, 1, 0), 0.5 / 3.0, test_support::rounding_error(6, 1.0));
    EXPECT_EQ(diffused_weight(weights, 4, 0), 1.0) << "a vertex without tets keeps its own";
}

// A step takes means, so that the jumps along edges do not grow, and spread over several edges they fall.
TEST(DiffusedWeights, JumpLessFromVertexToVertex)
{
    const double given = largest_jump(straight.weights), once = largest_jump(diffused_weights(straight.mesh, straight.weights, 1)),
                 eight = largest_jump(diffused_weights(straight.mesh, straight.weights));
    EXPECT_EQ(given, 0.5);
    EXPECT_LT(once, given);
    EXPECT_LT(eight, 0.5 * given);
}

}  // namespace
