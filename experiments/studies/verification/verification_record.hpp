// The verification on record: DIR/verification.csv, verification.json and verification.md, and the table for the terminal.
#pragma once

#include "reference_fem/verification/verification_row.hpp"

namespace experiments {

using reference_fem::VerificationRow;
using reference_fem::VerificationRows;

void write_verification_record(const std::string& folder, const VerificationRows& rows);

// One line a problem: how many rows hold, the range of their differences and of their orders less theory; and each row that fails.
std::string verification_table(const VerificationRows& rows);

}  // namespace experiments
