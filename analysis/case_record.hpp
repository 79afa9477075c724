// The recorded frames of each case, from which verdicts are computed.
#pragma once

#include "analysis/case_key.hpp"

#include <string>
#include <vector>

namespace analysis {

// One deformer on one scene; each frame is a row of metrics.csv.
struct CaseRecord {
    std::string scene, deformer, variant;          // as in metrics.csv; the variant may be empty or "default"
    CaseKey place = {};                            // body and motion of the scene; empty if the plan of its study does not state them
    std::string order = "", precision = "";        // of projection; both are empty if the deformer has none
    int iterations = 0;                            // 0: the deformer has none
    std::vector<double> frame, time_s, angle_deg;  // #frames each; angle_deg is empty for clips
    int frames_not_converged = 0;                  // these frames are left out of the series
    std::vector<double> volume_change_pct, volume_abs_change_pct, inverted_tets;  // #frames each; as in FrameMetrics
    std::string run;                                                              // the folder of the run, as reports name it
    // a further run of the same body and motion (another mesh, another reference): reported, but not part of the verdict
    bool beside = false;

    bool is_sweep() const { return !angle_deg.empty(); }  // true for a sweep of one joint through angle_deg
};

// A scene that could not run on this machine, with the reason, such as a character whose package is not installed.
struct LeftOut {
    std::string scene, reason;  // the reason in words, for reports
};

// A value printed in the paper, and the bounds that other values of the paper imply: a row of printed.csv.
struct PrintedValue {
    std::string claim;                              // id of the claim
    std::string quantity;                           // snake_case
    CaseKey of;                                     // the row of Table 1, or the equation
    double printed = 0.0, least = 0.0, most = 0.0;  // the printed value and its bounds; most may be infinite

    bool is_consistent() const { return least <= printed && printed <= most; }
};

// How a value limits the quantity where a tolerance was not reached: the quantity is at least, at most, or more than that value.
enum class Limit { none, at_least, at_most, more_than };
template <>
struct EnumNames<Limit> {
    static constexpr std::array<std::pair<Limit, const char*>, 3> table{
        {{Limit::at_least, "at_least"}, {Limit::at_most, "at_most"}, {Limit::more_than, "more_than"}}};
};

// A value that a study measured for a claim: a row of measurements.csv.
struct Measurement {
    std::string claim;                          // id of the claim
    std::string quantity;                       // as the claim's `metrics` name it
    CaseKey of;                                 // the case: character, pose, setting
    double value = 0.0, low = 0.0, high = 0.0;  // in `unit`, with its interval; without an interval, low and high equal the value
    std::string unit;                           // "1" for a pure number
    std::string run = {};                       // the folder of the run
    Limit limit = Limit::none;                  // how the value limits the quantity
    int n = 0;                                  // number of settings, cells or comparisons from which the value is computed; 0: one
    int not_reached = 0;                        // how many of these n reach the tolerance from no initial guess
};

// All records from which a claim is judged.
struct Records {
    std::vector<CaseRecord> cases = {};            // all scenes and deformers
    std::vector<LeftOut> left_out = {};            // named in the verdict
    std::vector<PrintedValue> printed = {};        // values for all claims with rule = "printed"
    std::vector<Measurement> measurements = {};    // values for all claims with rule = "measured"
    std::vector<std::string> missing_runs = {};    // planned runs that have not ended; measured values cannot be judged without them
    std::vector<std::string> planned_scenes = {};  // each must have a record or be left out; otherwise the verdict cannot be computed
};

// Reads the cases in a metrics.csv. Rows are grouped by scene, deformer, variant, order, precision, iterations and threads, in order of
// first appearance. Empty iterations (of a deformer that has none) become 0. A column angle_deg that is filled in throughout a case makes
// it a sweep.
// Rows of a deformer without iterations (a reference) whose outcome is not_converged are counted and left out, since they show another
// pose.
// InputError for a missing column, for a cell that is not a number, and for a case with angles in some frames only. run: for
// CaseRecord::run.
std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run);

// The rows of a file printed.csv: claim, quantity, fields of the key, printed, least, most. An empty most means that there is no upper
// bound. InputError as for read_csv, for a missing column and for a cell that is not a number.
std::vector<PrintedValue> printed_values(const std::string& csv);
CsvTable printed_table(const std::vector<PrintedValue>& values);  // the table that printed_values() reads

// The series of a claim's metric, #frames. InputError for an unknown name, or for a record with series of different lengths.
std::vector<double> metric_series(const CaseRecord& record, const std::string& metric);

}  // namespace analysis
