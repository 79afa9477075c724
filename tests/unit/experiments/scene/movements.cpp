// Reference: the angles of experiments/scenes/movements.toml, measured between the bones at the end of each movement.
#include "experiments/scene/movements.hpp"

#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace experiments;

// A left arm that is abducted by 45 degrees, with an elbow bent forwards by 30 degrees and two bones in the forearm.
pbs::Skeleton bent_arm()
{
    const double s = std::sqrt(0.5), bend = std::numbers::pi / 6.0;
    const pbs::Vec3 down_and_out(s, -s, 0.0),
        forearm = std::cos(bend) * down_and_out + std::sin(bend) * pbs::Vec3::UnitZ();
    const pbs::Vec3 elbow = 0.3 * down_and_out, middle = elbow + 0.1 * forearm, wrist = middle + 0.1 * forearm;
    return {{{"upper_arm.L", -1, pbs::Vec3::Zero(), elbow},
             {"forearm_upper.L", 0, elbow, middle},
             {"forearm_lower.L", 1, middle, wrist},
             {"hand.L", 2, wrist, wrist + 0.1 * forearm}}};
}

pbs::Motion through(const std::vector<std::string>& movements, int frames = 2)
{
    MotionSpec spec;
    spec.movements = movements;
    spec.frames = frames;
    return make_motion(spec, bent_arm(), "scene.toml");
}

pbs::Vec3 direction(const pbs::Pose& pose, int bone)
{
    const pbs::Skeleton skeleton = bent_arm();
    return pose[bone].linear() * (skeleton.bones[bone].tail - skeleton.bones[bone].head).normalized();
}

double angle_deg(const pbs::Vec3& one, const pbs::Vec3& other)
{
    return std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 / std::numbers::pi;
}

TEST(Movements, EndAtTheirRangeFromTheAnatomicalPosition)
{
    const auto elbow_deg = [](const std::string& name) {
        const pbs::Pose end = through({name}).steps.back();
        return angle_deg(direction(end, 0), direction(end, 1));
    };
    EXPECT_NEAR(elbow_deg("elbow_flexion"), 142.9, 1e-9);
    EXPECT_NEAR(elbow_deg("elbow_extension"), 0.0, 1e-5);  // an angle of 0 has the square root of the rounding
    const pbs::Vec3 raised = direction(through({"shoulder_abduction"}).steps.back(), 0);
    EXPECT_NEAR(std::atan2(raised.x(), -raised.y()) * 180.0 / std::numbers::pi, 184.0 - 360.0, 1e-9);
    EXPECT_NEAR(angle_deg(direction(through({"shoulder_adduction"}).steps.back(), 0), -pbs::Vec3::UnitY()), 0.0, 1e-5);
}

TEST(Movements, ATwistIsDividedAmongItsJointsAndTurnsNoBone)
{
    const pbs::Motion motion = through({"pronation"}, 3);
    ASSERT_EQ(motion.frames(), 4) << "the rest pose and three frames";
    for (const int bone : {1, 2, 3}) {
        const Eigen::AngleAxisd turned(motion.steps.back()[bone].linear());
        EXPECT_NEAR(turned.angle() * 180.0 / std::numbers::pi, 75.8 * bone / 3.0, 1e-9);
        EXPECT_NEAR(turned.axis().dot(direction(motion.steps.front(), 1)), 1.0, 1e-12);
    }
    EXPECT_TRUE(motion.steps[2][1].linear().isApprox(
        Eigen::AngleAxisd(2.0 / 3.0 * 75.8 / 3.0 * std::numbers::pi / 180.0, direction(motion.steps.front(), 1))
            .toRotationMatrix()));
    EXPECT_TRUE(is_twist("pronation") && is_twist("supination_at_the_wrist"));
    EXPECT_FALSE(is_twist("elbow_flexion") || is_twist("elbow_flexion+supination"));
    EXPECT_EQ(joints_of("hip_flexion+knee_flexion"), (std::vector<std::string>{"thigh.L", "shin.L"}));
}

