#include "analysis/claims_report.hpp"

#include "analysis/case_row.hpp"
#include "analysis/measurement.hpp"
#include "analysis/order_verdicts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace analysis {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> extent_names = {"none", "part", "whole"};

json to_json_of(const Interval& interval)
{
    return {{"estimate", interval.estimate}, {"low", interval.low}, {"high", interval.high},
            {"level", interval.level},       {"n", interval.n},     {"block", interval.block}};
}

json to_json_of(const CaseJudgement& judged)
{
    json angles = json::array(), deepest = json::array();
    for (const AngleRange& range : judged.angles) angles.push_back({range.from_deg, range.to_deg});
    for (const FailingFrame& failing : judged.deepest)
        deepest.push_back({{"frame", failing.frame},
                           {"time_s", failing.time_s},
                           {"angle_deg", failing.angle_deg},
                           {"value", failing.value},
                           {"inverted_tets", failing.inverted_tets}});
    return {{"scene", judged.scene},
            {"deformer", judged.deformer},
            {"variant", judged.variant},
            {"iterations", judged.iterations},
            {"metric", judged.metric},
            {"run", judged.run},
            {"frames", judged.frames},
            {"holds", extent_names[static_cast<std::size_t>(judged.extent)]},
            {"mean", to_json_of(judged.mean)},
            {"share_of_frames", to_json_of(judged.share)},
            {"angles_deg", angles},
            {"least", judged.least},
            {"most", judged.most},
            {"holding_with_inverted_tets", judged.holding_with_inverted_tets},
            {"deepest", deepest},
            {"text", measured_text(judged)}};
}

json to_json_of(const OrderVerdict& verdict)
{
    json cases = json::array();
    for (const CaseJudgement& judged : verdict.cases) cases.push_back(to_json_of(judged));
    return {{"order", verdict.order},
            {"precision", verdict.precision},
            {"verdict", label(verdict.kind)},
            {"own_verdict", label(verdict.own_kind)},
            {"same", verdict.same()},
            {"differing", verdict.differing},
            {"cases", cases}};
}

json to_json_of(const Measurement& measured)
{
    return {{"quantity", measured.quantity}, {"of", measured.of},     {"value", measured.value}, {"low", measured.low},
            {"high", measured.high},         {"unit", measured.unit}, {"run", measured.run}};
}

json to_json_of(const Claim& claim, const Measurement& measured)
{
    json record = to_json_of(measured);
    record["holds"] = extent_names[static_cast<std::size_t>(extent_of(claim, measured))];
    return record;
}

json to_json_of(const Verdict& verdict)
{
    json measurements = json::array();
    for (const Measurement& measured : verdict.measurements) measurements.push_back(to_json_of(verdict.claim, measured));
    json beside_measured = json::array();
    for (const Measurement& measured : verdict.measured_beside) beside_measured.push_back(to_json_of(measured));
    json cases = json::array(), beside = json::array(), orders = json::array();
    for (const OrderVerdict& other : verdict.orders) orders.push_back(to_json_of(other));
    for (const CaseJudgement& judged : verdict.cases) cases.push_back(to_json_of(judged));
    for (const CaseJudgement& judged : verdict.beside) beside.push_back(to_json_of(judged));
    return {{"id", verdict.claim.id},
            {"statement", verdict.claim.statement},
            {"place", verdict.claim.place},
            {"study", verdict.claim.study},
            {"expected", expected_text(verdict.claim)},
            {"verdict", label(verdict.kind)},
            {"text", verdict.text},
            {"measured", verdict.measured},
            {"interval", verdict.interval.n > 0 ? to_json_of(verdict.interval) : json(nullptr)},
            {"interval_of", verdict.interval_of},
            {"runs", verdict.runs},
            {"cases", cases},
            {"beside", beside},
            {"orders", orders},
            {"measurements", measurements},
            {"measured_beside", beside_measured}};
}

// One bound where all quantities share it, else each quantity's.
std::string measured_expectation(const Claim& claim)
{
    std::vector<std::string> texts;
    for (const std::string& quantity : claim.metrics) texts.push_back(bound_text(bound_of(claim, quantity)));
    if (std::set<std::string>(texts.begin(), texts.end()).size() == 1) return texts.front();
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = fmt::format("{}: {}", claim.metrics[i], texts[i]);
    return fmt::format("{}", fmt::join(texts, "; "));
}

// A cell of a Markdown table: one line, no column of its own.
std::string markdown_cell(const std::string& text)
{
    std::string cell;
    for (char c : text) {
        if (c == '|') cell += '\\';
        cell += c == '\n' ? ' ' : c;
    }
    return cell;
}

struct TitledRow {
    std::string title;  // the measure
    CaseRow row;
    std::string run;
};

std::string runs_text(const std::vector<const Measurement*>& measurements)
{
    constexpr std::size_t named = 4;  // the others stand in claims.json
    std::set<std::string> runs;
    for (const Measurement* measured : measurements) runs.insert(measured->run);
    std::vector<std::string> shown(runs.begin(), runs.end());
    if (shown.size() <= named) return fmt::format("{}", fmt::join(shown, ", "));
    shown.resize(named);
    return fmt::format("{} and {} more", fmt::join(shown, ", "), runs.size() - named);
}

