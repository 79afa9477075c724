// Writes verdicts as claims.json, as claims.md and as the table on the terminal: the functions claims_json,
// claims_markdown and claims_table of verdict.hpp. The first half of this file writes the members of claims.json, one
// function per struct of verdict.hpp; the second half writes the texts of the two tables.

#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/headline.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <ranges>
#include <set>

namespace analysis {
namespace {

using nlohmann::json;

// JSON has no infinity; null stands for it, as for values that are not known.
json finite(double value)
{
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json_of(const LeftOut& left_out)
{
    return {{"scene", left_out.scene}, {"reason", left_out.reason}};
}

json to_json_of(const Threshold& threshold)
{
    json object = to_json_of(threshold.of);
    object.update(
        {{"low", finite(threshold.low)}, {"high", finite(threshold.high)}, {"threshold", threshold_text(threshold)}});
    if (!threshold.quantity.empty()) object["quantity"] = threshold.quantity;
    return object;
}

// A value with its threshold, and whether it holds. key: the case that the value belongs to.
json tested_value(const CaseKey& key, const std::string& quantity, double value, const Threshold& threshold, bool holds)
{
    json object = to_json_of(key);
    object.update({{"value", finite(value)},
                   {"threshold_low", finite(threshold.low)},
                   {"threshold_high", finite(threshold.high)},
                   {"threshold", threshold_text(threshold)},
                   {"holds", holds}});
    if (!quantity.empty()) object["quantity"] = quantity;
    return object;
}

json to_json_of(const JudgedCase& tested)
{
    json object = tested_value(tested.of, tested.quantity, tested.value, tested.threshold, tested.holds);
    object.update({{"unit", tested.unit},
                   {"low", finite(tested.low)},
                   {"high", finite(tested.high)},
                   {"n", tested.n},
                   {"excluded", tested.counts() ? json(nullptr) : json(name_of(tested.excluded))}});
    for (const JudgedCase& part : tested.parts) object["parts"].push_back(to_json_of(part));
    if (tested.limit != Limit::none) object["limit"] = recorded_name(tested.limit);
    return object;
}

json to_json_of(const PrintedValue& value)
{
    return tested_value(value.of, value.quantity, value.printed, {.low = value.least, .high = value.most},
                        value.is_consistent());
}

json to_json_of(const BodyExcluded& excluded)
{
    return {{"body", excluded.body}, {"verdict", name_of(excluded.kind)}};
}

json to_json_of(const ThresholdRange& range)
{
    json object = to_json_of(range.threshold.of);
    object.update({{"end", range.is_high ? "high" : "low"},
                   {"threshold", range.is_high ? range.threshold.high : range.threshold.low},
                   {"low", finite(range.low)},
                   {"high", finite(range.high)}});
    if (!range.threshold.quantity.empty()) object["quantity"] = range.threshold.quantity;
    return object;
}

json text_or_null(const std::string& text)
{
    return text.empty() ? json(nullptr) : json(text);
}

json to_json_of(const Judged& judged);

template <typename List>
json list_of(const List& entries)
{
    json list = json::array();
    for (const auto& entry : entries) list.push_back(to_json_of(entry));
    return list;
}

// The finite numbers of the cases that count, in increasing order.
std::vector<double> numbers_of(const Judged& judged)
{
    std::vector<double> numbers;
    for (const JudgedCase& tested : judged.cases)
        if (tested.counts() && std::isfinite(tested.value)) numbers.push_back(tested.value);
    std::ranges::sort(numbers);
    return numbers;
}

// How many cases are excluded for each reason.
json excluded_of(const Judged& judged)
{
    json counts = json::object();
    for (const JudgedCase& tested : judged.cases)
        if (!tested.counts()) counts[name_of(tested.excluded)] = counts.value(name_of(tested.excluded), 0) + 1;
    return counts;
}

// The counts and the range that claims and controls have in common.
json facts_of(const Judged& judged)
{
    const std::vector<double> numbers = numbers_of(judged);
    const bool has_numbers = !numbers.empty();
    return {{"held", judged.held},
            {"n", judged.n},
            {"share", finite(judged.share())},
            {"least", has_numbers ? json(numbers.front()) : json(nullptr)},
            {"median", has_numbers ? json(median(numbers)) : json(nullptr)},
            {"most", has_numbers ? json(numbers.back()) : json(nullptr)},
            {"excluded_cases", excluded_of(judged)}};
}

json to_json_of(const Judged& judged)
{
    json object = facts_of(judged);
    object.update({{"name", judged.selection.name},
                   {"role", name_of(judged.selection.role)},
                   {"quantities", judged.selection.quantities},
                   {"of", to_json_of(judged.selection.of)},
                   {"over", to_json_of(judged.selection.over)},
                   {"thresholds", list_of(judged.selection.thresholds)},
                   {"behaves", judged.behaves},
                   {"cases", list_of(judged.cases)}});
    return object;
}

json difference_of(const Verdict& verdict)
{
    if (!verdict.differs) return nullptr;
    const Difference& difference = *verdict.differs;
    return {{"field", difference.field},
            {"least_at", difference.least_at},
            {"least", difference.least},
            {"most_at", difference.most_at},
            {"most", difference.most}};
}

// The statement of the claim and its thresholds, which were fixed before any result was seen.
json stated_facts(const Claim& claim)
{
    return {{"id", claim.id},
            {"short", claim.short_name},
            {"asked", text_or_null(asked_text(claim))},
            {"statement", claim.statement},
            {"place", claim.place},
            {"study", claim.study},
            {"rule", name_of(claim.rule)},
            {"reason", claim.reason},
            {"quantities", claim.own.quantities},
            {"of", to_json_of(claim.own.of)},
            {"over", to_json_of(claim.own.over)},
            {"thresholds", list_of(claim.own.thresholds)},
            {"source", claim.source},
            {"range", claim.range},
            {"case_fields", claim.case_fields},
            {"fixed_at", claim.fixed_at},
            {"thresholds_fixed_at", claim.thresholds_fixed_at.empty() ? claim.fixed_at : claim.thresholds_fixed_at}};
}

// The member of "claims" for one verdict.
json claim_object(const Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    json controls = json::array();
    json compared = json::array();
    for (const Judged& other : verdict.others)
        (other.selection.role == Role::comparison ? compared : controls).push_back(to_json_of(other));
    json object = facts_of(verdict.own);
    object.update(stated_facts(claim));
    object.update({{"measured", text_or_null(measured_text(verdict))},
                   {"verdict", name_of(verdict.kind)},
                   {"why_inconclusive", name_of(verdict.inconclusive)},
                   {"interval_low", finite(verdict.interval.low)},
                   {"interval_high", finite(verdict.interval.high)},
                   {"chance", finite(verdict.by_chance)},
                   {"q", finite(verdict.q)},
                   {"differs", difference_of(verdict)},
                   {"without_body", list_of(verdict.sensitivity.without_body)},
                   {"threshold_ranges", list_of(verdict.sensitivity.ranges)},
                   {"held_out", verdict.held_out.empty() ? json(nullptr) : claim_object(verdict.held_out.front())},
                   {"cases", verdict.printed.empty() ? list_of(verdict.own.cases) : list_of(verdict.printed)},
                   {"controls", controls},
                   {"compared", compared},
                   {"readings", list_of(verdict.readings)},
                   {"excluded_scenes", list_of(verdict.left_out)},
                   {"missing", verdict.missing},
                   {"runs", verdict.runs}});
    if (!verdict.printed.empty()) {
        object["n"] = verdict.printed.size();
        object["held"] = std::ranges::count_if(verdict.printed, &PrintedValue::is_consistent);
    }
    if (claim.rule != ClaimRule::cases) object["share"] = nullptr;
    return object;
}

json quantities_of(const std::vector<Verdict>& verdicts)
{
    json quantities = json::object();
    for (const Verdict& verdict : verdicts)
        for (const Quantity& quantity : verdict.claim.quantities)
            quantities[quantity.name] = {{"title", quantity.title}, {"unit", quantity.unit}};
    return quantities;
}

const char* colour_of(VerdictKind kind)
{
    constexpr const char* green = "\033[32m";
    constexpr const char* yellow = "\033[33m";
    constexpr const char* red = "\033[31m";
    constexpr const char* purple = "\033[35m";
    constexpr const char* grey = "\033[90m";
    // in the order of the enum
    constexpr const char* colours[] = {green, red, yellow, yellow, grey, grey, grey, purple, red};
    return colours[static_cast<int>(kind)];
}

// The kind in words, such as "not shown" or "cannot be tested". is_plural: the subject is more than one claim.
std::string kind_in_words(VerdictKind kind, bool is_plural)
{
    if (kind == VerdictKind::untestable) return "cannot be tested";
    if (is_plural && kind == VerdictKind::holds) return "hold";
    if (is_plural && kind == VerdictKind::fails) return "fail";
    std::string name = name_of(kind);
    std::ranges::replace(name, '_', ' ');
    return name;
}

// The kind in one or two words for the terminal, such as NOT SHOWN, INCONSISTENT or UNTESTABLE.
std::string in_capitals(VerdictKind kind)
{
    std::string name = kind == VerdictKind::inconsistent_in_print ? "inconsistent" : name_of(kind);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char letter) { return letter == '_' ? ' ' : std::toupper(letter); });
    return name;
}

// At most `width` characters; a longer text ends with an ellipsis.
std::string cut(const std::string& text, std::size_t width)
{
    if (characters(text) <= width) return text;
    std::string begin;
    std::size_t count = 0;
    for (const char byte : text) {
        const bool starts_a_character = (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
        if (starts_a_character && ++count == width) break;
        begin += byte;
    }
    return begin + "\u2026";
}

// A number; a censored one has its sign before it, as in "> 1000".
std::string number_text(const JudgedCase& tested)
{
    static constexpr std::array signs = {"", ">= ", "<= ", "> "};
    const bool is_long = tested.limit != Limit::none && tested.value >= 1e3;
    return signs[static_cast<std::size_t>(tested.limit)] + fmt::format("{:.{}g}", tested.value, is_long ? 4 : 3);
}

// The cases that count and have a number of this quantity, in increasing order. A case with several quantities is
// represented by its part for this one.
std::vector<JudgedCase> cases_with(const Judged& judged, const std::string& quantity)
{
    std::vector<JudgedCase> cases;
    for (const JudgedCase& tested : judged.cases) {
        const std::vector<JudgedCase> whole = {tested};
        for (const JudgedCase& part : tested.parts.empty() ? whole : tested.parts)
            if (tested.counts() && std::isfinite(part.value) && (part.quantity.empty() || part.quantity == quantity))
                cases.push_back(part);
    }
    std::ranges::stable_sort(cases, {}, &JudgedCase::value);
    return cases;
}

// The numbers of the cases for each quantity, least to most, with their thresholds.
std::string numbers_text(const Verdict& verdict)
{
    std::vector<std::string> texts;
    for (const std::string& quantity : verdict.claim.own.quantities) {
        const std::vector<JudgedCase> cases = cases_with(verdict.own, quantity);
        if (cases.empty()) continue;
        const std::string unit = cases.front().unit;
        const std::string unit_text = unit.empty() || unit == "1" ? "" : " " + unit;
        const std::string least = number_text(cases.front());
        const std::string most = number_text(cases.back());
        std::vector<std::string> thresholds;
        for (const Threshold& threshold : verdict.claim.own.thresholds)
            if (threshold.quantity.empty() || threshold.quantity == quantity)
                thresholds.push_back(threshold_text(threshold));
        texts.push_back(fmt::format("{}: {}{}{}{}", quantity, least == most ? least : least + " to " + most, unit_text,
                                    thresholds.empty() ? "" : "; threshold ", fmt::join(thresholds, ", ")));
    }
    return fmt::format("{}", fmt::join(texts, "; "));
}

// Why a verdict is inconclusive or not shown, with the controls that misbehave.
std::string reason_text(const Verdict& verdict)
{
    if (verdict.kind == VerdictKind::not_shown || verdict.inconclusive == Inconclusive::chance)
        return fmt::format("chance reaches as many with a probability of {:.2g}", verdict.by_chance);
    std::vector<std::string> texts;
    if (verdict.inconclusive == Inconclusive::too_few_cases) texts.push_back("too few cases");
    for (const Judged& other : verdict.others)
        if (!other.behaves)
            texts.push_back(
                fmt::format("{} {}: {} of {} hold",
                            other.selection.role == Role::negative_control ? "negative control" : "positive control",
                            other.selection.name, other.held, other.n));
    if (!verdict.claim.reason.empty()) texts.push_back(verdict.claim.reason);
    return fmt::format("{}", fmt::join(texts, "; "));
}

// Names once what the verdicts lack, such as a body that is not installed, and the records that are missing. Then it
// counts the verdicts of each kind.
std::vector<std::string> closing_texts(const std::vector<Verdict>& verdicts)
{
    std::map<std::array<std::string, 2>, std::set<std::string>> absent;
    for (const Verdict& verdict : verdicts) {
        for (const LeftOut& scene : verdict.left_out) absent[{"excluded from", scene.reason}].insert(verdict.claim.id);
        for (const std::string& name : verdict.missing) absent[{"no record for", name}].insert(verdict.claim.id);
    }
    std::vector<std::string> texts, counts;
    for (const auto& [what, claims] : absent)
        texts.push_back(fmt::format("{} {}: {}", what[0], fmt::join(claims, ", "), what[1]));
    for (int k = 0; k <= static_cast<int>(VerdictKind::not_computable); ++k) {
        const auto count = std::ranges::count(verdicts, static_cast<VerdictKind>(k), &Verdict::kind);
        if (count > 0)
            counts.push_back(fmt::format("{} {}", count, kind_in_words(static_cast<VerdictKind>(k), count > 1)));
    }
    texts.push_back(
        fmt::format("{} claim{}: {}", verdicts.size(), verdicts.size() == 1 ? "" : "s", fmt::join(counts, ", ")));
    return texts;
}

}  // namespace

json claims_json(const std::vector<Verdict>& verdicts, const std::string& revision)
{
    json claims = json::array();
    for (const Verdict& verdict : verdicts) claims.push_back(claim_object(verdict));
    return {{"schema", 4}, {"revision", revision}, {"quantities", quantities_of(verdicts)}, {"claims", claims}};
}

std::string claims_markdown(const std::vector<Verdict>& verdicts)
{
    std::string text =
        "| id | statement | verdict | measured | asked | held | cases | share | interval | chance | numbers | reason | "
        "study |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Verdict& verdict : verdicts) {
        const bool has_cases = verdict.own.n > 0 && verdict.claim.rule == ClaimRule::cases;
        const auto cell_of = [&](double value) {
            return has_cases && std::isfinite(value) ? fmt::format("{:.3g}", value) : std::string();
        };
        const std::string interval =
            has_cases ? fmt::format("[{:.3g}, {:.3g}]", verdict.interval.low, verdict.interval.high) : "";
        const json object = claim_object(verdict);
        const bool is_bounded = !verdict.claim.own.thresholds.empty() || !verdict.printed.empty();
        const std::vector<std::string> cells = {
            verdict.claim.id,           verdict.claim.statement,      name_of(verdict.kind),
            measured_text(verdict),     asked_text(verdict.claim),    is_bounded ? object["held"].dump() : "",
            object["n"].dump(),         cell_of(verdict.own.share()), interval,
            cell_of(verdict.by_chance), numbers_text(verdict),        reason_text(verdict),
            verdict.claim.study};
        for (const std::string& cell : cells) text += fmt::format("| {} ", markdown_cell(cell));
        text += "|\n";
    }
    return text;
}

