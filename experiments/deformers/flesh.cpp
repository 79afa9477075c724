// The deformers that minimise the energy of elastic flesh in equilibrium, on linear tets that springs around the bones
// hold: quasi_newton, vbd, warped_newton, xpbd_neo_hookean and projective_dynamics. Every frame begins at the initial
// guess anew, so that it does not depend on the frames before. A further method of this kind is a struct of options
// that derives from FleshOptions, a class that derives from FleshDeformer, and a kind whose keys begin with
// flesh_fields.
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/process/machine.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/flesh/warped_newton.hpp"
#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "pbs/skinning/blend.hpp"

#include <optional>
#include <utility>
#include <variant>

namespace experiments {

NAMED_OPTIONS(pbs::Acceleration, over_relaxation, chebyshev)
NAMED_OPTIONS(pbs::SpringPlacement, smooth, embedded, held)
NAMED_OPTIONS(pbs::XpbdMultipliers, kept, of_step, reset)

namespace {

// The options of a solver of pbs/flesh, and those of the flesh that it moves.
template <typename SolverOptions>
struct FleshOptions : SolverOptions {
    double poisson = 0.45;
    pbs::SpringPlacement attachment = pbs::SpringPlacement::smooth;
    double core_radius = 0.7, spring_factor = 10.0;
    pbs::StartShape start = pbs::StartShape::smooth_dqs;
    pbs::Precision precision = pbs::Precision::f32;
};

template <typename Options>
OptionFields<Options> flesh_fields(const std::string& kind)
{
    return OptionFields<Options>(kind)
        .add("iterations", &Options::iterations, {.range = {0, 1e6}, .meaning = "iterations per frame"})
        .add("poisson", &Options::poisson,
             {.range = {0.0, 0.4999}, .meaning = "Poisson's ratio of the flesh where strains are small"})
        .add("attachment", &Options::attachment,
             {.meaning = "smooth: springs whose density decreases from a bone's axis to the surface of a capsule "
                         "around it; embedded: of one "
                         "density, so that bones are rigid capsules with core_radius 0.35 and spring_factor 1e4; held: "
                         "as smooth, and each "
                         "bone holds the flesh that it alone moves"})
        .add("core_radius", &Options::core_radius,
             {.range = {above_zero, 1.0},
              .meaning =
                  "radius of the capsules whose springs hold the flesh, a factor on the limb's radius, without a unit"})
        .add("spring_factor", &Options::spring_factor,
             {.range = {above_zero},
              .meaning = "q, a factor without a unit: the springs have the density q E / r^2 on the axis of a capsule "
                         "of radius r"})
        .add("start", &Options::start,
             {.meaning = "initial guess of each frame: dual quaternion skinning with weights that the springs "
                         "determine, or LBS"})
        .add("precision", &Options::precision, {.meaning = "floating point of the iterations"})
        .add("packed", &Options::packed,
             {.meaning =
                  "several elements side by side in the registers; false: plain code in f64, one after the other"})
        .renamed("arithmetic", {{"packed_f32", {"precision=f32", "packed=true"}},
                                {"packed_f64", {"precision=f64", "packed=true"}},
                                {"plain_f64", {"precision=f64", "packed=false"}}});
}

FieldText contact_text()
{
    return {.meaning =
                "a penalty on skin that lies in flesh of another part of the body, as stiff as the column of flesh "
                "below that skin"};
}

// CHOLMOD is linked with BLAS, whose kernels have to be selected before the first module that brings it.
pbs::HeldFlesh held_flesh(const pbs::Character& character, pbs::SpringPlacement placement,
                          const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options)
{
    select_blas_kernels();
    const pbs::BoneSprings held = pbs::bone_springs(character, placement, springs).springs;
    return {character.mesh, held, static_cast<int>(character.skeleton.bones.size()), options};
}

// The flesh of a character with the initial guess of each frame, and the solver: Solver<float> or Solver<double>.
template <typename Options, template <typename> class Solver>
class FleshDeformer : public TimedDeformer {
public:
    explicit FleshDeformer(const Options& options) : options_(options) {}
    void start_from(const pbs::Positions& shape) final { next_start_ = shape; }
    nlohmann::json record() const override
    {
        if (!flesh_) return nullptr;
        nlohmann::json record = {{"springs_outside_the_tets", flesh_->hold().left_out()},
                                 {"entries_of_factor", flesh_->factor().value.size()}};
        if (flesh_->energy().slivers() > 0) record["weakened_slivers"] = flesh_->energy().slivers();
        return record;
    }

protected:
    // The share of lambda in the Laplacian that determines the weights of the initial guess. Methods that also solve
    // with this Laplacian choose a share of their own.
    virtual double volume_share() const { return pbs::HeldFleshOptions().volume_share; }
    virtual void make_solver(const pbs::Character& character) = 0;  // by `make`
    // x: the initial guess in, the result out [m], #V x 3. Returns iterations, work and outcome.
    virtual pbs::StepSummary minimise(const pbs::Pose& pose, pbs::Positions& x) = 0;

