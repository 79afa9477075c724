#include "pbs/character/character.hpp"

namespace pbs {

std::vector<bool> jiggle_zone(const BoneBinding& binding)
{
    const double mean = binding.distance.size() > 0 ? binding.distance.mean() : 0.0;
    std::vector<bool> zone(binding.distance.size());
    for (Eigen::Index vertex = 0; vertex < binding.distance.size(); ++vertex) zone[vertex] = binding.distance(vertex) > mean;
    return zone;
}

}  // namespace pbs
