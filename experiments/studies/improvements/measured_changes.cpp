#include "experiments/studies/improvements/measured_changes.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace experiments {
namespace {

std::vector<double> edge_lengths_m(const pbs::TetMesh& mesh)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    std::vector<double> lengths;
    for (const auto edge : edges.rowwise()) lengths.push_back((mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm());
    return lengths;
}

std::string name_of(const NestedSolution& solution)
{
    return std::string(solution.element_order == 2 ? "quadratic" : "linear") + (solution.refinements > 0 ? "_refined" : "");
}

// By the observed order; on unrefined tets, where there is none, from linear elements. Nothing where the reference is linear itself.
std::optional<double> bound_of(const PosedReference& reference, bool is_refined)
{
    if (reference.order() && std::isfinite(reference.bound().joint_pct)) return reference.bound().joint_pct;
    if (is_refined || !reference.is_reached() || reference.reference().element_order != 2) return std::nullopt;
    for (const NestedSolution& solution : reference.solutions())
        if (solution.finished && solution.element_order == 1) return reference.error_of(solution.positions).joint_pct;
    return std::nullopt;
}

// One setting at one number of iterations, moving back and forth between the pose and the one of the frame before.
struct TimedSetting {
    ChangeSetting setting;
    std::unique_ptr<Deformer> deformer;
    pbs::Positions positions;  // in the pose [m]
    bool finite = false;
    bool is_in_pose = true;
};

class PoseMeasuring {
public:
    explicit PoseMeasuring(const ChangesCase& of) : of_(of), character_(pbs::make_character(of.scene.character)), smooth_(character_)
    {
        smooth_.weights = pbs::weights_by(pbs::WeightKind::smooth, character_);
        const pbs::Motion motion = make_motion(of.scene.motion, character_.skeleton, of.scene.file);
        const auto pose = [&](int frame) { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); };
        pose_ = pose(of.frame);
        neighbour_ = pose(of.frame > 0 ? of.frame - 1 : of.frame + 1);
        time_step_s_ = motion.time_step_s;
    }

    MeasuredChanges measure()
    {
        reach_all();
        const std::vector<Samples> samples = time_all();
        const PosedReference reference(character_, reference_flesh(of_.scene), pose_, time_step_s_, of_.refined_reference);
        MeasuredChanges measured;
        for (std::size_t i = 0; i < settings_.size(); ++i) {
            measured.rows.push_back(row_of(settings_[i], reference));
            measured.rows.back().ms = spread_of(samples[i].front());
            if (!settings_[i].finite)
                measured.breakdown += settings_[i].setting.change + " " + settings_[i].setting.setting + " is not finite. ";
        }
        return measured;
    }

private:
    void reach_all()
    {
        pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec_of(of_.scene, "pbs"));
        options.jiggle.reset();
        for (const ChangeSetting& setting : change_settings(options, edge_lengths_m(character_.mesh), of_.range))
            for (const int iterations : of_.range.iterations) {
                stop_if_interrupted();
                TimedSetting& timed = settings_.emplace_back();
                timed.setting = setting;
                timed.setting.options.iterations = iterations;
                DeformerSpec spec = default_spec("pbs");
                spec.options = timed.setting.options;
                timed.deformer = make_deformer(spec);
                timed.deformer->reset(setting.weights == pbs::WeightKind::smooth ? smooth_ : character_);
                timed.finite = timed.deformer->advance(pose_, time_step_s_).outcome == pbs::Outcome::finished;
                timed.positions = timed.deformer->positions();
            }
    }

    std::vector<Samples> time_all()
    {
        std::vector<TimedVariant> turns;
        for (TimedSetting& timed : settings_)
            turns.push_back([this, &timed] {
                stop_if_interrupted();
                const double start_s = process_cpu_s();
                timed.deformer->advance(timed.is_in_pose ? neighbour_ : pose_, time_step_s_);
                const double end_s = process_cpu_s();
                timed.is_in_pose = !timed.is_in_pose;
                return std::vector<double>{1e3 * (end_s - start_s)};
            });
        return take_turns(turns, of_.rounds);
    }

    ChangePoint row_of(const TimedSetting& timed, const PosedReference& reference) const
    {
        ChangePoint row;
        row.of = of_.of;
        row.change = timed.setting.change;
        row.setting = timed.setting.setting;
        row.iterations = timed.setting.options.iterations;
        row.outcome = timed.finite ? "finished" : "not_finite";
        row.metrics = analysis::MeshMetrics(character_.mesh.rest, character_.mesh.tets).measure(timed.positions);
        row.masked_share_pct = reference.masked_share_pct();
        row.reference = reference.is_reached() ? name_of(reference.reference()) : "not_reached";
        row.reference_error_joint_pct = bound_of(reference, of_.refined_reference);
        if (!timed.finite || !reference.is_reached()) return row;
        const analysis::ErrorNorms error = reference.error_of(timed.positions);
        row.error_joint_pct = error.joint_pct;
        row.error_l2_pct = error.l2_pct;
        for (std::size_t b = 0; b < budget_iterations.size(); ++b)
            row.distance_pct[b] = reference.distance(timed.positions, baseline_after(budget_iterations[b])).joint_pct;
        return row;
    }

    const pbs::Positions& baseline_after(int iterations) const
    {
        return std::ranges::find_if(settings_,
                                    [&](const TimedSetting& timed) {
                                        return timed.setting.change == baseline && timed.setting.options.iterations == iterations;
                                    })
            ->positions;
    }

    const ChangesCase& of_;
    pbs::Character character_, smooth_;  // smooth_: with smooth weights
    pbs::Pose pose_, neighbour_;
    double time_step_s_ = 0.0;
    std::deque<TimedSetting> settings_;
};

}  // namespace

nlohmann::json to_json(const ChangesCase& of)
{
    static const auto fields = OptionFields<ChangesCase>("improvements")
                                   .record("of", &ChangesCase::of)
                                   .record("scene", &ChangesCase::scene)
                                   .record("frame", &ChangesCase::frame)
                                   .record("range", &ChangesCase::range)
                                   .record("refined_reference", &ChangesCase::refined_reference)
                                   .record("rounds", &ChangesCase::rounds)
                                   .complete();
    return fields.json(of);
}

MeasuredChanges measure_changes(const ChangesCase& of)
{
    return PoseMeasuring(of).measure();
}

}  // namespace experiments
