#include "experiments/run/body_regions.hpp"

#include "pbs/skinning/weights.hpp"

#include <algorithm>
#include <map>

namespace experiments {
namespace {

constexpr double nearest_bonus = 1e-6;  // a corner's nearest bone goes first where weights are equal

// Weight of each bone over a tet's four corners, #bones; and whether one of them is blended.
struct TetWeights {
    std::vector<double> of_bone;
    bool blended = false;
};

TetWeights weights_of_tet(const pbs::Character& character, const pbs::Weights& weights, Eigen::Index tet)
{
    TetWeights sum{std::vector<double>(character.skeleton.bones.size(), 0.0)};
    for (const int vertex : character.mesh.tets.row(tet)) {
        sum.blended = sum.blended || weights.blended(vertex);
        sum.of_bone[character.binding.bone[vertex]] += nearest_bonus;
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry)
            sum.of_bone[weights.bone[entry]] += weights.weight[entry];
    }
    return sum;
}

int heaviest(const std::vector<double>& weights)
{
    return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace

BodyRegions regions_by_bone(const pbs::Character& character)
{
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"bone", {}, {}};
    for (const auto& bone : character.skeleton.bones) regions.names.push_back(bone.name);
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet)
        regions.of_tet.push_back(heaviest(weights_of_tet(character, weights, tet).of_bone));
    return regions;
}

BodyRegions regions_by_joint(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"joint", {}, {}};
    std::map<std::string, int> index_of;
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet) {
        TetWeights sum = weights_of_tet(character, weights, tet);
        regions.of_tet.push_back(-1);
        if (!sum.blended) continue;
        const int first = heaviest(sum.of_bone);
        sum.of_bone[first] = 0.0;
        const int second = heaviest(sum.of_bone);
        const std::string name = bones[std::min(first, second)].name + " - " + bones[std::max(first, second)].name;
        const auto [entry, is_new] = index_of.emplace(name, static_cast<int>(regions.names.size()));
        if (is_new) regions.names.push_back(name);
        regions.of_tet.back() = entry->second;
    }
    return regions;
}

}  // namespace experiments
