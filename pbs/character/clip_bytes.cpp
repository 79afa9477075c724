#include "pbs/character/clip_bytes.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/packed_bytes.hpp"

#include <cmath>

namespace pbs {
namespace {

constexpr double shortest_frame_s = 1e-6, longest_frame_s = 1e3;
constexpr double farthest = 1e9;  // [clip's units]

[[noreturn]] void refuse(const std::string& path)
{
    throw InputError(path, 0, "", "", "damaged: the reader's answer is not a whole clip");
}

Positions taken_points(TakenBytes& taken, std::size_t rows, const std::string& path)
{
    const std::vector<double> numbers = taken.take_array<double>();
    if (!taken.sound() || numbers.size() != 3 * rows) refuse(path);
    const Positions points = Eigen::Map<const Positions>(numbers.data(), static_cast<Eigen::Index>(rows), 3);
    if (!points.allFinite() || (rows > 0 && points.cwiseAbs().maxCoeff() > farthest))
        throw InputError(path, 0, "positions", "", "expected finite numbers of at most 1e9");
    return points;
}

void take_joints(TakenBytes& taken, Clip& clip, const std::string& path)
{
    clip.parent = taken.take_array<int>();
    if (!taken.sound() || clip.parent.empty()) refuse(path);
    for (int j = 0; j < static_cast<int>(clip.parent.size()); ++j) {
        if (clip.parent[j] < -1 || clip.parent[j] >= j) refuse(path);
        clip.joints.push_back(taken.take_text());
    }
    clip.zero_pose = taken_points(taken, clip.parent.size(), path);
}

void take_frames(TakenBytes& taken, Clip& clip, const std::string& path)
{
    const std::vector<double> numbers = taken.take_array<double>();  // x, y, z, w
    const std::size_t joints = clip.joints.size();
    if (!taken.sound() || numbers.empty() || numbers.size() % (4 * joints) != 0) refuse(path);
    for (std::size_t at = 0; at < numbers.size(); at += 4) {
        const Eigen::Quaterniond rotation(numbers.data() + at);
        if (!(std::abs(rotation.norm() - 1.0) < 1e-3)) refuse(path);
        if (at % (4 * joints) == 0) clip.local.emplace_back();
        clip.local.back().push_back(rotation);
    }
    clip.root = taken_points(taken, clip.local.size(), path);
}

}  // namespace

std::string packed(const Clip& clip)
{
    PackedBytes bytes;
    bytes.put(clip.frame_time_s);
    bytes.put_array(clip.parent.data(), clip.parent.size());
    for (const std::string& joint : clip.joints) bytes.put_text(joint);
    bytes.put_array(clip.zero_pose.data(), static_cast<std::size_t>(clip.zero_pose.size()));
    std::vector<double> rotations;
    for (const auto& frame : clip.local)
        for (const Eigen::Quaterniond& rotation : frame)
            rotations.insert(rotations.end(), rotation.coeffs().begin(), rotation.coeffs().end());
    bytes.put_array(rotations.data(), rotations.size());
    bytes.put_array(clip.root.data(), static_cast<std::size_t>(clip.root.size()));
    return bytes.text();
}

Clip unpacked_clip(const std::string& bytes, const std::string& path)
{
    TakenBytes taken(bytes);
    Clip clip;
    clip.name = path;
    clip.frame_time_s = taken.take<double>();
    take_joints(taken, clip, path);
    take_frames(taken, clip, path);
    if (!taken.whole()) refuse(path);
    if (!(clip.frame_time_s >= shortest_frame_s && clip.frame_time_s <= longest_frame_s))
        throw InputError(path, 0, "frame time", std::to_string(clip.frame_time_s), "expected 1e-6 to 1000 s");
    return clip;
}

}  // namespace pbs
