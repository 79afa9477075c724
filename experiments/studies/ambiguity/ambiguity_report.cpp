#include "experiments/studies/ambiguity/ambiguity_report.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace experiments {
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

std::string volume_markdown(const std::vector<VolumeChange>& changes)
{
    std::string text =
        "| scene | place | B | signed A -> B [%] | absolute A -> B [%] | within 0.5 % A -> B | distance of B from A [mm] | jiggle A -> B "
        "[mm] | verdict changed |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const VolumeChange& first : changes) {
        if (first.quantity != mean_change) continue;
        const auto of = [&](const char* quantity) -> const VolumeChange& {
            return *std::ranges::find_if(changes, [&](const VolumeChange& other) {
                return other.quantity == quantity && other.scene == first.scene && other.place == first.place &&
                       other.reading_b == first.reading_b;
            });
        };
        text += fmt::format("| {} | {} | {} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.3f} | {:.2f} -> {:.2f} | {} |\n",
                            first.scene, title_of_place(first.place), first.reading_b, first.a, first.b, of(mean_abs_change).a,
                            of(mean_abs_change).b, of(share_within_printed).a, of(share_within_printed).b, 1e3 * of(distance_from_a).b,
                            1e3 * of(distance_by_jiggle).a, 1e3 * of(distance_by_jiggle).b, first.verdict_changed);
    }
    return text;
}

}  // namespace experiments
