#include "analysis/claims_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace analysis {
namespace {

using nlohmann::json;

json to_json_of(const Interval& interval)
{
    return {{"estimate", interval.estimate}, {"low", interval.low}, {"high", interval.high},
            {"level", interval.level},       {"n", interval.n},     {"block", interval.block}};
}

json to_json_of(const CaseJudgement& judged)
{
    const std::array<const char*, 3> extents = {"none", "part", "whole"};
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
            {"holds", extents[static_cast<std::size_t>(judged.extent)]},
            {"mean", to_json_of(judged.mean)},
            {"share_of_frames", to_json_of(judged.share)},
            {"angles_deg", angles},
            {"least", judged.least},
            {"most", judged.most},
            {"holding_with_inverted_tets", judged.holding_with_inverted_tets},
            {"deepest", deepest},
            {"text", measured_text(judged)}};
}

json to_json_of(const Verdict& verdict)
{
    json cases = json::array();
    for (const CaseJudgement& judged : verdict.cases) cases.push_back(to_json_of(judged));
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
            {"cases", cases}};
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

// Words of a text in lines of at most `width` characters; longer words stand alone.
std::vector<std::string> wrapped(const std::string& text, std::size_t width)
{
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
        lines.back() += lines.back().empty() ? word : ' ' + word;
    }
    return lines;
}

const char* colour_of(VerdictKind kind)
{
    switch (kind) {
        case VerdictKind::reproduced:
            return "\033[32m";
        case VerdictKind::reproduced_only_for:
            return "\033[33m";
        case VerdictKind::not_reproduced:
        case VerdictKind::not_computable:
            return "\033[31m";
        default:
            return "\033[90m";
    }
}

struct TableColumns {
    std::size_t id = 2, label = 7, expected = 8, text = 40;
};

TableColumns columns_for(const std::vector<Verdict>& verdicts, int width)
{
    TableColumns columns;
    for (const Verdict& verdict : verdicts) {
        columns.id = std::max(columns.id, verdict.claim.id.size());
        columns.label = std::max(columns.label, label(verdict.kind).size());
        columns.expected = std::max(columns.expected, expected_text(verdict.claim).size());
    }
    const int left = width - static_cast<int>(columns.id + columns.label + columns.expected) - 6;
    columns.text = static_cast<std::size_t>(std::max(left, 40));
    return columns;
}

std::string rows_of(const Verdict& verdict, const TableColumns& columns, const TableLook& look)
{
    std::string rows;
    bool first = true;
    const std::string text = verdict.measured.empty() ? verdict.text : verdict.measured;
    for (const std::string& line : wrapped(text, columns.text)) {
        const std::string name = fmt::format("{:<{}}", first ? label(verdict.kind) : "", columns.label);
        rows += fmt::format("{:<{}}  {}  {:<{}}  {}\n", first ? verdict.claim.id : "", columns.id,
                            look.colours && first ? colour_of(verdict.kind) + name + "\033[0m" : name,
                            first ? expected_text(verdict.claim) : "", columns.expected, line);
        first = false;
    }
    return rows;
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
    std::string text = "| id | statement | expected | measured | interval | verdict | runs |\n|---|---|---|---|---|---|---|\n";
    for (const Verdict& verdict : verdicts)
        text +=
            fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", markdown_cell(verdict.claim.id), markdown_cell(verdict.claim.statement),
                        markdown_cell(expected_text(verdict.claim)), markdown_cell(verdict.measured), markdown_cell(interval_text(verdict)),
                        markdown_cell(verdict.text), markdown_cell(fmt::format("{}", fmt::join(verdict.runs, ", "))));
    return text;
}

std::string claims_table(const std::vector<Verdict>& verdicts, const TableLook& look)
{
    const TableColumns columns = columns_for(verdicts, look.width);
    std::string table =
        fmt::format("{:<{}}  {:<{}}  {:<{}}  measured\n", "id", columns.id, "verdict", columns.label, "expected", columns.expected);
    for (const Verdict& verdict : verdicts) table += rows_of(verdict, columns, look);
    return table;
}

std::string expected_text(const Claim& claim)
{
    if (claim.metrics.empty()) return "";
    return fmt::format("{:.4g} % ({:.4g} to {:.4g} %)", claim.expected, claim.low, claim.high);
}

std::string interval_text(const Verdict& verdict)
{
    const Interval& interval = verdict.interval;
    if (interval.n == 0) return "";
    const double factor = verdict.claim.rule == ClaimRule::share_within ? 100.0 : 1.0;
    return fmt::format("{:.3g} % [{:.3g}, {:.3g}], {:.0f} %, {} frames in blocks of {}: {}", factor * interval.estimate,
                       factor * interval.low, factor * interval.high, 100.0 * interval.level, interval.n, interval.block,
                       verdict.interval_of);
}

}  // namespace analysis
