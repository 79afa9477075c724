// The shared options of the deformers that minimise the energy of elastic flesh: material, springs of the bones and initial guess.
// The options of such a deformer are a struct with these members and its own; its keys begin with flesh_fields<Options>(kind).

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/character/bone_capsules.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"

#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

namespace experiments {

template <>
struct OptionNames<pbs::Arithmetic> {
    static constexpr std::array<std::pair<pbs::Arithmetic, const char*>, 3> table{{{pbs::Arithmetic::packed_f32, "packed_f32"},
                                                                                   {pbs::Arithmetic::packed_f64, "packed_f64"},
                                                                                   {pbs::Arithmetic::plain_f64, "plain_f64"}}};
};

template <>
struct OptionNames<pbs::FleshStart> {
    static constexpr std::array<std::pair<pbs::FleshStart, const char*>, 2> table{
        {{pbs::FleshStart::smooth_dqs, "smooth_dqs"}, {pbs::FleshStart::lbs, "lbs"}}};
};

template <typename Options>
OptionFields<Options> flesh_fields(const std::string& kind)
{
    return OptionFields<Options>(kind)
        .add("iterations", &Options::iterations, {.lowest = 0, .highest = 1e6, .meaning = "iterations per frame"})
        .add("poisson", &Options::poisson,
             {.lowest = 0.0, .highest = 0.4999, .meaning = "Poisson's ratio of the flesh where strains are small"})
        .add("core_radius", &Options::core_radius,
             {.lowest = above_zero,
              .highest = 1.0,
              .meaning = "radius of the capsules whose springs hold the flesh, a factor on the limb's radius, without a unit"})
        .add("spring_factor", &Options::spring_factor,
             {.lowest = above_zero,
              .meaning = "q, a factor without a unit: the springs have the density q E / r^2 on the axis of a capsule of radius r"})
        .add("start", &Options::start,
             {.meaning = "initial guess of each frame: dual quaternion skinning with weights that the springs determine, or LBS"})
        .add("arithmetic", &Options::arithmetic,
             {.meaning = "several elements side by side in float or double, or one after the other in double"});
}

// The flesh of a character and the initial guesses of its frames.
class PosedFlesh {
public:
    // volume_share is the share of lambda in the Laplacian that determines the weights of the initial guess. Methods that also solve with
    // this Laplacian choose a share of their own.
    template <typename Options>
    PosedFlesh(const pbs::Character& character, const Options& options, double volume_share = pbs::HeldFleshOptions().volume_share)
        : PosedFlesh(character, {.core_radius = options.core_radius, .spring_factor = options.spring_factor},
                     {.poisson = options.poisson, .volume_share = volume_share}, options.start)
    {
    }

    // Sets the centres of the springs and the initial guess of a pose: the shape of start_from, if there is one, or as the options say.
    void pose(const pbs::Pose& pose);
    void start_from(const pbs::Positions& shape) { next_start_ = shape; }  // [m], #V x 3, for the next pose

    const pbs::HeldFlesh& flesh() const { return flesh_; }
    const pbs::Positions& centres() const { return centres_; }  // [m], #V x 3
    const pbs::Positions& start() const { return start_; }      // [m], #V x 3
    nlohmann::json record() const;                              // of the springs and the factor, for run.json

private:
    PosedFlesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options,
               pbs::FleshStart start);

    pbs::HeldFlesh flesh_;
    pbs::FleshStart how_;
    pbs::BlendSkinning<double> skinning_;
    pbs::Positions centres_, start_;
    std::optional<pbs::Positions> next_start_;
};

// The base class of the deformers that minimise the energy of elastic flesh. It has their frames, initial guesses, records and traits.
// Every frame begins at the initial guess anew, so that it does not depend on the frames before. A deformer of this kind derives from
// FleshDeformer, sets up its solver in make_solver, and minimises in `minimise`.

// Solver<float> or Solver<double>, whichever an arithmetic needs.
template <template <typename> class Solver>
class InArithmetic {
public:
    template <typename... Arguments>
    void make(pbs::Arithmetic arithmetic, const Arguments&... arguments)
    {
        if (arithmetic == pbs::Arithmetic::packed_f32)
            solver_.template emplace<Solver<float>>(arguments...);
        else
            solver_.template emplace<Solver<double>>(arguments...);
    }

    auto minimise(const pbs::Positions& targets, pbs::Positions& x)
    {
        using Summary = decltype(std::declval<Solver<double>&>().minimise(targets, x));
        return std::visit(
            [&](auto& solver) {
                if constexpr (std::is_same_v<std::decay_t<decltype(solver)>, std::monostate>)
                    return Summary{};
                else
                    return solver.minimise(targets, x);
            },
            solver_);
    }

private:
    std::variant<std::monostate, Solver<float>, Solver<double>> solver_;
};

