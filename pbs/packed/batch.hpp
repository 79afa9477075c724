// Sixteen groups of constraints that share no vertex, side by side: the input of the kernels. Plain data, for builders and kernels alike.
// A group is what one lane projects before it stores its vertices: a single constraint (order `ordered`), or a few that share most of their
// vertices (order `grouped`), so that each vertex is loaded and stored once for all of them.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace pbs {

// Groups in a batch; on machines of fewer lanes it is worked off in parts, so that the order of projection is the same everywhere.
inline constexpr int batch_size = 16;

// edge: one; edge_wedge: two that share a vertex; edge_triangle: three; edge_tet: the six of a tet; tet: one; tet_fan_2, _3: tets round an
// edge.
enum class GroupKind { edge, edge_wedge, edge_triangle, edge_tet, tet, tet_fan_2, tet_fan_3 };

// The vertices of a group that each of its constraints joins.
template <GroupKind kind>
struct GroupShape;

// vertices and constraints: how many; joins: of each constraint, its vertices within the group.
template <>
struct GroupShape<GroupKind::edge> {
    static constexpr int vertices = 2, constraints = 1;
    static constexpr std::array<std::array<int, 2>, 1> joins{{{0, 1}}};
};
template <>
struct GroupShape<GroupKind::edge_wedge> {
    static constexpr int vertices = 3, constraints = 2;
    static constexpr std::array<std::array<int, 2>, 2> joins{{{0, 1}, {1, 2}}};
};
template <>
struct GroupShape<GroupKind::edge_triangle> {
    static constexpr int vertices = 3, constraints = 3;
    static constexpr std::array<std::array<int, 2>, 3> joins{{{0, 1}, {1, 2}, {2, 0}}};
};
template <>
struct GroupShape<GroupKind::edge_tet> {  // opposite edges one after the other
    static constexpr int vertices = 4, constraints = 6;
    static constexpr std::array<std::array<int, 2>, 6> joins{{{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0, 3}, {1, 2}}};
};
template <>
struct GroupShape<GroupKind::tet> {
    static constexpr int vertices = 4, constraints = 1;
    static constexpr std::array<std::array<int, 4>, 1> joins{{{0, 1, 2, 3}}};
};
template <>
struct GroupShape<GroupKind::tet_fan_2> {  // round the edge 0, 1
    static constexpr int vertices = 5, constraints = 2;
    static constexpr std::array<std::array<int, 4>, 2> joins{{{0, 1, 2, 3}, {0, 1, 3, 4}}};
};
template <>
struct GroupShape<GroupKind::tet_fan_3> {
    static constexpr int vertices = 6, constraints = 3;
    static constexpr std::array<std::array<int, 4>, 3> joins{{{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 5}}};
};

// True for stretch constraints, false for volume constraints.
template <GroupKind kind>
inline constexpr bool of_edges = kind <= GroupKind::edge_tet;

// Every group [lane] of a batch. rest: rest length [m] of an edge, six times the rest volume [m^3] of a tet; stiffness: k, of an edge over
// w1 + w2; zero for a constraint that is not there.
template <typename Scalar, GroupKind kind>
struct alignas(64) Batch {
    std::uint32_t offset[GroupShape<kind>::vertices][batch_size];  // 4 * vertex
    Scalar rest[GroupShape<kind>::constraints][batch_size];        // l0, or 6 V0
    Scalar stiffness[GroupShape<kind>::constraints][batch_size];   // k / (w1 + w2), or k
};

// The bind constraints of sixteen vertices that follow each other.
template <typename Scalar>
struct alignas(64) BindBatch {
    Scalar x[batch_size], y[batch_size], z[batch_size];  // q_i [m]
    Scalar rest_distance[batch_size];                    // d_i [m]
    Scalar stiffness[batch_size];                        // zero where the vertex is pinned or has no bind constraint
};

// Calls f with a std::integral_constant of the kind.
template <typename F>
constexpr decltype(auto) with_kind(GroupKind kind, F&& f)
{
    switch (kind) {
        case GroupKind::edge:
            return f(std::integral_constant<GroupKind, GroupKind::edge>());
        case GroupKind::edge_wedge:
            return f(std::integral_constant<GroupKind, GroupKind::edge_wedge>());
        case GroupKind::edge_triangle:
            return f(std::integral_constant<GroupKind, GroupKind::edge_triangle>());
        case GroupKind::edge_tet:
            return f(std::integral_constant<GroupKind, GroupKind::edge_tet>());
        case GroupKind::tet:
            return f(std::integral_constant<GroupKind, GroupKind::tet>());
        case GroupKind::tet_fan_2:
            return f(std::integral_constant<GroupKind, GroupKind::tet_fan_2>());
        case GroupKind::tet_fan_3:
            break;
    }
    return f(std::integral_constant<GroupKind, GroupKind::tet_fan_3>());
}

}  // namespace pbs
