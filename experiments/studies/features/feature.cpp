#include "experiments/studies/features/feature.hpp"

namespace experiments {
namespace {

constexpr const char* errors = R"(output.metrics=["errors"])";
constexpr const char* with_lbs = R"(deformers.use=["lbs","pbs"])";
const Variant quadratic_reference = {{R"(deformers.use=["pbs","fem_p2"])", R"(reference.name="fem_p2")", errors}};

}  // namespace

const std::vector<Feature>& features()
{
    static const std::vector<Feature> all = {
        // The bare scene has these three. Their cost is what their absence saves.
        {.name = "stretch constraints", .without = {{"pbs.k_stretch=0"}}, .changes_result = true},
        {.name = "volume constraints", .without = {{"pbs.k_volume=0"}}, .changes_result = true},
        {.name = "bind constraints", .without = {{"pbs.k_bind=0"}}, .changes_result = true},
        {.name = "jiggling zone", .with = {{"pbs.jiggle.k_stretch=0.1"}}, .changes_result = true},
        {.name = "residuals of every iteration", .with = {{"pbs.record_iterations=true"}}},
        {.name = "stop_residual 0.1", .with = {{"pbs.stop_residual=0.1"}}, .changes_result = true},
        {.name = "sleep", .with = {{"pbs.sleep=true"}}, .changes_result = true},
        {.name = "lumped masses", .with = {{"pbs.masses=lumped"}}, .changes_result = true},
        {.name = "precision f64 for f32", .with = {{"pbs.precision=f64"}}, .changes_result = true},
        {.name = "order plain for ordered", .with = {{"pbs.order=plain"}}, .changes_result = true},
        {.name = "order grouped for ordered", .with = {{"pbs.order=grouped"}}, .changes_result = true},
        {.name = "two threads for one", .with = {.threads = 2}, .changes_result = true},
        {.name = "LBS beside", .with = {{with_lbs}}},
        {.name = "DQS beside", .with = {{R"(deformers.use=["dqs","pbs"])"}}},
        {.name = "errors against LBS", .without = {{with_lbs}}, .with = {{with_lbs, R"(reference.name="lbs")", errors}}},
        {.name = "smallest cross-sections", .with = {{R"(output.metrics=["sections"])"}}},
        {.name = "volume of the rendered surface", .with = {{R"(output.metrics=["surface"])"}}, .needs_surface = true},
        {.name = "every frame written", .with = {{"output.frames_every=1"}}},
        {.name = "linear reference, order 1", .with = {{R"(deformers.use=["pbs","fem_p1"])", R"(reference.name="fem_p1")", errors}}},
        {.name = "linear reference, order 2", .with = quadratic_reference},
        {.name = "error bar of the reference (orders)",
         .without = quadratic_reference,
         .with = {{quadratic_reference.overrides[0], quadratic_reference.overrides[1], errors, R"(reference.error_bar="orders")"}}},
        {.name = "progress bar on a terminal", .with = {.progress = true}},
    };
    return all;
}

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant)
{
    std::vector<std::string> overrides = {R"(deformers.use=["pbs"])", R"(reference.name="")",  "output.frames_every=0",
                                          "output.frames=[]",         "output.frame_names=[]", "output.metrics=[]"};
    overrides.insert(overrides.end(), cut.begin(), cut.end());
    overrides.insert(overrides.end(), variant.overrides.begin(), variant.overrides.end());
    Scene scene = read_scene(name, overrides);
    for (DeformerSpec& spec : scene.deformers) spec.threads = variant.threads;
    return scene;
}

}  // namespace experiments
