// C17: what setting a body up takes. One scene text stands for all; each body is that text with another [character] table (body, vertices),
// meshed anew, and run.
#pragma once

#include "analysis/csv_table.hpp"
#include "analysis/measurement.hpp"
#include "experiments/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct BodySetup {
    std::string body;                       // character.body
    int vertices = 0;                       // character.vertices; 0: the body's own default
    std::vector<std::string> further = {};  // key=value: what else had to be changed for it to run
};

// The text that all share: the human through the clip, PBS alone, at rate_hz frames a second.
Scene shared_scene(double rate_hz);
Scene scene_of(const BodySetup& setup, double rate_hz);

// Keys whose values differ outside the table [character], as "pbs.k_volume", of two resolved scenes.
std::vector<std::string> keys_changed(const nlohmann::json& shared, const nlohmann::json& own);

// The figures of C17, of a run's metrics.csv and run.json and the keys that were changed for it.
std::vector<analysis::Measurement> setup_measurements(const std::string& of, const analysis::CsvTable& metrics, const nlohmann::json& run,
                                                      const std::vector<std::string>& changed);

// Runs it in `folder`/run, with a cache of meshes of its own that is removed afterwards, and writes measurements.csv and changed_keys.csv.
// Returns what broke down. It sets this process's PBSKIN_CACHE.
std::string set_up_and_record(const BodySetup& setup, double rate_hz, const std::string& folder);

}  // namespace experiments