class FleshDeformer : public Deformer {
public:
    void reset(const pbs::Character& character) final;
    // Times the frame. A shape that is not finite is the outcome not_finite, whatever the method reports.
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) final;
    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override { return flesh_ ? flesh_->record() : nullptr; }

protected:
    virtual PosedFlesh make_flesh(const pbs::Character& character) const = 0;
    virtual void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) = 0;
    // x: the initial guess in, the result out [m], #V x 3. Returns iterations, work and outcome.
    virtual pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& pose, pbs::Positions& x) = 0;

    std::int64_t tets() const { return tets_; }

private:
    std::int64_t tets_ = 0;
    std::optional<PosedFlesh> flesh_;
    pbs::Positions positions_;
};

// Returns the traits of a spec. Options must have the members `arithmetic` and `iterations`.
template <typename Options>
DeformerTraits flesh_traits(const DeformerSpec& spec)
{
    const auto& options = options_of<Options>(spec);
    return {.precision = options.arithmetic == pbs::Arithmetic::packed_f32 ? "f32" : "f64",
            .packed = options.arithmetic != pbs::Arithmetic::plain_f64,
            .iterations = options.iterations,
            .threads = spec.threads};
}

namespace {

// CHOLMOD is linked with BLAS, whose kernels have to be selected before the first module that brings it.
pbs::HeldFlesh held_flesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options)
{
    select_blas_kernels();
    return {character.mesh, pbs::smooth_springs(character, springs).springs, static_cast<int>(character.skeleton.bones.size()), options};
}

}  // namespace

PosedFlesh::PosedFlesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options,
                       pbs::FleshStart start)
    : flesh_(held_flesh(character, springs, options)),
      how_(start),
      skinning_(character.mesh.rest, start == pbs::FleshStart::smooth_dqs ? flesh_.smooth_weights(character.weights) : character.weights)
{
}

void PosedFlesh::pose(const pbs::Pose& pose)
{
    flesh_.hold().centres(pose, centres_);
    if (next_start_)
        start_ = *std::exchange(next_start_, {});
    else if (how_ == pbs::FleshStart::smooth_dqs)
        skinning_.dual_quaternion(pose, start_);
    else
        skinning_.linear(pose, start_);
}

nlohmann::json PosedFlesh::record() const
{
    return {{"springs_outside_the_tets", flesh_.hold().left_out()}, {"entries_of_factor", flesh_.factor().value.size()}};
}

void FleshDeformer::reset(const pbs::Character& character)
{
    flesh_.emplace(make_flesh(character));
    positions_ = character.mesh.rest;
    tets_ = character.mesh.tets.rows();
    make_solver(character, flesh_->flesh());
}

pbs::StepSummary FleshDeformer::advance(const pbs::Pose& pose, double /*dt_s*/)
{
    const pbs::Stopwatch stopwatch;
    flesh_->pose(pose);
    positions_ = flesh_->start();
    pbs::StepSummary summary = minimise(*flesh_, pose, positions_);
    summary.seconds = stopwatch.seconds();
    if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

// Elastic flesh in equilibrium by a quasi-Newton method whose matrix is factored once (pbs/flesh/quasi_newton.hpp).

namespace {

struct QuasiNewtonDeformerOptions {
    int iterations = 24;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    int history = 5;
    double volume_share = pbs::HeldFleshOptions().volume_share;
    double stop_gradient = 0.0;
};

const OptionFields<QuasiNewtonDeformerOptions>& quasi_newton_fields()
{
    using Options = QuasiNewtonDeformerOptions;
    static const OptionFields<Options> fields =
        flesh_fields<Options>("quasi_newton")
            .add("history", &Options::history,
                 {.lowest = 0, .highest = 100, .meaning = "pairs of steps and changes of the gradient that L-BFGS keeps"})
            .add("volume_share", &Options::volume_share,
                 {.lowest = 0.0,
                  .highest = 100.0,
                  .meaning = "share of lambda in the first matrix; it changes the iterates, not the minimum"})
            .add("stop_gradient", &Options::stop_gradient,
                 {.lowest = 0.0,
                  .highest = 1.0,
                  .meaning = "stop where the preconditioned gradient is below this share of its first value; 0: never"});
    return fields;
}

class QuasiNewtonDeformer : public FleshDeformer {
public:
    QuasiNewtonDeformer(const QuasiNewtonDeformerOptions& options, int threads) : options_(options), threads_(threads) {}

private:
    PosedFlesh make_flesh(const pbs::Character& character) const override { return {character, options_, options_.volume_share}; }

    void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) override
    {
        const pbs::QuasiNewtonOptions options{.iterations = options_.iterations,
                                              .history = options_.history,
                                              .stop_gradient = options_.stop_gradient,
                                              .arithmetic = options_.arithmetic,
                                              .threads = threads_};
        solver_.make(options_.arithmetic, character.mesh, flesh.energy(), flesh.factor(), options);
    }

    pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::QuasiNewtonSummary newton = solver_.minimise(flesh.centres(), x);
        pbs::StepSummary summary;
        summary.iterations = newton.iterations;
        summary.work = {.gradients = newton.evaluations,
                        .vertex_visits = x.rows(),
                        .tet_visits = newton.evaluations * tets(),
                        .linear_solves = newton.solves};
        if (options_.stop_gradient > 0.0 && !newton.converged) summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }

    QuasiNewtonDeformerOptions options_;
    int threads_;
    InArithmetic<pbs::QuasiNewton> solver_;
};

}  // namespace

