#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using Cells = std::vector<analysis::CsvTable::Cell>;

const JudgedFigure* find(const ReadingFigures& of, const JudgedFigure& wanted)
{
    const auto found = std::find_if(of.figures.begin(), of.figures.end(), [&](const JudgedFigure& one) {
        return one.claim == wanted.claim && one.quantity == wanted.quantity && one.of == wanted.of;
    });
    return found == of.figures.end() ? nullptr : &*found;
}

analysis::CsvTable::Cell cell(bool known, double value)
{
    if (!known) return std::nullopt;
    return value;
}

std::string why(const JudgedFigure* a, const JudgedFigure* b, bool b_broke_down)
{
    if (b_broke_down) return "B breaks down";
    if (!a || !b) return std::string(a ? "B" : "A") + " has no such figure";
    const auto limit = [](const char* which, const JudgedFigure& of) {
        return of.limit == analysis::Limit::none ? "" : std::string(which) + ": " + analysis::name_of(of.limit);
    };
    const std::string of_a = limit("A", *a), of_b = limit("B", *b);
    return of_a + (of_a.empty() || of_b.empty() ? "" : "; ") + of_b;
}

std::string flips(const JudgedFigure* a, const JudgedFigure* b, bool b_broke_down)
{
    if (a && !b && b_broke_down) return a->extent == analysis::Extent::none ? "no" : "yes";
    if (!a || !b) return "no figure";
    return a->extent == b->extent ? "no" : "yes";
}

Cells compared(const JudgedFigure* a, const JudgedFigure* b, bool b_broke_down)
{
    const JudgedFigure& one = a ? *a : *b;
    const double nothing = std::nan(""), value_a = a ? a->value : nothing, value_b = b ? b->value : nothing;
    return {one.quantity,
            text_of(one.of),
            one.unit,
            one.bound,
            cell(a, value_a),
            cell(b, value_b),
            cell(a && b, value_b - value_a),
            cell(a && b && value_a != 0.0, value_b / value_a),
            a ? word_for(a->extent) : "",
            b ? word_for(b->extent) : "",
            flips(a, b, b_broke_down),
            why(a, b, b_broke_down)};
}

Cells without_figure(const std::string& flips, const std::string& reason, const std::string& quantity = "")
{
    Cells cells = {quantity, "", "", ""};
    for (int i = 0; i < 4; ++i) cells.push_back(std::nullopt);
    cells.insert(cells.end(), {"", "", flips, reason});
    return cells;
}

}  // namespace

void ClaimChanges::add(const std::string& body, const std::string& claim, const Reading& reading, const ReadingFigures& a,
                       const ReadingFigures& b)
{
    const auto add_row = [&](const Cells& cells) {
        Cells row = {body, reading.place, reading.baseline, reading.name, claim};
        row.insert(row.end(), cells.begin(), cells.end());
        table_.add_row(row);
    };
    bool any = false;
    for (const JudgedFigure& of_a : a.figures)
        if (of_a.claim == claim) {
            add_row(compared(&of_a, find(b, of_a), b.broke_down));
            any = true;
        }
    for (const JudgedFigure& of_b : b.figures)
        if (of_b.claim == claim && !find(a, of_b)) {
            add_row(compared(nullptr, &of_b, b.broke_down));
            any = true;
        }
    for (const LeftOutQuantity& one : b.left_out)
        if (one.claim == claim) {
            add_row(without_figure("no figure", one.reason, one.quantity));
            any = true;
        }
    if (!any) add_row(without_figure("no figure", b.broke_down ? "B breaks down" : "neither reading has a figure"));
}

void ClaimChanges::add_untouched(const std::string& body, const std::string& claim, const Reading& reading, const std::string& reason)
{
    Cells row = {body, reading.place, reading.baseline, reading.name, claim};
    const Cells cells = without_figure("not touched", reason);
    row.insert(row.end(), cells.begin(), cells.end());
    table_.add_row(row);
}

}  // namespace experiments
