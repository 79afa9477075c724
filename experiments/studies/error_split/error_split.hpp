// The error of PBS against the reference, split three ways. With x_n the shape after n iterations, x_inf the same constraints converged,
// x_h the reference and x_0 its limit on ever finer meshes,
//   x_n - x_0 = (x_n - x_inf) + (x_inf - x_h) + (x_h - x_0)
//               solver          model           discretisation
// exactly, vertex by vertex; in the norm the parts bound the whole. The first two are measured, the third is bounded by PosedReference.
// Measured as well are the effect of refinement on PBS itself, and that of the reference's own assumptions: flesh that the bones hold in
// other ways, and the linear model. All distances except whole_joint_pct are outside the part of the body that overlaps itself in
// the reference.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <optional>

namespace experiments {

struct ErrorSplitCase {
    Scene scene;                            // its character and motion
    std::vector<int> frames;                // of its motion
    DeformerSpec pbs, reference;            // reference: a [[fem]] deformer as PosedReference takes it
    std::vector<DeformerSpec> others = {};  // other flesh, which is compared with the reference
    std::vector<double> k_stretch;
    std::vector<int> iterations;
    int converged_iterations = 8000;  // of x_inf; compared with the shape after half of them
};

nlohmann::json to_json(const ErrorSplitCase& of);

// The reference's flesh with quadratic elements on the character's own tets, held in other ways: by stiffer springs, thinner bones,
// embedded bones or the paper's bind constraint; and the linear model, held by smooth springs and by embedded bones.
std::vector<DeformerSpec> other_attachments(const DeformerSpec& reference);

struct ErrorParts {
    std::string scene;
    int frame = 0;
    double angle_deg = 0.0;
    double k_stretch = 0.0;
    int iterations = 0;
    double error_joint_pct = 0.0, solver_pct = 0.0, model_pct = 0.0, discretisation_pct = 0.0;
    double not_converged_pct = 0.0, pbs_refinement_pct = 0.0, error_l2_pct = 0.0, error_linf_m = 0.0, whole_joint_pct = 0.0;
    double masked_share_pct = 0.0;
    std::optional<double> observed_order = {};
    std::optional<bool> order_is_reliable = {};
};
struct AttachmentShare {
    std::string scene;
    int frame = 0;
    double angle_deg = 0.0;
    std::string reference, model, attachment;
    std::optional<double> spring_factor = {}, core_radius = {};  // prescribed nodes have no q, the bind constraint no radius
    double difference_pct = 0.0, k_stretch = 0.0, model_pct = 0.0;
    bool finished = false;
};
extern const analysis::Columns<ErrorParts> part_columns;             // parts.csv
extern const analysis::Columns<AttachmentShare> attachment_columns;  // attachments.csv

// Poses whose reference is not reached have no rows.
struct ErrorSplit {
    std::vector<ErrorParts> parts;             // one per pose, k_stretch and number of iterations
    std::vector<AttachmentShare> attachments;  // one per pose, k_stretch and flesh, the reference's own first
    std::string breakdown;                     // the references that are not reached
};

ErrorSplit split_error(const ErrorSplitCase& of);

}  // namespace experiments
