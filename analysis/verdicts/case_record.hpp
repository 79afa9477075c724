// The recorded frames of each case, from which verdicts are computed.
#pragma once

#include "analysis/records/tables.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The key of a recorded value: the body, its motion, the deformer and the settings. A field that does not apply is
// empty.
//   const CaseKey key = {.body = "limb", .motion = "bend", .angle_deg = 90.0, .deformer = "pbs"};
// A field has the same name as its column of measurements.csv, its member of a case in claims.json, and its entry in
// `of` of claims.toml.
struct CaseKey {
    std::string body = {};    // of pbs::named_bodies(), or a character of the user's
    std::string motion = {};  // twist, bend, or the name of a clip such as 01_01
    std::string pose = {};    // pose in a clip: crouch, landing, in_the_air
    std::string joint = {};   // the names of the joint's two bones: upper|forearm
    std::optional<double> angle_deg = {};
    std::optional<double> time_s = {};  // time in the clip
    std::string deformer = {}, variant = {};
    std::string reference = {};  // the deformer that the value is compared with
    std::string order = {}, precision = {};
    std::optional<double> vertices = {}, vertices_to = {};  // for a ratio over a range: its first and last setting
    std::optional<double> k_stretch = {}, k_stretch_to = {}, k_bind = {};
    std::optional<double> young_pa = {};
    std::string masses = {};
    std::optional<double> iterations = {}, iterations_to = {};
    std::optional<double> time_step_s = {}, time_step_to_s = {};
    std::string constraint = {};     // stretch, volume, bind
    std::string initial_guess = {};  // previous_frame, rest_pose, rigid_bind; of controls: lbs, random
    // residual: within 5 % of its floor; volume: absolute change within 0.5 %
    std::string tolerance = {};
    std::string load = {}, ladder = {};           // of a stiffness test
    std::string factor = {}, second_factor = {};  // the parameters that a sweep of the stability study varies
    std::string model = {};                       // a row of Table 1 in the paper
    std::string equation = {};                    // an equation of the paper
    std::string gradient_of = {}, reading = {};   // a particle p1 to p4; as_printed, relative_to_p1, derived_gradients
    bool operator==(const CaseKey&) const = default;
    auto operator<=>(const CaseKey&) const = default;  // by the fields in this order; a missing one comes first
};

// A field of the key, which is either a text or a number.
struct CaseKeyField {
    const char* name;
    const char* unit;
    enum class Shown {
        alone,
        with_name,
        as_end_of_range
    } shown;  // in text_of(): limb, 90 deg; reference nh_p2; the 1 of k_stretch 0.2 to 1
    std::string CaseKey::*text = nullptr;
    std::optional<double> CaseKey::*number = nullptr;

    bool is_set(const CaseKey& key) const { return text ? !(key.*text).empty() : (key.*number).has_value(); }
};
const std::vector<CaseKeyField>& case_key_fields();           // in the order in which they are written
const CaseKeyField* case_key_field(const std::string& name);  // null if no field has that name

// without its unit; empty if the field is not set
std::string value_text(const CaseKeyField& field, const CaseKey& key);
// The fields that are set, as they are recorded: limb, bend, 90 deg, pbs, reference nh_p2, iterations 12 to 48,
// time_step 0.01 s. paper_figures/words/case_words.py describes a case in words.
std::string text_of(const CaseKey& key);

// True if every field that is set in `wanted` has the same value in `key`.
bool matches(const CaseKey& key, const CaseKey& wanted);

// One optional column per field, which used_columns() drops if no key sets it.
const Columns<CaseKey>& case_key_columns();

nlohmann::json to_json_of(const CaseKey& key);  // only the fields that are set
// Reads what to_json_of() wrote. InputError for an unknown field, a text where a number is expected, or a number where
// a text is expected.
CaseKey case_key(const nlohmann::json& object, const std::string& file);

// One deformer on one scene; each frame is a row of metrics.csv.
struct CaseRecord {
    std::string scene, deformer = {}, variant = {};  // as in metrics.csv; the variant may be empty or "default"
    // body and motion of the scene; empty if the plan of its study does not state them
    CaseKey place = {};
    std::string order = {}, precision = {};  // of projection; both are empty if the deformer has none
    int iterations = 0;                      // 0: the deformer has none
    std::vector<double> frame = {}, time_s = {}, angle_deg = {};  // #frames each; angle_deg is empty for clips
    int frames_not_converged = 0;                                 // these frames are left out of the series
    // #frames each; as in FrameMetrics
    std::vector<double> volume_change_pct = {}, volume_abs_change_pct = {}, inverted_tets = {};
    std::string run = {};  // the folder of the run, as reports name it
    // a further run of the same body and motion (another mesh, another reference), for comparisons only
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

// How a value limits the quantity where a tolerance was not reached: the quantity is at least, at most, or more than
// that value.
enum class Limit { none, at_least, at_most, more_than };
template <>
struct EnumNames<Limit> {
    static constexpr std::array<std::pair<Limit, const char*>, 3> table{
        {{Limit::at_least, "at_least"}, {Limit::at_most, "at_most"}, {Limit::more_than, "more_than"}}};
};

// A value that a study measured for a claim: a row of measurements.csv.
struct Measurement {
    std::string claim = {};     // id of the claim
    std::string quantity = {};  // as the claim names it
    CaseKey of = {};            // the case: character, pose, setting
    double value = 0.0, low = 0.0,
           high = 0.0;          // in `unit`, with its range (see Claim::range); without one, both equal the value
    std::string unit = {};      // "1" for a pure number
    std::string run = {};       // the folder of the run
    Limit limit = Limit::none;  // how the value limits the quantity
    int n = 0;                  // number of settings, cells or comparisons from which the value is computed; 0: one
    int not_reached = 0;        // how many of these n reach the tolerance from no initial guess
    bool beside = false;        // as CaseRecord::beside
};

// All records from which a claim is judged.
struct Records {
    std::vector<CaseRecord> cases = {};          // all scenes and deformers; judged by their frame_measurements()
    std::vector<LeftOut> left_out = {};          // named in the verdict
    std::vector<PrintedValue> printed = {};      // for claims with rule = "printed"
    std::vector<Measurement> measurements = {};  // for claims with rule = "units" or "single"
    // planned runs that have not ended; measured values cannot be judged without them
    std::vector<std::string> missing_runs = {};
    // each must have a record or be left out; otherwise the verdict cannot be computed
    std::vector<std::string> planned_scenes = {};
};

// Reads the cases in a metrics.csv. Rows are grouped by scene, deformer, variant, order, precision, iterations and
// threads, in order of first appearance. Empty iterations (of a deformer that has none) become 0. A column angle_deg
// that is filled in throughout a case makes it a sweep. Rows of a deformer without iterations (a reference) whose
// outcome is not_converged are counted and left out, since they show another pose. InputError for a missing column, for
// a cell that is not a number, and for a case with angles in some frames only. run: for CaseRecord::run.
std::vector<CaseRecord> case_records(const CsvTable& metrics, const std::string& run);

void require_whole(const CaseRecord& record);  // InputError unless all series have one value per frame

// The rows of a file printed.csv: claim, quantity, fields of the key, printed, least, most. An empty most means that
// there is no upper bound. InputError as for read_csv, for a missing column and for a cell that is not a number.
std::vector<PrintedValue> printed_values(const std::string& csv);
CsvTable printed_table(const std::vector<PrintedValue>& values);  // the table that printed_values() reads

}  // namespace analysis
