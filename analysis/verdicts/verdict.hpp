// Verdicts, computed from records and from bounds that were fixed beforehand. A verdict holds facts; the sentences are composed by its
// readers.
//   const Verdict verdict = judge(claim, records);   // verdict.kind, verdict.primary, verdict.cases
#pragma once

#include "analysis/verdicts/measurement.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace analysis {

// The verdict on a claim; every kind except the last is a result.
enum class VerdictKind {
    reproduced,
    reproduced_only_for,
    not_reproduced,
    inconsistent_in_print,
    cannot_be_tested_here,
    not_computable,  // records are missing: this is a failure of the run, not a result
};

// The claim judged on the records of another order and precision of projection, and its own deformer on the same scenes.
struct OrderVerdict {
    std::string order, precision;  // plain, ordered, grouped; f32, f64
    // From its own records, and from those of the claim's deformer on the same scenes.
    VerdictKind kind = VerdictKind::not_computable, own_kind = VerdictKind::not_computable;
    std::vector<CaseJudgement> cases = {}, own_cases = {};  // the same scenes and metrics, in the same order
    std::vector<std::size_t> differing = {};                // the indices in `cases` of those whose extent differs

    bool same() const { return kind == own_kind && differing.empty(); }  // compares every case, not only the verdict
};

// A subject (see claim.subject; mostly a body), and how many of its values lie within the claim's bounds.
struct SubjectCount {
    std::string name;
    int within = 0, all = 0;
    Extent extent = Extent::none;  // whole: all of its values; part: some values of each quantity
};

// The value that represents the claim. share_within, mean_within: the clip with the lowest share of frames within the bound, or with the
// mean farthest from the printed value. measured, printed: the value farthest outside its bound relative to the size of the bound or, if
// all lie within, the one nearest to its bound.
struct PrimaryFact {
    std::string quantity, statistic, unit;  // statistic: share_of_frames, mean, value, printed
    double value = 0.0, low = 0.0, high = 0.0;
    double bound_low = 0.0, bound_high = 0.0;
    CaseKey of = {};
};

// The verdict on a claim, with all values that reports show.
struct Verdict {
    Claim claim;                                     // the claim that was judged
    VerdictKind kind = VerdictKind::not_computable;  // by the claim's rule
    std::optional<PrimaryFact> primary = {};         // none if there is no such value, or only sweeps
    int within = 0, n = 0;                           // how many values or cases hold by the claim's own metric, and how many there are
    Interval interval;                               // interval of `primary`, only for share_within and mean_within; n = 0: none
    std::vector<CaseJudgement> cases = {};           // each matching record with each metric, the claim's own metric first
    std::vector<CaseJudgement> compared = {};    // the claim's other deformers and records, with its own metric; not part of the verdict
    std::vector<Measurement> measurements = {};  // the values by which a measured claim is judged, its own quantity first
    std::vector<Measurement> controls = {};      // its quantities with other keys, then claim.reported; not part of the verdict
    std::vector<SubjectCount> subjects = {};     // subjects of the measurements
    std::vector<PrintedValue> printed = {};      // values of a claim about printed numbers
    std::vector<OrderVerdict> orders = {};       // the claim in other orders and precisions; not part of the verdict
    std::vector<LeftOut> left_out = {};          // scenes that are not installed
    std::vector<std::string> missing = {};       // planned scenes or runs without a record: the reason why it is not computable
    std::vector<std::string> runs = {};          // the folders on which the verdict rests
};

// By the claim's own metric: if every case holds as a whole, the claim is reproduced. If some case holds as a whole or in part by any of
// the metrics, it is reproduced only for those. If none does, it is not reproduced. Planned scenes or runs without a record make it not
// computable. InputError as for metric_series.
Verdict judge(const Claim& claim, const Records& records);

// A verdict of that kind without cases.
Verdict verdict_of(const Claim& claim, VerdictKind kind);

// The verdict on judged cases, by the same rule.
VerdictKind kind_of(const Claim& claim, const std::vector<CaseJudgement>& cases);

const char* name_of(VerdictKind kind);  // reproduced, reproduced_only_for, ...
const char* name_of(Extent extent);     // none, part, whole

// The verdict on a claim that is judged by values that a study measured (rule = "measured").
// Values are grouped by subject: the field of the key that the claim names, mostly the body. A subject holds if all its values hold as a
// whole. It holds in part if some values of each of its quantities do, since a claim of several quantities requires all of them. The
// verdict is reproduced if all subjects hold, reproduced only for some if some hold or hold in part, and not reproduced if none does. If a
// planned run has no record, the verdict is not computable.
Verdict judge_measurements(const Claim& claim, const Records& records);

// Whether a claim's verdict changes with the order and precision of projection. Constraints that contradict each other converge to a
// different limit in each order.
//   for (const OrderVerdict& other : judge_orders(claim, records)) ...
// One verdict for each order and precision among the records of claim.orders, in order of first appearance. Each is judged on the scenes on
// which it was recorded, and so is the claim's own deformer (default variant). None if claim.orders is empty.
std::vector<OrderVerdict> judge_orders(const Claim& claim, const Records& records);

// Verdicts as files: claims.json holds the facts for programs, claims.md the most important of them as a table.
//   write_text_atomically(folder + "/claims.json", claims_json(verdicts, revision).dump(2) + "\n");
//   write_text_atomically(folder + "/claims.md", claims_markdown(verdicts));
// {"schema": 2, "revision", "quantities": {NAME: {"title", "unit"}}, "claims": [{id, statement, place, study, rule, verdict, ...}]}. The
// document holds facts alone and no sentences. The fields of a key (case_record.hpp) are members of the object that they describe. Values
// that are not known or not finite are null. revision: the program that judged.
nlohmann::json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision);

// A table with one row per claim: id, verdict, how many of its values hold, and the primary value with its interval, bound and case.
std::string claims_markdown(const std::vector<Verdict>& verdicts);

// The verdicts as a table for the terminal, with a few lines per claim.
//   fmt::print("{}", claims_table(verdicts, 100, false));
// The columns are claim, verdict, statement and facts: how many values lie within the bound, and the primary value with its interval, bound
// and case. Lines are wrapped so that none is longer than `width` characters (below 60: 60). The last lines count the verdicts. colours:
// green for reproduced, yellow for reproduced in part, red for not reproduced, magenta for inconsistent, grey otherwise. claims.json holds
// all values.
std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours);

}  // namespace analysis
