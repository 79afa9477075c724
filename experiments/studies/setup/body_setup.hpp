// C17: what it takes to set a body up. One scene text is shared by all. Each body is that text with another
// character.body and character.vertices, meshed anew and run. A body that fails is tried again with further keys
// changed, and these keys are counted.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct BodySetup {
    std::string body;                       // character.body
    int vertices = 0;                       // character.vertices; 0: the body's own default
    std::vector<std::string> further = {};  // key=value: what else was changed
    std::string deformer = "pbs";
};

// A run of the study: the body, and frames per second of the clip.
struct SetupCase {
    BodySetup setup;
    double rate_hz = 0.0;
};
nlohmann::json to_json(const BodySetup& setup);
nlohmann::json to_json(const SetupCase& setup_case);

// The shared text: the human through the clip, one deformer alone, at rate_hz frames per second.
Scene shared_scene(double rate_hz, const std::string& deformer = "pbs");
Scene scene_of(const BodySetup& setup, double rate_hz);

// The keys that are tried on a body, one set after the other, until it runs: none; the nearest bone's weights, where
// Eq. 2 gives none; double precision, where float overflows; double precision with softer volume constraints.
const std::vector<std::vector<std::string>>& further_keys();

// The control of C17: two bodies that must need a further key, or fail. open_surface: triangles that enclose nothing,
// with the skeleton of the clip. without_bones: tets on the same points, without a skeleton.
bool is_unsuitable(const std::string& body);
// Writes the files of an unsuitable body into `folder` and names them in the keys of its character. Any other body is
// returned as it is.
BodySetup with_files(const BodySetup& setup, const std::string& folder);

// Returns why the body did not run (refused input, positions that are not finite, a pose that was not reached). Empty:
// it ran.
using Trial = std::function<std::string(const BodySetup&)>;
struct TriedSetup {
    BodySetup setup;
    std::string failure;
};
// The trials in the order of further_keys(). The last one has no failure, unless none ran.
std::vector<TriedSetup> tried_setups(const BodySetup& setup, const Trial& trial);

// trials.csv, and changed_keys.csv, whose rows are keys.
struct TrialRow {
    int trial = 0;
    std::string further_keys, failure;
};
extern const analysis::Columns<TrialRow> trial_columns;
extern const analysis::Columns<std::string> key_columns;

// The keys whose values differ between two resolved scenes, such as "pbs.k_volume", except character.body and
// character.vertices.
std::vector<std::string> keys_changed(const nlohmann::json& shared, const nlohmann::json& own);

// The values of C17, from a run's metrics.csv and run.json and from the keys that were changed for it.
std::vector<analysis::Measurement> setup_measurements(const analysis::CaseKey& key, const analysis::CsvTable& metrics,
                                                      const nlohmann::json& run,
                                                      const std::vector<std::string>& changed);
// The values of a body that did not run with any of further_keys(): the number of keys is unknown, and no frame is
// sound.
std::vector<analysis::Measurement> not_set_up(const analysis::CaseKey& key);

}  // namespace experiments
