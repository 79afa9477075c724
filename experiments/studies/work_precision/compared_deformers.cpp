#include "experiments/studies/work_precision/compared_deformers.hpp"

namespace experiments {
namespace {

const std::vector<int> of_projections = {1, 2, 4, 8, 16, 24, 48, 96, 192}, few_of_projections = {4, 24, 96};
const std::vector<int> of_minimisers = {1, 2, 4, 8, 12, 16, 24, 48, 96}, few_of_minimisers = {4, 12, 24};
const std::vector<SettingChange> of_stiffness = {{}, {.young_factor = 4.0}, {.young_factor = 16.0}};

KeyValues set(const std::string& kind, const std::string& key, const std::string& value)
{
    return {kind + "." + key + "=" + value};
}

std::vector<SettingChange> each_of(const std::string& key, const std::vector<std::string>& values)
{
    std::vector<SettingChange> grid = {{}};
    for (const std::string& value : values) grid.push_back({{key + "=" + value}});
    return grid;
}

// In the code of each precision.
std::vector<KeyValues> precisions_of(const std::string& kind)
{
    return {set(kind, "precision", "f32"), set(kind, "precision", "f64")};
}

std::vector<KeyValues> codes_of_blend(const std::string& kind)
{
    return {set(kind, "precision", "f32"), set(kind, "packed", "false")};
}

std::vector<ComparedDeformer> blending()
{
    std::vector<ComparedDeformer> entries;
    for (const auto& [kind, words] : {std::pair{"lbs", "LBS"}, {"dqs", "DQS"}})
        for (const char* weights : {"paper", "diffused"}) {
            const bool is_diffused = std::string(weights) == "diffused";
            const std::string name = std::string(kind) + (is_diffused ? "_diffused" : "");
            entries.push_back({.name = name,
                               .kind = kind,
                               .group = name,
                               .words = std::string(words) + (is_diffused ? " with diffused weights" : ""),
                               .weights = weights,
                               .codes = codes_of_blend(kind)});
        }
    return entries;
}

// Numbers of steps, and sizes of a step for the rotations (lambda) and the translations (kappa, of which alpha is the share).
std::vector<SettingChange> direct_settings()
{
    std::vector<SettingChange> grid = each_of("direct_delta_mush.iterations", {"5", "40", "80"});
    grid.push_back({{"direct_delta_mush.lambda=1", "direct_delta_mush.kappa=1", "direct_delta_mush.alpha=0.5"}});
    grid.push_back({{"direct_delta_mush.lambda=2", "direct_delta_mush.kappa=2", "direct_delta_mush.alpha=0"}});
    return grid;
}

// Direct delta mush smooths once for all poses, so that its iterations are a setting and no work of a frame.
std::vector<ComparedDeformer> mushing()
{
    const ComparedDeformer mush = {.name = "delta_mush",
                                   .kind = "delta_mush",
                                   .group = "delta_mush",
                                   .words = "delta mush",
                                   .iterations_key = "delta_mush.iterations",
                                   .iterations = {0, 1, 2, 5, 10, 20, 50, 100, 200},
                                   .few_iterations = {2, 10, 50},
                                   .grid = each_of("delta_mush.step", {"0.25", "0.9"}),
                                   .codes = precisions_of("delta_mush")};
    const ComparedDeformer direct = {.name = "direct_delta_mush",
                                     .kind = "direct_delta_mush",
                                     .group = "direct_delta_mush",
                                     .words = "direct delta mush",
                                     .grid = direct_settings(),
                                     .codes = precisions_of("direct_delta_mush")};
    std::vector<ComparedDeformer> entries;
    for (ComparedDeformer entry : {mush, direct}) {
        entries.push_back(entry);
        entry.fixed = set(entry.kind, "weights", "diffused");
        entry.name = entry.group = entry.kind + "_diffused";
        entry.words += " with diffused weights";
        entries.push_back(entry);
    }
    return entries;
}

std::vector<ComparedDeformer> projecting()
{
    const std::string exponent = "pbs.variant.stiffness=exponent";
    std::vector<ComparedDeformer> entries;
    entries.push_back({.name = "pbs",
                       .kind = "pbs",
                       .group = "pbs",
                       .words = "PBS",
                       .iterations_key = "pbs.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections,
                       .grid = {{},
                                {{"pbs.k_stretch=0.5"}},
                                {{"pbs.k_stretch=0.9"}},
                                {{"pbs.k_stretch=0.05"}},
                                {{"pbs.k_bind=0.1"}},
                                {{"pbs.k_bind=0.3"}},
                                {{exponent}},
                                {{"pbs.k_stretch=0.9", exponent}}},
                       .codes = {{"pbs.order=ordered", "pbs.precision=f32"}, {"pbs.order=plain", "pbs.precision=f64"}}});
    entries.push_back({.name = "pbs_author",
                       .kind = "pbs_author",
                       .group = "pbs_author",
                       .words = "the first author's later code",
                       .iterations_key = "pbs_author.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections});
    for (const auto& [kind, words] : {std::pair{"xpbd", "XPBD"}, {"xpbd_small_steps", "XPBD"}})
        entries.push_back({.name = kind,
                           .kind = kind,
                           .group = "xpbd",
                           .words = words,
                           .iterations_key = "pbs.iterations",
                           .iterations = of_projections,
                           .few_iterations = few_of_projections,
                           .grid = of_stiffness,
                           .codes = {{"xpbd.order=ordered", "xpbd.precision=f32"}, {"xpbd.order=plain", "xpbd.precision=f64"}},
                           .young_key = "xpbd.young_pa",
                           .poisson_key = "xpbd.poisson"});
    return entries;
}

// Deformers with the reference's material, held by the reference's springs.
ComparedDeformer elastic(const std::string& kind, const std::string& words)
{
    return {.name = kind,
            .kind = kind,
            .group = kind,
            .words = words,
            .iterations_key = kind + ".iterations",
            .iterations = of_minimisers,
            .few_iterations = few_of_minimisers,
            .codes = {set(kind, "packed", "true"), set(kind, "packed", "false")},
            .poisson_key = kind + ".poisson"};
}

std::vector<ComparedDeformer> elastic_ones()
{
    ComparedDeformer quasi_newton = elastic("quasi_newton", "quasi-Newton");
    quasi_newton.grid = {{}, {{"quasi_newton.volume_share=0.3"}}, {{"quasi_newton.volume_share=1"}}, {{"quasi_newton.start=lbs"}}};
    ComparedDeformer vbd = elastic("vbd", "vertex block descent");
    vbd.grid = each_of("vbd.omega", {"1", "1.5", "1.75"});
    vbd.grid.push_back({{"vbd.acceleration=chebyshev", "vbd.omega=1", "vbd.rho=0.9"}});
    ComparedDeformer xpbd = elastic("xpbd_neo_hookean", "neo-Hookean XPBD");
    xpbd.grid = each_of("xpbd_neo_hookean.time_step", {"0.4", "0.6"});
    return {quasi_newton, vbd, xpbd, elastic("projective_dynamics", "projective dynamics")};
}

}  // namespace

const std::vector<ComparedDeformer>& compared_deformers()
{
    static const std::vector<ComparedDeformer> entries = [] {
        std::vector<ComparedDeformer> all = blending();
        for (const auto& more : {mushing(), projecting(), elastic_ones()}) all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return entries;
}

}  // namespace experiments