    template <typename... Arguments>
    void make(const Arguments&... arguments)
    {
        if (options_.packed && options_.precision == pbs::Precision::f32)
            solver_.template emplace<Solver<float>>(arguments..., options_);
        else
            solver_.template emplace<Solver<double>>(arguments..., options_);
    }
    template <typename... Arguments>
    auto solve(Arguments&&... arguments)
    {
        if (auto* in_float = std::get_if<Solver<float>>(&solver_)) return in_float->minimise(arguments...);
        return std::get<Solver<double>>(solver_).minimise(arguments...);
    }
    const pbs::HeldFlesh& flesh() const { return *flesh_; }
    const pbs::Positions& centres() const { return centres_; }     // of the springs [m], #V x 3
    pbs::BlendSkinning<double>& skinning() { return *skinning_; }  // with the weights of the initial guess
    std::int64_t tets() const { return tets_; }

    Options options_;

private:
    void set_up(const pbs::Character& character) final
    {
        flesh_.emplace(held_flesh(character, options_.attachment,
                                  {.core_radius = options_.core_radius, .spring_factor = options_.spring_factor},
                                  {.poisson = options_.poisson, .volume_share = volume_share()}));
        const bool smooth = options_.start == pbs::StartShape::smooth_dqs;
        skinning_.emplace(character.mesh.rest, smooth ? flesh_->smooth_weights(character.weights) : character.weights);
        tets_ = character.mesh.tets.rows();
        next_start_.reset();
        make_solver(character);
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) final
    {
        if (next_start_)
            x = *std::exchange(next_start_, {});
        else if (options_.start == pbs::StartShape::smooth_dqs)
            skinning_->dual_quaternion(pose, x);
        else
            skinning_->linear(pose, x);
        if (options_.iterations == 0) return {};
        flesh_->hold().centres(pose, centres_);
        return minimise(pose, x);
    }

    std::optional<pbs::HeldFlesh> flesh_;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::optional<pbs::Positions> next_start_;
    pbs::Positions centres_;
    std::int64_t tets_ = 0;
    std::variant<std::monostate, Solver<float>, Solver<double>> solver_;
};

// A quasi-Newton method whose matrix is factored once (pbs/flesh/quasi_newton.hpp).
struct QuasiNewtonFlesh : FleshOptions<pbs::QuasiNewtonOptions> {
    double volume_share = pbs::HeldFleshOptions().volume_share;
};

class QuasiNewtonDeformer : public FleshDeformer<QuasiNewtonFlesh, pbs::QuasiNewton> {
public:
    using FleshDeformer::FleshDeformer;

private:
    double volume_share() const override { return options_.volume_share; }
    void make_solver(const pbs::Character& character) override
    {
        make(character.mesh, flesh().energy(), flesh().factor());
    }
    pbs::StepSummary minimise(const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::QuasiNewtonSummary newton = solve(centres(), x);
        pbs::StepSummary summary;
        summary.iterations = newton.iterations;
        summary.work = {.gradients = newton.evaluations,
                        .vertex_visits = x.rows(),
                        .tet_visits = newton.evaluations * tets(),
                        .linear_solves = newton.solves};
        if (options_.stop_gradient > 0.0 && !newton.converged) summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }
};

// Vertex block descent (pbs/flesh/vbd.hpp).
using VbdFlesh = FleshOptions<pbs::VertexBlockOptions>;

class VbdDeformer : public FleshDeformer<VbdFlesh, pbs::VertexBlockDescent> {
public:
    using FleshDeformer::FleshDeformer;

private:
    void make_solver(const pbs::Character& character) override { make(character.mesh, flesh().energy()); }
    pbs::StepSummary minimise(const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::VertexBlockSummary descent = solve(centres(), x);
        return {.iterations = descent.iterations,
                .work = {.vertex_visits = (1 + descent.iterations) * x.rows(),  // blended once, then moved
                         .tet_visits = 4 * descent.iterations * tets()}};       // once for each of its vertices
    }
};

// A quasi-Newton method whose first matrix is the warped stiffness at rest (pbs/flesh/warped_newton.hpp).
using WarpedFlesh = FleshOptions<pbs::WarpedNewtonOptions>;

class WarpedNewtonDeformer : public FleshDeformer<WarpedFlesh, pbs::WarpedNewton> {
public:
    using FleshDeformer::FleshDeformer;

private:
    void make_solver(const pbs::Character& character) override
    {
        make(character.mesh, flesh().energy(), flesh().factor());
    }
    pbs::StepSummary minimise(const pbs::Pose& pose, pbs::Positions& x) override
    {
        skinning().rotations(pose, rotations_);
        const pbs::WarpedNewtonSummary newton = solve(centres(), rotations_, x);
        return {.iterations = newton.iterations,
                .work = {.gradients = newton.evaluations,
                         .vertex_visits = (1 + newton.sweeps) * x.rows(),
                         .tet_visits = (newton.evaluations + 4 * newton.sweeps) * tets(),
                         .linear_solves = newton.iterations}};
    }

