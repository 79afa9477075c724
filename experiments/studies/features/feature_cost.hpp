// What a feature costs: both scenes of the pair by turns, each run in a process of its own.
#pragma once

#include "experiments/studies/features/feature.hpp"

#include <string>
#include <vector>

namespace experiments {

// One run of a scene.
struct SceneCost {
    double frame_ms = 0.0;      // everything done a frame, wall time
    double frame_cpu_ms = 0.0;  // the same in processor time of all threads: other work on the machine stretches it less
    double step_ms = 0.0;       // PBS's step alone, wall time
    double step_cpu_ms = 0.0;
    double start_s = 0.0;  // character, motion, deformers, ruler, modules loaded; wall time
    double peak_mb = 0.0;  // 10^6 bytes
    int shared_objects = 0;
    std::string breakdown = {};  // RunResult::breakdown
};

// How far the answer is from the one without the feature, over the frames.
struct AnswerChange {
    double distance_m = 0.0;             // largest of a vertex
    double volume_difference_pct = 0.0;  // largest |difference of volume_change_pct|
};

SceneCost cost_of(const Scene& scene, const Variant& variant, const std::string& scratch_folder);
AnswerChange change_between(const Scene& without, const Scene& with);  // of their PBS deformers

}  // namespace experiments
