// C17: what setting a body up takes. One scene text stands for all; each body is that text with another character.body and
// character.vertices, meshed anew, and run. A body that does not run so is tried again with more keys changed, which are counted.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "analysis/measurement.hpp"
#include "experiments/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct BodySetup {
    std::string body;                       // character.body
    int vertices = 0;                       // character.vertices; 0: the body's own default
    std::vector<std::string> further = {};  // key=value: what else had to be changed for it to run
};

// A run of the study: the body, and frames per second of the clip.
struct SetupCase {
    BodySetup setup;
    double rate_hz = 0.0;
};
nlohmann::json to_json(const BodySetup& setup);
nlohmann::json to_json(const SetupCase& of);

// The text that all share: the human through the clip, PBS alone, at rate_hz frames a second.
Scene shared_scene(double rate_hz);
Scene scene_of(const BodySetup& setup, double rate_hz);

// What is tried on a body, one after the other, until it runs: nothing; the nearest bone's weights, where Eq. 2 finds none; double
// precision, where float overflows; and softer volume with it.
const std::vector<std::vector<std::string>>& further_keys();

// What came of a trial: why it did not run (refused input, positions that are not finite, a pose not reached); empty: it ran.
using Trial = std::function<std::string(const BodySetup&)>;
struct TriedSetup {
    BodySetup setup;
    std::string failure;
};
// In the order of further_keys(); the last one has no failure unless none ran.
std::vector<TriedSetup> tried_setups(const BodySetup& setup, const Trial& trial);

// Keys whose values differ, as "pbs.k_volume", of two resolved scenes: all but character.body and character.vertices.
std::vector<std::string> keys_changed(const nlohmann::json& shared, const nlohmann::json& own);

// The figures of C17, of a run's metrics.csv and run.json and the keys that were changed for it.
std::vector<analysis::Measurement> setup_measurements(const analysis::CaseKey& of, const analysis::CsvTable& metrics,
                                                      const nlohmann::json& run, const std::vector<std::string>& changed);
// Of a body that did not run with any of further_keys(): no number of keys does, and no frame is good.
std::vector<analysis::Measurement> not_set_up(const analysis::CaseKey& of);

// Runs it in `folder`/run, with a cache of meshes of its own that is removed afterwards, and writes measurements.csv, changed_keys.csv and
// trials.csv. Returns what broke down. It sets this process's PBSKIN_CACHE.
std::string set_up_and_record(const SetupCase& of, const std::string& folder);

}  // namespace experiments
