// Reference: bind poses of one or two joints, computed by hand. Tolerances: at most 64 roundings of numbers of at
// most 8.

#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::joint_bound_at;
using test_support::two_joint_rig;

const double bind_rounding = test_support::rounding_error(64, 8.0);

// Three points that follow the first of the given joints.
RigMesh small_mesh(const std::string& name, int node, const std::vector<SkinJoint>& joints)
{
    return {
        name, node, Positions::Identity(3, 3), Triangles{{0, 1, 2}}, joints, test_support::one_joint_each({0, 0, 0})};
}

void expect_rest_points(const RigBinding& binding, std::size_t mesh, const Positions& expected)
{
    const Positions points = rest_points(binding.meshes.at(mesh), binding);
    ASSERT_EQ(points.rows(), expected.rows());
    EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), bind_rounding);
}

Positions moved(const Positions& points, double x, double y, double z)
{
    return points.rowwise() + Eigen::RowVector3d(x, y, z);
}

TEST(RigBinding, RestPointsAreThoseOfTheMeshInMetres)
{
    Rig rig = two_joint_rig();
    rig.unit_m = 0.01;
    const RigBinding binding = bind_rig(rig, nullptr, 50.0);
    EXPECT_EQ(binding.metres_per_unit, 0.5);
    expect_rest_points(binding, 0, 0.5 * rig.meshes[0].points);
    EXPECT_LE((binding.bind.at(1).translation() - Vec3(0.5, 1, 0)).norm(), bind_rounding);
    EXPECT_TRUE(binding.remarks.empty());
}

TEST(RigBinding, TheBindPoseCountsAndIsAttachedWhereTheRootJointRests)
{
    Rig half_round = two_joint_rig(), elsewhere = half_round, identities = half_round;
    const Positions points = half_round.meshes[0].points;
    half_round.nodes[1].rest.rotation = Eigen::Quaterniond(0, 0, 0, 1);  // the elbow rests half round
    expect_rest_points(bind_rig(half_round, nullptr, 1.0), 0, points);
    elsewhere.nodes[0].rest.translation = Vec3(1, 0, 7);
    expect_rest_points(bind_rig(elsewhere, nullptr, 1.0), 0, moved(points, 0, 0, 7));
    // Identities as inverse bind matrices mean points in the joints' frames, all of which are where the root joint is.
    for (SkinJoint& joint : identities.meshes[0].joints) joint.inverse_bind.setIdentity();
    expect_rest_points(bind_rig(identities, nullptr, 1.0), 0, moved(points, 1, 0, 0));
}

TEST(RigBinding, TheLargestMeshComesFirstAndDeterminesTheBindPose)
{
    Rig rig = two_joint_rig();                                    // 4 points
    rig.nodes[1].rest.rotation = Eigen::Quaterniond(0, 0, 0, 1);  // the rest pose of the elbow does not matter
    rig.nodes.push_back(test_support::rig_node("hand", 1, {0, 1, 0}));
    rig.meshes.insert(rig.meshes.begin(),
                      small_mesh("cuff", 2, {joint_bound_at(1, {1, 2, 3}), joint_bound_at(3, {1, 3, 3})}));
    const RigBinding binding = bind_rig(rig, nullptr, 1.0);
    EXPECT_EQ(binding.meshes[0].name, "arm");
    EXPECT_LE((binding.bind.at(1).translation() - Vec3(1, 2, 0)).norm(), bind_rounding);
    EXPECT_LE((binding.bind.at(3).translation() - Vec3(1, 3, 0)).norm(), bind_rounding);
    // brought to where the larger mesh was bound
    expect_rest_points(binding, 1, moved(rig.meshes[0].points, 0, 0, -3));
}

TEST(RigBinding, BindPosesThatContradictEachOtherAreARemark)
{
    Rig rig = two_joint_rig();
    rig.meshes.push_back(small_mesh("cuff", 2, {joint_bound_at(0, {1, 0, 0}), joint_bound_at(1, {1, 3, 0})}));
    const RigBinding binding = bind_rig(rig, nullptr, 1.0);
    ASSERT_EQ(binding.remarks.size(), 1u);
    EXPECT_NE(binding.remarks[0].find("mesh cuff was bound to 1 of 2 joints in another pose"), std::string::npos)
        << binding.remarks[0];
}

TEST(RigBinding, AMeshWithoutASkinHangsOnTheJointAboveIt)
{
    Rig rig = two_joint_rig();
    rig.nodes.push_back(test_support::rig_node("hand", 1, {0, 1, 0}));
    rig.meshes.push_back(small_mesh("glove", 3, {}));
    const RigBinding binding = bind_rig(rig, nullptr, 1.0);
    ASSERT_EQ(binding.meshes.size(), 2u);
    ASSERT_EQ(binding.meshes[1].joints.size(), 1u);
    EXPECT_EQ(binding.meshes[1].joints[0].node, 1);
    expect_rest_points(binding, 1, moved(rig.meshes[1].points, 1, 3, 0));
}

