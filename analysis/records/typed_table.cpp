#include "analysis/records/typed_table.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace analysis {
namespace {

// Units as column names spell them and as they are written. If two endings fit a name, the longer one comes first.
constexpr std::array<std::pair<const char*, const char*>, 22> units{{{"m_s2", "m/s^2"},   {"m_s", "m/s"},
                                                                     {"n_m", "N/m"},      {"per_s", "1/s"},
                                                                     {"kg_m3", "kg/m^3"}, {"m3", "m^3"},
                                                                     {"m2", "m^2"},       {"pct", "%"},
                                                                     {"deg", "deg"},      {"rad", "rad"},
                                                                     {"mm", "mm"},        {"m", "m"},
                                                                     {"ns", "ns"},        {"us", "us"},
                                                                     {"ms", "ms"},        {"s", "s"},
                                                                     {"hz", "Hz"},        {"pa", "Pa"},
                                                                     {"kg", "kg"},        {"mb", "MB"},
                                                                     {"n", "N"},          {"diagonals", "diagonals"}}};

// The unit of the longest ending that is one.
std::string unit_by_ending(const std::string& name)
{
    for (const auto& [ending, unit] : units)
        if (name.ends_with(fmt::format("_{}", ending))) return unit;
    return "";
}

bool is_inside(const std::string& name, const std::string& wanted)
{
    for (const auto& [part, unit] : units)
        if (unit == wanted && fmt::format("_{}_", name).find(fmt::format("_{}_", part)) != std::string::npos) return true;
    return false;
}

}  // namespace

void require_unit(const std::string& name, const std::string& unit)
{
    const std::string ending = unit_by_ending(name);
    if (unit == ending || (ending.empty() && is_inside(name, unit))) return;
    throw std::logic_error{fmt::format("column {}: the unit '{}' does not agree with the name, which says '{}'", name, unit, ending)};
}

}  // namespace analysis
