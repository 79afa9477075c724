// Elastic flesh in equilibrium by XPBD with the neo-Hookean constraints of Macklin and Mueller (pbs/flesh/xpbd_neo_hookean.hpp). Every
// frame begins at the initial guess anew, so that it does not depend on the frames before.
#include "experiments/deformers/flesh/flesh_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <variant>

namespace experiments {

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
                  .meaning = "time step over the time in which the stiffness of a vertex moves its mass; above 0.8 the steps diverge "
                             "on small tets, and far below they are slow. With multipliers kept it changes the way, not the limit"})
            .add(
                "multipliers", &Options::multipliers,
                {.meaning = "kept over all steps of a frame, with the residual corrected, which converges to the minimum; of_step: zero at "
                            "the beginning of each step, as published, which does not; reset: zero in each iteration, a common mistake"})
            .add("momentum", &Options::momentum, {.meaning = "predict the next step by Nesterov's momentum, with restarts"});
    return fields;
}

class XpbdNeoHookeanDeformer : public Deformer {
public:
    XpbdNeoHookeanDeformer(const XpbdNeoHookeanDeformerOptions& options, int threads) : options_(options), threads_(threads) {}

    void reset(const pbs::Character& character) override
    {
        flesh_.emplace(character, options_);
        positions_ = character.mesh.rest;
        constraints_.emplace(character.mesh, flesh_->flesh().energy(), flesh_->flesh().hold(), pbs::flesh_material(options_.poisson),
                             options_.time_step);
        const pbs::XpbdNeoHookeanOptions options{.iterations = options_.iterations,
                                                 .iterations_per_step = options_.iterations_per_step,
                                                 .multipliers = options_.multipliers,
                                                 .momentum = options_.momentum,
                                                 .arithmetic = options_.arithmetic,
                                                 .threads = threads_};
        if (options_.arithmetic == pbs::Arithmetic::packed_f32)
            solver_.emplace<pbs::XpbdNeoHookean<float>>(character.mesh, *constraints_, options);
        else
            solver_.emplace<pbs::XpbdNeoHookean<double>>(character.mesh, *constraints_, options);
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        flesh_->pose(pose);
        constraints_->hold.targets(pose, targets_);
        positions_ = flesh_->start();
        pbs::XpbdNeoHookeanSummary done;
        if (auto* in_float = std::get_if<pbs::XpbdNeoHookean<float>>(&solver_)) done = in_float->minimise(targets_, positions_);
        if (auto* in_double = std::get_if<pbs::XpbdNeoHookean<double>>(&solver_)) done = in_double->minimise(targets_, positions_);
        pbs::StepSummary summary;
        summary.iterations = done.iterations;
        const auto tets = static_cast<std::int64_t>(constraints_->tets.size()), modes = static_cast<std::int64_t>(targets_.rows());
        summary.work = {.vertex_visits = positions_.rows(),
                        .tet_visits = done.iterations * tets,
                        .projections = done.iterations * (2 * tets + 3 * modes)};
        summary.seconds = stopwatch.seconds();
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override
    {
        if (!flesh_) return nullptr;
        nlohmann::json record = flesh_->record();
        record["linear_constraints_of_the_bones"] = 3 * constraints_->hold.modes().size();
        return record;
    }

private:
    XpbdNeoHookeanDeformerOptions options_;
    int threads_;
    std::optional<PosedFlesh> flesh_;
    std::optional<pbs::XpbdFlesh> constraints_;
    std::variant<std::monostate, pbs::XpbdNeoHookean<float>, pbs::XpbdNeoHookean<double>> solver_;
    pbs::Positions targets_, positions_;
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
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                const auto& options = options_of<XpbdNeoHookeanDeformerOptions>(spec);
                return {.precision = options.arithmetic == pbs::Arithmetic::packed_f32 ? "f32" : "f64",
                        .packed = options.arithmetic != pbs::Arithmetic::plain_f64,
                        .iterations = options.iterations,
                        .threads = spec.threads};
            }};
}

}  // namespace experiments
