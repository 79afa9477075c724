// Settings of a study's run as JSON: every member of a struct under its own name.
//   // defines to_json(const SagCase&)
//   RECORD_SETTINGS(SagCase, vertices, k_stretch, iterations)
//   // and values of OptionFields that are no members
//   RECORD_SETTINGS_AND(SagCase, .constant("poisson", 0.45), vertices, k_stretch)
// std::logic_error when it is first called, unless all members are listed: `--resume` must notice each change.
#pragma once

#include "experiments/settings/option_fields.hpp"

#include <nlohmann/json.hpp>

#define RECORDED_MEMBER(member) .record(#member, &Recorded::member)
#define RECORD_SETTINGS_AND(Type, further, ...)                                                                \
    nlohmann::json to_json(const Type& recorded)                                                               \
    {                                                                                                          \
        using Recorded = Type;                                                                                 \
        static const auto fields = OptionFields<Type>(#Type)                                                   \
                                       NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(RECORDED_MEMBER, __VA_ARGS__)) \
                                           further.complete();                                                 \
        return fields.json(recorded);                                                                          \
    }
#define RECORD_SETTINGS(Type, ...) RECORD_SETTINGS_AND(Type, , __VA_ARGS__)
