#include "experiments/run/limb_stations.hpp"

#include "analysis/metrics/cross_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

constexpr double limb_slenderness = 3.0;
constexpr double own_flesh = 0.9;         // of the area that the plane cuts nearby
constexpr double nearby_distances = 2.0;  // in mean distances of the bone's vertices
constexpr int stations_per_limb = 5;

pbs::Vec3 direction(const pbs::Bone& bone)
{
    return (bone.tail - bone.head).normalized();
}

// Mean distance at rest of the vertices that are bound to each bone [m], #bones; zero for a bone without vertices.
std::vector<double> mean_distances(const pbs::Character& character)
{
    std::vector<double> distance(character.skeleton.bones.size(), 0.0);
    std::vector<int> count(distance.size(), 0);
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v) {
        distance[character.binding.bone[v]] += character.binding.distance(v);
        ++count[character.binding.bone[v]];
    }
    for (std::size_t b = 0; b < distance.size(); ++b) distance[b] = count[b] > 0 ? distance[b] / count[b] : 0.0;
    return distance;
}

bool is_limb(const pbs::Bone& bone, double mean_distance)
{
    return mean_distance > 0.0 && (bone.tail - bone.head).norm() > limb_slenderness * mean_distance;
}

bool in_one_line(const pbs::Skeleton& skeleton, int parent, int child)
{
    const auto meeting = pbs::bones_meeting(skeleton, parent, pbs::BoneEnd::tail);
    return std::count(meeting.begin(), meeting.end(), child) > 0 &&
           direction(skeleton.bones[parent]).dot(direction(skeleton.bones[child])) > 0.0;
}

// The bones themselves and the next limbs in line.
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

// The tets with all vertices chosen.
std::vector<int> tets_within(const pbs::Tets& tets, const std::vector<char>& chosen)
{
    std::vector<int> within;
    for (Eigen::Index t = 0; t < tets.rows(); ++t) {
        const auto corners = tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return chosen[v]; })) within.push_back(static_cast<int>(t));
    }
    return within;
}

std::vector<int> tets_of(const pbs::Character& character, const std::set<int>& bones)
{
    std::vector<char> chosen(character.binding.bone.size());
    for (std::size_t v = 0; v < chosen.size(); ++v) chosen[v] = bones.count(character.binding.bone[v]) > 0;
    return tets_within(character.mesh.tets, chosen);
}

std::vector<int> tets_near(const pbs::TetMesh& mesh, const pbs::Vec3& point, double radius)
{
    std::vector<char> chosen(mesh.rest.rows());
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) chosen[v] = (mesh.rest.row(v).transpose() - point).norm() < radius;
    return tets_within(mesh.tets, chosen);
}

bool has_its_own_flesh(const pbs::Character& character, const LimbStation& station, double mean_distance)
{
    const analysis::Plane plane{station.point, station.normal};
    const auto area = [&](const std::vector<int>& tets) {
        return analysis::cross_section_area(character.mesh.rest, character.mesh.tets, tets, plane);
    };
    const double own = area(station.tets);
    return own > 0.0 && own >= own_flesh * area(tets_near(character.mesh, station.point, nearby_distances * mean_distance));
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
    const std::vector<double> distances = mean_distances(character);
    std::vector<LimbStation> stations;
    const auto add = [&](LimbStation station, double mean_distance) {
        if (has_its_own_flesh(character, station, mean_distance)) stations.push_back(std::move(station));
    };
    for (int b = 0; b < static_cast<int>(bones.size()); ++b) {
        if (!is_limb(bones[b], distances[b])) continue;
        for (int i = 1; i <= stations_per_limb; ++i) {
            const double along = i / (stations_per_limb + 1.0);
            const pbs::Vec3 point = bones[b].head + along * (bones[b].tail - bones[b].head);
            add(station_at(character, fmt::format("{} {:.2f}", bones[b].name, along), point, direction(bones[b]), {b}), distances[b]);
        }
        const int parent = bones[b].parent;
        if (parent < 0 || !is_limb(bones[parent], distances[parent]) || !in_one_line(character.skeleton, parent, b)) continue;
        const pbs::Vec3 normal = direction(bones[parent]) + direction(bones[b]);
        add(station_at(character, bones[parent].name + "|" + bones[b].name, bones[b].head, normal, {parent, b}), distances[b]);
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
