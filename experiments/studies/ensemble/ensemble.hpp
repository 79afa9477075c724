// Which deformer is closer to elastic flesh, whatever reference of a family is taken: one body in one pose against several members of a
// family of references, which differ in how the bones hold the flesh and in how compressible it is.
//   const EnsembleRecords records = measure_ensemble(of);
//   table_of(pair_columns, records.pairs).write("pairs.csv");
// A pair of deformers is decided if every member orders it in the same way by more than its own error allows
// (analysis/verdicts/pair_order.hpp).
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/pair_order.hpp"
#include "experiments/studies/shared/posed_reference.hpp"

#include "experiments/scene/scene.hpp"

namespace experiments {

struct EnsembleCase {
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    Scene scene;           // its character and motion
    int frame = 0;         // of its motion
    DeformerSpec flesh;    // a [[fem]] deformer, which the members change
    std::vector<EnsembleMember> members;
    std::vector<DeformerSpec> deformers;  // that are ordered
};
nlohmann::json to_json(const EnsembleCase& of);

struct MemberRow {
    analysis::CaseKey of;
    EnsembleMember member;
    std::string outcome;  // reached, inverted, not_converged
    std::optional<int> element_order = {}, refinements = {};
    std::optional<double> error_bound_pct = {}, error_bound_l2_pct = {}, observed_order = {};
    std::optional<bool> reliable = {};
    double masked_share_pct = 0.0;
    std::optional<double> volume_change_pct = {};
    std::optional<double> lowest_det_f = {};  // of the finest solution, as the following
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
};
struct PairRow {
    analysis::CaseKey of;
    std::string first, second;
    std::optional<double> difference_pct = {};  // of the errors against the first member reached, second minus first
    double largest_difference_pct = 0.0;        // of all members, without sign
    int members = 0, not_reached = 0, first_is_closer = 0, second_is_closer = 0;
    analysis::PairDecision decision = analysis::PairDecision::reference_error;
};
extern const analysis::Columns<MemberRow> member_columns;  // members.csv
extern const analysis::Columns<ErrorRow> error_columns;    // errors.csv
extern const analysis::Columns<PairRow> pair_columns;      // pairs.csv

struct EnsembleRecords {
    std::vector<MemberRow> members;
    std::vector<ErrorRow> errors;
    std::vector<PairRow> pairs;
    std::string breakdown;  // deformers that are not finite
};

EnsembleRecords measure_ensemble(const EnsembleCase& of);

}  // namespace experiments
