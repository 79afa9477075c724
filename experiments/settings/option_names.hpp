// The names of an option's values in scenes and records. A folder with such an option specialises OptionNames for it:
//   template <>
//   struct OptionNames<Colour> {
//       static constexpr std::array<std::pair<Colour, const char*>, 2> table{{{Colour::red, "red"}, {Colour::blue, "blue"}}};
//   };
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

template <typename Enum>
struct OptionNames;

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
