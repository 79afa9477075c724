// Reference: harmonic functions of one coordinate are linear in it, and linear elements represent those exactly.
#include "pbs/skinning/weights.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::harmonic_weights;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {10, 2, 2});

double weight_of(const pbs::Weights& weights, int vertex, int bone)
{
    for (int k = weights.first[vertex]; k < weights.first[vertex + 1]; ++k)
        if (weights.bone[k] == bone) return weights.weight[k];
    return 0.0;
}

// Whole cross-sections are gripped beyond x = 0.2 and x = 0.7. The term that keeps the matrix L regular, 1e-9 of its diagonal D, changes
// the weights by at most 1e-9 max(L^-1 D 1), by the maximum principle. With w the weight of the edges along x at a vertex and h the cell,
// L f = w h^2 for f = (x - 0.2) (0.7 - x) / 2, and D <= 10 w in cubes of six tets, whose edges have a weight of h / 6 or h / 3. Rounding is
// a millionth of that.
TEST(HarmonicWeights, AreLinearBetweenGrippedCrossSections)
{
    std::vector<int> gripping(bar.rest.rows(), -1);
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) {
        if (bar.rest(v, 0) < 0.2 + 1e-9) gripping[v] = 0;
        if (bar.rest(v, 0) > 0.7 - 1e-9) gripping[v] = 1;
    }
    const pbs::Weights weights = harmonic_weights(bar, gripping, 2);
    const double of_regularity = 1e-9 * 10.0 * (0.5 * 0.5 / 8.0) / (0.1 * 0.1);
    for (int v = 0; v < bar.rest.rows(); ++v) {
        const double expected = std::clamp((bar.rest(v, 0) - 0.2) / 0.5, 0.0, 1.0);
        EXPECT_NEAR(weight_of(weights, v, 1), expected, of_regularity);
        EXPECT_NEAR(weight_of(weights, v, 0) + weight_of(weights, v, 1), 1.0, test_support::mean_error(2, 1.0));
    }
}

TEST(HarmonicWeights, APartThatNothingGripsGoesWithTheFirstBone)
{
    const pbs::Weights weights = harmonic_weights(bar, std::vector<int>(bar.rest.rows(), -1), 2);
    for (int v = 0; v < bar.rest.rows(); ++v) EXPECT_EQ(weight_of(weights, v, 0), 1.0);
}

}  // namespace
