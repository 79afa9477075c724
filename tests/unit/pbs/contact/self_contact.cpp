// Reference: every skin vertex tried in every tet, and every triangle of the rest skin. Tolerances: both sides compute
// in double, and a point is sought in a tet by some fifty roundings.
#include "pbs/contact/self_contact.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/overlapping_blocks.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <set>

namespace self_contact_tests {
namespace {

using namespace test_support;
using pbs::Positions;
using pbs::Vec3;
using Pairs = std::set<std::array<int, 5>>;

const TwoBoneLimb limb = two_bone_limb({28, 6, 6}, Vec3::UnitZ(), 140.0);  // more groups of vertices than a cluster has
// Without its symmetry, which puts vertices on faces of tets.
const Positions bent = [] {
    RandomPoints random(3);
    Positions x = limb.lbs;
    for (auto row : x.rowwise()) row += random.point(1e-3).transpose();
    return x;
}();
const OverlappingBlocks blocks = overlapping_blocks(0.1);

template <typename Scalar = double>
std::vector<pbs::DepthConstraint<Scalar>> found(const pbs::TetMesh& mesh, const Positions& x)
{
    pbs::SelfContact<Scalar> contact(mesh, in_order(mesh.rest.rows()), 3);
    contact.find(Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>(x.cast<Scalar>()).data());
    return contact.constraints();
}

Pairs pairs(const auto& constraints)
{
    Pairs pairs;
    for (const auto& constraint : constraints) EXPECT_TRUE(pairs.insert(constraint.vertex).second);  // each once
    return pairs;
}

Pairs by_trying_all(const pbs::TetMesh& mesh, const Positions& x)
{
    const double half_edge_m = mean_edge_m(mesh) / 2.0;
    const std::vector<bool> on_skin = pbs::boundary_vertices(mesh.tets, x.rows());
    Pairs pairs;
    for (const auto tet : mesh.tets.rowwise()) {
        Eigen::Matrix4d corners, rest_corners;
        for (int i = 0; i < 4; ++i) {
            corners.col(i) << x.row(tet(i)).transpose(), 1.0;
            rest_corners.col(i) << mesh.rest.row(tet(i)).transpose(), 1.0;
        }
        if (!(corners.determinant() < 0.0)) continue;  // so that the tet is neither flat nor mirrored
        for (int v = 0; v < x.rows(); ++v) {
            const Eigen::Vector4d beta =
                corners.inverse() * (Eigen::Vector4d() << x.row(v).transpose(), 1.0).finished();
            const Vec3 rest = (rest_corners * beta).head<3>();
            if (on_skin[v] && beta.minCoeff() >= 0.0 && (rest - mesh.rest.row(v).transpose()).norm() > half_edge_m)
                pairs.insert({v, tet(0), tet(1), tet(2), tet(3)});
        }
    }
    return pairs;
}

TEST(SelfContact, FindsWhatTryingAllPairsFinds)
{
    const Pairs of_blocks = by_trying_all(blocks.mesh, blocks.pushed);
    EXPECT_EQ(pairs(found(blocks.mesh, blocks.pushed)), of_blocks);
    EXPECT_GE(of_blocks.size(), 9u);

    const Pairs of_limb = by_trying_all(limb.mesh, bent);
    EXPECT_EQ(pairs(found(limb.mesh, bent)), of_limb);
    EXPECT_GE(of_limb.size(), 50u);
}

// The bodies have 4,960 skin vertices, more than sixteen clusters hold.
TEST(SelfContact, FindsInEachOfManyBodiesWhatItFindsInOne)
{
    constexpr int bodies = 40;
    const auto V = int(blocks.mesh.rest.rows()), T = int(blocks.mesh.tets.rows());
    pbs::TetMesh many{blocks.mesh.rest.replicate<bodies, 1>(), blocks.mesh.tets.replicate<bodies, 1>()};
    Positions pushed = blocks.pushed.replicate<bodies, 1>();
    const Pairs in_one = pairs(found(blocks.mesh, blocks.pushed));
    Pairs in_each;
    for (int k = 0; k < bodies; ++k) {
        for (Positions* x : {&many.rest, &pushed}) x->middleRows(k * V, V).col(0).array() += 2.0 * k;
        many.tets.middleRows(k * T, T).array() += k * V;
        for (const auto& [v, a, b, c, d] : in_one)
            in_each.insert({v + k * V, a + k * V, b + k * V, c + k * V, d + k * V});
    }
    EXPECT_EQ(pairs(found(many, pushed)), in_each);
    EXPECT_EQ(pairs(found<float>(many, pushed)), in_each);
}

TEST(SelfContact, FindsNothingAtRestInRigidMotionAndInFlesh)
{
    EXPECT_TRUE(found(limb.mesh, limb.mesh.rest).empty());
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Positions turned = (limb.mesh.rest * turn.transpose()).rowwise() + Eigen::RowVector3d(100, -50, 20);
    EXPECT_TRUE(found(limb.mesh, turned).empty());
    Positions sheared = limb.mesh.rest;
    sheared.col(0) += 0.7 * sheared.col(1);
    EXPECT_TRUE(found(limb.mesh, sheared).empty());
}

TEST(SelfContact, DepthAndDirectionAreThoseOfTheNearestSkin)
{
    int of_second = 0;
    for (const auto& constraint : found(blocks.mesh, blocks.pushed)) {
        // the pushed block's own skin is not flat around its corners
        if (constraint.vertex[0] < blocks.vertices_of_first) continue;
        ++of_second;
        EXPECT_NEAR(constraint.depth, 0.1, rounding_error(50.0, 4.0));
        EXPECT_LE((constraint.m - Vec3::UnitZ()).norm(), rounding_error(50.0, 40.0));
    }
    EXPECT_GE(of_second, 9);
}

TEST(SelfContact, PartsNearerThanHalfAnEdgeAtRestAreNotInContact)
{
    const auto vertices_in_flesh = [](double gap_m) {  // at rest; the block is pushed to the same place, 0.1 m deep
        OverlappingBlocks near = blocks;
        near.mesh.rest.bottomRows(near.mesh.rest.rows() - near.vertices_of_first).col(2).array() -= 2.0 - gap_m;
        return found(near.mesh, near.pushed).size();
    };
    const double threshold_m = mean_edge_m(blocks.mesh) / 2.0;
    EXPECT_EQ(vertices_in_flesh(0.9 * threshold_m - 0.1), 0u);
    EXPECT_EQ(vertices_in_flesh(1.1 * threshold_m - 0.1), found(blocks.mesh, blocks.pushed).size());
}

TEST(RestSkin, FindsTheNearestPointOfABox)
{
    const pbs::TetMesh box = structured_bar({0, 0, 0}, {3, 2, 1}, {6, 4, 2});
    const pbs::RestSkin skin(box);
    const Vec3 size(3, 2, 1);
    RandomPoints random(11);
    for (int t = 0; t < box.tets.rows(); ++t) {
        const Eigen::Vector4i tet = box.tets.row(t);
        const Vec3 point = box.rest(tet, Eigen::all).colwise().mean().transpose() + random.point(0.02);
        const double depth = std::min(point.minCoeff(), (size - point).minCoeff());
        const double found = (skin.nearest(point, tet) - point).norm(), rounding = rounding_error(50.0, 4.0);
        EXPECT_GE(found, depth - rounding);
        // in the middle, two sides are almost as near
        EXPECT_LE(found, depth < 0.3 ? depth + rounding : 1.1 * depth) << depth;
    }
}

// Named degenerate states: what cannot be trusted gives no constraint, and no state gives one that is not finite.
TEST(SelfContact, CollapsedMirroredTornAndNotFiniteStatesGiveFiniteConstraints)
{
    const Positions& rest = limb.mesh.rest;
    Positions point = Positions::Constant(rest.rows(), 3, 0.5), plane = rest, mirrored = rest, teleported = limb.lbs,
              not_finite = bent;
    plane.col(2).setZero();
    mirrored.col(1) *= -1.0;
    for (Eigen::Index v = 0; v < rest.rows(); v += 7) teleported.row(v).array() += 1e3;
    for (Eigen::Index v = 0; v < rest.rows(); v += 5) not_finite(v, v % 3) = v % 2 ? NAN : INFINITY;
    Positions infinite = rest;
    for (Eigen::Index v = 0; v < rest.rows(); ++v) infinite.row(v).setConstant(v % 2 ? INFINITY : -INFINITY);
    RandomPoints random(5);
    Positions shaken = rest;
    for (auto row : shaken.rowwise()) row += random.point(10.0).transpose();
    for (const Positions& x : {point, plane, mirrored, infinite}) EXPECT_TRUE(found(limb.mesh, x).empty());
    Pairs finite = pairs(found(limb.mesh, bent));
    std::erase_if(finite, [](const auto& pair) { return std::ranges::any_of(pair, [](int v) { return v % 5 == 0; }); });
    EXPECT_GE(finite.size(), 9u);
    EXPECT_EQ(pairs(found(limb.mesh, not_finite)), finite);
    for (const Positions& x : {teleported, shaken})
        for (const auto& constraint : found(limb.mesh, x)) {
            EXPECT_TRUE(std::isfinite(constraint.depth));
            EXPECT_GT(constraint.m.norm(), 0.1);
            EXPECT_LT(constraint.m.norm(), 10.0);
        }
}

TEST(SelfContact, FindsTheSamePairsAtEveryScaleAndInBothPrecisions)
{
    const Pairs at_one = pairs(found(limb.mesh, bent));
    for (const double scale : {1e-3, 1e3})
        EXPECT_EQ(pairs(found({scale * limb.mesh.rest, limb.mesh.tets}, scale * bent)), at_one) << scale;
    EXPECT_EQ(pairs(found<float>(blocks.mesh, blocks.pushed)), pairs(found(blocks.mesh, blocks.pushed)));
}

TEST(SelfContact, MeshWithoutTetsHasNone)
{
    for (const int vertices : {0, 3})
        EXPECT_TRUE(found({Positions::Zero(vertices, 3), pbs::Tets(0, 4)}, Positions::Zero(vertices, 3)).empty());
}

}  // namespace
}  // namespace self_contact_tests
