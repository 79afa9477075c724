// A result of CGAL that is one of several kinds: a variant of Boost up to CGAL 5, of the standard library since CGAL 6.
//   if (const auto* point = alternative<Point>(hit->first)) ...
#pragma once

#include <boost/variant.hpp>

#include <variant>

namespace pbs {

// Null if the result is of another kind.
template <typename Kind, typename... Kinds>
const Kind* alternative(const boost::variant<Kinds...>& result)
{
    return boost::get<Kind>(&result);
}

template <typename Kind, typename... Kinds>
const Kind* alternative(const std::variant<Kinds...>& result)
{
    return std::get_if<Kind>(&result);
}

}  // namespace pbs
