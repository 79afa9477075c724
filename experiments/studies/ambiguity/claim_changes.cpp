#include "experiments/studies/ambiguity/claim_changes.hpp"

#include "analysis/records/report_table.hpp"
#include "pbs/character/body_cache.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace experiments {

const analysis::Columns<ClaimChange>& claim_change_columns()
{
    using Changes = analysis::Columns<ClaimChange>;
    static const Changes columns = [] {
        analysis::Columns<analysis::CaseKey> of_case = analysis::case_key_columns();
        auto& body = *std::ranges::find(of_case, "body", &analysis::Column<analysis::CaseKey>::name);
        body = {"case_body", &analysis::CaseKey::body, "", "body of the value's case, or its scene"};
        body.group = body.name;
        return Changes{{"body", &ClaimChange::body, "", "name of the body"},
                       {"place", &ClaimChange::place, "", "place of the paper that can be read in two ways"},
                       {"reading_a", &ClaimChange::reading_a, "", "the baseline"},
                       {"reading_b", &ClaimChange::reading_b, "", "the other reading"},
                       {"claim", &ClaimChange::claim, "", "id of the claim"},
                       {"quantity", &ClaimChange::quantity, "", "quantity that the claim is judged by"}} +
               within(&ClaimChange::of, of_case) +
               Changes{{"unit", &ClaimChange::unit, "", "unit of a, b and change"},
                       {"bound", &ClaimChange::bound, "", "the claim's bound, in words"},
                       {"a", &ClaimChange::a, "", "value by reading A"},
                       {"b", &ClaimChange::b, "", "value by reading B"},
                       {"change", &ClaimChange::change, "", "b less a"},
                       {"b_over_a", &ClaimChange::b_over_a, "", "b over a"},
                       {"holds_a", &ClaimChange::holds_a, "", "extent to which a lies within the bound: whole, part, none"},
                       {"holds_b", &ClaimChange::holds_b, "", "extent to which b lies within the bound"},
                       {"verdict_flips", &ClaimChange::verdict_flips, "", "yes, no, not_touched or no_value"},
                       {"reason", &ClaimChange::reason, "", "why there is no value, or why it is only a limit, in words"}};
    }();
    return columns;
}

namespace {

const JudgedValue* find(const ReadingValues& of, const JudgedValue& wanted)
{
    const auto found = std::ranges::find_if(of.values, [&](const JudgedValue& one) {
        return one.claim == wanted.claim && one.quantity == wanted.quantity && one.of == wanted.of;
    });
    return found == of.values.end() ? nullptr : &*found;
}

std::string why(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (b_broke_down) return "B breaks down";
    if (!a || !b) return std::string(a ? "B" : "A") + " has no such value";
    const auto limit = [](const char* which, const JudgedValue& of) {
        return of.limit == analysis::Limit::none ? "" : std::string(which) + ": " + analysis::recorded_name(of.limit);
    };
    const std::string of_a = limit("A", *a), of_b = limit("B", *b);
    return of_a + (of_a.empty() || of_b.empty() ? "" : "; ") + of_b;
}

std::string flips(const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (a && !b && b_broke_down) return a->extent == analysis::Extent::none ? "no" : "yes";
    if (!a || !b) return "no_value";
    return a->extent == b->extent ? "no" : "yes";
}

ClaimChange named(ClaimChange row, const JudgedValue& one)
{
    row.quantity = one.quantity, row.of = one.of, row.unit = one.unit, row.bound = one.bound;
    return row;
}

// row: named by one of them. Either may be null.
ClaimChange compared(ClaimChange row, const JudgedValue* a, const JudgedValue* b, bool b_broke_down)
{
    if (a) row.a = a->value, row.holds_a = analysis::name_of(a->extent);
    if (b) row.b = b->value, row.holds_b = analysis::name_of(b->extent);
    if (a && b) row.change = b->value - a->value;
    if (a && b && a->value != 0.0) row.b_over_a = b->value / a->value;
    row.verdict_flips = flips(a, b, b_broke_down);
    row.reason = why(a, b, b_broke_down);
    return row;
}

ClaimChange without_value(ClaimChange row, const std::string& verdict_flips, const std::string& reason, const std::string& quantity = "")
{
    row.quantity = quantity, row.verdict_flips = verdict_flips, row.reason = reason;
    return row;
}

ClaimChange row_of(const std::string& body, const std::string& claim, const Reading& reading)
{
    return {body, reading.place, reading.baseline, reading.name, claim};
}

}  // namespace

