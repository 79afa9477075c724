// The names of an option's values in scenes, records and keys: one table per enumeration, in the folder of the option.
//   NAMED_OPTIONS(Colour, red, blue)   // in the namespace experiments: each value by its own name
//   name_of(Colour::red)               "red"
// A table with other names is a specialisation of option_names.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace analysis {
template <typename Enum>
struct EnumNames;  // records/tables.hpp
}  // namespace analysis

namespace experiments {

template <typename Enum, std::size_t count>
using NameTable = std::array<std::pair<Enum, const char*>, count>;

template <typename Enum>
inline constexpr NameTable<Enum, 0> option_names;  // to be specialised

#define NAMED_OPTION(value) std::pair(value, #value),
#define NAMED_OPTIONS(Enum, ...)                                                                 \
    template <>                                                                                  \
    inline constexpr auto option_names<Enum> = [] {                                              \
        using enum Enum;                                                                         \
        return std::array{NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NAMED_OPTION, __VA_ARGS__))}; \
    }();

// The same table as a member.
template <typename Enum>
struct OptionNames {
    static constexpr const auto& table = option_names<Enum>;
};

template <typename Enum>
std::string name_of(Enum value)
{
    for (const auto& [entry, name] : OptionNames<Enum>::table)
        if (entry == value) return name;
    return "";
}

template <typename Enum>
Enum option_of(const std::string& name)  // the schema must have checked the name
{
    for (const auto& [entry, text] : OptionNames<Enum>::table)
        if (name == text) return entry;
    return OptionNames<Enum>::table.front().first;
}

template <typename Enum>
std::vector<std::string> names_of_options()
{
    std::vector<std::string> names;
    for (const auto& [entry, name] : OptionNames<Enum>::table) names.emplace_back(name);
    return names;
}

}  // namespace experiments

// Records name the values alike.
template <typename Enum>
requires(!experiments::option_names<Enum>.empty()) struct analysis::EnumNames<Enum> : experiments::OptionNames<Enum> {
};
