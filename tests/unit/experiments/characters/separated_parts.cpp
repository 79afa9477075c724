// Reference: which parts of the models below move apart is known from how they are made.
#include "experiments/characters/separated_parts.hpp"

#include "experiments/characters/skinning_weights.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

// Two boxes side by side along x, 0.1 m wide, with a gap between them. One piece of flesh fills both and the gap.
// `left` moves the points of the one box and `right` those of the other; both hang from `hip`, which is 1 m above.
struct TwoShoes {
    static constexpr double width_m = 0.1;
    RiggedBody body;
    TetMesh flesh;

    explicit TwoShoes(double gap_m = 0.004)
        : flesh(test_support::structured_bar({0, 0, 0}, {2 * width_m + gap_m, 0.1, 0.2}, {7, 4, 5}))
    {
        const double second_m = width_m + gap_m;
        body.skeleton.bones = {{"hip", -1, Vec3(second_m, 1.0, 0.0), Vec3(second_m, 1.2, 0.0)},
                               {"left", 0, Vec3(0.05, 0.05, 0.02), Vec3(0.05, 0.05, 0.18)},
                               {"right", 0, Vec3(second_m + 0.05, 0.05, 0.02), Vec3(second_m + 0.05, 0.05, 0.18)}};
        body.skin.first = {0};
        add_box(0.0, 1);
        add_box(second_m, 2);
    }

    void add_box(double from_m, int bone)
    {
        const TetMesh box = test_support::structured_bar({from_m, 0, 0}, {from_m + width_m, 0.1, 0.2}, {4, 4, 5});
        const Eigen::Index points = body.surface.rows(), triangles = body.triangles.rows();
        const Triangles boundary = boundary_of(box.tets);
        body.surface.conservativeResize(points + box.rest.rows(), 3);
        body.surface.bottomRows(box.rest.rows()) = box.rest;
        body.triangles.conservativeResize(triangles + boundary.rows(), 3);
        body.triangles.bottomRows(boundary.rows()) = boundary.array() + static_cast<int>(points);
        for (Eigen::Index v = 0; v < box.rest.rows(); ++v) {
            body.skin.add(bone, 1.0);
            body.skin.end_vertex();
        }
    }

    SeparatedFlesh separated() const { return separate_parts(flesh, SkinParts(body, {}), body.skeleton); }
};

TEST(SeparatedParts, TwoShoesAreCutApartAndNothingIsLost)
{
    const TwoShoes shoes;
    const SeparatedFlesh made = shoes.separated();
    ASSERT_EQ(made.cuts.size(), 1u);
    EXPECT_EQ(made.cuts[0].first, 1);
    EXPECT_EQ(made.cuts[0].second, 2);
    EXPECT_GE(made.cuts[0].area_m2, 0.1 * 0.2 * (1.0 - 1e-12));  // at least the section, since faces are oblique to it
    const std::vector<int> part = parts_of(made.mesh.tets);
    EXPECT_EQ(*std::ranges::max_element(part), 1);
    EXPECT_EQ(made.mesh.tets.rows(), shoes.flesh.tets.rows());
    EXPECT_GT(made.mesh.rest.rows(), shoes.flesh.rest.rows());
    const Eigen::VectorXd before = tet_volumes(shoes.flesh.rest, shoes.flesh.tets),
                          after = tet_volumes(made.mesh.rest, made.mesh.tets);
    EXPECT_EQ((before - after).cwiseAbs().maxCoeff(), 0.0);
}

// Under linear blend skinning the points of each box move exactly with its bone, as the artist moves them.
TEST(SeparatedParts, TheSurfaceFollowsItsOwnBone)
{
    const TwoShoes shoes;
    const SkinParts parts(shoes.body, {});
    const SeparatedFlesh made = separate_parts(shoes.flesh, parts, shoes.body.skeleton);
    const auto skin_of = [&](int tet) { return made.skin_of_tet[static_cast<std::size_t>(tet)]; };
    const EmbeddedSurface surface =
        embed(shoes.body.surface, shoes.body.triangles, made.mesh,
              [&](Eigen::Index point, int tet) { return !parts.are_apart(parts.at_vertex(point), skin_of(tet)); });
    const TransferredWeights moved = transfer_weights(
        made.mesh, shoes.body.surface, shoes.body.triangles, shoes.body.skin, 3,
        [&](Eigen::Index v, const SurfacePoint& point) { return !parts.are_apart(skin_of(made.tet_at(v)), point); });
    const CarriedWeight weight = carried_weight(shoes.body.skin, moved.weights, surface, made.mesh.tets, 3);
    EXPECT_NEAR(weight.share_pct(), 100.0, 1e-4);  // weights below 1e-6 are removed
}

