// A deformer on a character whose skinning weights follow another rule, for comparisons such as LBS with Eq. 2's and with smooth weights on
// the same mesh. make_deformer applies it wherever DeformerSpec::weights is set; scenes set that by the key `weights` of a deformer's
// table.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/deformer_spec.hpp"
#include "experiments/settings/scene_schema.hpp"

#include <memory>

namespace experiments {

class SceneValues;

// The deformer, which sees the character with weights by the rule (pbs::with_weights). InputError at reset where the character brings no
// such weights.
std::unique_ptr<Deformer> with_own_weights(std::unique_ptr<Deformer> deformer, pbs::WeightKind weights);

// The key `weights` of a deformer's table: scene (the default), paper, rigid, smooth, diffused or artist.
SceneKey own_weights_key(const std::string& table, bool in_list = false);

// Sets the weights and, unless they are the scene's, the variant: weights_smooth.
void read_own_weights(const SceneValues& values, const std::string& table, DeformerSpec& spec);

}  // namespace experiments
