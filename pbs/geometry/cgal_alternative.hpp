// What CGAL takes from Boost up to version 5, and from the standard library since version 6: a result that is one of several kinds, and a
// value that may be missing.
//   if (const auto* point = alternative<Point>(hit->first)) ...
#pragma once

#include <CGAL/version.h>

#include <boost/optional.hpp>
#include <boost/variant.hpp>

#include <optional>
#include <variant>

namespace pbs {

#if CGAL_VERSION_MAJOR < 6
template <typename Value>
using CgalOptional = boost::optional<Value>;
#else
template <typename Value>
using CgalOptional = std::optional<Value>;
#endif

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