std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours,
                         const FurtherColumn& further)
{
    struct Row {
        std::string id, claim, verdict, measured, further, colour;
    };
    std::vector<Row> rows = {{"", "claim of the paper", "verdict", "measured", further.heading, ""}};
    for (const Verdict& verdict : verdicts) {
        const auto added = further.texts.find(verdict.claim.id);
        rows.push_back({verdict.claim.id, verdict.claim.short_name, in_capitals(verdict.kind), measured_text(verdict),
                        added == further.texts.end() ? "" : added->second, colours ? colour_of(verdict.kind) : ""});
    }
    const auto widest = [&](std::string Row::*text) {
        return std::ranges::max(rows | std::views::transform([&](const Row& row) { return characters(row.*text); }));
    };
    constexpr std::size_t gap = 2;  // blanks between two columns
    const std::size_t table_width = std::max<std::size_t>(width, 60);
    const std::size_t id_width = widest(&Row::id);
    const std::size_t verdict_width = widest(&Row::verdict);
    const std::size_t further_width = std::min(widest(&Row::further), table_width / 4);
    const std::size_t gaps = (further_width > 0 ? 4 : 3) * gap;
    // The columns of the claim and of what was measured share what the others leave.
    const std::size_t shared_width = table_width - id_width - verdict_width - further_width - gaps;
    const std::size_t claim_width =
        std::min(widest(&Row::claim), shared_width - std::min(widest(&Row::measured), shared_width / 2));
    const std::size_t measured_width = shared_width - claim_width;
    std::string table;
    for (const Row& row : rows) {
        std::vector<TextColumn> columns = {
            {row.id, id_width},
            {cut(row.claim, claim_width), claim_width},
            {row.verdict, verdict_width, row.colour},
            {cut(row.measured, measured_width), std::min(widest(&Row::measured), measured_width)}};
        if (further_width > 0) columns.push_back({cut(row.further, further_width), further_width});
        table += side_by_side(columns);
    }
    for (const std::string& text : closing_texts(verdicts))
        for (const std::string& line : wrapped(text, table_width)) table += line + "\n";
    return table;
}

}  // namespace analysis
