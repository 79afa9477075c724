// Reference: the rules of the header on rigs whose joints and points have round coordinates. Tolerances: at most 64 roundings of numbers of
// at most 8.
#include "pbs/rig/bone_tails.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::rig_node;

const double tail_rounding = test_support::rounding_error(64, 8.0);

struct PlacedJoint {
    std::string name;
    int parent;
    Vec3 place;  // in the scene
};

// A rig of joints in this order and of points that follow one joint each.
Rig rig_with(const std::vector<PlacedJoint>& joints, const std::vector<Vec3>& points, const std::vector<int>& joint_of_point)
{
    Rig rig;
    RigMesh mesh;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto& [name, parent, place] = joints[j];
        rig.nodes.push_back(rig_node(name, parent, parent < 0 ? place : Vec3(place - joints[std::size_t(parent)].place)));
        mesh.joints.push_back(test_support::joint_bound_at(int(j), place));
    }
    rig.nodes.push_back(rig_node("body", -1, Vec3::Zero()));
    mesh.node = int(joints.size());
    mesh.points.resize(Eigen::Index(points.size()), 3);
    for (std::size_t p = 0; p < points.size(); ++p) mesh.points.row(Eigen::Index(p)) = points[p].transpose();
    mesh.triangles = (Triangles(1, 3) << 0, 1, 2).finished();
    mesh.skin = test_support::one_joint_each(joint_of_point);
    rig.meshes = {mesh};
    return rig;
}

Vec3 tail_of(const std::string& name, const Rig& rig)
{
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    return body.skeleton.bones.at(static_cast<std::size_t>(find_bone(body.skeleton, name))).tail;
}

TEST(BoneTails, ABoneEndsAtTheJointBelowIt)
{
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 1});
    EXPECT_LE((tail_of("a", rig) - Vec3(0, 2, 0)).norm(), tail_rounding);
}

TEST(BoneTails, AJointWithoutWeightBelowCountsToo)
{
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"end", 0, {3, 0, 0}}}, {{1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {0, 0, 0});
    EXPECT_LE((tail_of("a", rig) - Vec3(3, 0, 0)).norm(), tail_rounding);
}

TEST(BoneTails, SeveralJointsBelowEndItInTheirMiddle)
{
    const Rig rig =
        rig_with({{"hand", -1, {0, 0, 0}}, {"b", 0, {4, 1, 0}}, {"c", 0, {4, -3, 0}}}, {{1, 0, 0}, {4, 1, 0}, {4, -3, 0}}, {0, 1, 2});
    EXPECT_LE((tail_of("hand", rig) - Vec3(4, -1, 0)).norm(), tail_rounding);
}

TEST(BoneTails, JointsOnOppositeSidesEndItAtTheOneThatMovesMost)
{
    const Rig rig = rig_with({{"hips", -1, {0, 0, 0}}, {"spine", 0, {0, 3, 0}}, {"tail", 0, {0, -3, 0}}},
                             {{0, 0, 1}, {0, 3, 0}, {0, 4, 0}, {0, -3, 0}}, {0, 1, 1, 2});
    EXPECT_LE((tail_of("hips", rig) - Vec3(0, 3, 0)).norm(), tail_rounding);
}

TEST(BoneTails, BelowAJointAtTheSamePlaceTheNextOneCounts)
{
    const Rig rig =
        rig_with({{"a", -1, {0, 0, 0}}, {"twist", 0, {0, 0, 0}}, {"b", 1, {0, 2, 0}}}, {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 2});
    EXPECT_LE((tail_of("a", rig) - Vec3(0, 2, 0)).norm(), tail_rounding);
}

TEST(BoneTails, ANodeWithAMeshIsNoJointBelow)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 1});
    rig.nodes[2].parent = 0;
    rig.nodes[2].rest.translation = Vec3(6, 0, 0);
    EXPECT_LE((tail_of("a", rig) - Vec3(0, 2, 0)).norm(), tail_rounding);
}

TEST(BoneTails, ALeafEndsAtNineTenthsOfTheWayToItsFarthestPoint)
{
    // The middle of its points is at (0, 5, 0), so that it points along y; the farthest one is 4 along y.
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {1, 4, 0}, {-1, 6, 0}}, {0, 1, 1});
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 2 + 0.9 * 4, 0)).norm(), tail_rounding);
}

TEST(BoneTails, PointsThatOthersMoveMoreDoNotLengthenALeaf)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {0, 6, 0}, {0, 9, 0}}, {0, 1, 0});
    rig.meshes[0].skin.first = {0, 1, 2, 4};
    rig.meshes[0].skin.bone = {0, 1, 0, 1};
    rig.meshes[0].skin.weight = {1.0, 1.0, 0.75, 0.25};
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 2 + 0.9 * 4, 0)).norm(), tail_rounding);
}

TEST(BoneTails, ALeafWhosePointsSayNothingGoesOnAsItsParent)
{
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {3, 0, 0}}}, {{0, 1, 0}, {0, -1, 0}, {3, 0, 0}}, {0, 0, 1});
    EXPECT_LE((tail_of("b", rig) - Vec3(3 + 0.3 * 3, 0, 0)).norm(), tail_rounding);  // three tenths of its parent's length
}

TEST(BoneTails, ASingleJointAmongItsPointsStillHasALength)
{
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}}, {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}, {0, 0, 0, 0});
    EXPECT_GT(tail_of("a", rig).norm(), 0.1);
    EXPECT_TRUE(tail_of("a", rig).allFinite());
}

TEST(BoneTails, AreThoseOfTheBindPoseNotOfTheRestPose)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}, {"end", 1, {0, 4, 0}}}, {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 1});
    rig.nodes[1].rest.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()));
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 4, 0)).norm(), tail_rounding);
    rig.meshes[0].joints.pop_back();  // `end` is no joint of the skin: it keeps its place relative to b
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 4, 0)).norm(), tail_rounding);
}

// Tails move with a body that is moved as a whole, and grow with it.
TEST(BoneTails, MoveAndScaleWithTheRig)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Rig rig = rig_with({{"a", -1, scale * Vec3(5, 0, 0)}, {"b", 0, scale * Vec3(5, 2, 0)}},
                                 {scale * Vec3(5, 1, 0), scale * Vec3(6, 4, 0), scale * Vec3(4, 6, 0)}, {0, 1, 1});
        EXPECT_LE((tail_of("b", rig) / scale - Vec3(5, 5.6, 0)).norm(), 2.0 * tail_rounding) << scale;
    }
}

}  // namespace
