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

extern const std::vector<std::string> own_error_columns;  // references.csv: own errors of the references

std::vector<std::string> compared_columns();

// A share is the geometric mean over poses of the error over that of LBS with the weights that training has chosen: the
// median over the members, and the range over them. A budget of inf is any time: it is there if a deformer of the
// user's own needs more than the longest time, and the other methods then have the settings of the longest time.
struct Comparison {
    // The rows of points.csv that a table compares, with the error against each member.
    analysis::CsvTable errors{compared_columns(), "errors.csv"};
    // ms, times_pbs and skin_mm are medians over the poses by movement, of which inverted_poses have an inverted tet.
    // within: doubled if twice the time is within the budget, once if only the time is, no otherwise. poses and
    // fewest_poses: those in which the member with the most and with the fewest solutions compares the method. Methods
    // that share one of the letters are not decided.
    analysis::CsvTable methods{{"table", "budget_ms", "method", "takes", "setting", "ms", "times_pbs", "within",
                                "poses", "fewest_poses", "share", "share_low", "share_high", "fold_share", "fold_low",
                                "fold_high", "skin_mm", "inverted_poses", "letters"},
                               "methods.csv"};
    // One pair of methods on one member.
    analysis::CsvTable pairs{{"table", "budget_ms", "first", "second", "member", "wins", "ties", "losses", "p",
                              "p_holm", "ratio", "ratio_low", "ratio_high"},
                             "pairs.csv"};
    // Over all members, of all bodies and without each of them.
    analysis::CsvTable decisions{{"table", "budget_ms", "without_body", "first", "second", "decision"},
                                 "decisions.csv"};
    // The share of each method over its time.
    analysis::CsvTable curves{{"table", "method", "budget_ms", "setting", "ms", "share", "share_low", "share_high"},
                              "curves.csv"};
    // The share of the poses that a method solves to a share of LBS's error within a time (J. More, S. Wild, SIAM J.
    // Optim. 20, 2009): in the mean over the members.
    analysis::CsvTable profiles{{"table", "target_pct", "method", "budget_ms", "solved_pct"}, "profiles.csv"};
    // What another start or a wrong material makes of a setting, against the first member.
    analysis::CsvTable starts{{"budget_ms", "method", "of", "poses", "share", "share_of_setting"}, "starts.csv"};
};
// points: points.csv of evaluation runs. own: references.csv of their poses. Deformers of the user's own are in every
// budget that is at least their time.
Comparison concluded(const analysis::CsvTable& points, const analysis::CsvTable& own,
                     const std::vector<ChosenSetting>& settings);

// motion.csv: the same setting posed alone and begun at the frame before.
analysis::CsvTable concluded_motion(const analysis::CsvTable& played, const std::vector<ChosenSetting>& settings);

// The least geometric mean error over training poses and members among the settings whose mean time lies within each
// budget.
std::vector<ChosenSetting> chosen_settings(const analysis::CsvTable& training);

}  // namespace experiments
