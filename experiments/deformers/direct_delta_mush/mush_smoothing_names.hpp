// The names of the ways to smooth that direct delta mush has.
#pragma once

#include "experiments/settings/option_names.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"

namespace experiments {

template <>
struct OptionNames<pbs::MushSmoothing> {
    static constexpr std::array<std::pair<pbs::MushSmoothing, const char*>, 2> table{
        {{pbs::MushSmoothing::implicit_steps, "implicit"}, {pbs::MushSmoothing::explicit_steps, "explicit"}}};
};

}  // namespace experiments
