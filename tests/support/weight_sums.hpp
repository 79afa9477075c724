// Sums of a vertex's skinning weights.
#pragma once

#include "pbs/skinning/weights.hpp"

#include <numeric>

namespace test_support {

inline double weight_in(const pbs::Weights& weights, int vertex, int bone)
{
    double sum = 0.0;
    for (int e = weights.first[std::size_t(vertex)]; e < weights.first[std::size_t(vertex) + 1]; ++e)
        if (weights.bone[std::size_t(e)] == bone) sum += weights.weight[std::size_t(e)];
    return sum;
}

inline double sum_of_weights(const pbs::Weights& weights, int vertex)
{
    const auto first = weights.weight.begin();
    return std::accumulate(first + weights.first[std::size_t(vertex)], first + weights.first[std::size_t(vertex) + 1],
                           0.0);
}

}  // namespace test_support
