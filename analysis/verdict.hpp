// Verdicts: computed from records and from bounds that were fixed beforehand, nothing typed in.
//   const Verdict verdict = judge(claim, records);   // verdict.text: "reproduced only for limb_twist up to 116 of 170 deg"
#pragma once

#include "analysis/case_judgement.hpp"

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

// The claim judged on the records of one other order and precision of projection, beside its own deformer on the same scenes.
struct OrderVerdict {
    std::string order, precision;  // plain, ordered, grouped; f32, f64
    // By its own records, and by the claim's deformer on the same scenes.
    VerdictKind kind = VerdictKind::not_computable, own_kind = VerdictKind::not_computable;
    std::vector<CaseJudgement> cases = {}, own_cases = {};  // of the same scenes and metrics, in the same order
    std::vector<std::string> differing = {};                // scene and metric of cases that hold to another extent

    bool same() const { return kind == own_kind && differing.empty(); }  // in every case, not in the verdict alone
};

// What a claim comes to, with all that a report shows of it.
struct Verdict {
    Claim claim;                                     // that was judged
    VerdictKind kind = VerdictKind::not_computable;  // by its rule
    std::string text;                                // the verdict in words
    std::string summary;                             // the same by the claim's own metric alone
    std::string measured;                            // by the claim's own metric, case by case
    // Of the clip that decides: share_within, of its share, the one with the lowest lower bound; mean_within, of its mean, the one farthest
    // from the figure in print. NaN where there is none.
    Interval interval;
    std::string interval_of;                        // what of, and in which case; else empty
    std::vector<CaseJudgement> cases;               // each matching record under each metric, the claim's own metric first
    std::vector<CaseJudgement> beside;              // the claim's other deformers, by its own metric
    std::vector<Measurement> measurements = {};     // of a claim that is judged by them, its own quantity first
    std::vector<Measurement> measured_beside = {};  // of claim.beside; no part of the verdict
    std::vector<OrderVerdict> orders;               // the claim in other orders and precisions; no part of the verdict
    std::vector<std::string> runs;                  // folders behind the verdict
};

// By the claim's own metric: every case whole is reproduced; some case whole or in part, by any of the metrics, is reproduced only for
// those; none is not reproduced. Planned scenes or runs without record: not computable. InputError as metric_series.
Verdict judge(const Claim& claim, const Records& records);

// Of cases that have been judged, by the same rule.
VerdictKind kind_of(const Claim& claim, const std::vector<CaseJudgement>& cases);

std::string label(VerdictKind kind);  // "reproduced", "reproduced only for", ...

}  // namespace analysis