// The second movement of a joint is carried by the first: a supination turns the forearm about itself, however far the
// elbow is bent.
TEST(Movements, APairTurnsBothAndEachMovementBeginsAtRest)
{
    const pbs::Motion motion = through({"elbow_flexion", "elbow_flexion+supination", "elbow_flexion+wrist_flexion"});
    ASSERT_EQ(motion.steps.size(), 7u);
    const pbs::Pose &half = motion.steps[1], &bent = motion.steps[2];
    EXPECT_TRUE(half[1].isApprox(motion.steps[5][1])) << "half of the flexion, whatever came before";
    for (const int bone : {1, 2, 3}) {
        EXPECT_TRUE(direction(motion.steps[4], bone).isApprox(direction(bent, bone))) << bone;
        const Eigen::AngleAxisd turned(bent[bone].linear().transpose() * motion.steps[4][bone].linear());
        EXPECT_NEAR(turned.angle() * 180.0 / std::numbers::pi, 82.1 * bone / 3.0, 1e-9);
    }
    EXPECT_NEAR(angle_deg(direction(motion.steps[6], 1), direction(motion.steps[6], 3)), 76.4, 1e-9)
        << "the axis is across the hand";
}

// Signs of the left side: x to the left, y upwards, z forwards.
TEST(Movements, GoTheWayThatTheirNamesSay)
{
    const auto end = [](const std::string& name, int bone) { return direction(through({name}).steps.back(), bone); };
    const double rest_z = direction(through({"elbow_flexion"}).steps.front(), 1).z();
    EXPECT_GT(end("shoulder_flexion", 0).y(), 0.9) << "166.7 degrees forwards from hanging";
    EXPECT_GT(through({"shoulder_flexion"}).steps[1][0].linear().col(1).norm(), 0.0);
    EXPECT_GT(direction(through({"shoulder_flexion"}).steps[1], 0).z(), 0.7) << "on the way it points forwards";
    EXPECT_LT(end("shoulder_extension", 0).z(), -0.8);
    EXPECT_GT(direction(through({"shoulder_abduction"}).steps[1], 0).x(), 0.9) << "on the way it points to the left";
    EXPECT_GT(direction(through({"elbow_flexion"}).steps[1], 1).z(), rest_z);
    const auto thumb = [](const std::string& name) {  // forwards at rest
        return pbs::Vec3(through({name}).steps.back()[3].linear() * pbs::Vec3::UnitZ());
    };
    EXPECT_LT(thumb("pronation").x(), -0.1) << "inwards";
    EXPECT_GT(thumb("supination").x(), 0.1) << "outwards";
}

TEST(Movements, ABodyHasThoseOfItsJoints)
{
    const std::vector<std::string> names = movements_of(bent_arm());
    EXPECT_EQ(std::count(names.begin(), names.end(), "shoulder_flexion+elbow_flexion"), 1);
    EXPECT_EQ(std::count(names.begin(), names.end(), "knee_flexion"), 0);
    EXPECT_NO_THROW(through(names));
    expect_input_error([] { through({"elbow_flection"}); }, "scene.toml: motion.movements = elbow_flection: ",
                       "no such movement; the nearest is 'elbow_flexion'");
    expect_input_error([] { through({"elbow_flexion+knee_flexion"}); },
                       "scene.toml: motion.movements = knee_flexion: ", "expected a character with the joints shin.L");
}

TEST(Movements, AStraightLimbHasNoAxisAcrossIt)
{
    MotionSpec spec;
    spec.movements = {"elbow_flexion"};
    pbs::Skeleton straight = bent_arm();
    const pbs::Vec3 along = straight.bones[0].tail / 3.0;
    straight.bones[1].tail = straight.bones[1].head + along;
    expect_input_error([&] { make_motion(spec, straight, "scene.toml"); },
                       "scene.toml: motion.movements = elbow_flexion: ",
                       "expected a character that is bent at the joint forearm_upper.L at rest");
}

}  // namespace
