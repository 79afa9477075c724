// The tables over all poses: which methods are nearer to the references for a time per frame.
//   const Comparison comparison = concluded(points, references, settings);
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/statistics/paired_comparison.hpp"
#include "experiments/studies/work_precision/measuring.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// known: methods that take flesh have that of each reference. guessed: they have that of the first member, whatever the
// reference is.
enum class ComparisonTable { known, guessed };
NAMED_OPTIONS(ComparisonTable, known, guessed)

// Own errors of the references (references.csv).
struct OwnErrorRow {
    std::string pose, body;
    Stratum stratum = Stratum::movement;
    std::string member, outcome;
    std::optional<double> own_error_pct = {};
};
extern const analysis::Columns<OwnErrorRow> own_error_columns;

// errors.csv: the rows of points.csv that a table compares.
struct ComparedRow {
    ComparisonTable table = ComparisonTable::known;
    double budget_ms = 0.0;
    PointRow point;
};
extern const analysis::Columns<ComparedRow> compared_columns;

// methods.csv. A share is the geometric mean over poses of the error over that of LBS with the weights that training
// has chosen: the median over the members, and the range over them. A budget of inf is any time: it is there if a
// deformer of the user's own needs more than the longest time, and the other methods then have the settings of the
// longest time.
struct MethodRow {
    ComparisonTable table = ComparisonTable::known;
    double budget_ms = 0.0;
    std::string method;
    std::vector<std::string> takes = {};
    std::string setting = {};
    std::optional<double> ms = {}, times_pbs = {};  // medians over the poses by movement
    // doubled: within the budget with twice its time; once: only just; no: on this machine
    std::string within = {};
    int poses = 0,
        fewest_poses =
            0;  // by movement, in which the member with the most and with the fewest solutions compares the method
    double share = 0.0, share_low = 0.0, share_high = 0.0;  // movement
    std::optional<double> fold_share = {}, fold_low = {}, fold_high = {};
    std::optional<double> skin_mm = {};  // median over the poses by movement
    int inverted_poses = 0;              // of these, with an inverted tet
    std::string letters = {};            // methods that share one are not decided
};
extern const analysis::Columns<MethodRow> method_columns;

// pairs.csv: one pair of methods on one member.
struct MethodPairRow {
    ComparisonTable table = ComparisonTable::known;
    double budget_ms = 0.0;
    std::string first, second, member;
    int wins = 0, ties = 0, losses = 0;
    double p = 1.0, p_holm = 1.0, ratio = 1.0, ratio_low = 1.0, ratio_high = 1.0;
};
extern const analysis::Columns<MethodPairRow> method_pair_columns;

// decisions.csv: over all members, of all bodies and without each of them.
struct DecisionRow {
    ComparisonTable table = ComparisonTable::known;
    double budget_ms = 0.0;
    std::string without_body;  // empty: all bodies
    std::string first, second;
    analysis::MethodDecision decision = analysis::MethodDecision::open;
};
extern const analysis::Columns<DecisionRow> decision_columns;

// curves.csv: the share of each method over its time.
struct MethodCurveRow {
    ComparisonTable table = ComparisonTable::known;
    std::string method;
    double budget_ms = 0.0;
    std::string setting;
    double ms = 0.0, share = 0.0, share_low = 0.0, share_high = 0.0;
};
extern const analysis::Columns<MethodCurveRow> method_curve_columns;

// profiles.csv: the share of the poses that a method solves to a share of LBS's error within a time (J. More, S. Wild,
// SIAM J. Optim. 20, 2009): in the mean over the members.
struct SolvedRow {
    ComparisonTable table = ComparisonTable::known;
    double target_pct = 0.0;  // of LBS's error
    std::string method;
    double budget_ms = 0.0, solved_pct = 0.0;
};
extern const analysis::Columns<SolvedRow> solved_columns;

// starts.csv: what another start or a wrong material makes of a setting, against the first member.
struct OtherStartRow {
    double budget_ms = 0.0;
    std::string method, of;
    int poses = 0;
    double share = 0.0, share_of_setting = 0.0;
};
extern const analysis::Columns<OtherStartRow> other_start_columns;

// motion.csv: the same setting posed alone and begun at the frame before.
struct MotionRow {
    std::string clip;
    double budget_ms = 0.0;
    std::string method, setting, member;
    int frames = 0;
    double ms = 0.0, cold_share = 0.0, played_share = 0.0, cold_skin_mm = 0.0, played_skin_mm = 0.0;
};
extern const analysis::Columns<MotionRow> motion_columns;

// The least geometric mean error over training poses and members among the settings whose mean time lies within each
// budget.
std::vector<ChosenSetting> chosen_settings(const std::vector<PointRow>& training);

struct Comparison {
    std::vector<ComparedRow> errors;
    std::vector<MethodRow> methods;
    std::vector<MethodPairRow> pairs;
    std::vector<DecisionRow> decisions;
    std::vector<MethodCurveRow> curves;
    std::vector<SolvedRow> profiles;
    std::vector<OtherStartRow> starts;
};
// points: of evaluation runs. own: rows of their poses. Deformers of the user's own are in every budget that is at
// least their time.
Comparison concluded(const std::vector<PointRow>& points, const std::vector<OwnErrorRow>& own,
                     const std::vector<ChosenSetting>& settings);
std::vector<MotionRow> concluded(const std::vector<PlayedRow>& played, const std::vector<ChosenSetting>& settings);

}  // namespace experiments
