// A deformer moves the vertices of a character. LBS, DQS, PBS and the finite elements are deformers, so that every scene and metric
// works for each of them. README.md describes how to add one.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json.hpp>

#include <any>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace experiments {

class Deformer {
public:
    virtual ~Deformer() = default;

    virtual void reset(const pbs::Character& character) = 0;  // set-up and initial state; the character must outlive the deformer
    virtual pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3

    // The poses of the coming calls of advance, in order. A deformer without memory may work ahead, several frames at once.
    virtual void foresee(const std::vector<pbs::Pose>& /*poses*/) {}

    // Replaces the initial guess of the next call of advance, whatever its quality [m], #V x 3, in the world. Only deformers that minimise
    // an energy use it, the nonlinear finite elements in equilibrium among them; all others ignore it.
    virtual void start_from(const pbs::Positions& /*shape*/) {}

    // True if the next positions depend on the last ones. Such a deformer gets every step; the others get only the frames.
    virtual bool has_memory() const { return false; }

    // The vertices whose positions are prescribed to this deformer (the attachment of the FEM), #V; empty: none.
    virtual std::vector<bool> prescribed() const { return {}; }
    // The solution with fewer nodes that was tried as the initial guess of the last one, and how it ended. Null: none was tried.
    struct FewerNodes {
        const Deformer* deformer = nullptr;
        pbs::StepSummary step;
    };
    virtual FewerNodes set_out_from() const { return {}; }
    // The smallest det F at the quadrature points of the elements in the last pose. Nothing: no elements with quadrature points.
    virtual std::optional<double> lowest_det_f() const { return {}; }
    // The last state of the solver in the last call of advance [m], #V x 3, in the world. It differs from positions() where the pose was
    // not reached and positions() were taken back to an earlier state.
    virtual pbs::Positions last_state() const { return positions(); }
    // Further facts for run.json: the grip of each bone, the solver, sizes. Null: none.
    virtual nlohmann::json record() const { return nullptr; }
};

// A deformer to be made: its kind, its options, and its name in the records.
//   DeformerSpec spec = default_spec("fem");                       of registry.hpp: with the default options of the kind
//   options_of<FemOptions>(spec).element_order = 1;                if the caller knows the kind
//   spec.weights = pbs::WeightKind::diffused;                      LBS, delta mush ... with smooth weights on the same character
//   if (const auto* pbs = options_if<pbs::PbsOptions>(spec)) ...   for a deformer of any kind
struct DeformerSpec {
    std::string name;                 // a kind, or the name of a [[fem]] table
    std::string kind;                 // registered kind
    std::string label;                // unique in a run, e.g. pbs, pbs_96: in keys of run.json and names of frame files
    std::string variant = "default";  // e.g. jiggle, labels_relative
    std::any options = {};            // the struct of options of the kind; empty: the kind has none
    int threads = 1;                  // that a step may use; results do not depend on their number
    // Weights by this rule instead of the character's, for a deformer of any kind (registry.hpp). Null: the character's.
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
