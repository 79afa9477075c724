// Elastic flesh in equilibrium by a quasi-Newton method whose matrix is factored once (pbs/flesh/quasi_newton.hpp). Every frame begins at
// the initial guess anew, so that it does not depend on the frames before.
#include "experiments/deformers/flesh/flesh_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <variant>

namespace experiments {
namespace {

struct QuasiNewtonDeformerOptions {
    int iterations = 24;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    int history = 5;
    double volume_share = 0.6;
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
                 {.lowest = 0.0, .highest = 100.0, .meaning = "of lambda in the first matrix; it changes the way, not the minimum"})
            .add("stop_gradient", &Options::stop_gradient,
                 {.lowest = 0.0,
                  .highest = 1.0,
                  .meaning = "stop where the preconditioned gradient is below this share of its first value; 0: never"});
    return fields;
}

class QuasiNewtonDeformer : public Deformer {
public:
    QuasiNewtonDeformer(const QuasiNewtonDeformerOptions& options, int threads) : options_(options), threads_(threads) {}

    void reset(const pbs::Character& character) override
    {
        flesh_.emplace(character, options_, options_.volume_share);
        positions_ = character.mesh.rest;
        tets_ = character.mesh.tets.rows();
        const pbs::QuasiNewtonOptions options{.iterations = options_.iterations,
                                              .history = options_.history,
                                              .stop_gradient = options_.stop_gradient,
                                              .arithmetic = options_.arithmetic,
                                              .threads = threads_};
        const pbs::HeldFlesh& flesh = flesh_->flesh();
        if (options_.arithmetic == pbs::Arithmetic::packed_f32)
            solver_.emplace<pbs::QuasiNewton<float>>(character.mesh, flesh.energy(), flesh.factor(), options);
        else
            solver_.emplace<pbs::QuasiNewton<double>>(character.mesh, flesh.energy(), flesh.factor(), options);
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        flesh_->pose(pose);
        positions_ = flesh_->start();
        pbs::QuasiNewtonSummary newton;
        if (auto* in_float = std::get_if<pbs::QuasiNewton<float>>(&solver_)) newton = in_float->minimise(flesh_->centres(), positions_);
        if (auto* in_double = std::get_if<pbs::QuasiNewton<double>>(&solver_)) newton = in_double->minimise(flesh_->centres(), positions_);
        pbs::StepSummary summary;
        summary.iterations = newton.iterations;
        summary.work = {.gradients = newton.evaluations,
                        .vertex_visits = positions_.rows(),
                        .tet_visits = newton.evaluations * tets_,
                        .linear_solves = newton.solves};
        summary.seconds = stopwatch.seconds();
        if (!positions_.allFinite())
            summary.outcome = pbs::Outcome::not_finite;
        else if (options_.stop_gradient > 0.0 && !newton.converged)
            summary.outcome = pbs::Outcome::not_converged;
        return summary;
    }

    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override { return flesh_ ? flesh_->record() : nullptr; }

private:
    QuasiNewtonDeformerOptions options_;
    int threads_;
    std::int64_t tets_ = 0;
    std::optional<PosedFlesh> flesh_;
    std::variant<std::monostate, pbs::QuasiNewton<float>, pbs::QuasiNewton<double>> solver_;
    pbs::Positions positions_;
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
        .traits = [](const DeformerSpec& spec) -> DeformerTraits {
            const auto& options = options_of<QuasiNewtonDeformerOptions>(spec);
            return {.precision = options.arithmetic == pbs::Arithmetic::packed_f32 ? "f32" : "f64",
                    .packed = options.arithmetic != pbs::Arithmetic::plain_f64,
                    .iterations = options.iterations,
                    .threads = spec.threads};
        }};
}

}  // namespace experiments
