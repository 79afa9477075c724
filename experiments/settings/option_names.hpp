// The words that an option's values have in scenes and records. A folder with such an option specialises OptionNames for it:
//   template <>
//   struct OptionNames<Colour> {
//       static constexpr std::array<std::pair<Colour, const char*>, 2> table{{{Colour::red, "red"}, {Colour::blue, "blue"}}};
//   };
#pragma once

#include <array>
#include <string>
#include <utility>

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
Enum option_of(const std::string& name)  // the schema has checked the name
{
    for (const auto& [entry, text] : OptionNames<Enum>::table)
        if (name == text) return entry;
    return OptionNames<Enum>::table.front().first;
}

}  // namespace experiments
