// Reference: the sequence by its definition, and that no constraint is lost or changed.
#include "experiments/studies/shared/constraint_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

// Constraints that are numbered by their rest value.
template <typename Scalar>
pbs::ConstraintSet<Scalar> numbered(int edges, int tets)
{
    pbs::ConstraintSet<Scalar> constraints;
    for (int e = 0; e < edges; ++e) constraints.stretch.push_back({{e, e + 1}, Scalar(e), Scalar(1)});
    for (int t = 0; t < tets; ++t) constraints.volume.push_back({{t, t + 1, t + 2, t + 3}, Scalar(t), Scalar(1)});
    return constraints;
}

template <typename Scalar>
std::vector<int> edge_numbers(const pbs::ConstraintSet<Scalar>& constraints)
{
    std::vector<int> numbers;
    for (const auto& edge : constraints.stretch) {
        numbers.push_back(static_cast<int>(edge.rest_length));
        EXPECT_EQ(edge.vertex[0], numbers.back());
    }
    return numbers;
}

template <typename Scalar>
std::vector<int> tet_numbers(const pbs::ConstraintSet<Scalar>& constraints)
{
    std::vector<int> numbers;
    for (const auto& tet : constraints.volume) {
        numbers.push_back(static_cast<int>(tet.rest_volume));
        EXPECT_EQ(tet.vertex[0], numbers.back());
    }
    return numbers;
}

TEST(ConstraintSequence, SpreadTakesEightPartsInTurn)
{
    auto constraints = numbered<double>(20, 4);
    experiments::in_spread_sequence(constraints);  // parts of three
    EXPECT_EQ(edge_numbers(constraints), (std::vector<int>{0, 3, 6, 9, 12, 15, 18, 1, 4, 7, 10, 13, 16, 19, 2, 5, 8, 11, 14, 17}));
    EXPECT_EQ(tet_numbers(constraints), (std::vector<int>{0, 1, 2, 3}));
}

TEST(ConstraintSequence, RandomIsAPermutation)
{
    auto constraints = numbered<double>(1000, 500);
    experiments::in_random_sequence(constraints, 1);
    std::vector<int> edges = edge_numbers(constraints), tets = tet_numbers(constraints);
    EXPECT_FALSE(std::is_sorted(edges.begin(), edges.end()));
    std::sort(edges.begin(), edges.end());
    std::sort(tets.begin(), tets.end());
    EXPECT_EQ(edges, edge_numbers(numbered<double>(1000, 500)));
    EXPECT_EQ(tets, tet_numbers(numbered<double>(1000, 500)));
}

TEST(ConstraintSequence, RandomDependsOnTheSeedAlone)
{
    auto one = numbered<double>(100, 100), other = one, another_seed = one;
    auto in_float = numbered<float>(100, 100);
    experiments::in_random_sequence(one, 7);
    experiments::in_random_sequence(other, 7);
    experiments::in_random_sequence(another_seed, 8);
    experiments::in_random_sequence(in_float, 7);
    EXPECT_EQ(edge_numbers(one), edge_numbers(other));
    EXPECT_EQ(edge_numbers(one), edge_numbers(in_float));
    EXPECT_EQ(tet_numbers(one), tet_numbers(in_float));
    EXPECT_NE(edge_numbers(one), edge_numbers(another_seed));
}

TEST(ConstraintSequence, NoConstraints)
{
    auto constraints = numbered<double>(0, 0);
    experiments::in_spread_sequence(constraints);
    experiments::in_random_sequence(constraints, 1);
    EXPECT_TRUE(constraints.stretch.empty());
    EXPECT_TRUE(constraints.volume.empty());
}

}  // namespace
