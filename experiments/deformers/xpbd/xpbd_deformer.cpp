#include "experiments/deformers/xpbd/xpbd_deformer.hpp"

#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <algorithm>

namespace experiments {
namespace {

const OptionFields<XpbdOptions>& xpbd_fields()
{
    static const OptionFields<XpbdOptions> fields =
        OptionFields<XpbdOptions>("xpbd")
            .add("young_pa", &XpbdOptions::young_pa,
                 {.unit = "Pa", .lowest = above_zero, .meaning = "Young's modulus of xpbd and xpbd_small_steps"})
            .add("poisson", &XpbdOptions::poisson,
                 {.lowest = 0.25, .highest = 0.499999, .meaning = "Poisson's ratio; springs alone have 1/4, volume constraints raise it"})
            .add("density_kg_m3", &XpbdOptions::density_kg_m3, {.unit = "kg/m^3", .lowest = above_zero, .meaning = "density, lumped"})
            .record("iterations", &XpbdOptions::iterations)
            .record("substeps", &XpbdOptions::substeps)
            .record("gravity_m_s2", &XpbdOptions::gravity_m_s2)
            .record("jiggle", &XpbdOptions::jiggle)
            .record("keep_multipliers", &XpbdOptions::keep_multipliers);
    return fields;
}

// Both kinds share one table of a scene; iterations, gravity and jiggle are those of PBS.
XpbdOptions read_xpbd(const SceneValues& values, DeformerSpec& spec)
{
    XpbdOptions options = xpbd_fields().read(values, "xpbd");
    options.iterations = values.integer("pbs.iterations");
    options.gravity_m_s2 = read_option<pbs::Vec3>(values, "pbs.gravity_m_s2");
    options.jiggle = values.has_table("pbs.jiggle");
    if (options.jiggle) spec.variant = "jiggle";
    return options;
}

}  // namespace

void XpbdDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, character.weights);
    const std::vector<bool> zone = options_.jiggle ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
    solver_ = std::make_unique<XpbdSolver>(character.mesh, character.binding.distance, zone, options_);
}

pbs::StepSummary XpbdDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    const pbs::Stopwatch stopwatch;
    skinning_->linear(pose, lbs_);
    pbs::StepSummary summary = solver_->advance(lbs_, pbs::posed_bind_points(character_->binding, pose), dt_s);
    summary.seconds = stopwatch.seconds();
    return summary;
}

DeformerKind xpbd_kind()
{
    return {
        .name = "xpbd",
        .meaning = "LBS, then extended position based dynamics (Macklin 2016) with an elastic material: multipliers kept through a step",
        .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
            return std::make_unique<XpbdDeformer>(options_of<XpbdOptions>(spec));
        },
        .options = XpbdOptions{},
        .keys = xpbd_fields().keys(),
        .read = [](const SceneValues& values, const std::string&, DeformerSpec& spec) { spec.options = read_xpbd(values, spec); },
        .options_json = [](const DeformerSpec& spec) { return xpbd_fields().json(options_of<XpbdOptions>(spec)); },
        .traits = [](const DeformerSpec& spec) -> DeformerTraits {
            const auto& options = options_of<XpbdOptions>(spec);
            return {.iterations = options.iterations * options.substeps};
        }};
}

DeformerKind xpbd_small_steps_kind()
{
    DeformerKind kind = xpbd_kind();
    kind.name = "xpbd_small_steps";
    kind.meaning = "the same in as many substeps of one iteration (Macklin 2019): equal cost";
    kind.keys.clear();  // those of xpbd
    kind.read = [](const SceneValues& values, const std::string&, DeformerSpec& spec) {
        XpbdOptions options = read_xpbd(values, spec);
        options.substeps = std::max(options.iterations, 1);
        options.iterations = 1;
        spec.options = options;
    };
    return kind;
}

}  // namespace experiments
