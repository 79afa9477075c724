#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace analysis {
namespace {

using nlohmann::json;

// JSON has no infinity; null stands for it, as for values that are not known.
json finite(double value)
{
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json to_json_of(const LeftOut& out)
{
    return {{"scene", out.scene}, {"reason", out.reason}};
}

json to_json_of(const Bound& bound)
{
    json object = to_json_of(bound.of);
    object.update({{"low", finite(bound.low)}, {"high", finite(bound.high)}});
    if (!bound.quantity.empty()) object["quantity"] = bound.quantity;
    return object;
}

json to_json_of(const Unit& unit)
{
    json object = to_json_of(unit.of);
    object.update({{"unit", unit.unit},
                   {"value", finite(unit.value)},
                   {"low", finite(unit.low)},
                   {"high", finite(unit.high)},
                   {"bound_low", finite(unit.bound.low)},
                   {"bound_high", finite(unit.bound.high)},
                   {"n", unit.n},
                   {"holds", unit.holds},
                   {"left_out", unit.counts() ? json(nullptr) : json(name_of(unit.left_out))}});
    if (!unit.quantity.empty()) object["quantity"] = unit.quantity;
    for (const Unit& part : unit.parts) object["parts"].push_back(to_json_of(part));
    if (unit.limit != Limit::none) object["limit"] = recorded_name(unit.limit);
    return object;
}

json to_json_of(const PrintedValue& value)
{
    json object = to_json_of(value.of);
    object.update({{"quantity", value.quantity},
                   {"value", finite(value.printed)},
                   {"bound_low", finite(value.least)},
                   {"bound_high", finite(value.most)},
                   {"holds", value.is_consistent()}});
    return object;
}

json to_json_of(const Judged& judged);

template <typename List>
json list_of(const List& all)
{
    json list = json::array();
    for (const auto& one : all) list.push_back(to_json_of(one));
    return list;
}

// The numbers of the units that count: least, median, most.
std::vector<double> numbers_of(const Judged& judged)
{
    std::vector<double> numbers;
    for (const Unit& unit : judged.units)
        if (unit.counts() && std::isfinite(unit.value)) numbers.push_back(unit.value);
    std::ranges::sort(numbers);
    return numbers;
}

json left_out_of(const Judged& judged)
{
    json counts = json::object();
    for (const Unit& unit : judged.units)
        if (!unit.counts()) counts[name_of(unit.left_out)] = counts.value(name_of(unit.left_out), 0) + 1;
    return counts;
}

json facts_of(const Judged& judged)
{
    const std::vector<double> numbers = numbers_of(judged);
    const bool none = numbers.empty();
    return {{"held", judged.held},
            {"n", judged.n},
            {"share", finite(judged.share())},
            {"least", none ? json(nullptr) : json(numbers.front())},
            {"median", none ? json(nullptr) : json(median(numbers))},
            {"most", none ? json(nullptr) : json(numbers.back())},
            {"left_out_units", left_out_of(judged)}};
}

json to_json_of(const Judged& judged)
{
    json object = facts_of(judged);
    object.update({{"name", judged.selection.name},
                   {"role", name_of(judged.selection.role)},
                   {"quantities", judged.selection.quantities},
                   {"of", to_json_of(judged.selection.of)},
                   {"over", to_json_of(judged.selection.over)},
                   {"bounds", list_of(judged.selection.bounds)},
                   {"behaves", judged.behaves},
                   {"cases", list_of(judged.units)}});
    return object;
}

json difference_of(const Verdict& verdict)
{
    if (!verdict.differs) return nullptr;
    const Difference& of = *verdict.differs;
    return {{"field", of.field}, {"least_at", of.least_at}, {"least", of.least}, {"most_at", of.most_at}, {"most", of.most}};
}

json claim_object(const Verdict& verdict)
{
    const Claim& claim = verdict.claim;
    json controls = json::array(), compared = json::array();
    for (const Judged& other : verdict.others)
        (other.selection.role == Role::comparison ? compared : controls).push_back(to_json_of(other));
    json object = facts_of(verdict.own);
    object.update({{"id", claim.id},
                   {"statement", claim.statement},
                   {"place", claim.place},
                   {"study", claim.study},
                   {"rule", name_of(claim.rule)},
                   {"reason", claim.reason},
                   {"verdict", name_of(verdict.kind)},
                   {"why_inconclusive", name_of(verdict.inconclusive)},
                   {"quantities", claim.own.quantities},
                   {"of", to_json_of(claim.own.of)},
                   {"over", to_json_of(claim.own.over)},
                   {"bounds", list_of(claim.own.bounds)},
                   {"source", claim.source},
                   {"range", claim.range},
                   {"unit_fields", claim.unit},
                   {"interval_low", finite(verdict.interval.low)},
                   {"interval_high", finite(verdict.interval.high)},
                   {"chance", finite(verdict.by_chance)},
                   {"q", finite(verdict.q)},
                   {"differs", difference_of(verdict)},
                   {"fixed_at", claim.fixed_at},
                   {"confirmatory", verdict.confirmatory.empty() ? json(nullptr) : claim_object(verdict.confirmatory.front())},
                   {"cases", verdict.printed.empty() ? list_of(verdict.own.units) : list_of(verdict.printed)},
                   {"controls", controls},
                   {"compared", compared},
                   {"readings", list_of(verdict.readings)},
                   {"left_out", list_of(verdict.left_out)},
                   {"missing", verdict.missing},
                   {"runs", verdict.runs}});
    if (!verdict.printed.empty()) {
        object["n"] = verdict.printed.size();
        object["held"] = std::ranges::count_if(verdict.printed, &PrintedValue::is_consistent);
    }
    if (claim.rule != ClaimRule::units) object["share"] = nullptr;
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
    constexpr const char *green = "\033[32m", *yellow = "\033[33m", *red = "\033[31m", *purple = "\033[35m", *grey = "\033[90m";
    constexpr const char* colours[] = {green, red, yellow, yellow, grey, grey, grey, purple, red};  // in the order of the enum
    return colours[static_cast<int>(kind)];
}

std::string spoken(std::string name)
{
    std::ranges::replace(name, '_', ' ');
    return name;
}

// 28 of 29 hold, share 0.966 [0.822, 0.999]; empty without units.
std::string share_text(const Verdict& verdict)
{
    if (!verdict.printed.empty())
        return fmt::format("{} of {} printed values are consistent", std::ranges::count_if(verdict.printed, &PrintedValue::is_consistent),
                           verdict.printed.size());
    if (verdict.own.n == 0 || verdict.claim.rule != ClaimRule::units) return "";
    return fmt::format("{} of {} hold, share {:.3g} [{:.3g}, {:.3g}]", verdict.own.held, verdict.own.n, verdict.own.share(),
                       verdict.interval.low, verdict.interval.high);
}

// A censored number with its sign: > 1,000.
std::string number_text(const Unit& unit)
{
    static constexpr std::array signs = {"", ">= ", "<= ", "> "};
    const bool is_long = unit.limit != Limit::none && unit.value >= 1e3;
    return signs[static_cast<std::size_t>(unit.limit)] + fmt::format("{:.{}g}", unit.value, is_long ? 4 : 3);
}

// The units that count, or their parts, that have a number of this quantity, the least first.
std::vector<Unit> units_with(const Judged& judged, const std::string& quantity)
{
    std::vector<Unit> units;
    for (const Unit& unit : judged.units) {
        const std::vector<Unit> whole = {unit};
        for (const Unit& part : unit.parts.empty() ? whole : unit.parts)
            if (unit.counts() && std::isfinite(part.value) && (part.quantity.empty() || part.quantity == quantity)) units.push_back(part);
    }
    std::ranges::stable_sort(units, {}, &Unit::value);
    return units;
}

// The numbers of the units for each quantity, least to most, with their bounds.
std::string numbers_text(const Verdict& verdict)
{
    std::vector<std::string> texts;
    for (const std::string& quantity : verdict.claim.own.quantities) {
        const std::vector<Unit> units = units_with(verdict.own, quantity);
        if (units.empty()) continue;
        const std::string unit = units.front().unit, shown = unit.empty() || unit == "1" ? "" : " " + unit;
        const std::string least = number_text(units.front()), most = number_text(units.back());
        std::vector<std::string> bounds;
        for (const Bound& bound : verdict.claim.own.bounds)
            if (bound.quantity.empty() || bound.quantity == quantity) bounds.push_back(bound_text(bound));
        texts.push_back(fmt::format("{}: {}{}{}{}", quantity, least == most ? least : least + " to " + most, shown,
                                    bounds.empty() ? "" : "; bound ", fmt::join(bounds, ", ")));
    }
    return fmt::format("{}", fmt::join(texts, "; "));
}

// One line each: how many units hold; their numbers with the bound; why the verdict is inconclusive.
std::string facts_text(const Verdict& verdict)
{
    std::vector<std::string> lines;
    for (const std::string& line : {share_text(verdict), numbers_text(verdict)})
        if (!line.empty()) lines.push_back(line);
    if (verdict.kind == VerdictKind::not_shown || verdict.inconclusive == Inconclusive::chance)
        lines.push_back(fmt::format("chance reaches as many with a probability of {:.2g}", verdict.by_chance));
    else if (verdict.inconclusive != Inconclusive::no) {
        lines.push_back(spoken(name_of(verdict.inconclusive)));
        for (const Judged& other : verdict.others)
            if (!other.behaves)
                lines.push_back(fmt::format("{} ({}): {} of {} hold", other.selection.name, spoken(name_of(other.selection.role)),
                                            other.held, other.n));
    }
    if (!verdict.claim.reason.empty()) lines.push_back("reason: " + verdict.claim.reason);
    return fmt::format("{}", fmt::join(lines, "\n"));
}

// Names once what the claims leave out, such as a body that is not installed, and the records that are missing. Then it counts the verdicts
// of each kind.
std::vector<std::string> closing_texts(const std::vector<Verdict>& verdicts)
{
    std::map<std::array<std::string, 2>, std::set<std::string>> absent;
    for (const Verdict& verdict : verdicts) {
        for (const LeftOut& out : verdict.left_out) absent[{"left out of", out.reason}].insert(verdict.claim.id);
        for (const std::string& name : verdict.missing) absent[{"no record for", name}].insert(verdict.claim.id);
    }
    std::vector<std::string> texts, counts;
    for (const auto& [what, claims] : absent) texts.push_back(fmt::format("{} {}: {}", what[0], fmt::join(claims, ", "), what[1]));
    for (int k = 0; k <= static_cast<int>(VerdictKind::not_computable); ++k) {
        const auto count = std::ranges::count(verdicts, static_cast<VerdictKind>(k), &Verdict::kind);
        if (count > 0) counts.push_back(fmt::format("{} {}", count, spoken(name_of(static_cast<VerdictKind>(k)))));
    }
    texts.push_back(fmt::format("{} claim{}: {}", verdicts.size(), verdicts.size() == 1 ? "" : "s", fmt::join(counts, ", ")));
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
        "| id | statement | verdict | held | units | share | interval | chance | numbers | study |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Verdict& verdict : verdicts) {
        const bool none = verdict.own.n == 0 || verdict.claim.rule != ClaimRule::units;
        const auto known = [&](double value) { return none || !std::isfinite(value) ? std::string() : fmt::format("{:.3g}", value); };
        const std::string interval = none ? "" : fmt::format("[{:.3g}, {:.3g}]", verdict.interval.low, verdict.interval.high);
        const json object = claim_object(verdict);
        const bool is_bounded = !verdict.claim.own.bounds.empty() || !verdict.printed.empty();
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", markdown_cell(verdict.claim.id),
                            markdown_cell(verdict.claim.statement), name_of(verdict.kind), is_bounded ? object["held"].dump() : "",
                            object["n"].dump(), known(verdict.own.share()), interval, known(verdict.by_chance),
                            markdown_cell(numbers_text(verdict)), verdict.claim.study);
    }
    return text;
}

