// PBS and each change to it in one pose of one body, at every number of iterations: the time per frame, the error relative to the reference
// and the change of the volume.
//   table_of(change_columns, measure_changes(of).rows).write("points.csv");
// The reference is neo-Hookean flesh on quadratic elements (shared/posed_reference.hpp). With refined_reference its tets are those of the
// character cut into eight, and the bound on its own error comes from nested solutions. Otherwise the tets are the character's own, because
// refined ones take minutes, and the bound is the distance from linear elements on the same tets. It holds if quadratic elements at least
// halve the error of linear ones, |P2 - x| <= |P1 - x| / 2 <= (|P1 - P2| + |P2 - x|) / 2, as they do in the poses of the quick form.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/improvements/change_settings.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct ChangesCase {
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    Scene scene;           // its character, motion and PBS
    int frame = 0;         // of its motion; a timed frame begins in the one before it
    RangeOfChanges range;
    bool refined_reference = false;
    Rounds rounds;
};
nlohmann::json to_json(const ChangesCase& of);

// The iterations of the baseline whose time is a budget; they are among RangeOfChanges::iterations.
inline constexpr std::array<int, 3> budget_iterations = {4, 24, 96};

struct ChangePoint {
    analysis::CaseKey of;
    std::string change, setting;
    int iterations = 0;
    std::string outcome;  // finished, not_finite
    Spread ms;
    std::optional<double> error_joint_pct = {}, error_l2_pct = {};  // nothing where it is not finite, or there is no reference
    analysis::FrameMetrics metrics = {};
    // From the baseline after each of the budgets' iterations, at the joints.
    std::array<std::optional<double>, budget_iterations.size()> distance_pct = {};
    std::optional<double> reference_error_joint_pct = {};
    double masked_share_pct = 0.0;
    std::string reference;  // quadratic_refined, quadratic, linear, not_reached

    // The distance of the same column for a budget.
    std::optional<double> distance_from_baseline(int budget) const;
};
extern const analysis::Columns<ChangePoint> change_columns;  // points.csv

struct MeasuredChanges {
    std::vector<ChangePoint> rows;
    std::string breakdown;  // settings that are not finite
};
MeasuredChanges measure_changes(const ChangesCase& of);

}  // namespace experiments
