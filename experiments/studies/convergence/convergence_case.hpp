// A body in some poses, iterated from each start, in some orders and precisions and on some meshes (claims C03, C12).
//   const ConvergenceResult result = measure_convergence(case_of_the_limb);
#pragma once

#include "analysis/case_key.hpp"
#include "experiments/studies/shared/path_figures.hpp"
#include "experiments/studies/convergence/starts.hpp"
#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct NamedFrame {
    int frame = 0;
    std::string name;            // "twist 90", "01_01 crouch"
    analysis::CaseKey key = {};  // motion, angle, time or pose
    bool twist = false;          // about a bone's own axis, which no constraint feels
};

struct ProjectionSetting {
    pbs::Order order = pbs::Order::ordered;
    pbs::Precision precision = pbs::Precision::f32;
};

struct ConvergenceCase {
    Scene scene;
    std::vector<NamedFrame> frames;           // increasing
    std::vector<double> k_stretch;            // the first one is the scene's
    std::vector<ProjectionSetting> settings;  // of the scene's own mesh; the first one alone on the others
    std::vector<int> other_vertices;          // further meshes by their wanted size
    int every_setting_to = 0;                 // further meshes up to this wanted size take all settings
    bool ladder =
        false;  // other_vertices are a ladder of sizes, each figure its own; else of about one size: their spread is the uncertainty
    int most_iterations = 1000;
    std::string truth;      // deformer of the scene, on its own mesh and on a ladder's; empty: none
    int truth_to = 100000;  // vertices: larger meshes of a ladder are left without, and rates.csv says so
};

nlohmann::json to_json(const NamedFrame& frame);
nlohmann::json to_json(const ProjectionSetting& setting);
nlohmann::json to_json(const ConvergenceCase& of);  // all that a run of the study depends on

struct ConvergencePaths {
    std::string body, pose;
    analysis::CaseKey key = {};  // of the pose, as NamedFrame has it
    int vertices = 0, tets = 0;
    bool own_mesh = true;  // the scene's
    double k_stretch = 0.0;
    ProjectionSetting setting;
    bool character = false, twist = false;  // of a clip, that is no limb; see NamedFrame
    std::string reference;                  // the truth's name; of a mesh without, why
    bool reference_self_intersects = false;
    std::vector<IterationPath> paths;        // by SolverStart
    std::vector<double> limit_from_lbs_pct;  // from the last shape of each path to that of LBS, at the joints
};

struct ConvergenceResult {
    std::vector<ConvergencePaths> all;
    bool ladder = false;    // as asked for
    std::string breakdown;  // paths that ceased to be finite; a reference that was not reached is in `reference`
};

ConvergenceResult measure_convergence(const ConvergenceCase& of);

}  // namespace experiments