TEST(SeparatedParts, WithoutTheCutTheSurfaceDoesNotFollow)
{
    const TwoShoes shoes;
    const EmbeddedSurface surface = embed(shoes.body.surface, shoes.body.triangles, shoes.flesh);
    const TransferredWeights moved =
        transfer_weights(shoes.flesh, shoes.body.surface, shoes.body.triangles, shoes.body.skin, 3);
    EXPECT_LT(carried_weight(shoes.body.skin, moved.weights, surface, shoes.flesh.tets, 3).share_pct(), 99.0);
}

TEST(SeparatedParts, PartsThatTouchAreCutAsWell)
{
    EXPECT_EQ(TwoShoes(0.0).separated().cuts.size(), 1u);
}

// The same bone moves both boxes.
TEST(SeparatedParts, WhatMovesTogetherStaysInOnePiece)
{
    TwoShoes shoes;
    std::ranges::fill(shoes.body.skin.bone, 1);
    const SeparatedFlesh made = shoes.separated();
    EXPECT_TRUE(made.cuts.empty());
    EXPECT_EQ(made.mesh.rest, shoes.flesh.rest);
    EXPECT_EQ(made.mesh.tets, shoes.flesh.tets);
}

// A thin plate whose two sides follow two bones: only the way round its rim joins them. The ways from a point are kept
// for the next question.
TEST(SeparatedParts, AnswerTheSameWhateverWasAskedBefore)
{
    TwoShoes shoes;
    const TetMesh plate = test_support::structured_bar({0, 0, 0}, {0.2, 0.004, 0.2}, {8, 1, 8});
    shoes.body.surface = plate.rest;
    shoes.body.triangles = boundary_of(plate.tets);
    shoes.body.skin = {};
    shoes.body.skin.first = {0};
    for (Eigen::Index v = 0; v < plate.rest.rows(); ++v) {
        shoes.body.skin.add(plate.rest(v, 1) > 0.0 ? 2 : 1, 1.0);
        shoes.body.skin.end_vertex();
    }
    const SkinParts asked_before(shoes.body, {});
    int apart = 0, together = 0;
    for (Eigen::Index a = 0; a < plate.rest.rows(); a += 23)
        for (Eigen::Index k = 0; k < plate.rest.rows(); ++k) {
            const Eigen::Index b = (7 * k) % plate.rest.rows();
            const SkinParts fresh(shoes.body, {});
            const bool are_apart = fresh.are_apart(fresh.at_vertex(a), fresh.at_vertex(b));
            (are_apart ? apart : together) += 1;
            EXPECT_EQ(asked_before.are_apart(asked_before.at_vertex(a), asked_before.at_vertex(b)), are_apart)
                << a << " " << b;
        }
    EXPECT_GT(apart, 5);
    EXPECT_GT(together, 20);
}

// One box whose weights jump from bone to bone: the skin is continuous there.
TEST(SeparatedParts, AJointStaysWhole)
{
    TwoShoes shoes;
    shoes.body.surface = shoes.flesh.rest;
    shoes.body.triangles = boundary_of(shoes.flesh.tets);
    shoes.body.skin = Weights{{0}, {}, {}};
    for (Eigen::Index v = 0; v < shoes.flesh.rest.rows(); ++v) {
        shoes.body.skin.add(shoes.flesh.rest(v, 0) < 0.102 ? 1 : 2, 1.0);
        shoes.body.skin.end_vertex();
    }
    EXPECT_TRUE(shoes.separated().cuts.empty());
}

TEST(SeparatedParts, APieceWithoutABoneIsNotCutOff)
{
    TwoShoes shoes;
    for (Vec3* end : {&shoes.body.skeleton.bones[2].head, &shoes.body.skeleton.bones[2].tail}) (*end)(1) += 1.0;
    const SeparatedFlesh made = shoes.separated();
    EXPECT_TRUE(made.cuts.empty());
    EXPECT_EQ(made.mesh.rest, shoes.flesh.rest);
}

}  // namespace
