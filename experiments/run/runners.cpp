#include "experiments/run/runners.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/system/child_process.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

// All that the reference's frames depend on, except for their poses.
std::string reference_key(const DeformerSpec& spec, const pbs::Character& character)
{
    const nlohmann::json settings = {to_json(spec), pbs::hash_of_file(load_module_with_blas("pbskin_fem").path()),
                                     pbs::content_hash(character.mesh), pbs::hashes_by_name(character.inputs)};
    analysis::StateHash hash;
    const auto add = [&](const auto* data, std::size_t size) { hash.add_bytes(data, size * sizeof *data); };
    for (const pbs::Bone& bone : character.skeleton.bones) {
        add(bone.head.data(), 3);
        add(bone.tail.data(), 3);
        add(&bone.parent, 1);
    }
    add(character.moves_with.data(), character.moves_with.size());
    for (const pbs::Weights* weights : {&character.weights, character.artist ? &character.artist->weights : nullptr}) {
        if (!weights) continue;
        add(weights->bone.data(), weights->bone.size());
        add(weights->weight.data(), weights->weight.size());
    }
    return pbs::content_hash(settings.dump() + hash.hex());
}

std::unique_ptr<Deformer> deformer_of(const DeformerSpec& spec, const Scene& scene, const pbs::Character& character,
                                      const std::string& folder, WhenInterrupted when_interrupted)
{
    if (scene.reference_seconds == 0.0 || spec.name != scene.reference) return make_deformer(spec);
    return std::make_unique<SpreadReference>(spec, reference_budget(spec, character, folder, scene.reference_seconds,
                                                                    when_interrupted == WhenInterrupted::finish_early));
}

}  // namespace

ReferenceBudget reference_budget(const DeformerSpec& reference, const pbs::Character& character,
                                 const std::string& folder, double seconds, bool goes_on_without_the_rest)
{
    return {seconds, folder + "/reference_frames.cbor", reference_key(reference, character), goes_on_without_the_rest};
}

bool Runner::has_inverted_flesh(const FrameMeasurer& measurer) const
{
    if (!traits.solves_equations) return false;
    const FemFacts* facts = deformer->facts();
    const std::optional<double> lowest_det_f = facts ? facts->lowest_det_f : std::nullopt;
    return lowest_det_f.value_or(measurer.volume_ratios(deformer->positions()).minCoeff()) <= 0.0;
}

std::string Runner::summary(int frames) const
{
    if (lowest_change_pct > highest_change_pct)
        return fmt::format("  {:<12} reached none of {} poses, so that it has no volume change", spec.label, frames);
    return fmt::format("  {:<12} volume change {:8.3f} to {:7.3f} %, at most {} inverted tets", spec.label,
                       lowest_change_pct, highest_change_pct, most_inverted);
}

std::vector<Runner> make_runners(const Scene& scene, const pbs::Character& character, CostRecord& cost,
                                 const std::string& folder, WhenInterrupted when_interrupted)
{
    std::vector<Runner> runners;
    for (const DeformerSpec& spec : scene.deformers) {
        cost.time("set_up", spec.label, [&] {
            const pbs::Stage stage("setting up " + spec.label);
            runners.push_back({spec, traits_of(spec), deformer_of(spec, scene, character, folder, when_interrupted)});
            runners.back().deformer->reset(character);
        });
    }
    std::stable_partition(runners.begin(), runners.end(),
                          [&](const Runner& runner) { return runner.spec.name == scene.reference; });
    return runners;
}

std::vector<bool> prescribed_by_any(const std::vector<Runner>& runners)
{
    std::vector<bool> any;
    for (const Runner& runner : runners) {
        const std::vector<bool> own = prescribed_vertices(*runner.deformer);
        if (any.size() < own.size()) any.resize(own.size(), false);
        for (std::size_t v = 0; v < own.size(); ++v) any[v] = any[v] || own[v];
    }
    return any;
}

}  // namespace experiments
