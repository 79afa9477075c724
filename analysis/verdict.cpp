#include "analysis/verdict.hpp"

#include "analysis/measured_verdict.hpp"
#include "analysis/order_verdicts.hpp"
#include "analysis/statistics.hpp"
#include "analysis/verdict_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace analysis {
namespace {

bool is_asked_for(const Claim& claim, const CaseRecord& record)
{
    return record.deformer == claim.deformer && (claim.iterations == 0 || record.iterations == claim.iterations) && !record.frame.empty();
}

std::string what_is_asked_for(const Claim& claim)
{
    return claim.deformer + (claim.iterations > 0 ? fmt::format(" with {} iterations", claim.iterations) : "");
}

// Scenes that were planned and have neither a record nor a reason for having none.
std::vector<std::string> missing_scenes(const Claim& claim, const Records& records)
{
    std::vector<std::string> missing;
    for (const std::string& scene : records.planned_scenes) {
        const bool recorded = std::any_of(records.cases.begin(), records.cases.end(),
                                          [&](const CaseRecord& record) { return record.scene == scene && is_asked_for(claim, record); });
        const bool left_out =
            std::any_of(records.left_out.begin(), records.left_out.end(), [&](const LeftOut& entry) { return entry.scene == scene; });
        if (!recorded && !left_out) missing.push_back(scene);
    }
    return missing;
}

// The cases under one metric that hold at least in part, or that do not, in words; empty where there are none.
std::string list_of(const Verdict& verdict, const std::string& metric, bool holding)
{
    std::vector<std::string> entries;
    for (const CaseJudgement& judged : verdict.cases)
        if (judged.metric == metric && (judged.extent != Extent::none) == holding) entries.push_back(short_text(judged));
    return fmt::format("{}", fmt::join(entries, ", "));
}

// By the claim's own metric first: what holds, what does not.
std::string text_of_own_metric(const Verdict& verdict)
{
    const std::string& metric = verdict.claim.metrics.front();
    const std::string holding = list_of(verdict, metric, true), failing = list_of(verdict, metric, false);
    if (verdict.kind == VerdictKind::not_reproduced) return fmt::format("{}: {}", label(verdict.kind), failing);
    if (verdict.kind == VerdictKind::reproduced) return fmt::format("{}: {}", label(verdict.kind), holding);
    if (holding.empty()) return fmt::format("{} another measure than {}, which fails for {}", label(verdict.kind), metric, failing);
    return fmt::format("{} {}{}{}", label(verdict.kind), holding, failing.empty() ? "" : "; not for ", failing);
}

std::string text_of(const Verdict& verdict, const Records& records)
{
    std::string text = text_of_own_metric(verdict);
    for (std::size_t i = 1; i < verdict.claim.metrics.size(); ++i) {
        const std::string& metric = verdict.claim.metrics[i];
        const std::string holding = list_of(verdict, metric, true);
        text += fmt::format("; by {}: {}", metric, holding.empty() ? "nowhere" : holding);
    }
    if (!verdict.orders.empty()) text += "; in other orders of projection " + text_of(verdict.orders);
    if (!records.left_out.empty()) text += "; left out: " + left_out_text(records.left_out);
    return text;
}

// Among the clips in the paper's own variant, under the claim's own metric, the one that decides: the lowest share, or the mean farthest
// from the figure in print.
void choose_interval(Verdict& verdict)
{
    const bool by_share = verdict.claim.rule == ClaimRule::share_within;
    double worst = -std::numeric_limits<double>::infinity();
    for (const CaseJudgement& judged : verdict.cases) {
        const bool is_default = judged.variant.empty() || judged.variant == "default";
        if (judged.sweep || !is_default || judged.metric != verdict.claim.metrics.front()) continue;
        const double distance = by_share ? -judged.share.low : std::abs(judged.mean.estimate - verdict.claim.expected);
        if (!(distance > worst)) continue;
        worst = distance;
        verdict.interval = by_share ? judged.share : judged.mean;
        verdict.interval_of = fmt::format("{}, {}", by_share ? "share of frames" : "mean of " + judged.metric, case_name(judged));
    }
}

void list_measured_and_runs(Verdict& verdict)
{
    std::vector<std::string> entries;
    std::set<std::string> runs;
    for (const CaseJudgement& judged : verdict.cases) {
        if (judged.metric == verdict.claim.metrics.front()) entries.push_back(measured_text(judged));
        if (!judged.run.empty()) runs.insert(judged.run);
    }
    verdict.measured = fmt::format("{}", fmt::join(entries, "; "));
    verdict.runs.assign(runs.begin(), runs.end());
}

Verdict judge_cases(const Claim& claim, const Records& records)
{
    if (const auto missing = missing_scenes(claim, records); !missing.empty())
        return verdict_of(claim, VerdictKind::not_computable,
                          fmt::format("no record of {} on {}", what_is_asked_for(claim), fmt::join(missing, ", ")));
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable, "");
    for (const std::string& metric : claim.metrics)
        for (const CaseRecord& record : records.cases)
            if (is_asked_for(claim, record) && !record.beside) verdict.cases.push_back(judge_case(claim, record, metric));
    if (verdict.cases.empty() && !records.left_out.empty())
        return verdict_of(claim, VerdictKind::cannot_be_tested_here, left_out_text(records.left_out));
    if (verdict.cases.empty()) return verdict_of(claim, VerdictKind::not_computable, "no record of " + what_is_asked_for(claim));
    for (const CaseRecord& record : records.cases)
        if (is_asked_for(claim, record) && record.beside) verdict.beside.push_back(judge_case(claim, record, claim.metrics.front()));
    for (const std::string& deformer : claim.beside)
        for (const CaseRecord& record : records.cases)
            if (record.deformer == deformer && !record.frame.empty())
                verdict.beside.push_back(judge_case(claim, record, claim.metrics.front()));
    verdict.kind = kind_of(claim, verdict.cases);
    verdict.orders = judge_orders(claim, records);
    verdict.summary = text_of_own_metric(verdict);
    verdict.text = text_of(verdict, records);
    choose_interval(verdict);
    list_measured_and_runs(verdict);
    return verdict;
}

