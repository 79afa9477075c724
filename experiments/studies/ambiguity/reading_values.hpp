// The values that claims are judged by, for a body that is moved by each reading in turn, in one pose, order and precision, so that they
// have no interval. Every value is measured as its claim's own study does it, with two differences: C10's frame is timed by processor time,
// that of its study by wall time; and C09 has the values of single settings and of pairs of them, but none that its study computes from all
// settings.
//   const ReadingsCase of = {.scene = read_scene("limb_bend", {}), .frame = 18, .pose = "bend 90"};
//   for (const ReadingValues& read : values_of_starts(of, readings)) ...   // one per reading
#pragma once

#include "experiments/studies/ambiguity/claim_changes.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

struct ReadingsCase {
    Scene scene;
    int frame = 0;  // of the scene's motion
    std::string pose;
    analysis::CaseKey key = {};  // motion, angle or pose
    pbs::Vec3 jolt_direction = pbs::Vec3::UnitY();
    int most_iterations = 1000;  // of paths
    int jolt_steps = 150;        // including that of the jolt
    double timing_s = 2.0;       // of all readings together
};

nlohmann::json to_json(const ReadingsCase& of);

// C03, C12: paths of iterations from the four initial guesses, with the reading's weights and bind points. The previous frame, where it is
// the initial guess, was reached with the bone's own material points. C12 is judged on characters alone.
std::vector<ReadingValues> values_of_starts(const ReadingsCase& of, const std::vector<Reading>& readings);

// C04 or C05, as the case has it: sections of the body's joints in the poses of a sweep, all steps of which are taken, and one reference.
std::vector<ReadingValues> values_of_sections(const ArtefactCase& of, const std::vector<Reading>& readings);

// C07: single projections and a pass of each class that is judged, from the reading's LBS shape. Momentum is that of the reading's masses.
std::vector<ReadingValues> values_of_projections(const ReadingsCase& of, const std::vector<Reading>& readings);

// C09: a jolt without gravity at the reading's own stiffness in the zone, at 0.1 there, at half the time step and at twice the iterations.
// A reading whose flesh does not jiggle takes Table 1's 0.9 in the zone. All count as the paper's own setting. The values are damping
// ratios, and the ratios of frequencies over time steps and iterations; those that the study computes from all its settings are left out.
inline constexpr double table_1_k_stretch = 0.9, soft_k_stretch = 0.1;
inline constexpr double least_answer = 1e-3;  // of the jolt; flesh that LBS carries along moves by rounding, some 1e-5, which is no swing
std::vector<ReadingValues> values_of_jolts(const ReadingsCase& of, const std::vector<Reading>& readings);

// C10: processor time per frame, including LBS, of all readings in turns, in the order and precision that are judged (plain, f64).
std::vector<ReadingValues> values_of_frames(const ReadingsCase& of, const std::vector<Reading>& readings);

// How much a reading changes the volume of a scene: the values of A and B, and whether C01 or C02 would be judged otherwise on it, by their
// own rules and bounds.

// One run: a body moved through a scene by each reading in turn.
struct VolumeReadings {
    std::string body;
    Scene scene;
    std::vector<Reading> readings;
};
nlohmann::json to_json(const VolumeReadings& of);

// A row of figures.csv.
struct VolumeChange {
    std::string scene, place, reading_a, reading_b, quantity;
    double a = 0.0, b = 0.0, change = 0.0;
    std::string verdict_changed;  // no, or the claims with their extents before and after
};
extern const analysis::Columns<VolumeChange> volume_change_columns;

// Quantities that the report shows.
inline constexpr const char* mean_change = "mean_volume_change_pct";
inline constexpr const char* mean_abs_change = "mean_volume_abs_change_pct";
inline constexpr const char* share_within_printed = "share_of_frames_within_printed";
inline constexpr const char* distance_from_a = "distance_of_b_from_a_rms_m";
inline constexpr const char* distance_by_jiggle = "distance_of_zone_by_jiggle_rms_m";

// a: moved by the reading's baseline; resting: by the scene's own reading, from which jiggling is measured; zone: #V
std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b,
                                         const ReadMotion& resting, const std::vector<bool>& zone);

// Writes figures.csv and ambiguity.csv.
std::string record_volume(const VolumeReadings& of, const std::string& folder);

// One line per reading and scene, as Markdown.
std::string volume_markdown(const std::vector<VolumeChange>& changes);

}  // namespace experiments
