// Elastic flesh in equilibrium by a quasi-Newton method whose matrix is factored once (pbs/flesh/quasi_newton.hpp).
#include "experiments/deformers/flesh/flesh_deformer.hpp"
#include "pbs/flesh/quasi_newton.hpp"

namespace experiments {
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

}  // namespace experiments
