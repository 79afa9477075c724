#include "analysis/claims_table.hpp"

#include "analysis/case_row.hpp"
#include "analysis/case_texts.hpp"
#include "analysis/claims_report.hpp"
#include "analysis/text_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace analysis {
namespace {

constexpr std::array all_kinds = {VerdictKind::reproduced,
                                  VerdictKind::reproduced_only_for,
                                  VerdictKind::not_reproduced,
                                  VerdictKind::inconsistent_in_print,
                                  VerdictKind::cannot_be_tested_here,
                                  VerdictKind::not_computable};

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
        case VerdictKind::inconsistent_in_print:
            return "\033[35m";
        default:
            return "\033[90m";
    }
}

struct Layout {
    std::size_t id, verdict, statement, found;
};

Layout layout_of(const std::vector<Verdict>& verdicts, std::size_t width)
{
    Layout layout = {.id = 2, .verdict = 14, .statement = 0, .found = 0};
    for (const Verdict& verdict : verdicts) layout.id = std::max(layout.id, characters(verdict.claim.id));
    const std::size_t rest = std::max<std::size_t>(width, 60) - layout.id - layout.verdict - 6;
    layout.statement = rest * 2 / 5;
    layout.found = rest - layout.statement;
    return layout;
}

// By the claim's own metric: a clip's share of frames or its mean and range, a sweep's angles.
std::string case_line(const Claim& claim, const CaseJudgement& judged)
{
    constexpr std::array<const char*, 3> extents = {"no", "in part", "yes"};
    const CaseRow row = case_row(claim, judged);
    const std::string figures = judged.sweep                            ? row.holds
                                : claim.rule == ClaimRule::share_within ? row.interval + inverted_text(judged)
                                                                        : row.measured + inverted_text(judged);
    return fmt::format("{}: {}, {}\n", row.name, extents[static_cast<std::size_t>(judged.extent)], figures);
}

// A line a case; of figures, a line for what holds and one for what does not.
std::string found_text(const Verdict& verdict)
{
    std::string text;
    for (const CaseJudgement& judged : verdict.cases)
        if (judged.metric == verdict.claim.metrics.front()) text += case_line(verdict.claim, judged);
    if (!text.empty()) return text;
    text = verdict.summary;
    if (text.starts_with(label(verdict.kind))) text.erase(0, label(verdict.kind).size());
    text.erase(0, std::min(text.find_first_not_of(": "), text.size()));
    for (const char* part : {"; not for ", "; farthest: ", "; beside it: "})
        if (const std::size_t place = text.find(part); place != std::string::npos) text.replace(place, 2, "\n");
    return verdict.measured.empty() ? text : verdict.measured + "\n" + text;
}

std::string statement_text(const Verdict& verdict)
{
    const std::string expected = expected_text(verdict.claim);
    return fmt::format("{} ({}){}", verdict.claim.statement, verdict.claim.place, expected.empty() ? "" : "\nexpected: " + expected);
}

std::string counts_text(const std::vector<Verdict>& verdicts)
{
    std::vector<std::string> counts;
    for (const VerdictKind kind : all_kinds) {
        const auto same = [kind](const Verdict& verdict) { return verdict.kind == kind; };
        const auto count = std::count_if(verdicts.begin(), verdicts.end(), same);
        const char* rest = kind == VerdictKind::reproduced_only_for ? " some" : "";
        if (count > 0) counts.push_back(fmt::format("{} {}{}", count, label(kind), rest));
    }
    return fmt::format("{} claim{}: {}", verdicts.size(), verdicts.size() == 1 ? "" : "s", fmt::join(counts, ", "));
}

}  // namespace

std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours)
{
    const Layout layout = layout_of(verdicts, width);
    const std::size_t whole = std::max<std::size_t>(width, 60);
    std::string table = side_by_side({{"", layout.id}, {"verdict", layout.verdict}, {"claim", layout.statement}, {"found", layout.found}});
    table += std::string(whole, '-') + "\n";
    for (const Verdict& verdict : verdicts)
        table += side_by_side({{verdict.claim.id, layout.id},
                               {label(verdict.kind), layout.verdict, colours ? colour_of(verdict.kind) : ""},
                               {statement_text(verdict), layout.statement},
                               {found_text(verdict), layout.found}}) +
                 "\n";
    for (const std::string& line : wrapped(counts_text(verdicts), whole)) table += line + "\n";
    return table;
}

}  // namespace analysis
