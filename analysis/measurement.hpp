// Values that a study measured for a claim, with their intervals, and their comparison with the claim's bound.
//   for (const Measurement& measured : measurements("measurements.csv")) ...
#pragma once

#include "analysis/case_judgement.hpp"

#include <string>
#include <vector>

namespace analysis {

// The rows of the file `csv`: claim, quantity, the fields of the key, value, low, high and unit. The columns limit, n and not_reached exist
// if a row uses one of them. run is left empty. InputError as for read_csv, for a missing column, for a cell that is not a number, and for
// an unknown limit.
std::vector<Measurement> measurements(const std::string& csv);
CsvTable measurement_table(const std::vector<Measurement>& measurements);  // the table that measurements() reads; run is not part of it

// is_judged: the value is one of the claim's quantities, and its key agrees with claim.of. is_control: one of the quantities with another
// key.
bool is_judged(const Claim& claim, const Measurement& measured);
bool is_control(const Claim& claim, const Measurement& measured);

QuantityBound bound_of(const Claim& claim, const std::string& quantity);  // from claim.bounds, otherwise the claim's low and high

// whole: the interval lies within the claim's bound on the quantity; part: only the value does; none: the value does not, or is not a
// number.
Extent extent_of(const Claim& claim, const Measurement& measured);

std::string bound_text(const QuantityBound& bound);  // 0.9 to 1.1; 30 or more

}  // namespace analysis
