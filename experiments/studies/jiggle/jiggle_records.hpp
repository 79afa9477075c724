// The runs of the jiggle study: what each measures and records.
//   const std::string breakdown = record_jolts(of, folder);   // responses.csv, series.csv, zone.csv, measurements.csv
//   const std::string breakdown = record_walk(of, folder);    // walk.csv, series.csv
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "experiments/studies/jiggle/jolt_response.hpp"
#include "experiments/studies/jiggle/walk_response.hpp"
#include "pbs/character/overlap_and_jiggle.hpp"

#include <string>
#include <vector>

namespace experiments {

// The response of the zone's largest piece to a jolt, at each setting.
struct JoltCase {
    Scene scene;  // with pbs, whose gravity is used
    Jolt jolt;    // except its time step, which each setting has
    std::vector<JiggleSetting> settings;
    bool with_reference = false;  // for each setting that swings; then the settings' own values are left to another run
};

// The whole zone through the scene's motion.
struct WalkCase {
    Scene scene;
    std::vector<double> k_stretch;
    int still_steps = 100;  // after the motion
};

// responses.csv: one row per setting, and one per reference that was matched to it.
struct ResponseRow {
    std::string deformer;
    JiggleSetting setting;
    double time_step_ms = 0.0;
    double young_pa = 0.0;  // of the reference; not a number for pbs
    std::string outcome;
    JoltResponse response;
};
// series.csv of a jolt or of a walk.
struct SeriesRow {
    std::string of;
    double time_s = 0.0, excursion_m = 0.0, speed_rms_m_s = 0.0;
};
// zone.csv, one row per bone. The zone's own numbers are the same in all rows.
struct ZoneRow {
    double share_of_vertices = 0.0, share_on_skin = 0.0;
    int pieces = 0, largest_piece = 0;
    pbs::BoneInZone bone;
};
// walk.csv
struct WalkRow {
    double k_stretch = 0.0;
    WalkResponse response;
};
extern const analysis::Columns<ResponseRow> response_columns;
extern const analysis::Columns<SeriesRow> jolt_series_columns, walk_series_columns;
extern const analysis::Columns<ZoneRow> zone_columns;
extern const analysis::Columns<WalkRow> walk_columns;

// Everything that a run's result depends on.
nlohmann::json to_json(const Jolt& jolt);
nlohmann::json to_json(const JoltCase& of);
nlohmann::json to_json(const WalkCase& of);

// Both return what broke down, if anything.
std::string record_jolts(const JoltCase& of, const std::string& folder);
std::string record_walk(const WalkCase& of, const std::string& folder);

}  // namespace experiments