std::string claims_table(const std::vector<Verdict>& verdicts, std::size_t width, bool colours)
{
    constexpr std::size_t verdict_width = 14, gaps = 6;
    const std::size_t whole = std::max<std::size_t>(width, 60);
    std::size_t id_width = 2;
    for (const Verdict& verdict : verdicts) id_width = std::max(id_width, characters(verdict.claim.id));
    const std::size_t rest = whole - id_width - verdict_width - gaps, statement_width = rest * 2 / 5;
    const auto row = [&](const std::string& id, const TextColumn& kind, const std::string& statement, const std::string& facts) {
        return side_by_side({{id, id_width}, kind, {statement, statement_width}, {facts, rest - statement_width}});
    };
    std::string table = row("", {"verdict", verdict_width}, "claim", "facts") + std::string(whole, '-') + "\n";
    for (const Verdict& verdict : verdicts) {
        const TextColumn kind{spoken(name_of(verdict.kind)), verdict_width, colours ? colour_of(verdict.kind) : ""};
        table +=
            row(verdict.claim.id, kind, fmt::format("{} ({})", verdict.claim.statement, verdict.claim.place), facts_text(verdict)) + "\n";
    }
    for (const std::string& text : closing_texts(verdicts))
        for (const std::string& line : wrapped(text, whole)) table += line + "\n";
    return table;
}

std::string bound_text(const Bound& bound)
{
    if (bound.low == bound.high) return fmt::format("{:.4g}", bound.low);
    if (std::isinf(bound.high)) return bound.low > 0.0 && bound.low <= 1e-9 ? "above 0" : fmt::format("{:.4g} or more", bound.low);
    if (std::isinf(bound.low)) return std::nextafter(bound.high, 2.0) == 1.0 ? "below 1" : fmt::format("{:.4g} or less", bound.high);
    return fmt::format("{:.4g} to {:.4g}", bound.low, bound.high);
}

}  // namespace analysis
