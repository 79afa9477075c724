// The verification on record: DIR/verification.csv, verification.json and verification.md, and the table for the terminal.
#pragma once

#include "experiments/verification/verification_row.hpp"

namespace experiments {

void write_verification_record(const std::string& folder, const VerificationRows& rows);

std::string verification_table(const VerificationRows& rows);  // the rows that are judged, one line each, and how many hold

}  // namespace experiments
