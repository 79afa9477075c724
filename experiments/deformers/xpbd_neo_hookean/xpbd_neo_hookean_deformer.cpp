// Elastic flesh in equilibrium by XPBD with the neo-Hookean constraints of Macklin and Mueller (pbs/flesh/xpbd_neo_hookean.hpp).
#include "experiments/deformers/flesh/flesh_deformer.hpp"
#include "pbs/flesh/xpbd_neo_hookean.hpp"

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

}  // namespace experiments
