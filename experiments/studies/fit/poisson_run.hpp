// The runs of the fit on a limb that is twisted and bent: the Poisson's ratio of the finite elements nearest to PBS, as recorded in
// poisson.csv, poisson_poses.csv and valley.csv.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/fit/bar_runs.hpp"

namespace experiments {

// The elastic bodies are held by the smooth attachment. The paper's bind constraint as attachment is left out: Newton's method did not
// converge with it on this limb, bent by 30 deg. Quadratic tets take mean dilatation, which does not lock near nu = 1/2.
struct ElasticBody {
    reference_fem::Model model = reference_fem::Model::linear;
    int element_order = 2;
};
struct PoissonCase {
    std::vector<ElasticBody> elastic;
    int vertices = 600, ratios = 7, most_iterations = 10000;  // ratios: at which each pose is solved
    std::vector<double> angles_deg;
    std::vector<double> k_stretch = {0.05, 0.2, 0.9};
};
nlohmann::json to_json(const PoissonCase& of);

struct PoissonSetting {
    std::string model;
    int element_order = 0;
    std::string formulation, attachment;
    std::string body;  // pbs, pbs_converged
    double k_stretch = 0.0;
    int iterations = 0;  // the most of any pose
};
struct PoissonRow {
    PoissonSetting setting;
    int converged_poses = 0, poses = 0;  // converged: of pbs_converged
    double poisson = 0.0, low = 0.0, high = 0.0;
    FitQuality quality;
    double misfit_at_0_pct = 0.0, misfit_at_highest_pct = 0.0, highest_poisson = 0.0;
};
struct PoissonPoseRow {
    PoissonSetting setting;
    std::string pose;
    double poisson = 0.0;
    FitQuality quality;
};
struct ValleyRow {
    PoissonSetting setting;
    double poisson = 0.0, misfit_pct = 0.0;
};
extern const analysis::Columns<PoissonRow> poisson_columns;
extern const analysis::Columns<PoissonPoseRow> poisson_pose_columns;
extern const analysis::Columns<ValleyRow> valley_columns;

std::string record_poisson(const PoissonCase& of, const std::string& folder);

}  // namespace experiments