std::string bounds_in_print(const PrintedFigure& figure)
{
    if (std::isinf(figure.most)) return fmt::format("{:.6g} or more", figure.least);
    return fmt::format("{:.6g} to {:.6g}", figure.least, figure.most);
}

Verdict judge_print(const Claim& claim, const std::vector<PrintedFigure>& figures)
{
    constexpr std::size_t named = 3;  // the others stand in the study's table
    std::vector<std::string> broken;
    std::size_t count = 0;
    for (const PrintedFigure& figure : figures) {
        if (figure.claim != claim.id) continue;
        ++count;
        if (!(figure.least <= figure.printed && figure.printed <= figure.most))
            broken.push_back(fmt::format("{} is {:.6g}, but the rest asks for {}", figure.what, figure.printed, bounds_in_print(figure)));
    }
    if (count == 0) return verdict_of(claim, VerdictKind::not_computable, "no figures in print were given");
    const std::string measured = fmt::format("{} of {} figures consistent", count - broken.size(), count);
    if (broken.size() > named) {
        const std::size_t more = broken.size() - named;
        broken.resize(named);
        broken.push_back(fmt::format("and {} more", more));
    }
    Verdict verdict = verdict_of(claim, broken.empty() ? VerdictKind::reproduced : VerdictKind::inconsistent_in_print,
                                 fmt::format("{}", fmt::join(broken, "; ")));
    verdict.measured = measured;
    return verdict;
}

}  // namespace

VerdictKind kind_of(const Claim& claim, const std::vector<CaseJudgement>& cases)
{
    const auto is_whole_or_other = [&](const CaseJudgement& judged) {
        return judged.extent == Extent::whole || judged.metric != claim.metrics.front();
    };
    const auto holds_somewhere = [](const CaseJudgement& judged) { return judged.extent != Extent::none; };
    if (std::all_of(cases.begin(), cases.end(), is_whole_or_other)) return VerdictKind::reproduced;
    if (std::any_of(cases.begin(), cases.end(), holds_somewhere)) return VerdictKind::reproduced_only_for;
    return VerdictKind::not_reproduced;
}

Verdict judge(const Claim& claim, const Records& records)
{
    switch (claim.rule) {
        case ClaimRule::printed:
            return judge_print(claim, records.printed);
        case ClaimRule::measured:
            return judge_measurements(claim, records);
        case ClaimRule::untestable:
            return verdict_of(claim, VerdictKind::cannot_be_tested_here, claim.reason);
        default:
            return judge_cases(claim, records);
    }
}

}  // namespace analysis
