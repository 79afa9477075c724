// One name for what CGAL 5 and 6 call differently. A result that is one of several kinds, and a value that may be
// missing, are of Boost up to version 5, and of the standard library since version 6. The traits of a tree of boxes
// have another name since version 6.
//   if (const auto* point = alternative<Point>(hit->first)) ...
#pragma once

#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR < 6
#include <CGAL/AABB_traits.h>
#else
#include <CGAL/AABB_traits_3.h>
#endif

#include <boost/optional.hpp>
#include <boost/variant.hpp>

#include <optional>
#include <variant>

namespace pbs {

#if CGAL_VERSION_MAJOR < 6
template <typename Value>
using CgalOptional = boost::optional<Value>;
template <typename Geometry, typename Primitive>
using CgalTreeTraits = CGAL::AABB_traits<Geometry, Primitive>;
#else
template <typename Value>
using CgalOptional = std::optional<Value>;
template <typename Geometry, typename Primitive>
using CgalTreeTraits = CGAL::AABB_traits_3<Geometry, Primitive>;
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
