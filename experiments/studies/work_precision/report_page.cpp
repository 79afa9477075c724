#include "experiments/studies/work_precision/report_page.hpp"

#include "analysis/records/report_table.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/data_profile.hpp"
#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace experiments {
namespace {

std::vector<const Diagram*> shown(const ComparisonRecords& records, Comparison comparison)
{
    std::vector<const Diagram*> diagrams;
    for (const Diagram& diagram : records.diagrams)
        if (diagram.comparison == comparison && diagram.half == Half::evaluation) diagrams.push_back(&diagram);
    return diagrams;
}

// Every diagram of packed_f32; of plain_f64 the means, if there are any.
std::vector<const Diagram*> described(const ComparisonRecords& records, Comparison comparison)
{
    std::vector<const Diagram*> diagrams = shown(records, comparison);
    const auto is_mean = [](const Diagram* diagram) { return diagram->poses > 1; };
    if (comparison == Comparison::plain_f64 && std::ranges::any_of(diagrams, is_mean))
        std::erase_if(diagrams, [&](const Diagram* diagram) { return !is_mean(diagram); });
    return diagrams;
}

std::string split_text(const ComparisonRecords& records)
{
    std::string training, evaluation;
    for (const CaseRecords& of : records.cases) {
        std::string& list = of.rows.front().half == Half::training ? training : evaluation;
        list += (list.empty() ? "" : ", ") + case_name(of.rows.front().of);
    }
    return fmt::format(
        "Settings are chosen on the training poses ({}) and shown on the evaluated poses ({}). The poses of each body alternate, and a "
        "body with one pose is only evaluated.\n\n",
        training.empty() ? "none" : training, evaluation.empty() ? "none" : evaluation);
}

// Lists the user's own deformers, each with its clock, or returns an empty text where there are none.
std::string external_text(const ComparisonRecords& records)
{
    std::string text;
    for (const DeformerGroup& group : groups_of(records.diagrams)) {
        if (!group.is_external) continue;
        std::optional<FrameClock> clock;  // that of the first case with a time
        for (const CaseRecords& of : records.cases)
            for (const PointRow& row : of.rows)
                if (row.key.deformer == group.key && !clock) clock = row.clock;
        text += fmt::format("- `{}`: {}\n", group.key, clock ? words_of(*clock) : "it has no time");
    }
    if (text.empty()) return "";
    return "Deformers of the user's own take part in both comparisons, since it is not known whether their code is packed. Their "
           "times were taken as follows:\n\n" +
           text + "\n";
}

struct TriedRow {
    Comparison comparison;
    std::string deformer;
    int rungs = 0, tried = 0;
};

std::vector<TriedRow> settings_tried(const ComparisonRecords& records)
{
    std::vector<TriedRow> rows;
    for (const ChosenSetting& chosen : records.chosen) {
        auto found = std::ranges::find_if(
            rows, [&](const TriedRow& row) { return row.comparison == chosen.comparison && row.deformer == chosen.key.deformer; });
        if (found == rows.end()) found = rows.insert(rows.end(), {chosen.comparison, chosen.key.deformer});
        ++found->rungs;
        found->tried += chosen.tried;
    }
    return rows;
}

std::string tried_table(const ComparisonRecords& records)
{
    std::string page =
        "## Settings tried\n\nA rung is a number of iterations on a mesh, or an element order on a mesh.\n\n"
        "| comparison | deformer | rungs | settings tried at all rungs |\n|---|---|---|---|\n";
    for (const TriedRow& row : settings_tried(records))
        page += fmt::format("| {} | {} | {} | {} |\n", analysis::recorded_name(row.comparison), row.deformer, row.rungs, row.tried);
    return page;
}

// One row per group that solves a pose; the columns are tolerances and budgets.
std::string profile_table(const ComparisonRecords& records, Comparison comparison)
{
    constexpr double any_ms = std::numeric_limits<double>::infinity();
    std::string header = "| group |", line = "|---|", rows;
    for (const double tolerance_pct : profile_tolerances_pct)
        for (const double ms : {1.0, 10.0, 100.0, any_ms}) {
            header += fmt::format(" {:g} %{} |", tolerance_pct, ms < any_ms ? ", " + ms_text(ms) : "");
            line += "---|";
        }
    for (const DeformerGroup& group : groups_of(records.diagrams)) {
        if (solved_within(records.diagrams, comparison, group, profile_tolerances_pct.front(), any_ms).solved == 0) continue;
        rows += fmt::format("| {} |", group.words);
        for (const double tolerance_pct : profile_tolerances_pct)
            for (const double ms : {1.0, 10.0, 100.0, any_ms})
                rows += " " + text_of(solved_within(records.diagrams, comparison, group, tolerance_pct, ms)) + " |";
        rows += "\n";
    }
    return header + "\n" + line + "\n" + rows + "\n";
}

std::string omission_table(const ComparisonRecords& records)
{
    if (records.omissions.empty()) return "";
    return "## Omissions\n\n" +
           markdown_table(table_of(omission_columns, records.omissions), {{"comparison", "comparison"},
                                                                          {"case", "case"},
                                                                          {"deformer", "deformer"},
                                                                          {"why", "why"},
                                                                          {"points missing", "missing"},
                                                                          {"of", "points"},
                                                                          {"reason", "reason"}}) +
           "\n";
}

}  // namespace

std::string page_of(const ComparisonRecords& records)
{
    std::string page = "# Error against run time\n\n" + split_text(records) + external_text(records);
    for (const Comparison comparison : comparisons) {
        page += fmt::format(
            "## Poses solved: {}\n\nEvaluated poses with an error of at most 10, 5 and 2 % at the joints, within 1, 10 and "
            "100 ms per frame and at any time. A pose is solved with certainty if the error plus the bound on the reference's own error "
            "is within the tolerance. Groups that solve no pose are not listed.\n\n",
            words_of(comparison));
        page += profile_table(records, comparison);
    }
    page += tried_table(records) + "\n" + omission_table(records);
    for (const Comparison comparison : comparisons)
        for (const Diagram* diagram : described(records, comparison)) {
            page += fmt::format("## {}: {}\n\n```\n{}```\n\n", diagram->name, words_of(comparison), front_text(*diagram));
            for (const std::string& line : findings(*diagram)) page += "- " + line + "\n";
            page += "\n";
        }
    return page;
}

std::string terminal_text(const ComparisonRecords& records)
{
    std::string text;
    for (const Comparison comparison : comparisons) {
        const std::vector<const Diagram*> diagrams = shown(records, comparison);
        if (diagrams.empty()) continue;
        text += fmt::format("     {}, {}:\n", diagrams.back()->name, words_of(comparison));
        for (const std::string& line : findings(*diagrams.back())) text += "       " + line + "\n";
    }
    for (const Comparison comparison : comparisons) {
        std::string counts;
        for (const TriedRow& row : settings_tried(records))
            if (row.comparison == comparison)
                counts += fmt::format("{}{} {}/{}", counts.empty() ? "" : ", ", row.deformer, row.tried, row.rungs);
        if (!counts.empty()) text += fmt::format("     settings tried / rungs, {}: {}\n", words_of(comparison), counts);
    }
    return text + "     error: distance to the reference at the joints, outside the overlap, % of the mean bone distance\n";
}

}  // namespace experiments