std::vector<ClaimChange> claim_changes(const std::string& body, const std::string& claim, const Reading& reading, const ReadingValues& a,
                                       const ReadingValues& b)
{
    const ClaimChange row = row_of(body, claim, reading);
    std::vector<ClaimChange> changes;
    for (const JudgedValue& of_a : a.values)
        if (of_a.claim == claim) changes.push_back(compared(named(row, of_a), &of_a, find(b, of_a), b.broke_down));
    for (const JudgedValue& of_b : b.values)
        if (of_b.claim == claim && !find(a, of_b)) changes.push_back(compared(named(row, of_b), nullptr, &of_b, b.broke_down));
    for (const LeftOutQuantity& one : b.left_out)
        if (one.claim == claim) changes.push_back(without_value(row, "no_value", one.reason, one.quantity));
    if (changes.empty()) changes.push_back(without_value(row, "no_value", b.broke_down ? "B breaks down" : "neither reading has a value"));
    return changes;
}

ClaimChange untouched_claim(const std::string& body, const std::string& claim, const Reading& reading, const std::string& reason)
{
    return without_value(row_of(body, claim, reading), "not_touched", reason);
}

const Reading& ReadingComparison::baseline_of(const Reading& reading) const
{
    return *std::ranges::find_if(readings_, [&](const Reading& other) { return other.place.empty() && other.name == reading.baseline; });
}

void ReadingComparison::measure(const std::vector<std::string>& claims, const Measure& measure)
{
    std::vector<Reading> measured;
    const auto add = [&](const Reading& reading) {
        if (std::ranges::find(measured, reading.name, &Reading::name) == measured.end()) measured.push_back(reading);
    };
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty() || !untouched_because(claim, reading, baseline_of(reading)).empty()) continue;
            add(baseline_of(reading));
            add(reading);
        }
    const std::vector<ReadingValues> values = measure(measured);
    std::map<std::string, const ReadingValues*> by_name;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        by_name[measured[i].name] = &values.at(i);
        if (values[i].broke_down) breakdown_ += fmt::format("{} ({}). ", measured[i].name, fmt::join(claims, ", "));
    }
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty()) continue;
            const std::string reason = untouched_because(claim, reading, baseline_of(reading));
            if (reason.empty())
                std::ranges::copy(claim_changes(body_, claim, reading, *by_name.at(reading.baseline), *by_name.at(reading.name)),
                                  std::back_inserter(changes_));
            else
                changes_.push_back(untouched_claim(body_, claim, reading, reason));
        }
}

namespace {

JudgedValue of_case(const analysis::Claim& claim, const analysis::CaseRecord& record, const std::string& metric)
{
    const analysis::CaseJudgement judgement = analysis::judge_case(claim, record, metric);
    const bool of_share = claim.rule == analysis::ClaimRule::share_within;
    return {claim.id,
            (of_share ? "share_of_frames_by_" : "mean_") + metric,
            {.body = record.scene},
            of_share ? "1" : "%",
            of_share ? analysis::bound_text({"", claim.share, 1.0}) : analysis::bound_text({"", claim.low, claim.high}),
            of_share ? judgement.share.estimate : judgement.mean.estimate,
            judgement.extent};
}

}  // namespace

std::string digest_of(const std::vector<analysis::Claim>& claims)
{
    nlohmann::json all = nlohmann::json::array();
    for (const analysis::Claim& claim : claims) {
        all.push_back({claim.id, static_cast<int>(claim.rule), claim.metrics, claim.deformer, claim.iterations, claim.low, claim.high,
                       claim.share, claim.part, claim.level});
        for (const analysis::QuantityBound& bound : claim.bounds) all.push_back({bound.quantity, bound.low, bound.high});
    }
    return pbs::content_hash(all.dump());
}

std::vector<LeftOutQuantity> all_but(const std::string& claim, const std::vector<std::string>& measured, const std::string& reason)
{
    std::vector<LeftOutQuantity> left_out;
    for (const std::string& quantity : claim_named(claim).metrics)
        if (std::find(measured.begin(), measured.end(), quantity) == measured.end()) left_out.push_back({claim, quantity, reason});
    return left_out;
}

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured)
{
    std::vector<JudgedValue> values;
    for (const analysis::Measurement& one : measured) {
        const analysis::Claim& claim = claim_named(one.claim);
        if (!analysis::is_judged(claim, one)) continue;
        values.push_back({one.claim, one.quantity, one.of, one.unit, analysis::bound_text(analysis::bound_of(claim, one.quantity)),
                          one.value, analysis::extent_of(claim, one), one.limit});
    }
    return values;
}

std::vector<JudgedValue> judged(const ReadMotion& moved)
{
    std::vector<JudgedValue> values;
    for (const analysis::Claim& claim : claims()) {
        if (claim.study != "volume") continue;
        for (const std::string& metric : claim.metrics)
            values.push_back(of_case(claim, claim.deformer == "lbs" ? moved.lbs : moved.pbs, metric));
    }
    return values;
}