TEST(RigBinding, AMeshThatNoJointMovesIsLeftOutUnlessThereIsNoJointOrNoOtherMesh)
{
    Rig rig = two_joint_rig(), without_joints = rig, floor_alone = rig;
    rig.meshes.push_back(small_mesh("floor", 2, {}));
    const RigBinding left_out = bind_rig(rig, nullptr, 1.0);
    EXPECT_EQ(left_out.meshes.size(), 1u);
    EXPECT_EQ(left_out.remarks, std::vector<std::string>{"mesh floor is moved by no joint; it is left out"});

    without_joints.animations.clear();
    without_joints.meshes = {small_mesh("statue", 1, {})};
    const RigBinding at_rest = bind_rig(without_joints, nullptr, 1.0);
    ASSERT_EQ(at_rest.meshes.size(), 1u);
    expect_rest_points(at_rest, 0, moved(without_joints.meshes[0].points, 1, 2, 0));

    floor_alone.meshes = {small_mesh("floor", 2, {})};  // the animation moves a node, but no mesh
    expect_input_error([&] { bind_rig(floor_alone, nullptr, 1.0); },
                       "arm.gltf: meshes: ", "expected a mesh that a joint moves");
}

// Reference: the size of a body whose animation scales its root joint is that of the first frame.

Rig with_scaled_root(const Vec3& first)
{
    Rig rig = test_support::two_joint_rig();
    const KeyTrack track{.times_s = {0.0, 1.0}, .values = {{first.x(), first.y(), first.z(), 0}, {9, 9, 9, 0}}};
    rig.animations = {{"Grow", 0.0, 1.0, {{0, {}, {}, track}}}};
    return rig;
}

// The arm below a joint that moves no point and a node, which is none, as converters add them. The skin was bound
// without that node.
Rig below_a_container(const Vec3& scale)
{
    Rig arm = test_support::two_joint_rig(), rig = arm;
    rig.nodes = {test_support::rig_node("reference", -1, {0, 0, 0}), test_support::rig_node("container", 0, {0, 0, 0})};
    rig.nodes[1].rest.scale = scale;
    for (RigNode node : arm.nodes) {
        node.parent = node.parent < 0 ? 1 : node.parent + 2;
        rig.nodes.push_back(node);
    }
    RigMesh& mesh = rig.meshes[0];
    mesh.node += 2;
    mesh.joints = {joint_bound_at(0, {0, 0, 0}), joint_bound_at(2, {1, 0, 0}), joint_bound_at(3, {1, 2, 0})};
    for (int& joint : mesh.skin.bone) ++joint;
    rig.animations[0].nodes[0].node += 2;
    return rig;
}

TEST(ScaledContainer, BelowTheRootJointBelongsToTheRestPoseAsToTheMotion)
{
    const Rig centimetres = below_a_container(Vec3::Constant(0.01));
    for (const RigAnimation* animation : {static_cast<const RigAnimation*>(nullptr), &centimetres.animations[0]}) {
        const RigBinding binding = bind_rig(centimetres, animation, 1.0);
        EXPECT_LE((rest_points(binding.meshes[0], binding) - 0.01 * centimetres.meshes[0].points).cwiseAbs().maxCoeff(),
                  test_support::rounding_error(64, 0.04));
    }
    const RiggedBody body = make_rigged_body(centimetres, &centimetres.animations[0], 1.0);
    double stretch = 0.0;
    rigid_pose(body, node_transforms(centimetres, &centimetres.animations[0], 0.5), &stretch);
    EXPECT_LE(stretch, test_support::rounding_error(64, 1.0));
}

TEST(ScaledContainer, ThatAnAnimationScalesHasTheSizeOfTheFirstFrame)
{
    Rig rig = below_a_container(Vec3::Ones());
    const KeyTrack scale{.times_s = {0.0}, .values = {{0.01, 0.01, 0.01, 0}}};
    rig.animations[0].nodes.push_back({1, {}, {}, scale});
    const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
    EXPECT_LE((rest_points(binding.meshes[0], binding) - 0.01 * rig.meshes[0].points).cwiseAbs().maxCoeff(),
              test_support::rounding_error(64, 0.04));
}

TEST(ScaledContainer, AJointThatIsScaledForItsLooksDoesNotCount)
{
    Rig rig = test_support::two_joint_rig();
    rig.meshes[0].skin.weight = {1.0, 0.6, 0.4, 1.0, 0.6, 0.4};  // 2.2 of 4 on the root
    rig.nodes[1].rest.scale = Vec3::Constant(3.0);
    const RigBinding binding = bind_rig(rig, nullptr, 1.0);
    EXPECT_EQ(rest_points(binding.meshes[0], binding), rig.meshes[0].points);
}

// A mirrored root has the size of its magnitude. The scale is a cubic root of a determinant: some 20 roundings of
// numbers of at most 12.
TEST(ScaledAnimation, TheFirstFrameDeterminesTheSize)
{
    for (const auto& [scale, size] : {std::pair(Vec3(3, 3, 3), 3.0), {Vec3(-2, 2, 2), 2.0}}) {
        const Rig rig = with_scaled_root(scale);
        const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
        EXPECT_LE((rest_points(binding.meshes[0], binding) - size * rig.meshes[0].points).cwiseAbs().maxCoeff(),
                  test_support::rounding_error(64, 4.0 * size));
        EXPECT_EQ(binding.metres_per_unit, 1.0);
    }
}

