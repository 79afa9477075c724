// One walk in the dialects of other programs moves one body alike. Reference: CMU's clip 01_03 as it is, written again
// by an independent kinematics (bvh_kinematics.hpp) with the frames, axes, names and roots of other programs. Needs
// Debian's assimp-testmodels.
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/clips/clip.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"
#include "tests/verification/experiments/characters/bvh_kinematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace pbs;
using bvh_kinematics::Bvh;

constexpr int every = 40;  // frames of the clip, so that the test is quick

struct Dialect {
    std::string name;
    Eigen::Matrix3d world = Eigen::Matrix3d::Identity();  // from the axes of the clip to those of the dialect
    bool frames_along_bones = false;  // x of each joint points to its child, and all offsets lie along x
    bool positions_everywhere = false, second_root = false, first_frame = true;
    std::string prefix = {};
};

Eigen::Matrix3d turned(const Vec3& axis, double deg)
{
    return Eigen::AngleAxisd(deg * M_PI / 180.0, axis).toRotationMatrix();
}

// Of each joint the frame in which its offset's child lies along x, or the axes of the dialect.
std::vector<Eigen::Matrix3d> frames_of(const Bvh& bvh, const Dialect& dialect)
{
    std::vector<Eigen::Matrix3d> frames(bvh.joints.size(), dialect.world.transpose());
    for (std::size_t child = bvh.joints.size(); dialect.frames_along_bones && child-- > 1;)
        if (const Vec3 offset = bvh.joints[child].offset; offset.norm() > 0.0)
            frames[bvh.joints[child].parent] =
                Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), offset).toRotationMatrix();
    return frames;
}

std::string row_of(const Vec3& numbers)
{
    return number_text(numbers.x(), 9) + " " + number_text(numbers.y(), 9) + " " + number_text(numbers.z(), 9) + " ";
}

std::string joint_text(const Bvh& bvh, const Dialect& dialect, const std::vector<Eigen::Matrix3d>& frames,
                       std::size_t joint)
{
    const auto& own = bvh.joints[joint];
    const bool is_end = own.channels.empty(), is_root = own.parent < 0;
    const Vec3 offset = (is_root ? dialect.world : Eigen::Matrix3d(frames[own.parent].transpose())) * own.offset;
    std::string text = (is_root  ? "ROOT "
                        : is_end ? "End Site"
                                 : "JOINT ") +
                       (is_end ? "" : dialect.prefix + own.name) + "\n{\nOFFSET " + row_of(offset) + "\n";
    const bool moves = is_root || dialect.positions_everywhere;
    if (!is_end)
        text += std::string("CHANNELS ") + (moves ? "6 Xposition Yposition Zposition" : "3") +
                " Zrotation Yrotation Xrotation\n";
    for (std::size_t child = joint + 1; child < bvh.joints.size(); ++child)
        if (bvh.joints[child].parent == static_cast<int>(joint)) text += joint_text(bvh, dialect, frames, child);
    return text + "}\n";
}

std::string frame_text(const Bvh& bvh, const Dialect& dialect, const std::vector<Eigen::Matrix3d>& frames,
                       const std::vector<double>& row)
{
    const std::vector<Eigen::Isometry3d> places = bvh_kinematics::forward(bvh, row);
    std::vector<Eigen::Matrix3d> turns;
    std::string text;
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
        turns.push_back(dialect.world * places[j].linear() * frames[j]);
        const auto& joint = bvh.joints[j];
        if (joint.channels.empty()) continue;
        const Eigen::Matrix3d local =
            joint.parent < 0 ? turns[j] : Eigen::Matrix3d(turns[joint.parent].transpose() * turns[j]);
        if (joint.parent < 0)
            text += row_of(dialect.world * places[j].translation());
        else if (dialect.positions_everywhere)
            text += row_of(frames[joint.parent].transpose() * joint.offset);
        text += row_of(local.eulerAngles(2, 1, 0) * 180.0 / M_PI);
    }
    return text + (dialect.second_root ? "0 0 0 0 0 0" : "") + "\n";
}

// The T pose in front of the motion, from which CMU's own turns are measured: its first frame has the legs 17 degrees
// closer together.
std::vector<double> zero_pose_of(const Bvh& bvh)
{
    std::vector<double> row = bvh.frames.front();
    std::fill(row.begin() + 3, row.end(), 0.0);
    return row;
}