namespace {

constexpr std::size_t widest = 120, name_width = 36, cell_width = 7;  // of a cell, without the mark of a flip

template <typename T>
void add_new(std::vector<T>& to, const T& value)
{
    if (std::ranges::find(to, value) == to.end()) to.push_back(value);
}

std::string shortened(const std::string& text)
{
    return text.size() <= name_width ? text : text.substr(0, name_width - 2) + "..";
}

// How far B over A is from 1, either way.
double size_of_change(const ClaimChange& row)
{
    if (!row.change) return -1.0;
    if (!row.b_over_a) return *row.change == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    return *row.b_over_a > 0.0 ? std::abs(std::log(*row.b_over_a)) : std::numeric_limits<double>::infinity();
}

std::string value_text(const ClaimChange& row)
{
    if (row.b_over_a) {
        const std::string text = fmt::format("x{:.3g}", *row.b_over_a);
        return text.size() <= cell_width ? text : fmt::format("x{:.0e}", *row.b_over_a);
    }
    return row.a && row.b ? fmt::format("0>{:.2g}", *row.b) : "-";
}

// rows: of a body, a reading and a claim.
std::string cell_text(const std::vector<ClaimChange>& rows)
{
    if (rows.empty()) return "";
    if (std::ranges::find(rows, "not_touched", &ClaimChange::verdict_flips) != rows.end()) return ".";
    const auto rank = [](const ClaimChange& row) { return std::pair(row.verdict_flips == "yes", size_of_change(row)); };
    const ClaimChange& chosen = *std::ranges::max_element(rows, {}, rank);
    return value_text(chosen) + (chosen.verdict_flips == "yes" ? "!" : "");
}

std::set<std::string> claims_of(const std::vector<ClaimChange>& changes)
{
    std::set<std::string> claims;
    for (const ClaimChange& row : changes) claims.insert(row.claim);
    return claims;
}

std::string block_of(const std::string& body, const std::vector<ClaimChange>& changes)
{
    const std::set<std::string> claims = claims_of(changes);
    std::vector<std::pair<std::string, std::string>> readings;  // place, name
    std::map<std::vector<std::string>, std::vector<ClaimChange>> cells;
    for (const ClaimChange& row : changes) {
        if (row.body != body) continue;
        add_new(readings, {row.place, row.reading_b});
        cells[{row.place, row.reading_b, row.claim}].push_back(row);
    }
    std::vector<std::string> columns = {"reading"};
    std::vector<analysis::ReportColumn> shown = {{body, "reading"}};
    for (const std::string& claim : claims) columns.push_back(claim), shown.push_back({claim, claim});
    analysis::CsvTable table(columns);
    std::string last_place;
    for (const auto& [place, reading] : readings) {
        std::vector<analysis::CsvTable::Cell> heading(columns.size(), std::string()), line = {shortened("  " + reading)};
        heading.front() = shortened(title_of_place(place));
        if (place != last_place) table.add_row(heading);
        last_place = place;
        for (const std::string& claim : claims) line.emplace_back(cell_text(cells[{place, reading, claim}]));
        table.add_row(line);
    }
    return text_table(table, shown) + "\n";
}

// Lines of at most `widest`, all but the first indented.
std::string hanging(const std::string& head, const std::vector<std::string>& parts)
{
    if (parts.empty()) return head + "\n";
    const std::string indent(head.size() + 1, ' ');
    const auto lines = analysis::wrapped(fmt::format("{}", fmt::join(parts, "; ")), widest - indent.size());
    return fmt::format("{} {}\n", head, fmt::join(lines, "\n" + indent));
}

std::string words_of(const std::string& claim, const std::vector<ClaimChange>& changes)
{
    std::vector<std::string> flipping, reasons;
    std::map<std::string, std::vector<std::string>> without;  // quantities by why there is none
    int values = 0, flips = 0;
    for (const ClaimChange& row : changes) {
        if (row.claim != claim) continue;
        values += row.verdict_flips == "yes" || row.verdict_flips == "no";
        flips += row.verdict_flips == "yes";
        if (row.verdict_flips == "yes") add_new(flipping, row.body + ", " + row.reading_b);
        if (row.verdict_flips == "not_touched") add_new(reasons, row.reason);
        if (row.verdict_flips == "no_value") add_new(without[row.reason], row.quantity);
    }
    std::string text = hanging(fmt::format("{}: {} of {} values flip{}", claim, flips, values, flips > 0 ? " by" : ""), flipping);
    if (!reasons.empty()) text += hanging("     not touched where", reasons);
    for (const auto& [reason, quantities] : without)
        text += hanging("     no value:", {fmt::format("{}: {}", reason, fmt::join(quantities, ", "))});
    return text;
}

}  // namespace

std::string claim_changes_text(const std::vector<ClaimChange>& changes)
{
    std::vector<std::string> bodies;
    for (const ClaimChange& row : changes) add_new(bodies, row.body);
    std::string text;
    for (const std::string& body : bodies) text += block_of(body, changes);
    text += "B over A of the value that flips, or else changes most;  ! its verdict flips;  . not touched;  - no value\n\n";
    for (const std::string& claim : claims_of(changes)) text += words_of(claim, changes);
    return text;
}

}  // namespace experiments
