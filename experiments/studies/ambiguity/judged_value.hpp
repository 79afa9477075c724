// A value that a claim is judged by, for a character that is moved by one reading, and whether it lies in the claim's bound.
//   const std::vector<JudgedValue> values = judged(measurements);   // only of quantities that a claim is judged by
//   const std::vector<JudgedValue> of_sweep = judged(read_motion);   // C01, C02
#pragma once

#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/ambiguity/read_motion.hpp"
#include "experiments/studies/shared/program_claims.hpp"

#include <string>
#include <vector>

namespace experiments {

struct JudgedValue {
    std::string claim, quantity;
    analysis::CaseKey of;
    std::string unit, bound;
    double value = 0.0;
    analysis::Extent extent = analysis::Extent::none;  // of the claim, by this value
    analysis::Limit limit = analysis::Limit::none;     // where the value only bounds the quantity
};

// A quantity that a claim is judged by and that is not measured of readings.
struct LeftOutQuantity {
    std::string claim, quantity, reason;
};

// The values of the measured claims by one reading.
struct ReadingValues {
    std::vector<JudgedValue> values;
    bool broke_down = false;  // some positions are not finite
    std::vector<LeftOutQuantity> left_out = {};
};

// The quantities that the claim is judged by and that are not among those measured.
std::vector<LeftOutQuantity> all_but(const std::string& claim, const std::vector<std::string>& measured, const std::string& reason);

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured);

// C01: the mean of its metrics over the frames; C02: the share of frames within; both judged as analysis::judge_case does.
std::vector<JudgedValue> judged(const ReadMotion& moved);

// A hash of everything that decides whether a value holds: another bound gives another digest.
std::string digest_of(const std::vector<analysis::Claim>& claims);

}  // namespace experiments