    std::vector<Eigen::Matrix3d> rotations_;  // of the flesh around each vertex, #V
};

// XPBD with the neo-Hookean constraints of Macklin and Mueller (pbs/flesh/xpbd_neo_hookean.hpp).
struct XpbdNeoHookeanFlesh : FleshOptions<pbs::XpbdNeoHookeanOptions> {
    double time_step = 0.8;
};

class XpbdNeoHookeanDeformer : public FleshDeformer<XpbdNeoHookeanFlesh, pbs::XpbdNeoHookean> {
public:
    using FleshDeformer::FleshDeformer;
    nlohmann::json record() const override
    {
        nlohmann::json record = FleshDeformer::record();
        if (!constraints_) return record;
        record["linear_constraints_of_the_bones"] = 3 * constraints_->hold.modes().size();
        record.erase("weakened_slivers");  // the constraints of all tets keep their stiffness
        return record;
    }

private:
    void make_solver(const pbs::Character& character) override
    {
        constraints_.emplace(character.mesh, flesh().energy(), flesh().hold(), pbs::flesh_material(options_.poisson),
                             options_.time_step);
        make(character.mesh, *constraints_);
    }
    pbs::StepSummary minimise(const pbs::Pose& pose, pbs::Positions& x) override
    {
        constraints_->hold.targets(pose, targets_);
        const pbs::XpbdNeoHookeanSummary done = solve(targets_, x);
        const auto modes = static_cast<std::int64_t>(targets_.rows());
        return {.iterations = done.iterations,
                .work = {.vertex_visits = x.rows(),
                         .tet_visits = done.iterations * tets(),
                         .projections = done.iterations * (2 * tets() + 3 * modes)}};
    }

