// Projective dynamics in equilibrium (pbs/flesh/projective_dynamics.hpp). The matrix is factored once for all frames, and the same factor
// gives the weights of the initial guess.
#include "experiments/deformers/flesh/flesh_deformer.hpp"
#include "pbs/flesh/projective_dynamics.hpp"

namespace experiments {
namespace {

struct ProjectiveDeformerOptions {
    int iterations = 30;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    bool keeps_volume = true;
    double stop_step = 0.0;
};

const OptionFields<ProjectiveDeformerOptions>& projective_fields()
{
    using Options = ProjectiveDeformerOptions;
    static const OptionFields<Options> fields =
        flesh_fields<Options>("projective_dynamics")
            .add("keeps_volume", &Options::keeps_volume, {.meaning = "false: without the projection of volumes, as in projective skinning"})
            .add("stop_step", &Options::stop_step,
                 {.lowest = 0.0, .highest = 1.0, .meaning = "stop where a step is below this share of the first one; 0: never"});
    return fields;
}

class ProjectiveDynamicsDeformer : public FleshDeformer {
public:
    ProjectiveDynamicsDeformer(const ProjectiveDeformerOptions& options, int threads) : options_(options), threads_(threads) {}

private:
    PosedFlesh make_flesh(const pbs::Character& character) const override
    {
        return {character, options_, pbs::volume_share_of_projective(options_.poisson, options_.keeps_volume)};
    }

    void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) override
    {
        const pbs::ProjectiveEnergy energy(character.mesh, pbs::projective_weights(options_.poisson, options_.keeps_volume), flesh.hold());
        const pbs::ProjectiveOptions options{
            .iterations = options_.iterations, .stop_step = options_.stop_step, .arithmetic = options_.arithmetic, .threads = threads_};
        solver_.make(options_.arithmetic, character.mesh, energy, flesh.factor(), options);
    }

    pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::ProjectiveSummary projective = solver_.minimise(flesh.centres(), x);
        pbs::StepSummary summary;
        summary.iterations = projective.iterations;
        summary.work = {.gradients = projective.iterations,
                        .vertex_visits = x.rows(),
                        .tet_visits = projective.iterations * tets(),
                        .linear_solves = projective.iterations};
        if (options_.stop_step > 0.0 && !projective.converged) summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }

    ProjectiveDeformerOptions options_;
    int threads_;
    InArithmetic<pbs::ProjectiveDynamics> solver_;
};

}  // namespace

DeformerKind projective_dynamics_kind()
{
    return {.name = "projective_dynamics",
            .meaning = "local rotations and volumes and one prefactored system (Bouaziz 2014): its limit is a material of its own",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<ProjectiveDynamicsDeformer>(options_of<ProjectiveDeformerOptions>(spec), spec.threads);
            },
            .options = ProjectiveDeformerOptions{},
            .keys = projective_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = projective_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return projective_fields().json(options_of<ProjectiveDeformerOptions>(spec)); },
            .traits = flesh_traits<ProjectiveDeformerOptions>};
}

}  // namespace experiments
