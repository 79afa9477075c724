#include "pbs/geometry/name_list.hpp"

namespace pbs {

std::string name_list(const std::vector<std::string>& names)
{
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t n = 0; n < names.size() && n < most; ++n) text += (n ? ", " : "") + names[n];
    return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " others" : text;
}

}  // namespace pbs
