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
        {.name = "stretch_constraints", .without = {{"pbs.k_stretch=0"}}, .changes_result = true},
        {.name = "volume_constraints", .without = {{"pbs.k_volume=0"}}, .changes_result = true},
        {.name = "bind_constraints", .without = {{"pbs.k_bind=0"}}, .changes_result = true},
        {.name = "jiggling_zone", .with = {{"pbs.jiggle.k_stretch=0.1"}}, .changes_result = true},
        {.name = "residuals_of_every_iteration", .with = {{"pbs.record_iterations=true"}}},
        {.name = "stop_residual_0.1", .with = {{"pbs.stop_residual=0.1"}}, .changes_result = true},
        {.name = "sleep", .with = {{"pbs.sleep=true"}}, .changes_result = true},
        {.name = "lumped_masses", .with = {{"pbs.masses=lumped"}}, .changes_result = true},
        {.name = "precision_f64_for_f32", .with = {{"pbs.precision=f64"}}, .changes_result = true},
        {.name = "order_plain_for_ordered", .with = {{"pbs.order=plain"}}, .changes_result = true},
        {.name = "order_grouped_for_ordered", .with = {{"pbs.order=grouped"}}, .changes_result = true},
        {.name = "two_threads_for_one", .with = {.threads = 2}, .changes_result = true},
        {.name = "LBS_for_comparison", .with = {{with_lbs}}},
        {.name = "DQS_for_comparison", .with = {{R"(deformers.use=["dqs","pbs"])"}}},
        {.name = "errors_against_LBS", .without = {{with_lbs}}, .with = {{with_lbs, R"(reference.name="lbs")", errors}}},
        {.name = "smallest_cross_sections", .with = {{R"(output.metrics=["sections"])"}}},
        {.name = "volume_of_the_rendered_surface", .with = {{R"(output.metrics=["surface"])"}}, .needs_surface = true},
        {.name = "every_frame_written", .with = {{"output.frames_every=1"}}},
        {.name = "linear_reference_order_1", .with = {{R"(deformers.use=["pbs","fem_p1"])", R"(reference.name="fem_p1")", errors}}},
        {.name = "linear_reference_order_2", .with = quadratic_reference},
        {.name = "error_bar_of_the_reference_orders",
         .without = quadratic_reference,
         .with = {{quadratic_reference.overrides[0], quadratic_reference.overrides[1], errors, R"(reference.error_bar="orders")"}}},
        {.name = "progress_bar_on_a_terminal", .with = {.progress = true}},
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
