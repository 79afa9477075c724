// Verdicts, computed from records and from bounds that were fixed beforehand. A verdict holds facts; the sentences are composed by its
// readers.
//   const Verdict verdict = judge(claim, records);   // verdict.kind, verdict.own.share, verdict.own.units
#pragma once

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/measurement.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The rule's numbers, fixed before the records of today were judged by it.
inline constexpr double holding_share = 0.95, failing_share = 0.5;  // holds from the one on, fails up to the other
inline constexpr double largest_chance = 0.01;                      // a result that chance reaches more often is none
inline constexpr int least_units = 5;                               // fewer units do not carry a verdict

// The verdict on a claim; every kind except the last is a result.
enum class VerdictKind { holds, fails, mixed, not_shown, inconclusive, untestable, definition, inconsistent_in_print, not_computable };

// Why a verdict is inconclusive.
enum class Inconclusive { no, too_few_units, control_without_record, control_misbehaves, chance };

// Why a unit does not count.
enum class LeftOutUnit { no, nothing_to_see, no_control, nothing_to_compare_with, censored };

// A unit of a claim: its number is the mean of its dependent values, of the first quantity if there are several. NaN: it has none.
struct Unit {
    std::string quantity = {};  // empty unless the unit is one of a single quantity
    CaseKey of = {};            // the fields that make the unit
    std::string unit = {};
    double value = 0.0, low = 0.0, high = 0.0;  // the range spans what Claim::range names
    Limit limit = Limit::none;                  // how a censored value limits the number
    int n = 0;                                  // dependent values
    Bound bound = {};
    bool holds = false;
    LeftOutUnit left_out = LeftOutUnit::no;
    std::vector<Unit> parts = {};  // one for each quantity, if the unit has several

    bool counts() const { return left_out == LeftOutUnit::no; }
    bool is_same(const Unit& other) const { return quantity == other.quantity && of == other.of; }
};

// The units of a selection of values, and the share of those that hold.
struct Judged {
    Selection selection = {};
    std::vector<Unit> units = {};
    int held = 0, n = 0;  // of the units that count
    bool behaves = true;  // of a control

    double share() const { return n > 0 ? static_cast<double>(held) / n : not_known; }
};

// The property by whose values the shares of a claim differ most.
struct Difference {
    std::string field = {}, least_at = {}, most_at = {};
    double least = 0.0, most = 0.0;  // shares at these values
};

// The verdict on a claim, with all values that reports show.
struct Verdict {
    Claim claim;                                     // the claim that was judged
    VerdictKind kind = VerdictKind::not_computable;  // by the claim's rule
    Inconclusive inconclusive = Inconclusive::no;
    Judged own = {};
    // Of the share: the wider one of the exact binomial interval and a bootstrap over bodies.
    Interval interval = {.estimate = not_known, .low = not_known, .high = not_known};
    double by_chance = not_known;            // the probability of at least as many units under q
    double q = not_known;                    // the share that the positive controls, or no effect, reach
    std::optional<Difference> differs = {};  // for a mixed verdict
    std::vector<Judged> others = {};         // controls and comparisons, as in the claim
    std::vector<Judged> readings = {};       // the same in each recorded order and precision of projection
    std::vector<Verdict> confirmatory = {};  // one, by the same rule, on the units apart that Claim::confirmatory names, or none
    std::vector<PrintedValue> printed = {};  // values of a claim about printed numbers
    std::vector<LeftOut> left_out = {};      // scenes that are not installed
    std::vector<std::string> missing = {};   // planned scenes or runs without a record: the reason why it is not computable
    std::vector<std::string> runs = {};      // the folders on which the verdict rests
};

// Rule by rule:
// units        The dependent values of each unit are averaged and compared with the bound. Units in which the control `unseen_by` does not
//              fail are left out. Inconclusive if a control has no record or misbehaves (one that must fail does so in at least half of its
//              units, or in at least five if it is `unseen_by`; one that must hold does so in at least 95 %), and with fewer than five
//              units. Fails if at most half of the units hold. Otherwise chance must reach as many with a probability below 1 %: the claim
//              holds from 95 % on, and is mixed below. If chance reaches them more often, it is inconclusive from 95 % on, and not shown
//              below.
// single       The one number holds if its range lies within the bound, fails if it lies outside, and is mixed otherwise.
// printed      Holds if all printed values are consistent; otherwise inconsistent in print.
// Confirmatory values are judged apart. Where they have no unit of a control, the control of the other values is used.
// Planned scenes or runs without a record make the verdict not computable. InputError for records with series of different lengths.
Verdict judge(const Claim& claim, const Records& records);

// The units of a selection, in order of first appearance.
Judged judged(const Claim& claim, const Selection& selection, const std::vector<Measurement>& measured);

const char* name_of(VerdictKind kind);  // holds, fails, ...
const char* name_of(Inconclusive why);
const char* name_of(LeftOutUnit why);

// Verdicts as files: claims.json holds the facts for programs, claims.md the most important of them as a table.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts, revision).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
// {"schema": 3, "revision", "quantities": {NAME: {"title", "unit"}}, "claims": [{id, statement, place, study, rule, verdict, ...}]}. The
// document holds facts alone and no sentences. The fields of a key (case_record.hpp) are members of the object that they describe. Values
// that are not known or not finite are null. revision: the program that judged.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision);

// A table with one row per claim: id, verdict, how many of its units hold, share, interval and chance, and the range of its numbers.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

// The verdicts as a table for the terminal, with a few lines per claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));
// The columns are claim, verdict, statement and facts. Lines are wrapped so that none is longer than `width` characters (below 60: 60). The
// last lines count the verdicts. colours: green for holds, yellow for mixed, red for fails, magenta for inconsistent, grey otherwise.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

std::string bound_text(const Bound& bound);  // 0.9 to 1.1; 30 or more

}  // namespace analysis
