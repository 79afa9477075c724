// The figures that claims are judged by, of a body moved by each reading in turn, in one pose, order and precision, so that they have no
// interval. Every figure is measured as its claim's own study does it, with two differences: C10's frame is timed by processor time, its
// study's by wall time; of C09 there are the figures of single settings and of pairs of them, none that its study makes of all settings.
//   const ReadingsCase of = {.scene = read_scene("limb_bend", {}), .frame = 18, .pose = "bend 90"};
//   for (const ReadingFigures& read : figures_of_starts(of, readings)) ...   // one a reading
#pragma once

#include "experiments/studies/ambiguity/judged_figure.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

struct ReadingsCase {
    Scene scene;
    int frame = 0;  // of the scene's motion
    std::string pose;
    analysis::CaseKey key = {};  // motion, angle or pose
    pbs::Vec3 jolt_direction = pbs::Vec3::UnitY();
    int most_iterations = 1000;  // of paths
    int jolt_steps = 150;        // from the jolt's own on
    double timing_s = 2.0;       // in all
};

nlohmann::json to_json(const ReadingsCase& of);

// C03, C12: paths of iterations from the four starts, with the reading's weights and bind points. The previous frame, where it is a start,
// was reached with the bone's own material points. C12 is judged on characters alone.
std::vector<ReadingFigures> figures_of_starts(const ReadingsCase& of, const std::vector<Reading>& readings);

// C04 or C05, as the case has it: sections of the body's joints in the poses of a sweep, each step of which is taken, beside one reference.
std::vector<ReadingFigures> figures_of_sections(const ArtefactCase& of, const std::vector<Reading>& readings);

// C07: single projections and a pass of each class that is judged, from the reading's LBS shape, momentum counted by its own masses.
std::vector<ReadingFigures> figures_of_projections(const ReadingsCase& of, const std::vector<Reading>& readings);

// C09: a jolt without gravity at the reading's own stiffness in the zone, at 0.1 there, at half the time step and at twice the iterations.
// A reading of flesh that does not jiggle is given Table 1's 0.9 in the zone. All count as the paper's own setting.
// Damping ratios, and the frequency's ratios over time steps and iterations; what is of all settings of the study is left out.
inline constexpr double table_1_k_stretch = 0.9, soft_k_stretch = 0.1;
inline constexpr double least_answer = 1e-3;  // of the jolt; flesh that LBS carries along is off by rounding, some 1e-5, which is no swing
std::vector<ReadingFigures> figures_of_jolts(const ReadingsCase& of, const std::vector<Reading>& readings);

// C10: processor time of a frame, LBS included, of all readings by turns, in the order and precision that are judged (plain, f64).
std::vector<ReadingFigures> figures_of_frames(const ReadingsCase& of, const std::vector<Reading>& readings);

}  // namespace experiments