TEST(ScaledAnimation, AThousandthIsTakenForRoundingAndZeroRefusedByTheNameOfTheJoint)
{
    const Rig rig = with_scaled_root({1.0005, 1.0005, 1.0005}), flat = with_scaled_root({0, 1, 1});
    const RigBinding binding = bind_rig(rig, &rig.animations[0], 1.0);
    EXPECT_EQ(rest_points(binding.meshes[0], binding), bind_rig(rig, nullptr, 1.0).meshes[0].points);
    expect_input_error([&] { bind_rig(flat, &flat.animations[0], 1.0); }, "arm.gltf: scale of root = 0: ", "not zero");
}

// Reference: an elbow that turns half round within 1 s at a constant rate. Angles are in error by some hundred
// roundings.

const double motion_rounding = test_support::rounding_error(512, 8.0);

class RigMotionOfAnElbow : public testing::Test {
protected:
    RigMotion motion(const MotionSampling& sampling) const
    {
        return rig_motion(rig, body, rig.animations[0], sampling);
    }

    Rig rig = test_support::two_joint_rig();
    RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
};

TEST_F(RigMotionOfAnElbow, HasAPosePerTimeStepFromTheFirstKeyToTheLast)
{
    const Motion made = motion({.rate_hz = 4.0, .time_step_s = 0.125}).motion;
    EXPECT_EQ(made.steps_per_frame, 2);
    EXPECT_EQ(made.frames(), 5);
    ASSERT_EQ(made.steps.size(), 9u);
    for (std::size_t step = 0; step < made.steps.size(); ++step) {
        const Eigen::Matrix3d expected(Eigen::AngleAxisd(M_PI * double(step) / 8.0, Vec3::UnitZ()));
        EXPECT_LE((made.steps[step][1].linear() - expected).cwiseAbs().maxCoeff(), motion_rounding) << step;
        EXPECT_LE((made.steps[step][0].matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), motion_rounding)
            << step;
    }
}

TEST_F(RigMotionOfAnElbow, BeginsAfterTheFirstKeyWhereverThatIs)
{
    rig.animations[0].nodes[0].rotation->times_s = {10.0, 11.0};
    rig.animations[0].start_s = 10.0;
    rig.animations[0].end_s = 11.0;
    const Motion made = motion({.start_s = 0.5, .rate_hz = 4.0, .time_step_s = 0.25}).motion;
    EXPECT_EQ(made.frames(), 3);
    EXPECT_LE((made.steps[0][1] * Vec3(1, 4, 0) - Vec3(-1, 2, 0)).norm(), motion_rounding);
}

TEST_F(RigMotionOfAnElbow, ReportsTheStretchThatIsLeftOut)
{
    EXPECT_NEAR(motion({.rate_hz = 4.0, .time_step_s = 0.25}).stretch, 0.0, motion_rounding);
    rig.animations[0].nodes[0].scale = KeyTrack{.times_s = {0.0, 1.0}, .values = {{1, 1, 1, 0}, {1, 1.25, 1, 0}}};
    EXPECT_NEAR(motion({.rate_hz = 4.0, .time_step_s = 0.25}).stretch, 0.25, motion_rounding);
}

TEST_F(RigMotionOfAnElbow, TheArtistsFramesAreThoseOfTheMotion)
{
    const MotionSampling sampling{.start_s = 0.5, .rate_hz = 4.0, .time_step_s = 0.125};
    const Positions frame = artist_frame(rig, body, rig.animations[0], sampling, 2);  // 1 s after the first key
    Positions expected(4, 3);
    expected << 1, 0, 0, 1, 2, 0, 1, 0, 0, 0.5, 2, 0;
    EXPECT_LE((frame - expected).cwiseAbs().maxCoeff(), motion_rounding);
}

TEST_F(RigMotionOfAnElbow, AStretchBeyondTheAnimationIsRefused)
{
    expect_input_error([&] { motion({.start_s = 1.5, .rate_hz = 4.0, .time_step_s = 0.25}); },
                       "arm.gltf: start_s = 1.5", "lasts 1.0");
    expect_input_error([&] { motion({.start_s = 0.5, .duration_s = 0.75, .rate_hz = 4.0, .time_step_s = 0.25}); },
                       "arm.gltf: duration_s = 0.75", "ends at 1.0");
}

TEST_F(RigMotionOfAnElbow, AnAnimationOfASingleKeyHasOneFrame)
{
    rig.animations[0].nodes[0].rotation->times_s = {0.0};
    rig.animations[0].nodes[0].rotation->values.resize(1);
    rig.animations[0].end_s = 0.0;
    EXPECT_EQ(motion({.rate_hz = 4.0, .time_step_s = 0.25}).motion.frames(), 1);
}

}  // namespace