DeformerKind quasi_newton_kind()
{
    return {
        .name = "quasi_newton",
        .meaning = "neo-Hookean flesh in equilibrium on linear tets, by L-BFGS with one prefactored Laplacian (Liu 2017)",
        .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
            return std::make_unique<QuasiNewtonDeformer>(options_of<QuasiNewtonDeformerOptions>(spec), spec.threads);
        },
        .options = QuasiNewtonDeformerOptions{},
        .keys = quasi_newton_fields().keys(),
        .read = [](const SceneValues& values, const std::string& table,
                   DeformerSpec& spec) { spec.options = quasi_newton_fields().read(values, table); },
        .options_json = [](const DeformerSpec& spec) { return quasi_newton_fields().json(options_of<QuasiNewtonDeformerOptions>(spec)); },
        .traits = flesh_traits<QuasiNewtonDeformerOptions>};
}

// Elastic flesh in equilibrium by vertex block descent (pbs/flesh/vbd.hpp).
template <>
struct OptionNames<pbs::Acceleration> {
    static constexpr std::array<std::pair<pbs::Acceleration, const char*>, 2> table{
        {{pbs::Acceleration::over_relaxation, "over_relaxation"}, {pbs::Acceleration::chebyshev, "chebyshev"}}};
};

namespace {

struct VbdOptions {
    int iterations = 64;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    pbs::Acceleration acceleration = pbs::Acceleration::over_relaxation;
    double omega = 1.88;
    double rho = 0.95;
};

const OptionFields<VbdOptions>& vbd_fields()
{
    static const OptionFields<VbdOptions> fields =
        flesh_fields<VbdOptions>("vbd")
            .add("acceleration", &VbdOptions::acceleration,
                 {.meaning = "over-relaxation of each vertex, or Chebyshev's weights after each sweep, which may diverge"})
            .add("omega", &VbdOptions::omega,
                 {.lowest = above_zero,
                  .highest = 1.999,
                  .meaning = "each vertex moves by omega times the way to its minimum; 1 with chebyshev"})
            .add("rho", &VbdOptions::rho,
                 {.lowest = 0.0, .highest = 0.9999, .meaning = "the spectral radius of a sweep that chebyshev assumes; unused otherwise"});
    return fields;
}

class VbdDeformer : public FleshDeformer {
public:
    VbdDeformer(const VbdOptions& options, int threads) : options_(options), threads_(threads) {}

private:
    PosedFlesh make_flesh(const pbs::Character& character) const override { return {character, options_}; }

    void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) override
    {
        const pbs::VertexBlockOptions options{.iterations = options_.iterations,
                                              .acceleration = options_.acceleration,
                                              .omega = options_.omega,
                                              .rho = options_.rho,
                                              .arithmetic = options_.arithmetic,
                                              .threads = threads_};
        solver_.make(options_.arithmetic, character.mesh, flesh.energy(), options);
    }

    pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::VertexBlockSummary descent = solver_.minimise(flesh.centres(), x);
        pbs::StepSummary summary;
        summary.iterations = descent.iterations;
        summary.work = {.vertex_visits = (1 + descent.iterations) * x.rows(),  // blended once, then moved
                        .tet_visits = 4 * descent.iterations * tets()};        // once for each of its vertices
        return summary;
    }

    VbdOptions options_;
    int threads_;
    InArithmetic<pbs::VertexBlockDescent> solver_;
};

}  // namespace

DeformerKind vbd_kind()
{
    return {.name = "vbd",
            .meaning = "neo-Hookean flesh in equilibrium on linear tets, by vertex block descent with over-relaxation (Chen 2024)",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<VbdDeformer>(options_of<VbdOptions>(spec), spec.threads);
            },
            .options = VbdOptions{},
            .keys = vbd_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = vbd_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return vbd_fields().json(options_of<VbdOptions>(spec)); },
            .traits = flesh_traits<VbdOptions>};
}

