#include "experiments/characters/character.hpp"

#include "experiments/characters/skinning_weights.hpp"

#include <algorithm>
#include <map>

namespace pbs {
namespace {

// Coarse vertices keep their weights; a new vertex has the mean of its parents' weights.
Weights mean_of_parents(Weights weights, const Edges& parents)
{
    for (Eigen::Index e = 0; e < parents.rows(); ++e) {
        std::map<int, double> mean;
        for (const int parent : parents.row(e))
            for (int entry = weights.first[parent]; entry < weights.first[parent + 1]; ++entry)
                mean[weights.bone[entry]] += 0.5 * weights.weight[entry];
        for (const auto& [bone, weight] : mean) weights.add(bone, weight);
        weights.end_vertex();
    }
    return weights;
}

}  // namespace

std::vector<bool> jiggle_zone(const BoneBinding& binding)
{
    const double mean = binding.distance.size() > 0 ? binding.distance.mean() : 0.0;
    std::vector<bool> zone(binding.distance.size());
    for (Eigen::Index vertex = 0; vertex < binding.distance.size(); ++vertex)
        zone[vertex] = binding.distance(vertex) > mean;
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

BoneBinding nearest_bones(const Character& character)
{
    if (!character.artist || !character.artist->is_cut)
        return bind_to_nearest_bone(character.mesh.rest, character.skeleton);
    const Weights& weights = character.artist->weights;
    return bind_to_nearest_bone(character.mesh.rest, character.skeleton,
                                // at most four bones
                                [&](int vertex, int bone) { return weights.of(vertex, bone) >= 0.25; });
}

void bind_by_paper(Character& character)
{
    character.binding = nearest_bones(character);
    const Weights paper = paper_weights(character.binding, character.skeleton);
    character.blended.clear();
    for (int vertex = 0; vertex < paper.vertices(); ++vertex) character.blended.push_back(paper.blended(vertex));
}

Character refined(const Character& character)
{
    const Refinement fine = refine(character.mesh);
    Character result = character;
    result.mesh = fine.mesh;
    if (character.artist) result.artist->weights = mean_of_parents(character.artist->weights, fine.parents);
    bind_by_paper(result);
    if (character.weight_kind == WeightKind::paper || character.weight_kind == WeightKind::rigid ||
        character.weight_kind == WeightKind::either_end)
        result.weights = weights_by(character.weight_kind, result);
    else
        result.weights = mean_of_parents(character.weights, fine.parents);
    if (character.surface) result.surface = embed_in_children(*character.surface, character.mesh, fine.mesh);
    if (character.refinements == 0) result.unrefined = std::make_shared<const Character>(character);
    ++result.refinements;
    return result;
}

}  // namespace pbs
