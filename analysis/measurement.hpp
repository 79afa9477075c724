// Values that a study measured for a claim, with their intervals, and what the claim's bound makes of them.
//   for (const Measurement& measured : measurements("measurements.csv")) ...
#pragma once

#include "analysis/case_judgement.hpp"
#include "analysis/records/csv_table.hpp"

#include <string>
#include <vector>

namespace analysis {

// The rows of the file `csv`: claim, quantity, the fields of the key, value, low, high, unit, and limit, n, not_reached where a row has one
// of them; run is left empty. InputError as read_csv, for a missing column, for what is no number, and for another limit.
std::vector<Measurement> measurements(const std::string& csv);
CsvTable measurement_table(const std::vector<Measurement>& measurements);  // what measurements() reads, without run

const char* name_of(Limit limit);  // at_least, at_most, more_than; empty for none

// One of the claim's quantities, of a key that agrees with claim.of. is_control: of the quantities, but another key.
bool is_judged(const Claim& claim, const Measurement& measured);
bool is_control(const Claim& claim, const Measurement& measured);

QuantityBound bound_of(const Claim& claim, const std::string& quantity);  // from claim.bounds, else the claim's low and high

// whole: the interval lies in the claim's bound of the quantity; part: the value does; none: it does not, or is not a number.
Extent extent_of(const Claim& claim, const Measurement& measured);

std::string bound_text(const QuantityBound& bound);  // 0.9 to 1.1; 30 or more

}  // namespace analysis
