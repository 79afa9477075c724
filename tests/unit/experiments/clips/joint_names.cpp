// Reference: one body of twelve parts whose clip, the same in each scheme, turns one joint per frame. Its names are
// those that CMU, other recordings, Mixamo, Rigify and Unreal's mannequin give to these parts.
#include "experiments/characters/named_bodies.hpp"
#include "experiments/clips/clip.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace {

using namespace pbs;

// The five of the trunk, and seven of the left side.
using Names = std::vector<std::string>;
const Names bones = {"pelvis",      "spine",           "chest",  "neck",    "head",   "clavicle.L",
                     "upper_arm.L", "forearm_upper.L", "hand.L", "thigh.L", "shin.L", "foot.L"};
const std::vector<Names> schemes = {
    {"Hips", "LowerBack", "Spine1", "Neck", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "LeftUpLeg",
     "LeftLeg", "LeftFoot"},
    {"root", "lowerback", "thorax", "lowerneck", "head", "lclavicle", "lhumerus", "lradius", "lwrist", "lfemur",
     "ltibia", "lfoot"},
    {"Hips", "Ab", "Chest", "Neck", "Head", "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftHip",
     "LeftKnee", "LeftAnkle"},
    {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine2", "mixamorig:Neck", "mixamorig:Head",
     "mixamorig:LeftShoulder", "mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand",
     "mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot"},
    {"DEF-spine", "DEF-spine.001", "DEF-spine.003", "DEF-spine.004", "DEF-spine.006", "DEF-shoulder.L",
     "DEF-upper_arm.L", "DEF-forearm.L", "DEF-hand.L", "DEF-thigh.L", "DEF-shin.L", "DEF-foot.L"},
    {"pelvis", "spine_01", "spine_03", "neck_01", "head", "clavicle_l", "upperarm_l", "lowerarm_l", "hand_l", "thigh_l",
     "calf_l", "foot_l"},
    // One scheme in several spellings of the side.
    {"HIPS", "lower_back", "spine1", "neck", "head", "L_Shoulder", "Arm.L", "fore_arm_l", "hand_left", "l-UpLeg",
     "leftleg", "lfoot"},
    {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_Neck", "J_Bip_C_Head", "J_Bip_L_Shoulder",
     "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand", "J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot"},
    {"hips", "spine", "chest", "neck", "head", "leftShoulder", "leftUpperArm", "leftLowerArm", "leftHand",
     "leftUpperLeg", "leftLowerLeg", "leftFoot"},
    {"Hips", "Spine", "Chest", "Neck", "Head", "Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L", "UpperLeg_L",
     "LowerLeg_L", "Foot_L"},
    {"Hips", "Spine", "Chest", "Neck", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "LeftThigh",
     "LeftShin", "LeftFoot"},
    {"hip", "abdomenLower", "chestLower", "neckLower", "head", "lCollar", "lShldrBend", "lForearmBend", "lHand",
     "lThighBend", "lShin", "lFoot"},
    {"hip", "abdomen", "chest", "neck", "head", "lCollar", "lShldr", "lForeArm", "lHand", "lThigh", "lShin", "lFoot"},
    {"Bip01 Pelvis", "Bip01 Spine", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head", "Bip01 L Clavicle", "Bip01 L UpperArm",
     "Bip01 L Forearm", "Bip01 L Hand", "Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot"},
    {"CC_Base_Hip", "CC_Base_Waist", "CC_Base_Spine02", "CC_Base_NeckTwist01", "CC_Base_Head", "CC_Base_L_Clavicle",
     "CC_Base_L_Upperarm", "CC_Base_L_Forearm", "CC_Base_L_Hand", "CC_Base_L_Thigh", "CC_Base_L_Calf",
     "CC_Base_L_Foot"},
    {"Hip", "Ab", "Chest", "Neck", "Head", "LShoulder", "LUArm", "LFArm", "LHand", "LThigh", "LShin", "LFoot"},
    {"Hips", "Chest", "Chest4", "Neck", "Head", "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftHip",
     "LeftKnee", "LeftAnkle"},
    {"Pelvis", "Spine1", "Spine3", "Neck", "Head", "L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist", "L_Hip", "L_Knee",
     "L_Ankle"},
    // What exporters add to every name.
    {"Model_Hips", "Model_Spine", "Model_Spine2", "Model_Neck", "Model_Head", "Model_LeftShoulder", "Model_LeftArm",
     "Model_LeftForeArm", "Model_LeftHand", "Model_LeftUpLeg", "Model_LeftLeg", "Model_LeftFoot"},
    {"Hips_01", "Spine_02", "Spine2_03", "Neck_04", "Head_05", "LeftShoulder_06", "LeftArm_07", "LeftForeArm_08",
     "LeftHand_09", "LeftUpLeg_10", "LeftLeg_11", "LeftFoot_12"}};