// All measurements of a quantity in one row; each of them stands in claims.json.
std::optional<TitledRow> measured_row(const Claim& claim, const std::vector<Measurement>& from, const std::string& quantity, bool judged)
{
    std::vector<const Measurement*> all;
    for (const Measurement& measured : from)
        if (measured.quantity == quantity) all.push_back(&measured);
    if (all.empty()) return {};
    const auto [least, most] = std::minmax_element(all.begin(), all.end(), [](auto a, auto b) { return a->value < b->value; });
    const auto whole = std::count_if(all.begin(), all.end(), [&](auto m) { return extent_of(claim, *m) == Extent::whole; });
    const std::string holds = fmt::format("{} in {} of them; ", bound_text(bound_of(claim, quantity)), whole);
    const std::string least_of = all.size() > 1 ? fmt::format("least: {}; ", (*least)->of) : "";
    return TitledRow{quantity + (judged ? "" : ", beside"),
                     {fmt::format("{} figures", all.size()), fmt::format("{} to {}", figure_text(**least), figure_text(**most)),
                      interval_text(**most), fmt::format("{}{}most: {}", judged ? holds : "", least_of, (*most)->of)},
                     runs_text(all)};
}

// The claim's cases, one metric after the other, then the other deformers, then the claim in other orders of projection.
std::vector<TitledRow> rows_of(const Verdict& verdict)
{
    std::vector<TitledRow> rows;
    for (const CaseJudgement& judged : verdict.cases) rows.push_back({judged.metric, case_row(verdict.claim, judged), judged.run});
    for (const CaseJudgement& judged : verdict.beside) {
        rows.push_back({judged.metric + ", beside", case_row(verdict.claim, judged), judged.run});
        rows.back().row.name += ", " + judged.deformer;
    }
    for (const std::string& quantity : verdict.claim.metrics)
        if (const auto row = measured_row(verdict.claim, verdict.measurements, quantity, true)) rows.push_back(*row);
    if (verdict.claim.rule == ClaimRule::measured)
        for (const std::string& quantity : verdict.claim.beside)
            if (const auto row = measured_row(verdict.claim, verdict.measured_beside, quantity, false)) rows.push_back(*row);
    for (const OrderVerdict& other : verdict.orders)
        rows.push_back({other.cases.front().metric + ", in another order of projection",
                        {name_of(other), measured_in(other), "", text_of(other)},
                        ""});
    return rows;
}

// Every case by the claim's own metric, or every quantity with its range.
std::string figures_in_short(const Verdict& verdict)
{
    std::vector<std::string> figures;
    for (const CaseJudgement& judged : verdict.cases)
        if (judged.metric == verdict.claim.metrics.front()) {
            const CaseRow row = case_row(verdict.claim, judged);
            figures.push_back(row.name + ": " + row.measured);
        }
    for (const std::string& quantity : verdict.claim.metrics)
        if (const auto row = measured_row(verdict.claim, verdict.measurements, quantity, true))
            figures.push_back(fmt::format("{}: {}", quantity, row->row.measured));
    return figures.empty() ? verdict.measured : fmt::format("{}", fmt::join(figures, "; "));
}

std::string deciding_interval(const Verdict& verdict)
{
    if (verdict.interval.n == 0) return "";
    const bool share = verdict.claim.rule == ClaimRule::share_within;
    const double scale = share ? 100.0 : 1.0;
    return fmt::format("{}: [{:.3g}, {:.3g}] %", verdict.interval_of, scale * verdict.interval.low, scale * verdict.interval.high);
}

}  // namespace

json claims_json(const std::vector<Verdict>& verdicts)
{
    json claims = json::array();
    for (const Verdict& verdict : verdicts) claims.push_back(to_json_of(verdict));
    return {{"schema", 1}, {"claims", claims}};
}

std::string claims_markdown(const std::vector<Verdict>& verdicts)
{
    const std::string head = "| id | statement | expected | measured | interval | verdict | runs |\n|---|---|---|---|---|---|---|\n";
    std::string text = head;
    for (const Verdict& verdict : verdicts)
        text += fmt::format("| {} | {} ({}) | {} | {} | {} | {} | {} |\n", markdown_cell(verdict.claim.id),
                            markdown_cell(verdict.claim.statement), verdict.claim.place, markdown_cell(expected_text(verdict.claim)),
                            markdown_cell(figures_in_short(verdict)), deciding_interval(verdict), markdown_cell(verdict.summary),
                            verdict.claim.study);
    text += "\n## The figures behind them\n\n" + head;
    for (const Verdict& verdict : verdicts)
        for (const auto& [title, row, run] : rows_of(verdict))
            text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", markdown_cell(verdict.claim.id), markdown_cell(row.name),
                                markdown_cell(title), row.measured, row.interval, markdown_cell(row.holds), markdown_cell(run));
    return text;
}

std::string expected_text(const Claim& claim)
{
    if (claim.rule == ClaimRule::printed) return "each figure as the others ask for";
    if (claim.metrics.empty()) return "";
    if (claim.rule == ClaimRule::measured) return measured_expectation(claim);
    return fmt::format("{:.4g} % ({:.4g} to {:.4g} %)", claim.expected, claim.low, claim.high);
}

}  // namespace analysis
