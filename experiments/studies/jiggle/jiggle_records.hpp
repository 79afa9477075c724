// The runs of the jiggle study: what each measures and leaves on record.
//   const std::string breakdown = record_jolts(of, folder);   // responses.csv, series.csv, zone.csv, measurements.csv
//   const std::string breakdown = record_walk(of, folder);    // walk.csv, series.csv
#pragma once

#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "experiments/studies/jiggle/jolt_response.hpp"
#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

// The zone's largest piece after a jolt, at each setting.
struct JoltCase {
    Scene scene;  // with pbs, whose gravity counts
    Jolt jolt;    // time steps are the settings'
    std::vector<JiggleSetting> settings;
    bool with_reference = false;  // beside each setting that swings; no figures of the settings themselves, which another run measures
};

// The whole zone through the scene's motion.
struct WalkCase {
    Scene scene;
    std::vector<double> k_stretch;
    int still_steps = 100;  // behind the motion
};

// All that a run's result depends on.
nlohmann::json settings_of(const JoltCase& of);
nlohmann::json settings_of(const WalkCase& of);

// What broke down, if anything.
std::string record_jolts(const JoltCase& of, const std::string& folder);
std::string record_walk(const WalkCase& of, const std::string& folder);

}  // namespace experiments
