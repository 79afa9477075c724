#include "experiments/studies/ambiguity/claim_changes_text.hpp"

#include "analysis/text_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace experiments {
namespace {

constexpr std::size_t widest = 120, name_width = 36, cell_width = 9;

// Rows of a body, a reading and a claim.
struct Cell {
    std::vector<int> rows;
};

template <typename T>
void add_new(std::vector<T>& to, const T& value)
{
    if (std::find(to.begin(), to.end(), value) == to.end()) to.push_back(value);
}

std::string shortened(const std::string& text, std::size_t width)
{
    return text.size() <= width ? text : text.substr(0, width - 2) + "..";
}

// How far B over A is from 1, either way.
double size_of_change(const analysis::CsvTable& table, int row)
{
    const auto ratio = table.number_or_nothing(row, "b_over_a");
    const auto change = table.number_or_nothing(row, "change");
    if (!change) return -1.0;
    if (!ratio) return *change == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    return *ratio > 0.0 ? std::abs(std::log(*ratio)) : std::numeric_limits<double>::infinity();
}

std::string text_of_figure(const analysis::CsvTable& table, int row)
{
    const auto ratio = table.number_or_nothing(row, "b_over_a"), b = table.number_or_nothing(row, "b");
    if (const std::string text = ratio ? fmt::format("x{:.3g}", *ratio) : ""; !text.empty())
        return text.size() + 2 <= cell_width ? text : fmt::format("x{:.0e}", *ratio);  // a blank before it, a mark behind
    if (!b) return "-";
    return table.number_or_nothing(row, "a") ? fmt::format("0>{:.2g}", *b) : "-";
}

std::string text_of(const analysis::CsvTable& table, const Cell& cell)
{
    int chosen = -1;
    bool chosen_flips = false;
    for (const int row : cell.rows) {
        if (table.text_at(row, "verdict_flips") == "not touched") return ".";
        const bool flips = table.text_at(row, "verdict_flips") == "yes";
        const bool larger = chosen < 0 || size_of_change(table, row) > size_of_change(table, chosen);
        if (chosen >= 0 && (flips != chosen_flips ? !flips : !larger)) continue;
        chosen = row;
        chosen_flips = flips;
    }
    return chosen < 0 ? "" : text_of_figure(table, chosen) + (chosen_flips ? "!" : "");
}

// Lines of at most `widest`, all but the first indented.
std::string hanging(const std::string& head, const std::vector<std::string>& parts)
{
    if (parts.empty()) return head + "\n";
    const std::string indent(head.size() + 1, ' ');
    const auto lines = analysis::wrapped(fmt::format("{}", fmt::join(parts, "; ")), widest - indent.size());
    return fmt::format("{} {}\n", head, fmt::join(lines, "\n" + indent));
}

class Text {
public:
    explicit Text(const analysis::CsvTable& table) : table_(table)
    {
        for (int row = 0; row < table.rows(); ++row) {
            add_new(bodies_, table.text_at(row, "body"));
            add_new(claims_, table.text_at(row, "claim"));
            add_new(readings_, {table.text_at(row, "place"), table.text_at(row, "reading_b")});
            cells_[key(row)].rows.push_back(row);
        }
        std::sort(claims_.begin(), claims_.end());
    }

    std::string whole() const
    {
        std::string text;
        for (const std::string& body : bodies_) text += block_of(body);
        text += "B over A of the figure that flips, or else changes most;  ! its verdict flips;  . not touched;  - no figure\n\n";
        for (const std::string& claim : claims_) text += words_of(claim);
        return text;
    }

private:
    using Key = std::vector<std::string>;

    Key key(int row) const
    {
        return {table_.text_at(row, "body"), table_.text_at(row, "place"), table_.text_at(row, "reading_b"), table_.text_at(row, "claim")};
    }

    std::string block_of(const std::string& body) const
    {
        std::string text = fmt::format("{:<{}}", body, name_width), last_place;
        for (const std::string& claim : claims_) text += fmt::format(" {:>{}}", claim, cell_width - 1);
        text += "\n";
        for (const auto& [place, reading] : readings_) {
            std::string line;
            for (const std::string& claim : claims_) {
                const auto found = cells_.find({body, place, reading, claim});
                line += fmt::format(" {:>{}}", found == cells_.end() ? "" : text_of(table_, found->second), cell_width - 1);
            }
            if (line.find_first_not_of(' ') == std::string::npos) continue;
            if (place != last_place) text += "  " + place + "\n";
            last_place = place;
            text += fmt::format("    {:<{}}{}\n", shortened(reading, name_width - 4), name_width - 4, line);
        }
        return text + "\n";
    }

    std::string words_of(const std::string& claim) const
    {
        std::vector<std::string> flipping, reasons;
        std::map<std::string, std::vector<std::string>> without;  // quantities by why there is none
        int figures = 0, flips = 0;
        for (int row = 0; row < table_.rows(); ++row) {
            if (table_.text_at(row, "claim") != claim) continue;
            const std::string& word = table_.text_at(row, "verdict_flips");
            figures += word == "yes" || word == "no";
            flips += word == "yes";
            if (word == "yes") add_new(flipping, table_.text_at(row, "body") + ", " + table_.text_at(row, "reading_b"));
            if (word == "not touched") add_new(reasons, table_.text_at(row, "reason"));
            if (word == "no figure") add_new(without[table_.text_at(row, "reason")], table_.text_at(row, "quantity"));
        }
        std::string text = hanging(fmt::format("{}: {} of {} figures flip{}", claim, flips, figures, flips > 0 ? " by" : ""), flipping);
        if (!reasons.empty()) text += hanging("     not touched where", reasons);
        for (const auto& [reason, quantities] : without)
            text += hanging("     no figure:", {fmt::format("{}: {}", reason, fmt::join(quantities, ", "))});
        return text;
    }

    const analysis::CsvTable& table_;
    std::vector<std::string> bodies_, claims_;
    std::vector<std::pair<std::string, std::string>> readings_;
    std::map<Key, Cell> cells_;
};

}  // namespace

std::string claim_changes_text(const analysis::CsvTable& table)
{
    return Text(table).whole();
}

}  // namespace experiments
