#include "pbs/character/character.hpp"

#include <algorithm>

namespace pbs {

std::vector<bool> jiggle_zone(const BoneBinding& binding)
{
    const double mean = binding.distance.size() > 0 ? binding.distance.mean() : 0.0;
    std::vector<bool> zone(binding.distance.size());
    for (Eigen::Index vertex = 0; vertex < binding.distance.size(); ++vertex) zone[vertex] = binding.distance(vertex) > mean;
    return zone;
}

std::vector<bool> jiggle_zone_by_bone(const BoneBinding& binding)
{
    const int bones = binding.bone.empty() ? 0 : *std::max_element(binding.bone.begin(), binding.bone.end()) + 1;
    std::vector<double> sum(bones, 0.0), count(bones, 0.0);
    for (std::size_t vertex = 0; vertex < binding.bone.size(); ++vertex) {
        sum[binding.bone[vertex]] += binding.distance(vertex);
        count[binding.bone[vertex]] += 1.0;
    }
    std::vector<bool> zone(binding.bone.size());
    for (std::size_t vertex = 0; vertex < zone.size(); ++vertex) {
        const int bone = binding.bone[vertex];
        zone[vertex] = binding.distance(vertex) * count[bone] > sum[bone];
    }
    return zone;
}

}  // namespace pbs
