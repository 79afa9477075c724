#include "experiments/limb_stations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

constexpr double limb_slenderness = 1.5;
constexpr int stations_per_limb = 5;

pbs::Vec3 direction(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

std::vector<bool> limbs_of(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    std::vector<double> distance(bones.size(), 0.0);
    std::vector<int> count(bones.size(), 0);
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v) {
        distance[character.binding.bone[v]] += character.binding.distance(v);
        ++count[character.binding.bone[v]];
    }
    std::vector<bool> limbs(bones.size());
    for (std::size_t b = 0; b < bones.size(); ++b)
        limbs[b] = count[b] > 0 && (bones[b].tail - bones[b].head).norm() > limb_slenderness * distance[b] / count[b];
    return limbs;
}

bool in_one_line(const pbs::Skeleton& skeleton, int parent, int child)
{
    const auto meeting = pbs::bones_meeting(skeleton, parent, pbs::BoneEnd::tail);
    return std::count(meeting.begin(), meeting.end(), child) > 0 &&
           direction(skeleton.bones[parent]).dot(direction(skeleton.bones[child])) > 0.0;
}

// The bones themselves and the limbs next in line.
std::set<int> along_limb(const pbs::Skeleton& skeleton, const std::vector<int>& carriers)
{
    std::set<int> bones(carriers.begin(), carriers.end());
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const int parent = skeleton.bones[b].parent;
        if (parent < 0 || !in_one_line(skeleton, parent, static_cast<int>(b))) continue;
        const bool parent_in = std::count(carriers.begin(), carriers.end(), parent) > 0;
        const bool child_in = std::count(carriers.begin(), carriers.end(), static_cast<int>(b)) > 0;
        if (parent_in) bones.insert(static_cast<int>(b));
        if (child_in) bones.insert(parent);
    }
    return bones;
}

std::vector<int> tets_of(const pbs::Character& character, const std::set<int>& bones)
{
    std::vector<int> tets;
    for (Eigen::Index t = 0; t < character.mesh.tets.rows(); ++t) {
        const auto corners = character.mesh.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return bones.count(character.binding.bone[v]) > 0; }))
            tets.push_back(static_cast<int>(t));
    }
    return tets;
}

LimbStation station_at(const pbs::Character& character, std::string name, const pbs::Vec3& point, const pbs::Vec3& normal,
                       std::vector<int> carriers)
{
    std::vector<int> tets = tets_of(character, along_limb(character.skeleton, carriers));
    return {std::move(name), point, normal.normalized(), std::move(carriers), std::move(tets)};
}

}  // namespace

std::vector<LimbStation> limb_stations(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    const std::vector<bool> limbs = limbs_of(character);
    std::vector<LimbStation> stations;
    for (int b = 0; b < static_cast<int>(bones.size()); ++b) {
        if (!limbs[b]) continue;
        for (int i = 1; i <= stations_per_limb; ++i) {
            const double along = i / (stations_per_limb + 1.0);
            const pbs::Vec3 point = bones[b].head + along * (bones[b].tail - bones[b].head);
            stations.push_back(station_at(character, fmt::format("{} {:.2f}", bones[b].name, along), point, direction(bones[b]), {b}));
        }
        const int parent = bones[b].parent;
        if (parent < 0 || !limbs[parent] || !in_one_line(character.skeleton, parent, b)) continue;
        stations.push_back(station_at(character, bones[parent].name + "|" + bones[b].name, bones[b].head,
                                      direction(bones[parent]) + direction(bones[b]), {parent, b}));
    }
    return stations;
}

pbs::Vec3 posed_point(const LimbStation& station, const pbs::Pose& pose)
{
    pbs::Vec3 sum = pbs::Vec3::Zero();
    for (const int bone : station.carriers) sum += pose[bone] * station.point;
    return sum / static_cast<double>(station.carriers.size());
}

pbs::Vec3 posed_normal(const LimbStation& station, const pbs::Pose& pose)
{
    pbs::Vec3 sum = pbs::Vec3::Zero();
    for (const int bone : station.carriers) sum += pose[bone].linear() * station.normal;
    return sum.norm() > 0.0 ? pbs::Vec3(sum.normalized()) : pbs::Vec3(pose[station.carriers.front()].linear() * station.normal);
}

}  // namespace experiments
