// How much a reading changes the volume of a scene: the values of A and B, and whether C01 or C02 would be judged otherwise on it, by their
// own rules and bounds.
#pragma once

#include "experiments/studies/ambiguity/claim_changes.hpp"

namespace experiments {

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

}  // namespace experiments
