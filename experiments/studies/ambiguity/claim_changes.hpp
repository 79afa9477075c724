// What each reading does to the judged figure of each claim: A's and B's value, and whether the claim's bound judges them otherwise.
//   ClaimChanges changes;
//   changes.add("human", "C09", reading, figures_of_a, figures_of_b);
//   changes.add_untouched("human", "C10", reading, "another factor is no more work");
//   changes.table().write("ambiguity.csv");
// verdict_flips: yes, no, not touched, no figure. A figure that B has none of because the reading broke down does not hold: the verdict
// flips where A's held. Where A or B has no figure for another reason, nothing is said of a verdict; a quantity that is left out of
// readings has a row with the reason.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/ambiguity/judged_figure.hpp"

namespace experiments {

class ClaimChanges {
public:
    void add(const std::string& body, const std::string& claim, const Reading& reading, const ReadingFigures& a, const ReadingFigures& b);
    void add_untouched(const std::string& body, const std::string& claim, const Reading& reading, const std::string& reason);

    // Columns: body, place, reading_a, reading_b, claim, quantity, of, unit (of a, b and change), bound, a, b, change, b_over_a (1),
    // holds_a, holds_b (whole, in part, nowhere), verdict_flips, reason. Empty where there is none.
    const analysis::CsvTable& table() const { return table_; }

private:
    analysis::CsvTable table_{{"body", "place", "reading_a", "reading_b", "claim", "quantity", "of", "unit", "bound", "a", "b", "change",
                               "b_over_a", "holds_a", "holds_b", "verdict_flips", "reason"}};
};

}  // namespace experiments
