#include "analysis/claims_table.hpp"

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
    std::size_t id, verdict, statement, facts;
};

Layout layout_of(const std::vector<Verdict>& verdicts, std::size_t width)
{
    Layout layout = {.id = 2, .verdict = 14, .statement = 0, .facts = 0};
    for (const Verdict& verdict : verdicts) layout.id = std::max(layout.id, characters(verdict.claim.id));
    const std::size_t rest = std::max<std::size_t>(width, 60) - layout.id - layout.verdict - 6;
    layout.statement = rest * 2 / 5;
    layout.facts = rest - layout.statement;
    return layout;
}

std::string spoken(VerdictKind kind)
{
    std::string name = name_of(kind);
    if (name == "reproduced_only_for") return "reproduced in part";
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

// One line each: how many values hold; the primary value with its bound; its case; what is missing.
std::string facts_text(const Verdict& verdict)
{
    std::vector<std::string> lines;
    if (verdict.n > 0) lines.push_back(fmt::format("within the bound: {} of {}", verdict.within, verdict.n));
    if (const PrimaryTexts primary = texts_of_primary(verdict); !primary.value.empty()) {
        const std::string interval = primary.interval.empty() ? "" : " " + primary.interval;
        lines.push_back(fmt::format("{}: {}{}; bound {}", primary.quantity, primary.value, interval, primary.bound));
        if (!primary.of.empty()) lines.push_back(fmt::format("of: {}", primary.of));
    }
    if (!verdict.claim.reason.empty()) lines.push_back("reason: " + verdict.claim.reason);
    if (!verdict.missing.empty()) lines.push_back(fmt::format("no record: {}", fmt::join(verdict.missing, ", ")));
    for (const LeftOut& out : verdict.left_out) lines.push_back(fmt::format("left out: {}: {}", out.scene, out.reason));
    return fmt::format("{}", fmt::join(lines, "\n"));
}

std::string counts_text(const std::vector<Verdict>& verdicts)
{
    std::vector<std::string> counts;
    for (const VerdictKind kind : all_kinds) {
        const auto same = [kind](const Verdict& verdict) { return verdict.kind == kind; };
        const auto count = std::count_if(verdicts.begin(), verdicts.end(), same);
        if (count > 0) counts.push_back(fmt::format("{} {}", count, spoken(kind)));
    }
    return fmt::format("{} claim{}: {}", verdicts.size(), verdicts.size() == 1 ? "" : "s", fmt::join(counts, ", "));
}

}  // namespace

std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours)
{
    const Layout layout = layout_of(verdicts, width);
    const std::size_t whole = std::max<std::size_t>(width, 60);
    std::string table = side_by_side({{"", layout.id}, {"verdict", layout.verdict}, {"claim", layout.statement}, {"facts", layout.facts}});
    table += std::string(whole, '-') + "\n";
    for (const Verdict& verdict : verdicts)
        table += side_by_side({{verdict.claim.id, layout.id},
                               {spoken(verdict.kind), layout.verdict, colours ? colour_of(verdict.kind) : ""},
                               {fmt::format("{} ({})", verdict.claim.statement, verdict.claim.place), layout.statement},
                               {facts_text(verdict), layout.facts}}) +
                 "\n";
    for (const std::string& line : wrapped(counts_text(verdicts), whole)) table += line + "\n";
    return table;
}

}  // namespace analysis
