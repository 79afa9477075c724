// Projective dynamics in equilibrium (pbs/flesh/projective_dynamics.hpp). Every frame begins at the initial guess anew, so that it does not
// depend on the frames before; the matrix is factored once for all frames.
#include "experiments/deformers/flesh/flesh_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/geometry/stopwatch.hpp"

namespace experiments {
namespace {

struct ProjectiveDeformerOptions {
    int iterations = 30;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    bool keeps_volume = true;
    double stop_step = 0.0;
};

// The arithmetic of flesh_fields is no option here: there is plain code in double alone.
const OptionFields<ProjectiveDeformerOptions>& projective_fields()
{
    using Options = ProjectiveDeformerOptions;
    static const OptionFields<Options> fields =
        OptionFields<Options>("projective_dynamics")
            .add("iterations", &Options::iterations, {.lowest = 0, .highest = 1e6, .meaning = "local and global steps per frame"})
            .add("poisson", &Options::poisson,
                 {.lowest = 0.0, .highest = 0.4999, .meaning = "Poisson's ratio of the flesh where strains are small"})
            .add("core_radius", &Options::core_radius,
                 {.lowest = above_zero,
                  .highest = 1.0,
                  .meaning = "radius of the capsules whose springs hold the flesh, over the limb's radius"})
            .add("spring_factor", &Options::spring_factor,
                 {.lowest = above_zero, .meaning = "q: the springs have the density q E / r^2 on the axis of a capsule of radius r"})
            .add("start", &Options::start,
                 {.meaning = "initial guess of each frame: dual quaternion skinning with weights that the springs determine, or LBS"})
            .add("keeps_volume", &Options::keeps_volume, {.meaning = "false: without the projection of volumes, as in projective skinning"})
            .add("stop_step", &Options::stop_step,
                 {.lowest = 0.0, .highest = 1.0, .meaning = "stop where a step is below this share of the first one; 0: never"});
    return fields;
}

class ProjectiveDynamicsDeformer : public Deformer {
public:
    explicit ProjectiveDynamicsDeformer(const ProjectiveDeformerOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        constexpr double volume_share = 0.6;  // of the matrix that the initial guess needs
        flesh_.emplace(character, options_, volume_share);
        solver_.emplace(character.mesh, flesh_->flesh().hold(),
                        pbs::ProjectiveOptions{.poisson = options_.poisson,
                                               .iterations = options_.iterations,
                                               .stop_step = options_.stop_step,
                                               .keeps_volume = options_.keeps_volume});
        positions_ = character.mesh.rest;
        tets_ = character.mesh.tets.rows();
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        flesh_->pose(pose);
        positions_ = flesh_->start();
        const pbs::ProjectiveSummary projective = solver_->minimise(flesh_->centres(), positions_);
        pbs::StepSummary summary;
        summary.iterations = projective.iterations;
        summary.work = {.gradients = projective.iterations,
                        .vertex_visits = positions_.rows(),
                        .tet_visits = projective.iterations * tets_,
                        .linear_solves = projective.iterations};
        summary.seconds = stopwatch.seconds();
        if (!positions_.allFinite())
            summary.outcome = pbs::Outcome::not_finite;
        else if (options_.stop_step > 0.0 && !projective.converged)
            summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }

    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override { return flesh_ ? flesh_->record() : nullptr; }

private:
    ProjectiveDeformerOptions options_;
    std::int64_t tets_ = 0;
    std::optional<PosedFlesh> flesh_;
    std::optional<pbs::ProjectiveDynamics> solver_;
    pbs::Positions positions_;
};

}  // namespace

DeformerKind projective_dynamics_kind()
{
    return {.name = "projective_dynamics",
            .meaning = "local rotations and volumes and one prefactored system (Bouaziz 2014): its limit is a material of its own",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<ProjectiveDynamicsDeformer>(options_of<ProjectiveDeformerOptions>(spec));
            },
            .options = ProjectiveDeformerOptions{},
            .keys = projective_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = projective_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return projective_fields().json(options_of<ProjectiveDeformerOptions>(spec)); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                return {.iterations = options_of<ProjectiveDeformerOptions>(spec).iterations};
            }};
}

}  // namespace experiments