std::string written(const Bvh& bvh, const Dialect& dialect)
{
    const std::vector<Eigen::Matrix3d> frames = frames_of(bvh, dialect);
    std::string text = "HIERARCHY\n" + joint_text(bvh, dialect, frames, 0), rows;
    if (dialect.second_root)
        text +=
            "ROOT Prop\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n}\n";
    int count = 0;
    for (std::size_t f = dialect.first_frame ? 0 : 1; f < bvh.frames.size(); f += f == 0 ? 1 : every, ++count)
        rows += frame_text(bvh, dialect, frames, f == 0 ? zero_pose_of(bvh) : bvh.frames[f]);
    return text + "MOTION\nFrames: " + std::to_string(count) + "\nFrame Time: 0.1\n" + rows;
}

const Bvh& walk()
{
    static const Bvh bvh = bvh_kinematics::read(find_clip("01_03.bvh", "."));
    return bvh;
}

const Character& walker()
{
    static const Character character = make_character({.body = "human"});
    return character;
}

Motion motion_of(const Dialect& dialect)
{
    const test_support::ScratchFolder folder;
    ClipSampling sampling;
    sampling.rate_hz = 10.0;
    sampling.time_step_s = 0.1;
    return retarget(read_clip(folder.file("walk.bvh", written(walk(), dialect))), walker().skeleton, sampling);
}

// Change of LBS's volume in each frame [%].
std::vector<double> volume_changes_pct(const Motion& motion)
{
    static const Weights weights = weights_by(WeightKind::paper, walker());
    const TetMesh& mesh = walker().mesh;
    const double rest_m3 = tet_volumes(mesh.rest, mesh.tets).sum();
    std::vector<double> changes;
    Positions posed;
    for (const Pose& pose : motion.steps) {
        linear_blend_skinning(mesh.rest, weights, pose, posed);
        changes.push_back(100.0 * (tet_volumes(posed, mesh.tets).sum() / rest_m3 - 1.0));
    }
    return changes;
}

class ClipDialect : public testing::TestWithParam<Dialect> {};

INSTANTIATE_TEST_SUITE_P(
    Programs, ClipDialect,
    testing::Values(
        Dialect{"z_up", turned(Vec3::UnitX(), 90.0)}, Dialect{"faces_minus_z", turned(Vec3::UnitY(), 180.0)},
        Dialect{"faces_x", turned(Vec3::UnitY(), 90.0)}, Dialect{.name = "maya_frames", .frames_along_bones = true},
        Dialect{.name = "maya_frames_z_up", .world = turned(Vec3::UnitX(), 90.0), .frames_along_bones = true},
        Dialect{.name = "blender_export", .world = turned(Vec3::UnitX(), 90.0), .positions_everywhere = true},
        Dialect{.name = "two_roots", .second_root = true}, Dialect{.name = "prefixed_names", .prefix = "Walker_"}),
    [](const auto& info) { return info.param.name; });

// The angles are in single precision, where 180 degrees have an error of 1e-5; the bound is a hundredth of a per cent
// of the volume.
TEST_P(ClipDialect, LbsHasTheSameVolumeOnTheHuman)
{
    static const std::vector<double> expected = volume_changes_pct(motion_of({"as_it_is"}));
    const std::vector<double> changes = volume_changes_pct(motion_of(GetParam()));
    ASSERT_EQ(changes.size(), expected.size());
    ASSERT_GT(changes.size(), 20u);
    double largest_pct = 0.0, most_pct = 0.0;
    for (std::size_t frame = 0; frame < changes.size(); ++frame) {
        largest_pct = std::max(largest_pct, std::abs(changes[frame] - expected[frame]));
        most_pct = std::max(most_pct, std::abs(expected[frame]));
    }
    RecordProperty("largest_difference_pct", std::to_string(largest_pct));
    EXPECT_GT(most_pct, 1.0) << "the walk changes the volume";
    EXPECT_LT(largest_pct, 0.01);
}

// Without a T pose there is no rest pose: the offsets lie along one axis, and the first frame is a step.
TEST(ClipWithoutATPose, IsRefusedWhereItsOffsetsLieAlongOneAxis)
{
    const Dialect dialect{.name = "no_t_pose", .frames_along_bones = true, .first_frame = false};
    const test_support::ScratchFolder folder;
    const Clip clip = read_clip(folder.file("walk.bvh", written(walk(), dialect)));
    expect_input_error([&] { retarget(clip, walker().skeleton, {}); }, folder / "walk.bvh: rest pose: cannot be known",
                       "put a T pose in front");
}

}  // namespace
