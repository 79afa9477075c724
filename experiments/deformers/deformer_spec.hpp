// A deformer to be made: its kind, its options, and its name in the records.
//   DeformerSpec spec = default_spec("fem");                       of registry.hpp: with the default options of the kind
//   options_of<FemOptions>(spec).element_order = 1;                if the caller knows the kind
//   spec.weights = pbs::WeightKind::diffused;                      LBS, delta mush ... with smooth weights on the same character
//   if (const auto* pbs = options_if<pbs::PbsOptions>(spec)) ...   for a deformer of any kind
#pragma once

#include "pbs/character/character.hpp"

#include <any>
#include <optional>
#include <stdexcept>
#include <string>

namespace experiments {

struct DeformerSpec {
    std::string name;                 // a kind, or the name of a [[fem]] table
    std::string kind;                 // registered kind
    std::string label;                // unique in a run, e.g. pbs, pbs_96: in keys of run.json and names of frame files
    std::string variant = "default";  // e.g. jiggle, labels_relative
    std::any options = {};            // the struct of options of the kind; empty: the kind has none
    int threads = 1;                  // that a step may use; results do not depend on their number
    // Weights by this rule instead of the character's, for a deformer of any kind (own_weights.hpp). Null: the character's.
    std::optional<pbs::WeightKind> weights = {};
};

// The options if they are of this type; null otherwise.
template <typename Options>
const Options* options_if(const DeformerSpec& spec)
{
    return std::any_cast<Options>(&spec.options);
}

template <typename Options>
Options& options_of(DeformerSpec& spec)
{
    if (Options* options = std::any_cast<Options>(&spec.options)) return *options;
    throw std::logic_error("the deformer " + spec.name + " of kind " + spec.kind + " has other options than those asked for");
}

template <typename Options>
const Options& options_of(const DeformerSpec& spec)
{
    return options_of<Options>(const_cast<DeformerSpec&>(spec));
}

}  // namespace experiments
