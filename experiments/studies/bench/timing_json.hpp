// Timings as the record has them: a median under its own name, its quartiles beside it under "quartiles".
#pragma once

#include "experiments/studies/shared/timed_rounds.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace experiments {

inline void put_spread(nlohmann::json& json, const std::string& name, const Spread& spread)
{
    json[name] = spread.median;
    json["quartiles"][name] = {spread.lower, spread.upper};
    json["rounds"] = spread.rounds;
}

}  // namespace experiments
