// Any bytes as the numbers of a clip that a library has read, for two skeletons: poses of finite numbers, or an
// InputError.
#include "experiments/clips/clip.hpp"
#include "tests/fuzz/taken_bytes.hpp"
#include "tests/fuzz/target.hpp"

#include <algorithm>
#include <optional>

namespace {

using pbs::Vec3;

const pbs::Skeleton arm = {{{"upper", -1, Vec3(-1, 0, 0), Vec3::Zero()}, {"forearm", 0, Vec3::Zero(), Vec3(1, 0, 0)}}};
const pbs::Skeleton leg = {
    {{"pelvis", -1, Vec3(0, 1, 0), Vec3(0, 0.9, 0)}, {"thigh.L", 0, Vec3(0, 0.9, 0), Vec3(0, 0.5, 0)}}};

pbs::Positions points_of(const std::vector<double>& numbers)
{
    return Eigen::Map<const pbs::Positions>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

// Nothing where the counts or the parents are not those of a clip: its reader makes them.
std::optional<pbs::Clip> clip_of(fuzz::TakenBytes taken)
{
    pbs::Clip clip;
    clip.name = "clip.bvh";
    clip.frame_time_s = taken.take<double>();
    clip.parent = taken.take_array<int>();
    const std::size_t joints = clip.parent.size();
    for (std::size_t j = 0; j < joints; ++j) {
        if (clip.parent[j] < -1 || clip.parent[j] >= static_cast<int>(j)) return std::nullopt;
        const std::vector<char> name = taken.take_array<char>();
        clip.joints.emplace_back(name.begin(), name.end());
    }
    clip.zero_pose = points_of(taken.take_array<double>());
    const std::vector<double> rotations = taken.take_array<double>();  // x, y, z, w
    const pbs::Positions path = points_of(taken.take_array<double>());
    if (!taken.whole() || joints == 0 || rotations.empty() || rotations.size() % (4 * joints) != 0) return std::nullopt;
    for (std::size_t at = 0; at < rotations.size(); at += 4) {
        if (at % (4 * joints) == 0) clip.local.emplace_back();
        clip.local.back().emplace_back(rotations.data() + at);
    }
    const bool shaped = clip.zero_pose.rows() == static_cast<Eigen::Index>(joints) && path.rows() == clip.frames();
    if (!shaped) return std::nullopt;
    for (const auto& place : path.rowwise()) clip.places.emplace_back(clip.zero_pose.rowwise() + place);
    return clip;
}

}  // namespace

void fuzz::try_input(const std::string& bytes)
{
    const std::optional<pbs::Clip> clip = clip_of(TakenBytes(bytes));
    if (!clip) return;
    for (const pbs::Skeleton& skeleton : {arm, leg}) try {
            pbs::check_clip(*clip);
            pbs::ClipSampling sampling;
            sampling.duration_s = std::min(1.0, (clip->frames() - 2) * clip->frame_time_s);
            const pbs::Motion motion = pbs::retarget(*clip, skeleton, sampling);
            for (const pbs::Pose& pose : motion.steps)
                for (const auto& bone : pose) expect(bone.matrix().allFinite());
        } catch (const pbs::InputError&) {
        }
}