// Elastic flesh in equilibrium by XPBD with the neo-Hookean constraints of Macklin and Mueller (pbs/flesh/xpbd_neo_hookean.hpp).
template <>
struct OptionNames<pbs::XpbdMultipliers> {
    static constexpr std::array<std::pair<pbs::XpbdMultipliers, const char*>, 3> table{
        {{pbs::XpbdMultipliers::kept, "kept"}, {pbs::XpbdMultipliers::of_step, "of_step"}, {pbs::XpbdMultipliers::reset, "reset"}}};
};

namespace {

struct XpbdNeoHookeanDeformerOptions {
    int iterations = 48;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    int iterations_per_step = 1;
    double time_step = 0.8;
    pbs::XpbdMultipliers multipliers = pbs::XpbdMultipliers::kept;
    bool momentum = true;
};

const OptionFields<XpbdNeoHookeanDeformerOptions>& xpbd_neo_hookean_fields()
{
    using Options = XpbdNeoHookeanDeformerOptions;
    static const OptionFields<Options> fields =
        flesh_fields<Options>("xpbd_neo_hookean")
            .add("iterations_per_step", &Options::iterations_per_step,
                 {.lowest = 1, .highest = 1e6, .meaning = "iterations of each step of implicit Euler"})
            .add("time_step", &Options::time_step,
                 {.lowest = above_zero,
                  .highest = 1e6,
                  .meaning =
                      "time step over the time in which the stiffness of a vertex moves its mass; above 0.8 some poses end in "
                      "an oscillation, and far below it convergence is slow. With multipliers kept it changes the iterates, not the limit"})
            .add(
                "multipliers", &Options::multipliers,
                {.meaning = "kept over all steps of a frame, with the residual corrected, which converges to the minimum; of_step: zero at "
                            "the beginning of each step, as published, which does not; reset: zero in each iteration, a common mistake"})
            .add("momentum", &Options::momentum, {.meaning = "predict the next step by Nesterov's momentum, with restarts"});
    return fields;
}

class XpbdNeoHookeanDeformer : public FleshDeformer {
public:
    XpbdNeoHookeanDeformer(const XpbdNeoHookeanDeformerOptions& options, int threads) : options_(options), threads_(threads) {}

    nlohmann::json record() const override
    {
        nlohmann::json record = FleshDeformer::record();
        if (constraints_) record["linear_constraints_of_the_bones"] = 3 * constraints_->hold.modes().size();
        return record;
    }

private:
    PosedFlesh make_flesh(const pbs::Character& character) const override { return {character, options_}; }

    void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) override
    {
        constraints_.emplace(character.mesh, flesh.energy(), flesh.hold(), pbs::flesh_material(options_.poisson), options_.time_step);
        const pbs::XpbdNeoHookeanOptions options{.iterations = options_.iterations,
                                                 .iterations_per_step = options_.iterations_per_step,
                                                 .multipliers = options_.multipliers,
                                                 .momentum = options_.momentum,
                                                 .arithmetic = options_.arithmetic,
                                                 .threads = threads_};
        solver_.make(options_.arithmetic, character.mesh, *constraints_, options);
    }

    pbs::StepSummary minimise(const PosedFlesh& /*flesh*/, const pbs::Pose& pose, pbs::Positions& x) override
    {
        constraints_->hold.targets(pose, targets_);
        const pbs::XpbdNeoHookeanSummary done = solver_.minimise(targets_, x);
        pbs::StepSummary summary;
        summary.iterations = done.iterations;
        const auto modes = static_cast<std::int64_t>(targets_.rows());
        summary.work = {
            .vertex_visits = x.rows(), .tet_visits = done.iterations * tets(), .projections = done.iterations * (2 * tets() + 3 * modes)};
        return summary;
    }

    XpbdNeoHookeanDeformerOptions options_;
    int threads_;
    std::optional<pbs::XpbdFlesh> constraints_;
    InArithmetic<pbs::XpbdNeoHookean> solver_;
    pbs::Positions targets_;
};

}  // namespace

DeformerKind xpbd_neo_hookean_kind()
{
    return {.name = "xpbd_neo_hookean",
            .meaning =
                "neo-Hookean flesh in equilibrium on linear tets, by XPBD with a hydrostatic and a deviatoric constraint per tet "
                "(Macklin and Mueller 2021)",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<XpbdNeoHookeanDeformer>(options_of<XpbdNeoHookeanDeformerOptions>(spec), spec.threads);
            },
            .options = XpbdNeoHookeanDeformerOptions{},
            .keys = xpbd_neo_hookean_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = xpbd_neo_hookean_fields().read(values, table); },
            .options_json =
                [](const DeformerSpec& spec) { return xpbd_neo_hookean_fields().json(options_of<XpbdNeoHookeanDeformerOptions>(spec)); },
            .traits = flesh_traits<XpbdNeoHookeanDeformerOptions>};
}

// Projective dynamics in equilibrium (pbs/flesh/projective_dynamics.hpp). The matrix is factored once for all frames, and the same factor
// gives the weights of the initial guess.

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
