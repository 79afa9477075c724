// The names of the precisions in scenes and records.
#pragma once

#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/precision.hpp"

namespace experiments {

template <>
struct OptionNames<pbs::Precision> {
    static constexpr std::array<std::pair<pbs::Precision, const char*>, 2> table{
        {{pbs::Precision::f32, "f32"}, {pbs::Precision::f64, "f64"}}};
};

}  // namespace experiments
