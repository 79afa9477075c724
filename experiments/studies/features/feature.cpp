#include "experiments/studies/features/feature.hpp"

namespace experiments {
namespace {

Variant set(std::vector<std::string> overrides)
{
    return {.overrides = std::move(overrides)};
}

// On top of the bare scene.
Feature added(const std::string& name, std::vector<std::string> overrides)
{
    return {.name = name, .without = {}, .with = set(std::move(overrides))};
}

Feature answer_changing(Feature feature)
{
    feature.changes_answer = true;
    return feature;
}

// Part of the bare scene: what its absence saves.
Feature left_out(const std::string& name, std::vector<std::string> overrides)
{
    return {.name = name, .without = set(std::move(overrides)), .with = {}, .changes_answer = true};
}

Feature on_top_of(const std::string& name, std::vector<std::string> without, const std::vector<std::string>& more)
{
    Feature feature{.name = name, .without = set(without), .with = {}};
    without.insert(without.end(), more.begin(), more.end());
    feature.with = set(std::move(without));
    return feature;
}

std::vector<Feature> features_of_the_solver()
{
    return {
        left_out("stretch constraints", {"pbs.k_stretch=0"}),
        left_out("volume constraints", {"pbs.k_volume=0"}),
        left_out("bind constraints", {"pbs.k_bind=0"}),
        answer_changing(added("jiggling zone", {"pbs.jiggle.k_stretch=0.1"})),
        added("residuals of every iteration", {"pbs.record_iterations=true"}),
        answer_changing(added("stop_residual 0.1", {"pbs.stop_residual=0.1"})),
        answer_changing(added("sleep", {"pbs.sleep=true"})),
        answer_changing(added("lumped masses", {"pbs.masses=lumped"})),
        answer_changing(added("precision f64 for f32", {"pbs.precision=f64"})),
        answer_changing(added("order plain for ordered", {"pbs.order=plain"})),
        answer_changing(added("order grouped for ordered", {"pbs.order=grouped"})),
        {.name = "two threads for one", .without = {}, .with = {.overrides = {}, .threads = 2}, .changes_answer = true},
    };
}

Feature with_surface(Feature feature)
{
    feature.needs_surface = true;
    return feature;
}

std::vector<Feature> features_of_the_scene()
{
    const std::vector<std::string> blend = {R"(deformers.use=["lbs","pbs"])"};
    const std::vector<std::string> order_2 = {R"(deformers.use=["pbs","fem_p2"])", R"(reference.name="fem_p2")",
                                              R"(output.metrics=["errors"])"};
    std::vector<Feature> features = {
        added("LBS beside", blend),
        added("DQS beside", {R"(deformers.use=["dqs","pbs"])"}),
        on_top_of("errors against LBS", blend, {R"(reference.name="lbs")", R"(output.metrics=["errors"])"}),
        added("smallest cross-sections", {R"(output.metrics=["sections"])"}),
        with_surface(added("volume of the rendered surface", {R"(output.metrics=["surface"])"})),
        added("every frame written", {"output.frames_every=1"}),
        added("linear reference, order 1",
              {R"(deformers.use=["pbs","fem_p1"])", R"(reference.name="fem_p1")", R"(output.metrics=["errors"])"}),
        added("linear reference, order 2", order_2),
        on_top_of("error bar of the reference (orders)", order_2, {R"(reference.error_bar="orders")"}),
        {.name = "progress bar on a terminal", .without = {}, .with = {.overrides = {}, .progress = true}},
    };
    return features;
}

std::vector<Feature> all_features()
{
    std::vector<Feature> all = features_of_the_solver();
    for (Feature& feature : features_of_the_scene()) all.push_back(std::move(feature));
    return all;
}

}  // namespace

std::vector<std::string> bare_scene()
{
    return {R"(deformers.use=["pbs"])", R"(reference.name="")",  "output.frames_every=0",
            "output.frames=[]",         "output.frame_names=[]", "output.metrics=[]"};
}

const std::vector<Feature>& features()
{
    static const std::vector<Feature> all = all_features();
    return all;
}

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant)
{
    std::vector<std::string> overrides = bare_scene();
    overrides.insert(overrides.end(), cut.begin(), cut.end());
    overrides.insert(overrides.end(), variant.overrides.begin(), variant.overrides.end());
    Scene scene = read_scene(name, overrides);
    for (DeformerSpec& spec : scene.deformers) spec.threads = variant.threads;
    return scene;
}

}  // namespace experiments
