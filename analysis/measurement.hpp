// Figures that a study measured for a claim, with how sure they are; and what a claim's bound says of them.
//   for (const Measurement& measured : measurements("measurements.csv")) ...
#pragma once

#include "analysis/case_judgement.hpp"
#include "analysis/records/csv_table.hpp"

#include <string>
#include <vector>

namespace analysis {

// The rows of the file `csv`; run is left empty. InputError as read_csv, for a missing column and what is no number.
std::vector<Measurement> measurements(const std::string& csv);
CsvTable measurement_table(const std::vector<Measurement>& measurements);  // what measurements() reads, without run

QuantityBound bound_of(const Claim& claim, const std::string& quantity);  // from claim.bounds, else the claim's low and high

// whole: the interval lies in the claim's bound of the quantity; part: the value does; none: it does not, or is not a number.
Extent extent_of(const Claim& claim, const Measurement& measured);

std::string figure_text(const Measurement& measured);    // 3.1e-06, 12.4 mm
std::string bound_text(const QuantityBound& bound);      // 0.9 to 1.1; 30 or more
std::string interval_text(const Measurement& measured);  // [2e-06, 5e-06]; empty where there is none

}  // namespace analysis
