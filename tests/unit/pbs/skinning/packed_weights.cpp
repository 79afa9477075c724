// Truth: rows of weights written down by hand.
#include "pbs/skinning/packed_weights.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::PackedWeights;
using pbs::Weights;

// Vertices 0, 3: bone 2 alone; 1, 4: half and half of 0 and 1; 2: a row of its own, its second bone the heaviest.
const Weights five_vertices = {{0, 1, 3, 5, 6, 8}, {2, 0, 1, 0, 1, 2, 0, 1}, {1.0, 0.5, 0.5, 0.25, 0.75, 1.0, 0.5, 0.5}};

TEST(PackedWeights, AVertexOfOneBoneIsMovedByItsMatrix)
{
    const PackedWeights<double> packed = pbs::pack_weights<double>(five_vertices);
    EXPECT_EQ(packed.bones, 3);
    EXPECT_EQ(packed.matrix[0], 2);
    EXPECT_EQ(packed.matrix[3], 2);
}

TEST(PackedWeights, VerticesOfEqualRowsShareOne)
{
    const PackedWeights<double> packed = pbs::pack_weights<double>(five_vertices);
    EXPECT_EQ(packed.shared.rows(), 1);
    EXPECT_EQ(packed.shared.bone, (std::vector<int>{0, 1}));
    EXPECT_EQ(packed.matrix[1], 3);  // behind the three bones
    EXPECT_EQ(packed.matrix[4], 3);
}

TEST(PackedWeights, ARowOfOneVertexIsItsOwn)
{
    const PackedWeights<float> packed = pbs::pack_weights<float>(five_vertices);
    EXPECT_EQ(packed.matrix[2], -1);
    EXPECT_EQ(packed.own.rows(), 1);
    EXPECT_EQ(packed.own.weight, (std::vector<float>{0.25F, 0.75F}));
}

TEST(PackedWeights, StretchesCoverTheVerticesInOrder)
{
    const auto stretches = pbs::pack_weights<double>(five_vertices).stretches;
    ASSERT_EQ(stretches.size(), 3U);
    EXPECT_EQ(std::tie(stretches[0].first, stretches[0].last, stretches[0].own_row), std::make_tuple(0, 2, -1));
    EXPECT_EQ(std::tie(stretches[1].first, stretches[1].last, stretches[1].own_row), std::make_tuple(2, 3, 0));
    EXPECT_EQ(std::tie(stretches[2].first, stretches[2].last, stretches[2].own_row), std::make_tuple(3, 5, -1));
}

TEST(PackedWeights, TheHeaviestBoneIsThePivotAndEachPairStandsOnce)
{
    const auto bones = pbs::pack_weights<double>(five_vertices).turned_bones;
    EXPECT_EQ(bones, (std::vector<pbs::TurnedBone>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));  // the first of equals; then vertex 2's
}

TEST(PackedWeights, WeightsOfZeroAreLeftOut)
{
    const PackedWeights<double> packed = pbs::pack_weights<double>({{0, 3, 5}, {0, 1, 2, 1, 4}, {0.0, 0.5, 0.5, 0.0, 1.0}});
    EXPECT_EQ(packed.own.bone, (std::vector<int>{1, 2}));
    EXPECT_EQ(packed.matrix[1], 4);  // one bone is left, so it moves the vertex rigidly
}

TEST(PackedWeights, RowsInAnotherOrderAreOthers)  // sums in another order have other roundings
{
    EXPECT_EQ(pbs::pack_weights<double>({{0, 2, 4}, {0, 1, 1, 0}, {0.5, 0.5, 0.5, 0.5}}).own.rows(), 2);
}

TEST(PackedWeights, NoVertices)
{
    const PackedWeights<float> packed = pbs::pack_weights<float>({{0}, {}, {}});
    EXPECT_EQ(packed.bones, 0);
    EXPECT_TRUE(packed.matrix.empty());
    EXPECT_TRUE(packed.stretches.empty());
}

}  // namespace
