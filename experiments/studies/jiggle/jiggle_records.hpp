// The runs of the jiggle study: what each measures and records.
//   const std::string breakdown = record_jolts(of, folder);   // responses.csv, zone.csv, measurements.csv
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/study.hpp"

#include <string>
#include <vector>

namespace experiments {

// The step response of a body's flesh: the skeleton is moved by a jolt in one time step and then held still.
//   const JoltResponse response = jolt_response(character, spec, probe, {});
//   response.swing.frequency_hz.estimate, response.left_over_peak
// The quantity that swings is the mean displacement of the probe's vertices along the jolt, from where they lay before,
// moved with the skeleton.
struct Jolt {
    pbs::Vec3 direction = pbs::Vec3::UnitY();  // unit
    double length_m = 0.02;
    double time_step_s = 0.01;
    int still_steps = 2;  // before it
    int steps = 150;      // including that of the jolt
};

struct JoltResponse {
    double path_m = 0.0;  // length of the jolt, or of the probe's path on its bones: the unit of what is over the jolt
    std::vector<double> excursion_m{};    // of the probe, one per step, beginning with that of the jolt
    std::vector<double> speed_rms_m_s{};  // of all the body's vertices
    analysis::DampedOscillation swing{};  // fitted to the excursion
    double peak_over_jolt = 0.0;          // largest excursion, either way; 1 where flesh stays behind at first
    double overshoot_over_jolt = 0.0;     // largest excursion beyond the place on the skeleton
    double settling_s = 0.0;              // after which the excursion stays within a tenth of its peak
    double rest_over_jolt = 0.0;  // of stop_response: where the probe comes to rest, from its place without inertia
    double left_over_peak = 0.0;  // largest excursion of the last tenth
    double speed_growth = 0.0;    // largest speed after the first tenth over that within it; above 1, energy has grown
    bool finished = true;         // every step
};

inline constexpr double settled_share = 0.1;  // of the peak, within which the excursion is settled
JoltResponse jolt_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe,
                           const Jolt& jolt);

// The skeleton goes through a motion and is then held still. What swings is the mean displacement of the probe's
// vertices from where they come to rest (their mean in the last tenth), along the probe's last velocity. The excursion
// begins with the first still step. InputError where the motion does not move the probe.
JoltResponse stop_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe,
                           const pbs::Motion& motion, int still_steps);

// A limb that moves and stops. PBS and XPBD have their jiggling zone; XPBD and the finite elements have one material,
// that of the scene's reference, and nothing is fitted. The other minimisers have no inertia.
struct StopCase {
    Scene scene;                                                      // a movement, with pbs, xpbd and a reference
    std::string bone;                                                 // the probe: its vertices in the zone
    std::vector<double> k_stretch = {0.05, 0.1, 0.2, 0.5, 0.9};       // of PBS in the zone
    std::vector<double> rayleigh_stiffness_s = {0.001, 0.003, 0.01};  // dampings of the finite elements
    int finer_steps = 4;   // of these, and of a second run of XPBD, for each step of PBS
    double still_s = 2.0;  // after the motion
};

// The response of the zone's largest piece to a jolt, at each setting.
struct JoltCase {
    std::string scene;                     // built-in, with pbs, whose gravity is used
    Overrides overrides = {};              // of the scene
    std::vector<Overrides> settings = {};  // each one on top of these
    Jolt jolt = {};                        // except its time step, which each setting has
    bool with_reference = false;  // for each setting that swings; then the settings' own values are left to another run
    std::vector<double> young_pa = {};  // of the finite elements that are controls
};

Scene scene_of(const JoltCase& jolt_case, Overrides setting = {});

// responses.csv: one row per setting in plain f64, the paper's solver, and one per reference that was matched to it.
struct ResponseRow {
    std::string deformer = "pbs";
    double k_stretch = 0.1;  // in the zone; 1 elsewhere
    double time_step_ms = 10.0;
    int iterations = paper_iterations;
    std::string masses = "unit";
    double k_bind = 1.0;                    // in the zone; 1 elsewhere
    double young_pa = analysis::not_known;  // of the reference
    std::string order = "plain", precision = "f64";
    JoltResponse response = {};
};
// zone.csv, one row per bone. The zone's own numbers are the same in all rows.
struct ZoneRow {
    double share_of_vertices = 0.0, share_on_skin = 0.0;
    int pieces = 0, largest_piece = 0;
    pbs::BoneInZone bone;
};
extern const analysis::Columns<ResponseRow> response_columns;
extern const analysis::Columns<ZoneRow> zone_columns;

// Everything that a run's result depends on.
nlohmann::json to_json(const Jolt& jolt);
nlohmann::json to_json(const JoltCase& jolt_case);
nlohmann::json to_json(const StopCase& stop);

// Both return what broke down, if anything.
std::string record_jolts(const JoltCase& jolt_case, const std::string& folder);
std::string record_stop(const StopCase& stop, const std::string& folder);  // stop.csv, one row per deformer and setting

ResponseRow setting_of(const Scene& scene);  // of its PBS; the response is left out

// The case of a setting. k_bind is set only where the zone is not bound as the rest is.
analysis::CaseKey key_of(const std::string& body, const ResponseRow& row);

// What one body's responses measure, per setting: the amplitude, which is the overshoot over the jolt, of those that
// finish; the damping ratio and the frequency of those that swing (DampedOscillation::found). If the zone is bound and
// all masses are 1, as in the paper: the share of the peak that is left at the end (C09a), NaN where the setting breaks
// down. Otherwise the damping ratio is a quantity of its own.
std::vector<analysis::Measurement> response_values(const std::string& body, const std::vector<ResponseRow>& rows);

// These conclusions follow from the measured values:
// - in the paper's solver: the share of the paper's settings that swing; the rank correlation of the frequency with
//   k_stretch, with its range when one setting is left out, and the ratio of the frequencies at the ends of k_stretch;
// - the ratio of the largest and the smallest amplitude over k_stretch and their rank correlation (C09b), in each order
//   and precision. The damped finite elements have Young's modulus in the place of k_stretch;
// - the ratio of frequencies with twice the iterations and with the default;
// - the ratio of frequencies with half the time step and with the whole, for the first setting, with its range over all
//   halvings. Without gravity Algorithm 1 makes it 2 on any body: by lines 7, 8 and 16 a particle moves on by its last
//   movement, x_n + (x_n - x_n-1), however long a step is, so that the frequency is one per step.
std::vector<analysis::Measurement> jiggle_conclusions(const std::vector<analysis::Measurement>& measured);

// Both.
std::vector<analysis::Measurement> jiggle_values(const std::string& body, const std::vector<ResponseRow>& rows);

}  // namespace experiments