    std::optional<pbs::XpbdFlesh> constraints_;
    pbs::Positions targets_;
};

// Projective dynamics (pbs/flesh/projective_dynamics.hpp). The matrix is factored once for all frames, and the same
// factor gives the weights of the initial guess.
struct ProjectiveFlesh : FleshOptions<pbs::ProjectiveOptions> {
    bool keeps_volume = true;
};

class ProjectiveDynamicsDeformer : public FleshDeformer<ProjectiveFlesh, pbs::ProjectiveDynamics> {
public:
    using FleshDeformer::FleshDeformer;

private:
    double volume_share() const override
    {
        return pbs::volume_share_of_projective(options_.poisson, options_.keeps_volume);
    }
    void make_solver(const pbs::Character& character) override
    {
        const pbs::ProjectiveEnergy energy(
            character.mesh, pbs::projective_weights(options_.poisson, options_.keeps_volume), flesh().hold());
        make(character.mesh, energy, flesh().factor());
    }
    pbs::StepSummary minimise(const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::ProjectiveSummary projective = solve(centres(), x);
        pbs::StepSummary summary;
        summary.iterations = projective.iterations;
        summary.work = {.gradients = projective.iterations,
                        .vertex_visits = x.rows(),
                        .tet_visits = projective.iterations * tets(),
                        .linear_solves = projective.iterations};
        if (options_.stop_step > 0.0 && !projective.converged) summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }
};

}  // namespace

pbs::Weights smooth_weights_of(const pbs::Character& character)
{
    return held_flesh(character, pbs::SpringPlacement::smooth, {}, {}).smooth_weights(character.weights);
}

DeformerKind quasi_newton_kind()
{
    using Options = QuasiNewtonFlesh;
    return kind_of<QuasiNewtonDeformer>(
        "quasi_newton",
        "neo-Hookean flesh in equilibrium on linear tets, by L-BFGS with one prefactored Laplacian (Liu 2017)",
        flesh_fields<Options>("quasi_newton")
            .add("history", &Options::history,
                 {.range = {0, 100}, .meaning = "pairs of steps and changes of the gradient that L-BFGS keeps"})
            .add("volume_share", &Options::volume_share,
                 {.range = {0.0, 100.0},
                  .meaning = "share of lambda in the first matrix; it changes the iterates, not the minimum"})
            .add("stop_gradient", &Options::stop_gradient,
                 {.range = {0.0, 1.0},
                  .meaning = "stop where the preconditioned gradient is below this share of its first value; 0: never"})
            .add("contact", &Options::contact, contact_text()));
}

DeformerKind vbd_kind()
{
    return kind_of<VbdDeformer>(
        "vbd",
        "neo-Hookean flesh in equilibrium on linear tets, by vertex block descent with over-relaxation (Chen 2024)",
        flesh_fields<VbdFlesh>("vbd")
            .add("acceleration", &VbdFlesh::acceleration,
                 {.meaning =
                      "over-relaxation of each vertex, or Chebyshev's weights after each sweep, which may diverge"})
            .add("omega", &VbdFlesh::omega,
                 {.range = {above_zero, 1.999},
                  .meaning = "each vertex moves by omega times the way to its minimum; 1 with chebyshev"})
            .add("rho", &VbdFlesh::rho,
                 {.range = {0.0, 0.9999},
                  .meaning = "the spectral radius of a sweep that chebyshev assumes; unused otherwise"})
            .add("contact", &VbdFlesh::contact, contact_text()));
}

DeformerKind warped_newton_kind()
{
    return kind_of<WarpedNewtonDeformer>(
        "warped_newton",
        "neo-Hookean flesh in equilibrium on linear tets, by L-BFGS with the warped stiffness at rest (Mueller 2002) "
        "and sweeps of vertex "
        "block descent",
        flesh_fields<WarpedFlesh>("warped_newton")
            .add("sweeps", &WarpedFlesh::sweeps,
                 {.range = {0, 1e6}, .meaning = "sweeps over all vertices before the first step and after each"})
            .add("omega", &WarpedFlesh::omega,
                 {.range = {above_zero, 1.999}, .meaning = "over-relaxation of the sweeps"})
            .add("history", &WarpedFlesh::history,
                 {.range = {0, 100}, .meaning = "pairs of steps and changes of the gradient that L-BFGS keeps"}));
}

DeformerKind xpbd_neo_hookean_kind()
{
    using Options = XpbdNeoHookeanFlesh;
    return kind_of<XpbdNeoHookeanDeformer>(
        "xpbd_neo_hookean",
        "neo-Hookean flesh in equilibrium on linear tets, by XPBD with a hydrostatic and a deviatoric constraint per "
        "tet "
        "(Macklin and Mueller 2021)",
        flesh_fields<Options>("xpbd_neo_hookean")
            .add("iterations_per_step", &Options::iterations_per_step,
                 {.range = {1, 1e6}, .meaning = "iterations of each step of implicit Euler"})
            .add("time_step", &Options::time_step,
                 {.range = {above_zero, 1e6},
                  .meaning = "time step over the time in which the stiffness of a vertex moves its mass; above 0.8 "
                             "some poses end in "
                             "an oscillation, and far below it convergence is slow. With multipliers kept it changes "
                             "the iterates, not the limit"})
            .add("multipliers", &Options::multipliers,
                 {.meaning = "kept over all steps of a frame, with the residual corrected, which converges to the "
                             "minimum; of_step: zero at "
                             "the beginning of each step, as published, which does not; reset: zero in each iteration, "
                             "a common mistake"})
            .add("momentum", &Options::momentum,
                 {.meaning = "predict the next step by Nesterov's momentum, with restarts"}));
}

DeformerKind projective_dynamics_kind()
{
    using Options = ProjectiveFlesh;
    return kind_of<ProjectiveDynamicsDeformer>(
        "projective_dynamics",
        "local rotations and volumes and one prefactored system (Bouaziz 2014): its limit is a material of its own",
        flesh_fields<Options>("projective_dynamics")
            .add("keeps_volume", &Options::keeps_volume,
                 {.meaning = "false: without the projection of volumes, as in projective skinning"})
            .add("stop_step", &Options::stop_step,
                 {.range = {0.0, 1.0}, .meaning = "stop where a step is below this share of the first one; 0: never"}));
}

}  // namespace experiments
