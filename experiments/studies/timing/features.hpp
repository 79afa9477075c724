// The optional features of a scene, as pairs of scenes that differ in one feature alone.
#pragma once

#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A scene's settings on top of the bare scene: PBS alone, no reference, no frames on disk and no metrics except the volume.
struct Variant {
    std::vector<std::string> overrides = {};  // key=value
    int threads = 1;
    bool progress = false;  // a progress bar on a terminal

    bool operator==(const Variant&) const = default;
};

// A pair of scenes that differ in one feature alone.
struct Feature {
    std::string name;
    Variant without = {}, with = {};
    bool changes_result = false;  // the positions; how far they move is measured too
};

// The features of a case of cases.toml: features = [{ name = "sleep", with = ["pbs.sleep=true"], changes_result = true }, ...]. Further
// keys of a feature: without, threads and progress (of the second scene), and only = "human" for one of the case's bodies.
std::vector<Feature> features_of(const StudyCase& of);

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant);

// The cost of a feature: time and memory of both scenes of the pair, and how far the result moves.
//   const Samples with = take_turns(...)[0];   // each turn is costs_of_run(run_scene_alone(scene, folder), scene)
//   table_of(feature_columns, {feature_row("limb", feature, without, with)}).write("features.csv");

// A scene with features. `scene` and `cut` are a built-in scene and its overrides.
struct FeaturesCase {
    std::string name, scene;
    std::vector<std::string> cut;
    std::vector<Feature> features = {};
    Rounds rounds = {};
};
nlohmann::json to_json(const Variant& variant);
nlohmann::json to_json(const Feature& feature);
nlohmann::json to_json(const FeaturesCase& of);

struct Compared {
    Spread without, with, ratio;  // ratio: with / without in the same round
};
// std::logic_error unless both have the same number of rounds, at least one.
Compared compare(const std::vector<double>& without, const std::vector<double>& with);

// How far the result is from the one without the feature, over the frames.
struct ResultChange {
    double distance_m = 0.0;             // largest of a vertex
    double volume_difference_pct = 0.0;  // largest |difference of volume_change_pct|
};
ResultChange change_between(const Scene& without, const Scene& with);  // of their PBS deformers

struct FeatureRow {
    std::string scene, feature;
    int rounds = 0;
    Compared frame_ms, frame_cpu_ms, step_ms, step_cpu_ms, start_s, peak_mb;
    int shared_objects_without = 0, shared_objects_with = 0;
    std::optional<ResultChange> change;
};
extern const analysis::Columns<FeatureRow> feature_columns;

// The costs of one run of a scene from its run.json, in the order of FeatureRow: frame_ms to peak_mb, then the shared objects.
std::vector<double> costs_of_run(const nlohmann::json& run, const Scene& scene);

FeatureRow feature_row(const std::string& scene, const std::string& feature, const Samples& without, const Samples& with,
                       const std::optional<ResultChange>& change = {});

// The work of a run: writes features.csv. Each scene runs in a process of its own, and they take turns. Returns the first breakdown, or "".
std::string measure_features(const FeaturesCase& of, const std::string& folder);

}  // namespace experiments
