// The skin of the exported surface. Reference: the definition in bake.hpp, by hand.
#include "experiments/trial/bake.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

// A point in the middle of a tet has a quarter of the weights of each corner, of which the four heaviest bones remain.
TEST(BakedSurface, HasTheFourHeaviestBonesOfTheTetThatCarriesAPoint)
{
    pbs::Character character;
    character.mesh.rest = pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    character.mesh.tets = pbs::Tets{{0, 1, 2, 3}};
    character.weights.first = {0};
    for (int corner = 0; corner < 4; ++corner) {
        character.weights.add(corner, 0.6);
        character.weights.add(4 + corner / 2, 0.4);
        character.weights.end_vertex();
    }
    character.surface.emplace();
    character.surface->tet = Eigen::VectorXi::Zero(2);
    character.surface->barycentric.resize(2, 4);
    character.surface->barycentric << 0.25, 0.25, 0.25, 0.25, 1.0, 0.0, 0.0, 0.0;
    const pbs::Weights weights = surface_weights(character);
    ASSERT_EQ(weights.first, (std::vector<int>{0, 4, 6}));
    const double rounding = test_support::rounding_error(20, 1.0);
    const double sum = 0.2 + 0.2 + 0.15 + 0.15;  // bones 4 and 5 have 0.4 / 4 twice, the first four 0.6 / 4
    for (const auto& [bone, share] : {std::pair(4, 0.2), std::pair(5, 0.2), std::pair(0, 0.15), std::pair(1, 0.15)})
        EXPECT_NEAR(weights.of(0, bone), share / sum, rounding) << bone;
    EXPECT_NEAR(weights.of(1, 0), 0.6, rounding);
    EXPECT_NEAR(weights.of(1, 4), 0.4, rounding);
}

}  // namespace
