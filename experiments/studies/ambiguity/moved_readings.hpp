// What is measured of a scene that moves by each reading: its volume, with the values of A and B and whether C01 or C02 would be judged
// otherwise on it, by their own rules and bounds; and the time of a frame (C10).
//   const ReadMotion moved = move(character, scene);
//   volume_changes("limb_bend", reading, a, b, a, {});
#pragma once

#include "experiments/studies/ambiguity/claim_changes.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

// A character that PBS moves through the motion of a scene.
struct ReadMotion {
    analysis::CaseRecord pbs, lbs;       // volume, from which a verdict is computed
    std::vector<pbs::Positions> shapes;  // of PBS, one per frame [m], #V x 3
    bool finite = true;
};
ReadMotion move(const pbs::Character& character, const Scene& scene);

// C01: the mean of its metrics over the frames; C02: the share of frames within; both judged as analysis::judge_case does.
std::vector<JudgedValue> judged(const ReadMotion& moved);

// A row of figures.csv.
struct VolumeChange {
    std::string scene, place, reading_a, reading_b, quantity;
    double a = 0.0, b = 0.0, change = 0.0;
    std::string verdict_changed;  // no, or the claims with their extents before and after
};
extern const analysis::Columns<VolumeChange> volume_change_columns;

// a: moved by the reading's baseline; resting: by the scene's own reading, from which jiggling is measured; zone: #V
std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b,
                                         const ReadMotion& resting, const std::vector<bool>& zone);

// Moves the body of a case by each reading in turn; writes figures.csv and ambiguity.csv, and returns what broke down.
std::string record_volume(const StudyCase& of, const std::vector<Reading>& readings, const std::string& folder);

// C10: processor time per frame, including LBS, of all readings in turns, in the order and precision that are judged (plain, f64).
std::vector<JudgedReading> values_of_frames(const StudyCase& of, const std::vector<Overrides>& readings);

}  // namespace experiments
