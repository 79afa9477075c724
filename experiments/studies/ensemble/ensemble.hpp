// Which deformer is closer to elastic flesh, whatever reference of a family is taken: one body in one pose against several members of a
// family of references, which differ in how the bones hold the flesh and in how compressible it is.
//   const EnsembleRecords records = measure_ensemble(of);
//   table_of(pair_columns, records.pairs).write("pairs.csv");
// A pair of deformers is decided if every member orders it in the same way by more than its own error allows, with the default settings of
// both and with those chosen on training poses (analysis/verdicts/pair_order.hpp).
//
// And what the error of PBS against the first member is made of. With x_n the shape after n iterations, x_inf the same constraints
// converged, x_h the reference and x_0 its limit on ever finer meshes,
//   x_n - x_0 = (x_n - x_inf) + (x_inf - x_h) + (x_h - x_0)
//               solver          model           discretisation
// exactly, vertex by vertex; the norm of the whole is at most the sum of those of the parts. The first two are measured, the third is
// bounded by PosedReference.
// The effect of the reference's own assumptions is measured as well: flesh that the bones hold in other ways, and the linear model. All
// distances except whole_joint_pct are outside the tips of the reference's creases.
#pragma once

#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/pair_order.hpp"
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
    DeformerSpec flesh = {};  // a [[fem]] deformer, which the members change
    std::vector<EnsembleMember> members = {};
    ReferenceEffort effort = ReferenceEffort::other_tets;  // of the first member with each Poisson's ratio
    std::vector<DeformerSpec> deformers = {};              // that are ordered
    std::vector<DeformerSpec> tuned = {};                  // some of them with the settings chosen on the training poses
    // The parts of PBS's error, of each stiffness of the stretch constraints and number of iterations.
    DeformerSpec pbs = {};
    std::vector<DeformerSpec> other_flesh = {};  // is compared with the first member
    std::vector<double> k_stretch = {};
    std::vector<int> iterations = {};
    int converged_iterations = 8000;  // of x_inf; compared with the shape after half of them
};
nlohmann::json to_json(const EnsembleCase& of);

// The flesh with quadratic elements on the character's own tets, held in other ways: by stiffer springs, thinner bones, embedded bones or
// the paper's bind constraint; and the linear model, held by smooth springs and by embedded bones.
std::vector<DeformerSpec> other_attachments(const DeformerSpec& flesh);

struct MemberRow {
    analysis::CaseKey of;
    EnsembleMember member;
    std::string outcome;                                      // reached, inverted, not_converged
    std::optional<int> element_order = {}, refinements = {};  // nothing for refinements: on other tets
    std::optional<double> error_bound_pct = {}, error_bound_l2_pct = {}, spread_pct = {}, observed_order = {};
    std::optional<bool> reliable = {};
    double masked_share_pct = 0.0;
    std::optional<double> volume_change_pct = {};
    std::optional<double> lowest_det_f = {};  // of the reference, as the following; of the finest solution where it is not reached
    int inverted_tets = 0;
    double j_min = 0.0;
    int worst_tet = -1;
    int newton_steps = 0, projected = 0;
    double solve_s = 0.0;
};
struct ErrorRow {
    analysis::CaseKey of;
    std::string member, deformer;
    double error_joint_pct = 0.0, error_l2_pct = 0.0, whole_joint_pct = 0.0, volume_change_pct = 0.0;
    analysis::SkinError skin = {};
};
// How one member orders a pair, with the values that decide it.
struct PairOrderRow {
    analysis::CaseKey of;
    std::string member, first, second;
    SettingsOf settings = SettingsOf::defaults;
    std::optional<double> first_error_pct = {}, second_error_pct = {}, distance_pct = {};  // nothing where the member is not reached
    std::optional<double> error_bound_pct = {};                                            // of the member
    analysis::PairOrder order = analysis::PairOrder::undecided;
};
struct PairRow {
    analysis::CaseKey of;
    std::string first, second;
    std::optional<double> difference_pct = {};  // of the errors against the first member reached, second minus first
    double largest_difference_pct = 0.0;        // of all members, without sign
    int members = 0, not_reached = 0, first_is_closer = 0, second_is_closer = 0;  // in the default settings
    analysis::PairDecision decision = analysis::PairDecision::reference_error;
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
    std::optional<double> spring_factor = {}, core_radius = {};  // prescribed nodes have no q, the bind constraint no radius
    double difference_pct = 0.0, k_stretch = 0.0, model_pct = 0.0;
    bool finished = false;
};
extern const analysis::Columns<MemberRow> member_columns;          // members.csv
extern const analysis::Columns<ErrorRow> error_columns;            // errors.csv
extern const analysis::Columns<PairOrderRow> pair_order_columns;   // pair_orders.csv
extern const analysis::Columns<PairRow> pair_columns;              // pairs.csv
extern const analysis::Columns<PartsRow> part_columns;             // parts.csv
extern const analysis::Columns<AttachmentRow> attachment_columns;  // attachments.csv

// A pose whose first member is not reached has no parts.
struct EnsembleRecords {
    std::vector<MemberRow> members;
    std::vector<ErrorRow> errors;
    std::vector<PairOrderRow> orders;  // one per pair, member and settings
    std::vector<PairRow> pairs;
    std::vector<PartsRow> parts;             // one per k_stretch and number of iterations
    std::vector<AttachmentRow> attachments;  // one per k_stretch and flesh, the reference's own first
    std::string breakdown;                   // deformers that are not finite
};

// solutions: the folder in which the solutions of the references are kept (solutions_of_run); "": none.
EnsembleRecords measure_ensemble(const EnsembleCase& of, const std::string& solutions = "");

}  // namespace experiments