constexpr int mixamo = 3, unreal = 5;

std::string other_side(std::string name)
{
    // LUArm
    if (name.starts_with('L') && std::isupper(static_cast<unsigned char>(name[1]))) return name.replace(0, 1, "R");
    for (const auto& [left, right] : {std::pair<std::string, std::string>{"Left", "Right"},
                                      {"left", "right"},
                                      {"_L", "_R"},
                                      {"L_", "R_"},
                                      {" L ", " R "},
                                      {".L", ".R"},
                                      {"_l", "_r"},
                                      {"l", "r"}})
        if (const std::size_t at = name.find(left); at != std::string::npos)
            return name.replace(at, left.size(), right);
    return name;
}

// Depth first, as the columns of a BVH file: the trunk, both arms, both legs.
const std::vector<int> part_of_joint = {0, 1, 2, 3, 4, 5, 6, 7, 8, 5, 6, 7, 8, 9, 10, 11, 9, 10, 11};
const std::vector<int> parent = {-1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 0, 16, 17};

bool is_right(int joint)
{
    return (joint >= 9 && joint < 13) || joint >= 16;
}

Names on_both_sides(const Names& names)
{
    Names all;
    for (int joint = 0; joint < 19; ++joint)
        all.push_back(is_right(joint) ? other_side(names[part_of_joint[joint]]) : names[part_of_joint[joint]]);
    return all;
}

constexpr double turn_deg = 40.0;

std::string joint_text(const Names& names, int joint)
{
    const int part = part_of_joint[joint];
    const double offsets[12][2] = {{0, 0}, {0, 1}, {0, 1}, {0, 2},  {0, 1},  {1, 1},
                                   {1, 0}, {2, 0}, {2, 0}, {1, -1}, {0, -4}, {0, -4}};
    const std::string x = std::to_string((is_right(joint) ? -1 : 1) * offsets[part][0]),
                      y = std::to_string(offsets[part][1]);
    std::string text = (joint == 0 ? "ROOT " : "JOINT ") + names[joint] + "\n{\nOFFSET " + x + " " + y +
                       " 0\nCHANNELS " + (joint == 0 ? "6 Xposition Yposition Zposition " : "3 ") +
                       "Zrotation Xrotation Yrotation\n";
    bool is_end = true;
    for (int child = joint + 1; child < static_cast<int>(parent.size()); ++child)
        if (parent[child] == joint) {
            text += joint_text(names, child);
            is_end = false;
        }
    return text + (is_end ? "End Site\n{\nOFFSET 0 0 1\n}\n}\n" : "}\n");
}

// Two frames at rest, and one per joint of `names`.
Clip clip_of(const Names& names)
{
    const test_support::ScratchFolder folder;
    std::string text = "HIERARCHY\n" + joint_text(names, 0) + "MOTION\nFrames: 21\nFrame Time: 0.01\n";
    for (int turned = -2; turned < 19; ++turned) {
        text += "0 0 0";
        for (int joint = 0; joint < 19; ++joint)
            text += joint == turned ? " " + std::to_string(turn_deg) + " 0 0" : " 0 0 0";
        text += "\n";
    }
    return read_clip(folder.file("walk.bvh", text));
}

