// Verdicts, computed from records and from thresholds that were fixed beforehand. A verdict holds facts; the sentences
// are composed by its readers.
//   const Verdict verdict = judge(claim, records);   // verdict.kind, verdict.own.share, verdict.own.cases
#pragma once

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/measurement.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The rule's numbers, fixed before the records of today were judged by it.
inline constexpr double holding_share = 0.95, failing_share = 0.5;  // holds from the one on, fails up to the other
inline constexpr double largest_chance = 0.01;                      // a result that chance reaches more often is none
inline constexpr int least_cases = 5;                               // fewer cases do not carry a verdict

// The verdict on a claim; every kind except the last is a result.
enum class VerdictKind {
    holds,
    fails,
    mixed,
    not_shown,
    inconclusive,
    untestable,
    definition,
    inconsistent_in_print,
    not_computable
};

// Why a verdict is inconclusive.
enum class Inconclusive { no, too_few_cases, control_without_record, control_misbehaves, chance };

// Why a case does not count.
enum class Excluded { no, nothing_to_see, no_control, nothing_to_compare_with, censored };

// A case of a claim: its number is the mean of its dependent values, of the first quantity if there are several. NaN:
// it has none.
struct JudgedCase {
    std::string quantity = {};                  // empty unless the case is one of a single quantity
    CaseKey of = {};                            // the fields that make the case
    std::string unit = {};                      // of the value
    double value = 0.0, low = 0.0, high = 0.0;  // the range spans what Claim::range names
    Limit limit = Limit::none;                  // how a censored value limits the number
    int n = 0;                                  // dependent values
    Threshold threshold = {};
    bool holds = false;
    Excluded excluded = Excluded::no;
    std::vector<JudgedCase> parts = {};  // one for each quantity, if the case has several

    bool counts() const { return excluded == Excluded::no; }
    bool is_same(const JudgedCase& other) const { return quantity == other.quantity && of == other.of; }
};

// The cases of a selection of values, and the share of those that hold.
struct Judged {
    Selection selection = {};
    std::vector<JudgedCase> cases = {};
    int held = 0, n = 0;  // of the cases that count
    bool behaves = true;  // of a control

    double share() const { return n > 0 ? static_cast<double>(held) / n : not_known; }
};

// The property by whose values the shares of a claim differ most.
struct Difference {
    std::string field = {}, least_at = {}, most_at = {};
    double least = 0.0, most = 0.0;  // shares at these values
};

// The verdict if all values of a body are excluded.
struct BodyExcluded {
    std::string body;
    VerdictKind kind;
};

// The values of one end of a threshold for which the verdict is the same; infinite: no value changes it.
struct ThresholdRange {
    Threshold threshold;
    bool is_high;  // which of its ends is another one
    double low, high;
};

// On what a verdict depends (sensitivity.hpp).
struct Sensitivity {
    std::vector<BodyExcluded> without_body = {};
    std::vector<ThresholdRange> ranges = {};
};

// The verdict on a claim, with all values that reports show.
struct Verdict {
    Claim claim;                                     // the claim that was judged
    VerdictKind kind = VerdictKind::not_computable;  // by the claim's rule
    Inconclusive inconclusive = Inconclusive::no;
    Judged own = {};
    // Of the share: the wider one of the exact binomial interval and a bootstrap over bodies.
    Interval interval = {.estimate = not_known, .low = not_known, .high = not_known};
    double by_chance = not_known;            // the probability of at least as many cases under q
    double q = not_known;                    // the share that the negative controls, or no effect, reach
    std::optional<Difference> differs = {};  // for a mixed verdict
    std::vector<Judged> others = {};         // controls and comparisons, as in the claim
    std::vector<Judged> readings = {};       // the same in each recorded order and precision of projection
    std::vector<Verdict> held_out = {};      // one, by the same rule, on the cases that Claim::held_out names, or none
    Sensitivity sensitivity = {};            // empty unless it was asked for
    std::vector<PrintedValue> printed = {};  // values of a claim about printed numbers
    std::vector<LeftOut> left_out = {};      // scenes that are not installed
    // planned scenes or runs without a record: the reason why it is not computable
    std::vector<std::string> missing = {};
    std::vector<std::string> runs = {};  // the folders on which the verdict rests
};

// The verdict on a claim by its rule:
//   cases     The dependent values of each case are averaged and compared with the threshold. Cases in which the
//             control `selected_by` does not fail are excluded. The claim is inconclusive with fewer than five cases,
//             and if a control has no record or misbehaves (a negative one must fail in at least half of its cases, or
//             in at least five if it is `selected_by`; a positive one must hold in at least 95 %). It fails if at most
//             half of the cases hold. Otherwise chance must reach as many with a probability below 1 %: the claim holds
//             from 95 % on, and is mixed below. If chance reaches them more often, the claim is inconclusive from 95 %
//             on, and not shown below.
//   single    The claim holds if the range of its one number lies within the threshold, fails if it lies outside, and
//             is mixed otherwise.
//   printed   The claim holds if all printed values are consistent; otherwise it is inconsistent in print.
// Held-out values are judged apart. Where they have no case of a control, the control of the other values is used.
// Planned scenes or runs without a record make the verdict not computable. InputError for records with series of
// different lengths.
Verdict judge(const Claim& claim, const Records& records);

// The kind of the verdict by cases on these values alone, without all else that reports show. A control that has no
// case among them is judged from `otherwise`, except the one that selects the cases.
VerdictKind kind_on(const Claim& claim, const std::vector<Measurement>& measured,
                    const std::vector<Measurement>& otherwise = {});

// The values that the claim, its controls or its comparisons read, without the held-out ones.
std::vector<Measurement> own_measurements(const Claim& claim, const Records& records);
std::vector<std::string> missing_from(const Records& records);  // planned scenes and runs without a record

// The cases of a selection, in order of first appearance.
Judged judged(const Claim& claim, const Selection& selection, const std::vector<Measurement>& measured);

const char* name_of(VerdictKind kind);  // holds, fails, ...
const char* name_of(Inconclusive why);
const char* name_of(Excluded why);

// Verdicts as files: claims.json holds the facts for programs, claims.md the most important of them as a table.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts, revision).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
// {"schema": 4, "revision", "quantities": {NAME: {"title", "unit"}}, "claims": [{id, statement, place, study, rule,
// verdict, ...}]}. The document holds facts alone and no sentences. The fields of a key (case_record.hpp) are members
// of the object that they describe. Values that are not known or not finite are null. revision: the program that
// judged.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision);

// A table with one row per claim: id, verdict, how many of its cases hold, share, interval and chance, and the range of
// its numbers.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

// A further column of the table of claims: its heading, and its texts by the claims' names.
struct FurtherColumn {
    std::string heading = {};
    std::map<std::string, std::string> texts = {};
};

// The verdicts as a table for the terminal, one line per claim: its name, the claim in a few words, the verdict in
// capitals and what was measured. The last lines name what is missing and count the verdicts.
//   fmt::print("{}", claims_table(verdicts, 100, false));
//   fmt::print("{}", claims_table(verdicts, 100, false, {.heading = "here", .texts = {{"C04", "94 numbers agree"}}}));
// No line is longer than `width` characters (below 60: 60); a text that is too long for its column ends with an
// ellipsis. colours: green for holds, yellow for mixed and not shown, red for fails, magenta for inconsistent, grey
// otherwise.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours,
                         const FurtherColumn& further = {});

}  // namespace analysis
