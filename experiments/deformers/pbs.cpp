// The paper's two-layered deformer: LBS, then position based dynamics (Algorithm 1).
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <optional>

namespace experiments {
namespace {

class PbsDeformer : public Deformer {
public:
    explicit PbsDeformer(const pbs::PbsOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    // With several threads, on a mesh whose steps cannot be shared among them, frames are projected in parallel, sixteen per thread. The
    // results are equal to the bit to those of single frames.
    void foresee(const std::vector<pbs::Pose>& poses) override;
    const pbs::Positions& positions() const override { return ahead_ ? ahead_->positions(done_ahead_ - 1) : solver_->positions(); }
    bool has_memory() const override { return options_.jiggle || options_.lbs_entry == pbs::LbsEntry::increment; }

private:
    bool works_ahead() const;
    pbs::StepSummary advance_ahead(double dt_s);

    pbs::PbsOptions options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<pbs::PbsSolver> solver_;
    pbs::Positions lbs_;

    std::vector<pbs::Pose> foreseen_;            // coming poses; empty: they are not known, or working ahead does not pay
    std::size_t next_ = 0;                       // the next one of them
    std::unique_ptr<pbs::PosesSolver> ahead_;    // the frames of foreseen_ from next_ - done_ahead_
    std::vector<pbs::StepSummary> steps_ahead_;  // of these frames
    int done_ahead_ = 0;
};

void PbsDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, character.weights);
    const std::vector<bool> zone = options_.jiggle ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
    solver_ = std::make_unique<pbs::PbsSolver>(character.mesh, character.binding.distance, zone, options_);
}

bool PbsDeformer::works_ahead() const
{
    const bool another_reading = options_.class_order != pbs::ClassOrder::bind_stretch_volume ||
                                 options_.lbs_entry != pbs::LbsEntry::start || options_.bind_on_bone != pbs::BindOnBone::pinned;
    const bool other_constraints =
        options_.bind_to != pbs::BindTo::bone_distance || options_.volume_of != pbs::VolumeOf::tets || options_.k_stretch_length_m != 0.0;
    const bool each_its_own = another_reading || other_constraints || options_.jiggle || options_.sleep || options_.stop_residual > 0.0 ||
                              options_.record_iterations;
    return options_.threads > 1 && options_.order != pbs::Order::plain && !each_its_own &&
           !pbs::shared_among_threads(static_cast<int>(character_->mesh.rest.rows()));
}

void PbsDeformer::foresee(const std::vector<pbs::Pose>& poses)
{
    foreseen_ = works_ahead() ? poses : std::vector<pbs::Pose>{};
    next_ = 0;
    ahead_.reset();
}

// Returns the next of the frames that are done, or else of a new lot.
pbs::StepSummary PbsDeformer::advance_ahead(double dt_s)
{
    if (!ahead_ || done_ahead_ == static_cast<int>(steps_ahead_.size())) {
        const pbs::Stopwatch stopwatch;
        const std::size_t lot = std::min(static_cast<std::size_t>(options_.threads) * pbs::poses_at_once, foreseen_.size() - next_);
        std::vector<pbs::Positions> lbs(lot), bind_points(lot);
        for (std::size_t i = 0; i < lot; ++i) {
            skinning_->linear(foreseen_[next_ + i], lbs[i]);
            bind_points[i] = pbs::posed_bind_points(character_->binding, foreseen_[next_ + i]);
        }
        if (!ahead_ || lot != steps_ahead_.size())
            ahead_ = std::make_unique<pbs::PosesSolver>(character_->mesh, character_->binding.distance, std::vector<bool>{},
                                                        std::vector<pbs::PbsOptions>(lot, options_));
        steps_ahead_ = ahead_->advance(lbs, bind_points, dt_s);
        for (pbs::StepSummary& step : steps_ahead_) {
            step.seconds = stopwatch.seconds() / double(lot);
            step.work.vertex_visits += character_->mesh.rest.rows();
        }
        done_ahead_ = 0;
    }
    ++next_;
    return steps_ahead_[done_ahead_++];
}

pbs::StepSummary PbsDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    if (next_ < foreseen_.size()) return advance_ahead(dt_s);
    ahead_.reset();
    const pbs::Stopwatch stopwatch;
    skinning_->linear(pose, lbs_);
    pbs::StepSummary summary = solver_->advance(lbs_, pbs::posed_bind_points(character_->binding, pose), dt_s);
    summary.seconds = stopwatch.seconds();
    summary.work.vertex_visits += lbs_.rows();
    return summary;
}

}  // namespace

DeformerKind pbs_kind()
{
    return {.name = "pbs",
            .meaning = "the paper: LBS, then bind, stretch and volume constraints (Algorithm 1)",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec);
                options.threads = spec.threads;
                return std::make_unique<PbsDeformer>(options);
            },
            .options = pbs::PbsOptions{},
            .keys = pbs_fields().keys(),
            .read = read_pbs,
            .options_json = [](const DeformerSpec& spec) { return pbs_fields().json(options_of<pbs::PbsOptions>(spec)); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                const auto& options = options_of<pbs::PbsOptions>(spec);
                return {.order = name_of(options.order),
                        .precision = name_of(options.precision),
                        .packed = options.order != pbs::Order::plain,
                        .iterations = options.iterations,
                        .threads = spec.threads,
                        .sleeps = options.sleep,
                        .is_negative_control = options.volume_form != pbs::VolumeForm::derived};
            }};
}

}  // namespace experiments
