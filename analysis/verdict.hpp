// Verdicts: computed from records and from bounds that were fixed beforehand. A verdict holds facts; who reads it composes the sentences.
//   const Verdict verdict = judge(claim, records);   // verdict.kind, verdict.primary, verdict.cases
#pragma once

#include "analysis/measurement.hpp"

#include <string>
#include <utility>
#include <vector>

namespace analysis {

// What became of a claim; any but the last is a result.
enum class VerdictKind {
    reproduced,
    reproduced_only_for,
    not_reproduced,
    inconsistent_in_print,
    cannot_be_tested_here,
    not_computable,  // records are missing: a failure of the run, not a result
};

// The claim judged on the records of one other order and precision of projection, and its own deformer on the same scenes.
struct OrderVerdict {
    std::string order, precision;  // plain, ordered, grouped; f32, f64
    // By its own records, and by the claim's deformer on the same scenes.
    VerdictKind kind = VerdictKind::not_computable, own_kind = VerdictKind::not_computable;
    std::vector<CaseJudgement> cases = {}, own_cases = {};  // of the same scenes and metrics, in the same order
    std::vector<std::size_t> differing = {};                // places in `cases` of those that hold to another extent

    bool same() const { return kind == own_kind && differing.empty(); }  // in every case, not in the verdict alone
};

// What claim.subject names, mostly a body, and how many of its values lie within the claim's bounds.
struct SubjectCount {
    std::string name;
    int within = 0, all = 0;
    Extent extent = Extent::none;  // whole: all values of it; part: some of each quantity
};

// The value that stands for the claim. share_within, mean_within: the clip with the lowest share of frames within the bound, or with the
// mean farthest from the value in print; measured, printed: the value farthest outside its bound in the bound's own size, or where all lie
// within, the one nearest to its bound.
struct PrimaryFact {
    std::string quantity, statistic, unit;  // statistic: share_of_frames, mean, value, printed
    double value = 0.0, low = 0.0, high = 0.0;
    double bound_low = 0.0, bound_high = 0.0;
    CaseKey of = {};
};

// What a claim comes to, with all that a report shows of it.
struct Verdict {
    Claim claim;                                     // that was judged
    VerdictKind kind = VerdictKind::not_computable;  // by its rule
    std::optional<PrimaryFact> primary = {};         // none: no such value, or sweeps alone
    int within = 0, n = 0;                           // values or cases, by the claim's own metric, that hold, and all of them
    Interval interval;                               // of `primary`, share_within and mean_within alone; n = 0: none
    std::vector<CaseJudgement> cases = {};           // each matching record under each metric, the claim's own metric first
    std::vector<CaseJudgement> compared = {};        // the claim's other deformers and records, by its own metric; no part of the verdict
    std::vector<Measurement> measurements = {};      // of a claim that is judged by them, its own quantity first
    std::vector<Measurement> controls = {};          // its quantities of other keys, then claim.reported; no part of the verdict
    std::vector<SubjectCount> subjects = {};         // of measurements
    std::vector<PrintedFigure> printed = {};         // of a claim about values in print
    std::vector<OrderVerdict> orders = {};           // the claim in other orders and precisions; no part of the verdict
    std::vector<LeftOut> left_out = {};              // what was not installed
    std::vector<std::string> missing = {};           // planned scenes or runs without record: why it is not computable
    std::vector<std::string> runs = {};              // folders behind the verdict
};

// By the claim's own metric: every case whole is reproduced; some case whole or in part, by any of the metrics, is reproduced only for
// those; none is not reproduced. Planned scenes or runs without record: not computable. InputError as metric_series.
Verdict judge(const Claim& claim, const Records& records);

// A verdict of that kind without cases.
Verdict verdict_of(const Claim& claim, VerdictKind kind);

// Of cases that have been judged, by the same rule.
VerdictKind kind_of(const Claim& claim, const std::vector<CaseJudgement>& cases);

const char* name_of(VerdictKind kind);  // reproduced, reproduced_only_for, ...
const char* name_of(Extent extent);     // none, part, whole

}  // namespace analysis
