// Reference: rows of weights written by hand.
#include "pbs/skinning/blend.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::PackedWeights;
using pbs::Weights;

// Vertices 0, 3: only bone 2; 1, 4: equal parts of 0 and 1; 2: its own row, whose second bone has the largest weight.
const Weights five_vertices = {{0, 1, 3, 5, 6, 8}, {2, 0, 1, 0, 1, 2, 0, 1}, {1.0, 0.5, 0.5, 0.25, 0.75, 1.0, 0.5, 0.5}};

using Kind = pbs::VertexStretch::Kind;

void expect_stretch(const pbs::VertexStretch& stretch, Kind kind, int first, int last)
{
    EXPECT_EQ(stretch.kind, kind);
    EXPECT_EQ(stretch.first, first);
    EXPECT_EQ(stretch.last, last);
}

void append_rigid(Weights& weights, int bone)
{
    weights.bone.push_back(bone);
    weights.weight.push_back(1.0);
    weights.first.push_back(static_cast<int>(weights.bone.size()));
}

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
    EXPECT_EQ(packed.matrix[1], 3);  // after the three bones
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
    expect_stretch(stretches[0], Kind::matrix_each, 0, 2);
    expect_stretch(stretches[1], Kind::own_rows, 2, 3);
    expect_stretch(stretches[2], Kind::matrix_each, 3, 5);
}

TEST(PackedWeights, ManyVerticesOfOneMatrixAreAStretchOfTheirOwn)
{
    Weights weights = {{0}, {}, {}};
    for (int vertex = 0; vertex < 300; ++vertex) append_rigid(weights, vertex < 100 ? vertex % 2 : vertex < 200 ? 2 : 3);
    const auto stretches = pbs::pack_weights<double>(weights).stretches;
    ASSERT_EQ(stretches.size(), 3U);
    expect_stretch(stretches[0], Kind::matrix_each, 0, 100);
    expect_stretch(stretches[1], Kind::one_matrix, 100, 200);
    expect_stretch(stretches[2], Kind::one_matrix, 200, 300);
}

TEST(PackedWeights, TheHeaviestBoneIsThePivotAndEachPairStandsOnce)
{
    const auto bones = pbs::pack_weights<double>(five_vertices).turned_bones;
    EXPECT_EQ(bones, (std::vector<pbs::TurnedBone>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));  // the first of equal weights; then vertex 2's
}

TEST(PackedWeights, WeightsOfZeroAreLeftOut)
{
    const PackedWeights<double> packed = pbs::pack_weights<double>({{0, 3, 5}, {0, 1, 2, 1, 4}, {0.0, 0.5, 0.5, 0.0, 1.0}});
    EXPECT_EQ(packed.own.bone, (std::vector<int>{1, 2}));
    EXPECT_EQ(packed.matrix[1], 4);  // one bone remains, so it moves the vertex rigidly
}

TEST(PackedWeights, RowsInAnotherOrderAreOthers)  // sums in another order are rounded differently
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
