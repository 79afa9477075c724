#include "pbs/character/skinning_weights.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {
namespace {

Weights smooth_weights(const Character& character)
{
    std::vector<int> held(character.blended.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = character.blended[v] ? -1 : character.binding.bone[v];
    return harmonic_weights(character.mesh, held, static_cast<int>(character.skeleton.bones.size()));
}

}  // namespace

bool has_artist_weights(const Character& character)
{
    return character.artist && character.artist->weights.vertices() > 0;
}

const char* name_of(WeightKind kind)
{
    switch (kind) {
        case WeightKind::paper:
            return "paper";
        case WeightKind::rigid:
            return "rigid";
        case WeightKind::smooth:
            return "smooth";
        case WeightKind::diffused:
            return "diffused";
        case WeightKind::artist:
            return "artist";
        case WeightKind::file:
            return "file";
    }
    return "";
}

Weights weights_by(WeightKind kind, const Character& character)
{
    switch (kind) {
        case WeightKind::paper:
            return paper_weights(character.binding, character.skeleton);
        case WeightKind::rigid:
            return rigid_weights(character.binding);
        case WeightKind::smooth:
            return smooth_weights(character);
        case WeightKind::diffused:
            return diffused_weights(character.mesh, paper_weights(character.binding, character.skeleton));
        case WeightKind::artist:
            if (has_artist_weights(character)) return character.artist->weights;
            break;
        case WeightKind::file:
            if (character.weight_kind == WeightKind::file) return character.weights;
            break;
    }
    throw InputError(character.name, 0, "skinning.weights", name_of(kind), "expected a character that brings such weights");
}

Character with_weights(WeightKind kind, Character character)
{
    character.weights = weights_by(kind, character);
    character.weight_kind = kind;
    return character;
}

}  // namespace pbs
