// The study splits the error of PBS against the first member of the family. With x_n the shape after n iterations,
// x_inf the same constraints converged, x_h the reference and x_0 its limit on ever finer meshes,
//   x_n - x_0 = (x_n - x_inf) + (x_inf - x_h) + (x_h - x_0)
//               solver          model           discretisation
// exactly, vertex by vertex; the norm of the whole is at most the sum of those of the parts. The first two are
// measured, the third is bounded by PosedReference. The effect of the reference's own assumptions is measured as well:
// flesh that the bones hold in other ways, and the linear model. All distances except whole_joint_pct are outside the
// tips of the reference's creases.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/posed_reference.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct EnsembleCase {
    analysis::CaseKey of;     // body, motion, and the pose or the angle
    Scene scene;              // its character and motion
    int frame = 0;            // of its motion
    DeformerSpec flesh = {};  // a [[fem]] deformer: the reference
    ReferenceEffort effort = ReferenceEffort::other_tets;
    DeformerSpec pbs = {};
    std::vector<DeformerSpec> other_flesh = {};  // is compared with the reference
    std::vector<double> k_stretch = {};
    std::vector<int> iterations = {};
    int converged_iterations = 8000;  // of x_inf; compared with the shape after half of them
};
nlohmann::json to_json(const EnsembleCase& ensemble_case);

// The flesh with quadratic elements on the character's own tets, held in other ways: by stiffer springs, thinner bones,
// embedded bones or the paper's bind constraint; and the linear model, held by smooth springs and by embedded bones.
std::vector<DeformerSpec> other_attachments(const DeformerSpec& flesh);

// The check of KeptReference::own_error_pct: on the body's own tets, the bound that nested solutions and other tets
// give, and the distance of linear elements.
struct OwnTetsRow {
    analysis::CaseKey of;
    std::optional<double> bound_pct = {}, linear_distance_pct = {};
};
struct PartsRow {
    analysis::CaseKey of;
    double k_stretch = 0.0;
    int iterations = 0;
    double error_joint_pct = 0.0, solver_pct = 0.0, model_pct = 0.0, discretisation_pct = 0.0;
    double not_converged_pct = 0.0, error_l2_pct = 0.0, error_linf_m = 0.0, whole_joint_pct = 0.0;
    double masked_share_pct = 0.0;
    std::optional<double> observed_order = {};
    std::optional<bool> order_is_reliable = {};
};
struct AttachmentRow {
    analysis::CaseKey of;
    std::string reference, model, attachment;
    // prescribed nodes have no q, the bind constraint no radius
    std::optional<double> spring_factor = {}, core_radius = {};
    double difference_pct = 0.0, k_stretch = 0.0, model_pct = 0.0;
    bool finished = false;
};
extern const analysis::Columns<OwnTetsRow> own_tets_columns;       // own_tets.csv
extern const analysis::Columns<PartsRow> part_columns;             // parts.csv
extern const analysis::Columns<AttachmentRow> attachment_columns;  // attachments.csv

// A pose whose reference is not reached has no parts.
struct EnsembleRecords {
    std::vector<OwnTetsRow> own_tets;
    std::vector<PartsRow> parts;             // one per k_stretch and number of iterations
    std::vector<AttachmentRow> attachments;  // one per k_stretch and flesh, the reference's own first
};

// solutions: the folder in which the solutions of the references are kept (solutions_of_run); "": none.
EnsembleRecords measure_ensemble(const EnsembleCase& ensemble_case, const std::string& solutions = "");

}  // namespace experiments
