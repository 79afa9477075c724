#include "pbs/skinning/weights.hpp"

#include "pbs/geometry/topology.hpp"

#include <map>

namespace pbs {
namespace {

constexpr double negligible_weight = 1e-6;

using Row = std::map<int, double>;  // weights of a vertex by bone, in the order of the bones

std::vector<Row> rows_of(const Weights& weights)
{
    std::vector<Row> rows(weights.vertices());
    for (int v = 0; v < weights.vertices(); ++v)
        for (int k = weights.first[v]; k < weights.first[v + 1]; ++k) rows[v][weights.bone[k]] += weights.weight[k];
    return rows;
}

Weights weights_of(const std::vector<Row>& rows)
{
    Weights result{{0}, {}, {}};
    for (const Row& row : rows) {
        double sum = 0.0;
        for (const auto& [bone, weight] : row)
            if (weight > negligible_weight) sum += weight;
        for (const auto& [bone, weight] : row) {
            if (!(weight > negligible_weight)) continue;
            result.bone.push_back(bone);
            result.weight.push_back(weight / sum);
        }
        result.first.push_back(static_cast<int>(result.bone.size()));
    }
    return result;
}

}  // namespace

Weights diffused_weights(const TetMesh& mesh, const Weights& weights, int steps)
{
    const Adjacency neighbours = adjacency_of(mesh.tets, weights.vertices());
    std::vector<Row> rows = rows_of(weights);
    for (int step = 0; step < steps; ++step) {
        const std::vector<Row> last = rows;
        for (int v = 0; v < weights.vertices(); ++v) {
            const int first = neighbours.first[v], end = neighbours.first[v + 1];
            if (first == end) continue;
            for (auto& [bone, weight] : rows[v]) weight *= 0.5;
            for (int k = first; k < end; ++k)
                for (const auto& [bone, weight] : last[neighbours.neighbour[k]]) rows[v][bone] += 0.5 * weight / (end - first);
        }
    }
    return weights_of(rows);
}

}  // namespace pbs
