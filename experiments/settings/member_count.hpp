// The number of members of a struct, to check that a declaration of its fields is complete.
//   static_assert(member_count<Jolt>() == 5);
// The struct must be an aggregate without base classes and without C arrays (std::array is allowed).
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace experiments {

// Converts to a member of any type; only its type is used.
struct AnyMember {
    template <typename Member>
    operator Member() const;
};

template <typename Struct, std::size_t... indices>
constexpr bool takes_members(std::index_sequence<indices...>)
{
    return requires
    {
        Struct{(static_cast<void>(indices), AnyMember{})...};
    };
}

template <typename Struct, std::size_t count = 0>
constexpr std::size_t member_count()
{
    static_assert(std::is_aggregate_v<Struct>);
    if constexpr (takes_members<Struct>(std::make_index_sequence<count + 1>{}))
        return member_count<Struct, count + 1>();
    else
        return count;
}

}  // namespace experiments
