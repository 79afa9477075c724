// The names of the orders of projection in scenes and records.
#pragma once

#include "experiments/settings/option_names.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

template <>
struct OptionNames<pbs::Order> {
    static constexpr std::array<std::pair<pbs::Order, const char*>, 3> table{
        {{pbs::Order::plain, "plain"}, {pbs::Order::ordered, "ordered"}, {pbs::Order::grouped, "grouped"}}};
};

}  // namespace experiments