TEST(JointNames, EachSchemeReachesEveryPartOfTheHuman)
{
    const Skeleton human = human_skeleton();
    const Names parts = on_both_sides(bones);
    Motion first;
    for (const Names& scheme : schemes) {
        SCOPED_TRACE(scheme[9]);
        const Clip clip = clip_of(on_both_sides(scheme));
        const ClipMatch match = match_of(clip, human);
        EXPECT_EQ(match.matched, 19);
        EXPECT_TRUE(match.unmatched.empty());
        EXPECT_EQ(match.bones_without_joint, (Names{"hip.L", "hip.R"}));
        const Motion motion = retarget(clip, human, {});
        ASSERT_EQ(motion.frames(), 20);
        const auto turned_deg = [&](int frame, int bone) {
            return Eigen::AngleAxisd(motion.steps[0][bone].linear().transpose() * motion.steps[frame][bone].linear())
                       .angle() *
                   180.0 / M_PI;
        };
        for (int part = 0; part < 19; ++part) {
            const int bone = find_bone(human, parts[part]), above = human.bones[bone].parent;
            // BVH's numbers are single precision
            EXPECT_NEAR(turned_deg(1 + part, bone), turn_deg, 1e-3) << parts[part];
            EXPECT_NEAR(above < 0 ? 0.0 : turned_deg(1 + part, above), 0.0, 1e-3) << parts[part];
        }
        if (first.steps.empty()) first = motion;
        for (std::size_t step = 0; step < motion.steps.size(); ++step)
            for (std::size_t bone = 0; bone < human.bones.size(); ++bone)
                EXPECT_EQ(motion.steps[step][bone].matrix(), first.steps[step][bone].matrix())
                    << "names change no number";
    }
}

TEST(JointNames, ABoneOfAModelFollowsTheSamePartOfAnotherScheme)
{
    const Names of_model = on_both_sides(schemes[mixamo]);
    const Clip clip = clip_of(on_both_sides(schemes[unreal]));
    const Skeleton model = skeleton_from_clip(clip_of(of_model), 1.0);
    const JointMap map = joint_map(clip, model);
    for (std::size_t part = 0; part < 19; ++part)
        EXPECT_EQ(clip.joints.at(map.bones.at(find_bone(model, of_model[part])).joint),
                  on_both_sides(schemes[unreal])[part]);
}

// Names that say nothing, beside a table as VRM has it, on either side.
TEST(JointNames, TheTableOfAFileCountsInPlaceOfItsNames)
{
    const Names parts = on_both_sides(schemes[unreal]);
    Clip clip = clip_of(parts);
    Skeleton model = skeleton_from_clip(clip, 1.0);
    const Clip mixamo_clip = clip_of(on_both_sides(schemes[mixamo]));
    const Skeleton mixamo_model = skeleton_from_clip(mixamo_clip, 1.0);
    for (std::size_t b = 0; b < model.bones.size(); ++b)
        model.bones[b].body_part = std::exchange(model.bones[b].name, "bone" + std::to_string(b * b));
    clip.body_parts = clip.joints;
    for (std::size_t j = 0; j < clip.joints.size(); ++j) clip.joints[j] = "joint" + std::to_string(j * j);
    EXPECT_EQ(match_of(mixamo_clip, model).matched, 19);
    EXPECT_EQ(match_of(clip, mixamo_model).matched, 19);
    EXPECT_EQ(body_joints(clip).shin, body_joints(clip_of(parts)).shin);
}

// LeftShoulder is the collar bone of one scheme and the upper arm of another; Spine and Neck are called alike where
// schemes differ.
TEST(JointNames, EqualNamesComeFirstUnlessTheyAreOtherParts)
{
    const Names of_model = on_both_sides(schemes[mixamo - 3]);  // CMU: LowerBack, Spine1
    Names of_clip = on_both_sides({"Hips", "Chest", "Spine1", "Neck", "Head", "LeftCollar", "LeftShoulder", "LeftElbow",
                                   "LeftWrist", "LeftHip", "LeftKnee", "LeftAnkle"});
    const Clip clip = clip_of(of_clip);
    const Skeleton model = skeleton_from_clip(clip_of(of_model), 1.0);
    const JointMap map = joint_map(clip, model);
    const auto joint_of = [&](const std::string& bone) {
        return clip.joints.at(map.bones.at(find_bone(model, bone)).joint);
    };
    EXPECT_EQ(joint_of("Spine1"), "Spine1") << "no part of the clip's scheme, but the same name";
    EXPECT_EQ(joint_of("LeftShoulder"), "LeftCollar");
    EXPECT_EQ(joint_of("LeftArm"), "LeftShoulder");
    EXPECT_EQ(joint_of("RightUpLeg"), "RightHip");
}

