// One requirement on a run or on a frame from elsewhere, and its result, as the terminal, JUnit, GitHub and check.json
// show it.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// failed: a bound does not hold; broke_down: the run is not finite; refused: the input is invalid.
enum class CheckState { held, failed, left_out, broke_down, refused };

// A case that holds has a message too.
struct CheckCase {
    std::string suite;                    // name of the scene, or of the rest mesh
    std::string name;                     // name of the bound
    CheckState state = CheckState::held;  // the result
    std::string message = {};             // one line; for a failure: the frame, the metric, its value and the bound
    std::optional<int> frame = {};        // the worst frame
    std::optional<double> value = {};     // value in that frame
    std::string file = {};                // file that declares the bound; empty: the command line
    int line = 0;                         // in that file, from 1; 0: none
    double seconds = 0.0;                 // wall time; recorded but never judged
};

// The cases of one suite, in their order.
struct CheckSuite {
    std::string name;                                                  // name of the scene, or of the rest mesh
    double seconds = 0.0;                                              // wall time of the whole suite
    std::vector<std::pair<std::string, std::string>> properties = {};  // name, value
    // one per bound, and one per deformer of the baseline
    std::vector<CheckCase> cases = {};
};

int count(const std::vector<CheckSuite>& suites, CheckState state);  // summed over all suites
// "holds", "FAILS", "left out", "BREAKDOWN", "REFUSED"
const char* to_string(CheckState state);

// A table for the terminal with one line per case and its message.
std::string check_table(const std::vector<CheckSuite>& suites);

// A check as GitHub shows it: annotations at the lines of the bounds (workflow commands on stdout) and the summary of
// the job.
// ::error file=FILE,line=N,title=SUITE NAME::MESSAGE for cases that fail, ::warning for cases that were left out; one
// line each.
std::string github_annotations(const std::vector<CheckSuite>& suites);

// A Markdown table of the cases.
std::string github_summary(const std::vector<CheckSuite>& suites);

// JUnit XML for CI servers: one testsuite per suite and one testcase per case (classname: the name of the suite), with
// its wall time. <failure> marks a case that fails, <error> a breakdown or a refused frame, <skipped> a case that was
// left out.
//   write_text_atomically(path, junit_report(suites));
// The whole document, with counts and seconds for each suite and in total.
std::string junit_report(const std::vector<CheckSuite>& suites);

// The rules of a check: scenes, bounds on their frames, and tolerances for the comparison with a baseline. They are
// data in TOML; the keys are documented at [[check.scene]] in experiments/verdicts/claims.toml.
//   const CheckRules rules = parse_check_rules(text, "check.toml", known_metrics);
// One table [[check.scene]].
struct CheckScene {
    std::string name;              // the name by which bounds refer to it
    std::string scene;             // a built-in scene, or a file in the same folder
    std::vector<std::string> set;  // key=value, as for `pbskin run --set`
    std::string needs;             // a body; the scene is left out where that body is not installed
    int line = 0;                  // line of its table, from 1
};

// One table [[check.bound]]: low <= metric <= high in each of its frames.
struct CheckBound {
    std::string name, scene, deformer, metric;  // scene: a CheckScene's name; metric: a column of metrics.csv
    // in the metric's unit
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    // first and last; empty: all
    std::vector<int> frames;
    std::string why;  // the reason for the bound, in words
    int line = 0;     // line of its table, from 1
};

// A value counts as unchanged when |now - then| <= absolute + relative |then|.
struct CheckTolerance {
    std::string metric;                     // a column of metrics.csv
    double absolute = 0.0, relative = 0.0;  // in the metric's unit; as a share. Both are finite and >= 0
    std::string why;                        // the reason for the tolerance, in words
    int line = 0;                           // line of its table, from 1; 0: a count, which is compared exactly
};

// The rules of one file, read and checked.
struct CheckRules {
    std::string file;                        // for messages
    std::vector<CheckScene> scenes;          // at least one, each name once
    std::vector<CheckBound> bounds;          // each name once; may be empty
    std::vector<CheckTolerance> tolerances;  // at most one per metric
};

