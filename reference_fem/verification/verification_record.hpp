// The verification on record: DIR/verification.csv, verification.json and verification.md, and the table for the terminal.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "reference_fem/verification/verification_row.hpp"

namespace reference_fem {

// One line of verification.csv: a row and what follows from it.
struct RecordedRow {
    VerificationRow row;
    std::optional<double> difference_pct;
    std::string holds;  // yes, no, or empty where the row has no bounds
};
const analysis::Columns<RecordedRow>& verification_columns();

void write_verification_record(const std::string& folder, const VerificationRows& rows);

// One line per problem: how many rows hold, the range of their differences, and the range of their orders less that of theory. A further
// line for each row that fails.
std::string verification_table(const VerificationRows& rows);

}  // namespace reference_fem
