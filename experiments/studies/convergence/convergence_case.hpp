// A body in some poses, iterated from each initial guess, in some orders and precisions and on some meshes (claims C03, C12).
//   const ConvergenceResult result = measure_convergence(case_of_the_limb);
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/convergence/starts.hpp"
#include "experiments/studies/shared/iteration_path.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct NamedFrame {
    int frame = 0;
    std::string name;            // twist_90, 01_01_crouch
    analysis::CaseKey key = {};  // motion, angle, time or pose
    bool twist = false;          // about a bone's own axis, which no constraint feels
    bool compared = false;       // with the reference
};

struct ProjectionSetting {
    pbs::Order order = pbs::Order::ordered;
    pbs::Precision precision = pbs::Precision::f32;
};

struct ConvergenceCase {
    Scene scene;
    std::vector<NamedFrame> frames;           // increasing
    std::vector<double> k_stretch;            // the first one is the scene's
    std::vector<ProjectionSetting> settings;  // on the scene's own mesh; on the others only the first one
    std::vector<int> other_vertices;          // further meshes by their wanted size
    int every_setting_to = 0;                 // further meshes up to this wanted size take all settings
    bool ladder = false;  // other_vertices are a ladder of sizes with values of their own; otherwise their spread is the uncertainty
    int most_iterations = 1000;
    DeformerSpec reference = {};    // as PosedReference takes it, solved on the scene's own mesh and on those of a ladder
    bool refines_reference = true;  // also solves it on tets cut into eight, without which it has no bound
    int reference_to = 100000;      // vertices: larger meshes have no reference, and rates.csv states why
};

nlohmann::json to_json(const NamedFrame& frame);
nlohmann::json to_json(const ProjectionSetting& setting);
nlohmann::json to_json(const ConvergenceCase& of);  // everything that a run of the study depends on

// The quality of a path's reference. Empty where there is none. The order and the bound need all of its nested solutions.
struct ReferenceQuality {
    std::optional<double> masked_share_pct = {}, observed_order = {}, bound_pct = {};
    std::optional<bool> order_is_reliable = {};
};

struct ConvergencePaths {
    std::string body, pose;
    analysis::CaseKey key = {};  // of the pose, as NamedFrame has it
    int vertices = 0, tets = 0;
    bool own_mesh = true;  // the scene's
    double k_stretch = 0.0;
    ProjectionSetting setting;
    bool character = false, twist = false;  // character: in a clip; twist: see NamedFrame
    std::string reference;                  // its name, or why there is none
    ReferenceQuality quality = {};
    std::vector<IterationPath> paths;        // by SolverStart
    std::vector<double> limit_from_lbs_pct;  // between the last shapes of each path and of that from LBS, at the joints
};

struct ConvergenceResult {
    std::vector<ConvergencePaths> all;
    bool ladder = false;    // as in the case
    std::string breakdown;  // paths that ceased to be finite; `reference` states one that was not reached
};

ConvergenceResult measure_convergence(const ConvergenceCase& of);

}  // namespace experiments