// InputError with file and line for broken TOML, unknown or missing keys, metrics that are not among `metrics` or are
// wall time, bounds on scenes that are not named, duplicate names, and bounds that no value can meet.
CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics);

// Bounds on single frames, and their results frame by frame and as test cases. Each bound has the name of the option
// that sets it.
struct FrameValues {
    FrameMetrics metrics;          // of a surface volume_change_pct and volume_abs_change_pct alone
    double j_max = 0.0;            // largest V_t / V0_t
    double edge_strain_max = 0.0;  // largest |l / l0 - 1|
    double self_intersections =
        0.0;  // of a surface: pairs of triangles that meet; NaN: not counted, in a build without CGAL
};

// The kind of mesh that is measured, by which bounds are chosen.
enum class Measured { tets, surface, both };

struct FrameBound {
    std::string option;  // --max-volume-change
    std::string metric;  // |volume_change_pct|
    std::string meaning;
    bool is_upper = true;
    double lowest = 0.0;  // the lowest bound that makes sense
    double (*of)(const FrameValues&) = nullptr;
    std::string unit = {};     // behind a number, with its blank
    bool is_absolute = false;  // the bound is on |value|
    Measured applies_to = Measured::both;
    std::optional<double> value = {};  // nothing: the bound is not asked for
};
std::vector<FrameBound> known_frame_bounds();

// InputError for a bound that no frame or every frame meets: not finite, or below the lowest possible value; and for
// one that does not apply to what is measured.
void require_meaningful(const FrameBound& bound, Measured measured);

// A bound that does not hold, e.g. "|volume_change_pct| = 0.62 > 0.5". Empty if it holds or was not asked for. A value
// that is not a number breaks every bound.
std::string broken_text(const FrameBound& bound, const FrameValues& values);

struct MeasuredFrame {
    std::string name;
    FrameValues values;
};

struct RefusedFrame {
    std::string name, reason;
};

// One case per bound, which names the worst frame and counts the others, or a case "measured" if no bound was asked
// for. One case per refused frame.
CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds,
                       const std::vector<MeasuredFrame>& frames, const std::vector<RefusedFrame>& refused,
                       double seconds);

// The result in one line: "fails: 14 of 18 frames beyond 0.5 %, worst -8.64 % in frame 17", "holds: ..." or, without a
// bound, the range of the volume. Bounds other than that on the volume are named by their metric, and frames that could
// not be read are counted.
std::string frame_summary(const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                          std::size_t refused);

// Compares a scene's metrics.csv with a bound and with a baseline.
// Every frame of the bound must lie within it. The case names the frame farthest outside or, if all hold, the one
// nearest to the bound. For a two-sided bound that holds, it names the smallest and the largest value. InputError if
// the scene lacks the deformer, the frames or the values.
CheckCase judge_bound(const CheckBound& bound, const std::string& unit, const CsvTable& metrics,
                      const std::string& rules_file);

// The columns of a baseline, which has one row per scene, deformer and frame: counts, the metrics that have a
// tolerance, and step_ms.
CsvTable baseline_columns(const CheckRules& rules);
// Adds the frames of a scene's metrics.csv in their order. Metrics that the scene does not measure get empty cells.
// InputError as for CsvTable.
void add_baseline_rows(CsvTable& baseline, const std::string& scene, const CsvTable& metrics, int vertices, int tets);

// InputError if the baseline lacks a column, or contains a frame of a scene's deformer twice.
void require_baseline(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// One failed case for each scene that the baseline contains and the rules no longer name.
std::vector<CheckCase> scenes_gone(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// One case per deformer: in every frame the counts (vertices, tets, iterations) must be equal and the metrics within
// their tolerances. InputError if the baseline contains something else than numbers there.
std::vector<CheckCase> compare_with_baseline(const CheckRules& rules, const std::string& scene, const CsvTable& now,
                                             const CsvTable& baseline, const std::string& baseline_file);

// "1.234 ms per step, 1.05 of the baseline's" for each deformer. Times depend on the machine, so they are shown and
// never judged.
std::vector<std::pair<std::string, std::string>> step_times(const std::string& scene, const CsvTable& now,
                                                            const CsvTable* baseline);

}  // namespace analysis
