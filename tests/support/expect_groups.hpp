// The requirements on every grouping of constraints: each constraint is in one group, and joins its vertices as the
// group's shape defines.
#pragma once

#include "pbs/packed/groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace test_support {

// The vertices that constraint c of the group joins, in the order of the shape.
inline std::vector<int> joined(const pbs::ConstraintGroup& group, int c)
{
    return pbs::with_kind(group.kind, [&](auto kind) {
        std::vector<int> vertices;
        for (const int v : pbs::GroupShape<kind()>::joins[c]) vertices.push_back(group.vertex[v]);
        return vertices;
    });
}

// Whether an even number of swaps turns a into b, which contain the same vertices.
inline bool even_permutation(std::vector<int> a, const std::vector<int>& b)
{
    bool even = true;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto at = std::find(a.begin() + i, a.end(), b[i]);
        if (at == a.begin() + i) continue;
        std::iter_swap(at, a.begin() + i);
        even = !even;
    }
    return even;
}

// constraints: the vertices of each. The order of a tet's vertices must keep its orientation.
template <std::size_t corners>
void expect_each_once(const std::vector<pbs::ConstraintGroup>& groups,
                      const std::vector<std::array<int, corners>>& constraints)
{
    std::vector<int> uses(constraints.size(), 0);
    for (const pbs::ConstraintGroup& group : groups)
        for (int c = 0; c < pbs::constraints_of(group.kind); ++c) {
            const int constraint = group.constraint[c];
            if (constraint < 0) continue;
            ASSERT_LT(constraint, static_cast<int>(constraints.size()));
            ++uses[constraint];
            const std::vector<int> expected(constraints[constraint].begin(), constraints[constraint].end()),
                found = joined(group, c);
            ASSERT_TRUE(std::is_permutation(found.begin(), found.end(), expected.begin(), expected.end()))
                << "constraint " << constraint;
            if (corners == 4) {
                ASSERT_TRUE(even_permutation(found, expected)) << "tet " << constraint << " is mirrored";
            }
        }
    for (std::size_t i = 0; i < uses.size(); ++i) EXPECT_EQ(uses[i], 1) << "constraint " << i;
}

inline void expect_vertices_differ(const std::vector<pbs::ConstraintGroup>& groups)
{
    for (const pbs::ConstraintGroup& group : groups) {
        std::vector<int> vertices(group.vertex.begin(), group.vertex.begin() + pbs::vertices_of(group.kind));
        std::sort(vertices.begin(), vertices.end());
        EXPECT_EQ(std::adjacent_find(vertices.begin(), vertices.end()), vertices.end());
    }
}

inline std::map<pbs::GroupKind, int> count_by_kind(const std::vector<pbs::ConstraintGroup>& groups)
{
    std::map<pbs::GroupKind, int> counts;
    for (const pbs::ConstraintGroup& group : groups) ++counts[group.kind];
    return counts;
}

}  // namespace test_support
