#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <numeric>

namespace pbs {
namespace {

constexpr int tets_of_cluster = 4096;  // whose vertices stay in the cache from colour to colour

}  // namespace

int rows_with_dummies(int vertices, int slabs)
{
    return (vertices + batch_size - 1) / batch_size * batch_size + slabs * dummies_of_slab;
}

std::vector<std::vector<int>> slabs_of_tets(const std::vector<std::array<int, 4>>& vertex, const VertexOrder& order)
{
    std::vector<int> sorted(vertex.size()), first_vertex;
    for (const std::array<int, 4>& of_tet : vertex) {
        int lowest = order.new_of_old[of_tet[0]];
        for (const int v : of_tet) lowest = std::min(lowest, order.new_of_old[v]);
        first_vertex.push_back(lowest);
    }
    std::iota(sorted.begin(), sorted.end(), 0);
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return first_vertex[a] < first_vertex[b]; });
    const std::vector<int> slab_of = order.slab_of_new();
    std::vector<std::vector<int>> slabs(order.slabs());
    for (const int t : sorted) slabs[slab_of[first_vertex[t]]].push_back(t);
    const std::vector<int> place = projection_sequence(single_tets(vertex), static_cast<int>(order.new_of_old.size()));
    for (std::vector<int>& slab : slabs)
        for (auto first = slab.begin(); first != slab.end();) {
            const auto last = slab.end() - first < 3 * tets_of_cluster / 2 ? slab.end() : first + tets_of_cluster;  // no small last one
            std::sort(first, last, [&](int a, int b) { return place[a] < place[b]; });
            first = last;
        }
    return slabs;
}

}  // namespace pbs