TEST(JointNames, HalfALimbIsNoMatch)
{
    const auto torn = [](const std::string& joint) {
        Names names = on_both_sides(schemes[mixamo]);
        *std::ranges::find(names, "mixamorig:" + joint) = "mixamorig:LeftUnheardOf";
        return joint_map(clip_of(names), human_skeleton()).torn;
    };
    EXPECT_EQ(torn("LeftForeArm"), (Names{"forearm_upper.L (its joint may be mixamorig:LeftUnheardOf)",
                                          "forearm_lower.L (its joint may be mixamorig:LeftUnheardOf)"}));
    EXPECT_EQ(torn("LeftArm"), Names{"upper_arm.L (its joint may be mixamorig:LeftUnheardOf)"});
    EXPECT_EQ(torn("LeftShoulder"), Names{"clavicle.L (its joint may be mixamorig:LeftUnheardOf)"});
    EXPECT_EQ(torn("LeftFoot"), Names{}) << "nothing below it follows the clip";
    EXPECT_TRUE(joint_map(clip_of(on_both_sides(schemes[mixamo])), human_skeleton()).torn.empty());
}

TEST(JointNames, NumbersThatTellJointsApartAreKept)
{
    const Skeleton chain{{{"Bone.001", -1, Vec3(0, 0, 0), Vec3(1, 0, 0)},
                          {"Bone.003", 0, Vec3(1, 0, 0), Vec3(2, 0, 0)},
                          {"Bone.002", 1, Vec3(2, 0, 0), Vec3(3, 0, 0)},
                          {"Bone.004", 2, Vec3(3, 0, 0), Vec3(4, 0, 0)}}};
    Clip clip;
    clip.joints = {"Bone_001", "Bone_002", "Bone_003", "Bone_004"};
    clip.parent = {-1, 0, 1, 2};
    const JointMap map = joint_map(clip, chain);
    for (const auto& [bone, joint] : {std::pair(0, 0), std::pair(1, 2), std::pair(2, 1), std::pair(3, 3)})
        EXPECT_EQ(map.bones[bone].joint, joint);
}

TEST(JointNames, FingersCountOnlyWhereABoneFollowsThem)
{
    Clip clip = clip_of(on_both_sides(schemes[mixamo]));
    for (const std::string finger : {"mixamorig:LeftHandThumb1", "mixamorig:LeftHandIndex1", "mixamorig:LeftWing"}) {
        clip.joints.push_back(finger);
        clip.parent.push_back(8);
        clip.zero_pose.conservativeResize(clip.zero_pose.rows() + 1, 3);
        clip.zero_pose.bottomRows(1) = clip.zero_pose.row(8) + Eigen::RowVector3d(0, 1, 0);
        for (auto& frame : clip.local) frame.push_back(frame[8]);
        for (Positions& places : clip.places) {
            places.conservativeResize(clip.zero_pose.rows(), 3);
            places.bottomRows(1) = places.row(8) + Eigen::RowVector3d(0, 1, 0);
        }
    }
    const ClipMatch match = match_of(clip, human_skeleton());
    EXPECT_EQ(match.moving, 22);
    EXPECT_EQ(match.matched, 19);
    EXPECT_EQ(match.small, 2);
    EXPECT_EQ(match.unmatched.size(), 3u);
    const Skeleton arm{
        {{"forearm", -1, Vec3(0, 0, 0), Vec3(1, 0, 0)}, {"Left_Hand_Index_1", 0, Vec3(1, 0, 0), Vec3(2, 0, 0)}}};
    EXPECT_EQ(match_of(clip, arm).matched, 1) << "the same finger in another spelling";
    EXPECT_EQ(match_of(clip, arm).small, 0) << "the arm's names are of no known scheme";
}

TEST(JointNames, NamesThatAreASideAloneOrAnotherSideDoNotMatch)
{
    const Skeleton pair{{{"L", -1, Vec3(0, 0, 0), Vec3(1, 0, 0)}, {"Fin.R", 0, Vec3(1, 0, 0), Vec3(2, 0, 0)}}};
    Clip clip;
    clip.joints = {"left", "LeftFin", "_"};
    clip.parent = {-1, 0, 1};
    for (const JointMapping& mapping : joint_map(clip, pair).bones) EXPECT_EQ(mapping.joint, -1);
}

}  // namespace
