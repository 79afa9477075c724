// The error of PBS against the reference, split three ways. With x_n the shape after n iterations, x_inf the same constraints converged,
// x_h the reference on this mesh and x_0 its limit on ever finer ones,
//   x_n - x_0 = (x_n - x_inf) + (x_inf - x_h) + (x_h - x_0)
//               solver          model           discretisation
// exactly, vertex by vertex; in the norm the parts bound the whole. The first two are measured. The third is the grid convergence index of
// the reference over element order and refinement. Measured as well are the effect of refinement on PBS itself, that of the attachment
// (flesh held by the paper's bind constraint instead of by embedded bones), and that of the bones' thickness (core_radius).
#pragma once

#include "analysis/records/typed_table.hpp"
#include "experiments/studies/shared/posed_character.hpp"

namespace experiments {

struct ErrorSplitCase {
    Scene scene;                    // its character and motion
    std::vector<int> frames;        // of its motion
    DeformerSpec pbs, truth, twin;  // truth: the reference; twin: its law with linear elements
    std::vector<double> k_stretch;
    std::vector<int> iterations;
    int converged_iterations = 8000;  // of x_inf; compared with the shape after half of them
    std::vector<double> core_radii;   // in addition to the scene's own
    int refined_poses = 0;            // so many poses have the reference on the refined mesh too, the others only its twin
};

nlohmann::json to_json(const ErrorSplitCase& of);

struct ErrorParts {
    std::string scene;
    int frame = 0;
    double angle_deg = 0.0;
    double k_stretch = 0.0;
    int iterations = 0;
    double error_joint_pct = 0.0, solver_pct = 0.0, model_pct = 0.0, discretisation_pct = 0.0;
    std::string discretisation_of;
    double not_converged_pct = 0.0, pbs_refinement_pct = 0.0, error_l2_pct = 0.0, error_linf_m = 0.0;
    bool truth_self_intersects = false;
};
struct AttachmentShare {
    std::string scene;
    int frame = 0;
    double angle_deg = 0.0;
    std::string reference, attachment;
    double core_radius = 0.0, difference_pct = 0.0, k_stretch = 0.0, model_pct = 0.0;
    bool finished = false, self_intersects = false;
};
extern const analysis::Columns<ErrorParts> part_columns;             // parts.csv
extern const analysis::Columns<AttachmentShare> attachment_columns;  // attachments.csv

struct ErrorSplit {
    std::vector<ErrorParts> parts;             // one per pose, k_stretch and number of iterations
    std::vector<AttachmentShare> attachments;  // one per pose, k_stretch and reference
    std::string breakdown;                     // what did not finish
};

ErrorSplit split_error(const ErrorSplitCase& of);

}  // namespace experiments
