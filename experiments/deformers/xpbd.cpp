// LBS, then extended position based dynamics with a material. It costs what PBS costs: n iterations, or n substeps with one
// iteration each. The vertices that jiggle are those of PBS. The default is plain code in double precision; `order` and `precision` choose
// the packed code that PBS has by default.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <algorithm>
#include <optional>

namespace experiments {
namespace {

const OptionFields<pbs::XpbdOptions>& xpbd_fields()
{
    static const OptionFields<pbs::XpbdOptions> fields =
        OptionFields<pbs::XpbdOptions>("xpbd")
            .add("young_pa", &pbs::XpbdOptions::young_pa,
                 {.unit = "Pa", .lowest = above_zero, .meaning = "Young's modulus of xpbd and xpbd_small_steps"})
            .add("poisson", &pbs::XpbdOptions::poisson,
                 {.lowest = 0.25, .highest = 0.499999, .meaning = "Poisson's ratio; springs alone have 1/4, volume constraints raise it"})
            .add("density_kg_m3", &pbs::XpbdOptions::density_kg_m3, {.unit = "kg/m^3", .lowest = above_zero, .meaning = "density, lumped"})
            .add("order", &pbs::XpbdOptions::order,
                 {.meaning =
                      "order of projection within a class: plain is the order of the file; ordered and grouped are those of pbs, which "
                      "project sixteen constraints at once"})
            .add("precision", &pbs::XpbdOptions::precision, {.meaning = "floating point of the projections and their multipliers"})
            .record("iterations", &pbs::XpbdOptions::iterations)
            .record("substeps", &pbs::XpbdOptions::substeps)
            .record("gravity_m_s2", &pbs::XpbdOptions::gravity_m_s2)
            .record("jiggle", &pbs::XpbdOptions::jiggle)
            .record("keep_multipliers", &pbs::XpbdOptions::keep_multipliers);
    return fields;
}

// Both kinds share one table of a scene; iterations, gravity and jiggle are those of PBS.
pbs::XpbdOptions read_xpbd(const SceneValues& values, DeformerSpec& spec)
{
    pbs::XpbdOptions options = xpbd_fields().read(values, "xpbd");
    options.iterations = values.integer("pbs.iterations");
    options.gravity_m_s2 = read_option<pbs::Vec3>(values, "pbs.gravity_m_s2");
    options.jiggle = values.has_table("pbs.jiggle");
    if (options.jiggle) spec.variant = "jiggle";
    return options;
}

class XpbdDeformer : public Deformer {
public:
    explicit XpbdDeformer(const pbs::XpbdOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        character_ = &character;
        skinning_.emplace(character.mesh.rest, character.weights);
        const std::vector<bool> zone = options_.jiggle ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
        solver_.emplace(character.mesh, character.binding.distance, zone, options_);
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const pbs::Stopwatch stopwatch;
        skinning_->linear(pose, lbs_);
        pbs::StepSummary summary = solver_->advance(lbs_, pbs::posed_bind_points(character_->binding, pose), dt_s);
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits += lbs_.rows();
        return summary;
    }

    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return options_.jiggle; }

private:
    pbs::XpbdOptions options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::optional<pbs::XpbdSolver> solver_;
    pbs::Positions lbs_;
};

}  // namespace

DeformerKind xpbd_kind()
{
    return {.name = "xpbd",
            .meaning =
                "LBS, then extended position based dynamics (Macklin 2016) with an elastic material; multipliers are kept through a step",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                pbs::XpbdOptions options = options_of<pbs::XpbdOptions>(spec);
                options.threads = spec.threads;
                return std::make_unique<XpbdDeformer>(options);
            },
            .options = pbs::XpbdOptions{},
            .keys = xpbd_fields().keys(),
            .read = [](const SceneValues& values, const std::string&, DeformerSpec& spec) { spec.options = read_xpbd(values, spec); },
            .options_json = [](const DeformerSpec& spec) { return xpbd_fields().json(options_of<pbs::XpbdOptions>(spec)); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                const auto& options = options_of<pbs::XpbdOptions>(spec);
                const bool packed = options.order != pbs::Order::plain;
                return {.order = name_of(options.order),
                        .precision = name_of(options.precision),
                        .packed = packed,
                        .iterations = options.iterations * options.substeps,
                        .threads = packed ? spec.threads : 1};
            }};
}

DeformerKind xpbd_small_steps_kind()
{
    DeformerKind kind = xpbd_kind();
    kind.name = "xpbd_small_steps";
    kind.meaning = "xpbd with as many substeps as xpbd has iterations, of one iteration each (Macklin 2019): equal cost";
    kind.keys.clear();  // those of xpbd
    kind.read = [](const SceneValues& values, const std::string&, DeformerSpec& spec) {
        pbs::XpbdOptions options = read_xpbd(values, spec);
        options.substeps = std::max(options.iterations, 1);
        options.iterations = 1;
        spec.options = options;
    };
    return kind;
}

}  // namespace experiments
