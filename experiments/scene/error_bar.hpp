// Which further solutions tell how far the reference is from the limit of ever finer tets.
#pragma once

#include "experiments/settings/option_names.hpp"

namespace experiments {

// none; orders: the other element order on the same tets; refined: the same order on the once refined tets; both: three solutions of
// mesh sizes graded by about two.
enum class ErrorBar { none, orders, refined, both };

template <>
struct OptionNames<ErrorBar> {
    static constexpr std::array<std::pair<ErrorBar, const char*>, 4> table{
        {{ErrorBar::none, "none"}, {ErrorBar::orders, "orders"}, {ErrorBar::refined, "refined"}, {ErrorBar::both, "both"}}};
};

}  // namespace experiments
