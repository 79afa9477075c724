// A deformer moves the vertices of a character. LBS, DQS, PBS and the finite elements are deformers, so that every
// scene and metric works for each of them. README.md describes how to add one.
#pragma once

#include "experiments/characters/character.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json.hpp>

#include <any>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

class Deformer;

// A deformer, and how its last step ended.
struct TriedSolution {
    const Deformer* deformer = nullptr;
    pbs::StepSummary step;
};

// A place where a reference with contact begins to press on itself: a crease is the sharper there, the finer the tets
// are.
struct CreaseTip {
    pbs::Vec3 at_rest;    // [m]
    double radius_m = 0;  // of the part of the flesh in which its place matters: a third of the local limb radius
};

// The points that lie within a tip's radius at rest, #P. points_at_rest: [m], #P x 3.
std::vector<bool> near_tips(const std::vector<CreaseTip>& tips, const pbs::Positions& points_at_rest);

// What only finite elements state about their last frame.
struct FemFacts {
    std::vector<bool> prescribed;  // #V: the vertices whose positions the attachment prescribes; empty: none
    // the smallest at the quadrature points; nothing: no elements with quadrature points
    std::optional<double> lowest_det_f;
    std::optional<double> energy_j;  // of a nonlinear equilibrium: flesh, springs, gravity and contact
    std::vector<CreaseTip> tips;     // none without contact
    // Where places in the tets are in positions() [m], #P x 3, interpolated by the elements, of a nonlinear model. Each
    // place has a tet, and may lie outside it.
    std::function<pbs::Positions(const std::vector<pbs::Location>& places)> moved;
    // The last state of the solver [m], #V x 3, in the world. It differs from positions() where the pose was not
    // reached and positions() were taken back to an earlier state.
    pbs::Positions last_state;
    TriedSolution fewer_nodes;  // that was tried as the initial guess; null: none was tried
};

class Deformer {
public:
    virtual ~Deformer() = default;

    // set-up and initial state; the character must outlive the deformer
    virtual void reset(const pbs::Character& character) = 0;
    virtual pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3

    // The poses of the coming calls of advance, in order. A deformer without memory may work ahead, several frames at
    // once.
    virtual void foresee(const std::vector<pbs::Pose>& /*poses*/) {}

    // Replaces the initial guess of the next call of advance, whatever its quality [m], #V x 3, in the world. PBS and
    // XPBD project from there. Deformers that minimise an energy use it, too, the nonlinear finite elements in
    // equilibrium among them; all others ignore it.
    virtual void start_from(const pbs::Positions& /*shape*/) {}

    // Makes an earlier frame, its pose and its positions [m], #V x 3, in the world, the state from which the next call
    // of advance goes on. Deformers whose frames do not need the last one ignore it.
    virtual void continue_from(const pbs::Pose& /*pose*/, const pbs::Positions& /*positions*/) {}

    // Asked within advance: once it is true, a solver whose frame takes seconds gives up, and the pose is not reached.
    // The others ignore it.
    virtual void give_up_when(std::function<bool()> /*is_over*/) {}

    // False in a frame without a solution, as of a reference whose budget of time left the frame out: positions() are
    // then of no meaning.
    virtual bool has_state() const { return true; }

    // True if the next positions depend on the last ones. Such a deformer gets every step; the others get only the
    // frames.
    virtual bool has_memory() const { return false; }

    virtual const FemFacts* facts() const { return nullptr; }  // null: no finite elements

    // Further facts for run.json: the grip of each bone, the solver, sizes. Null: none.
    virtual nlohmann::json record() const { return nullptr; }
};

// FemFacts::prescribed and FemFacts::last_state for a deformer of any kind: no vertices, and positions().
inline std::vector<bool> prescribed_vertices(const Deformer& deformer)
{
    return deformer.facts() ? deformer.facts()->prescribed : std::vector<bool>{};
}
inline const pbs::Positions& last_state(const Deformer& deformer)
{
    return deformer.facts() ? deformer.facts()->last_state : deformer.positions();
}

// The base class of deformers that write their positions: it times each frame, and a shape that is not finite is the
// outcome not_finite, whatever the method reports.
class TimedDeformer : public Deformer {
public:
    void reset(const pbs::Character& character) override;  // positions at rest, then set_up
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) final;
    const pbs::Positions& positions() const final { return positions_; }

private:
    virtual void set_up(const pbs::Character& character) = 0;
    virtual bool has_own_clock() const { return false; }  // true: deform states the seconds
    // x: the last positions in, the new ones out [m], #V x 3.
    virtual pbs::StepSummary deform(const pbs::Pose& pose, double dt_s, pbs::Positions& x) = 0;

    pbs::Positions positions_;
};

// The base class of deformers that have another one do the work: each call is passed on.
class WrappingDeformer : public Deformer {
public:
    explicit WrappingDeformer(std::unique_ptr<Deformer> deformer) : deformer_(std::move(deformer)) {}

    void reset(const pbs::Character& character) override { deformer_->reset(character); }
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override { return deformer_->advance(pose, dt_s); }
    const pbs::Positions& positions() const override { return deformer_->positions(); }
    void foresee(const std::vector<pbs::Pose>& poses) override { deformer_->foresee(poses); }
    void start_from(const pbs::Positions& shape) override { deformer_->start_from(shape); }
    void continue_from(const pbs::Pose& pose, const pbs::Positions& positions) override
    {
        deformer_->continue_from(pose, positions);
    }
    void give_up_when(std::function<bool()> is_over) override { deformer_->give_up_when(std::move(is_over)); }
    bool has_state() const override { return deformer_->has_state(); }
    bool has_memory() const override { return deformer_->has_memory(); }
    const FemFacts* facts() const override { return deformer_->facts(); }
    nlohmann::json record() const override { return deformer_->record(); }

protected:
    Deformer& wrapped() const { return *deformer_; }

private:
    std::unique_ptr<Deformer> deformer_;
};

// A deformer to be made: its kind, its options, and its name in the records.
//   DeformerSpec spec = default_spec("fem");                       // of registry.hpp, with the kind's default options
//   options_of<FemOptions>(spec).element_order = 1;                // if the caller knows the kind
//   spec.weights = pbs::WeightKind::diffused;                      // LBS, delta mush, ... with smooth weights
//   if (const auto* pbs = options_if<pbs::PbsOptions>(spec)) ...   // for a deformer of any kind
struct DeformerSpec {
    std::string name;                 // a kind, or the name of a [[fem]] table
    std::string kind;                 // registered kind
    std::string label;                // unique in a run, e.g. pbs, pbs_96: in keys of run.json and names of frame files
    std::string variant = "default";  // e.g. jiggle, labels_relative
    std::any options = {};            // the struct of options of the kind; empty: the kind has none
    int threads = 1;                  // that a step may use; results do not depend on their number
    // Weights by this rule instead of the character's, for a deformer of any kind: LBS with Eq. 2's and with smooth
    // weights on the same mesh. Null: the character's. InputError at reset where the character brings no such weights.
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
    throw std::logic_error("the deformer " + spec.name + " of kind " + spec.kind +
                           " has other options than those asked for");
}

template <typename Options>
const Options& options_of(const DeformerSpec& spec)
{
    return options_of<Options>(const_cast<DeformerSpec&>(spec));
}

}  // namespace experiments
