// What a verdict is computed from: the frames of each case as they were written down.
#pragma once

#include "analysis/case_key.hpp"
#include "analysis/records/csv_table.hpp"

#include <string>
#include <vector>

namespace analysis {

// One deformer on one scene: a row of metrics.csv a frame.
struct CaseRecord {
    std::string scene, deformer, variant;          // as in metrics.csv; the variant may be empty or "default"
    CaseKey place = {};                            // body and motion of the scene; empty where its study's plan does not give them
    std::string order = "", precision = "";        // of projection; both empty: the deformer has none
    int iterations = 0;                            // 0: the deformer has none
    std::vector<double> frame, time_s, angle_deg;  // #frames each; angle_deg is empty for clips
    int frames_not_converged = 0;                  // left out of the series
    std::vector<double> volume_change_pct, volume_abs_change_pct, inverted_tets;  // #frames each, by FrameMetrics
    std::string run;                                                              // the folder it came from, as to be named in reports
    bool beside = false;  // the same body and motion once more (another mesh, another reference): reported, no part of a verdict

    bool is_sweep() const { return !angle_deg.empty(); }  // of one joint through angle_deg
};

// What one could not run here, and why: a character whose package is not installed.
struct LeftOut {
    std::string scene, reason;  // the reason in words, for reports
};

// A value in print and the bounds that other values of the paper put on it: a row of printed.csv.
struct PrintedFigure {
    std::string claim;                              // its id
    std::string quantity;                           // snake_case
    CaseKey of;                                     // the row of Table 1 or the equation
    double printed = 0.0, least = 0.0, most = 0.0;  // in print, and its bounds; most may be infinite

    bool is_consistent() const { return least <= printed && printed <= most; }
};

// What a value says of the quantity where a tolerance was not reached: the quantity is at least or at most that value, or more than it.
enum class Limit { none, at_least, at_most, more_than };

// A value that a study measured for a claim: a row of measurements.csv.
struct Measurement {
    std::string claim;                          // its id
    std::string quantity;                       // as the claim's `metrics` name it
    CaseKey of;                                 // the case: character, pose, setting
    double value = 0.0, low = 0.0, high = 0.0;  // in `unit`, with its interval; where there is none, low and high are the value
    std::string unit;                           // 1 where there is none
    std::string run = {};                       // the folder it came from
    Limit limit = Limit::none;                  // of the value
    int n = 0;                                  // settings, cells or comparisons that it is computed from; 0: one
    int not_reached = 0;                        // of these n, those in which no initial guess reaches the tolerance
};

// All that a claim is judged from.
struct Records {
    std::vector<CaseRecord> cases = {};            // of all scenes and deformers
    std::vector<LeftOut> left_out = {};            // named in the verdict
    std::vector<PrintedFigure> printed = {};       // of all claims with rule = "printed"
    std::vector<Measurement> measurements = {};    // of all claims with rule = "measured"
    std::vector<std::string> missing_runs = {};    // planned, and not ended: what is measured cannot be judged without them
    std::vector<std::string> planned_scenes = {};  // each must have a record or be left out, or the verdict cannot be computed
};

// The cases in a metrics.csv: its rows grouped by scene, deformer, variant, order, precision, iterations and threads, in order of first
// appearance; empty iterations (a deformer that has none) are 0. A column angle_deg, filled in throughout a case, makes it a sweep.
// Left out and counted: rows of a deformer without iterations, that is a reference, whose outcome is not_converged. They show another pose.
// InputError for a missing column, for what is no number, and for a case with angles in some frames only. run: for CaseRecord::run.
std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run);

// The rows of a file printed.csv: claim, quantity, fields of the key, printed, least, most; an empty most is no bound. InputError as
// read_csv, for a missing column and what is no number.
std::vector<PrintedFigure> printed_figures(const std::string& csv);
CsvTable printed_table(const std::vector<PrintedFigure>& figures);  // what printed_figures() reads

// The series that a metric of a claim names, #frames; InputError for an unknown name or a record with series of different lengths.
std::vector<double> metric_series(const CaseRecord& record, const std::string& metric);

}  // namespace analysis
