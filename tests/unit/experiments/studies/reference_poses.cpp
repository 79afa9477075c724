// The poses of the references. Reference: the design of the comparison, counted here, and the angles that the names of
// the limb's poses state.
#include "experiments/studies/reference_poses.hpp"

#include "experiments/characters/bodies.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

namespace reference_poses_tests {
namespace {

using namespace experiments;
using nlohmann::json;

// The cases of poses of all bodies, whether the bodies are installed or not. The cases of correctives have no pose.
const json& listed()
{
    static const json cases = [] {
        json poses = json::array();
        const json document = cases_document("references");
        for (const json& one : document.at("case"))
            if (!one.contains("learned_from")) poses.push_back(one);
        return poses;
    }();
    return cases;
}

TEST(ListedPoses, AreEightMovementsOfEachBodyAndSixForTraining)
{
    std::set<std::string> names;
    std::map<std::string, int> of_stratum, movements_of_body;
    for (const json& pose : listed()) {
        EXPECT_TRUE(names.insert(pose.at("name")).second) << pose.at("name");
        ASSERT_EQ(pose.at("bodies").size(), 1u) << pose.at("name");
        const std::string body = pose.at("bodies")[0], stratum = pose.at("stratum"), name = pose.at("name");
        EXPECT_TRUE(name.starts_with(body + "_")) << name;
        ++of_stratum[stratum];
        if (stratum == "movement") ++movements_of_body[body];
    }
    EXPECT_EQ(of_stratum, (std::map<std::string, int>{{"training", 6}, {"movement", 40}, {"fold", 6}, {"played", 6}}));
    EXPECT_EQ(movements_of_body,
              (std::map<std::string, int>{{"limb", 8}, {"human", 8}, {"man", 8}, {"lady", 8}, {"frankie", 8}}));
}

// Settings are chosen on other poses than methods are compared on.
TEST(ListedPoses, AreEachOneMotionAndFrame)
{
    std::set<std::string> poses;
    for (json pose : listed()) {
        json what = {pose.at("bodies"), pose.value("movement", ""), pose.value("scene", ""),
                     pose.value("overrides", json::array())};
        what.push_back(pose.value("frame", 0));
        EXPECT_TRUE(poses.insert(what.dump()).second) << pose.at("name");
    }
}

TEST(ReferencePoses, AreThoseOfInstalledBodies)
{
    std::set<std::string> names;
    for (const ReferencePose& pose : reference_poses()) {
        EXPECT_TRUE(names.insert(pose.name).second) << pose.name;
        EXPECT_EQ(pose.scene.character.body, pose.of.body) << pose.name;
        if (pose.stratum != Stratum::movement || pose.of.body == "limb") continue;
        ASSERT_EQ(pose.scene.motion.movements.size(), 1u) << pose.name;
        EXPECT_EQ(pose.name, pose.of.body + "_" + pose.scene.motion.movements[0]);
        EXPECT_TRUE(pose.scene.motion.clip.empty()) << pose.name;
        EXPECT_EQ(pose.frame, pose.scene.motion.frames - 1) << "the end of the range";
    }
    for (const json& pose : listed())
        if (pose.at("bodies")[0] == "limb") {
            EXPECT_TRUE(names.contains(pose.at("name"))) << pose.at("name");
        }
}

const ReferencePose& pose_named(const std::string& name)
{
    static const std::vector<ReferencePose> poses = reference_poses();
    return *std::ranges::find(poses, name, &ReferencePose::name);
}

struct LimbAngle {
    const char* name;
    double angle_deg;
    pbs::Vec3 axis;
};

// The forearm turns, and the upper arm does not.
TEST(ReferencePoses, OfTheLimbHaveTheAnglesOfTheirNames)
{
    const pbs::Skeleton limb = pbs::make_character({.body = "limb", .vertices = 300}).skeleton;
    const std::vector<LimbAngle> angles = {
        {"limb_twist_45", 45.0, pbs::Vec3::UnitX()},        {"limb_twist_60", 60.0, pbs::Vec3::UnitX()},
        {"limb_twist_90", 90.0, pbs::Vec3::UnitX()},        {"limb_twist_120", 120.0, pbs::Vec3::UnitX()},
        {"limb_twist_150", 150.0, pbs::Vec3::UnitX()},      {"limb_bend_30", 30.0, pbs::Vec3::UnitZ()},
        {"limb_bend_45", 45.0, pbs::Vec3::UnitZ()},         {"limb_bend_60", 60.0, pbs::Vec3::UnitZ()},
        {"limb_bend_75", 75.0, pbs::Vec3::UnitZ()},         {"limb_bend_90", 90.0, pbs::Vec3::UnitZ()},
        {"limb_bend_sideways_50", 50.0, pbs::Vec3::UnitY()}};
    for (const auto& [name, angle_deg, axis] : angles) {
        const pbs::Pose bones = bones_in(pose_named(name), limb);
        ASSERT_EQ(bones.size(), 2u) << name;
        EXPECT_TRUE(bones[0].isApprox(Eigen::Isometry3d::Identity(), 1e-15)) << name;
        const Eigen::Matrix3d turned = Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, axis).toRotationMatrix();
        EXPECT_LT((bones[1].linear() - turned).norm(), 2.0 * test_support::motion_matrix_error(1, 0.0)) << name;
    }
}

TEST(MembersOfAPose, AreTheWholeFamilyOrTheTwoThatArePlayed)
{
    const auto names = [](Stratum stratum) {
        std::vector<std::string> of;
        for (const EnsembleMember& member : members_of(stratum)) of.push_back(member.name);
        return of;
    };
    EXPECT_EQ(names(Stratum::played), (std::vector<std::string>{"smooth", "rigid_capsules"}));
    for (const Stratum stratum : {Stratum::training, Stratum::movement, Stratum::fold})
        EXPECT_EQ(names(stratum), (std::vector<std::string>{"smooth", "stiffer_springs", "thinner_bones",
                                                            "stiffer_springs_thinner_bones", "nu_0.3", "nu_0.49",
                                                            "rigid_capsules", "held_parts"}));
    EXPECT_EQ(family().size(), 1 + further_members);
}

}  // namespace
}  // namespace reference_poses_tests
