#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace pbs {
namespace {

// Earlier groups at each vertex, ascending, as one array.
struct GroupsAtVertex {
    std::vector<int> first, group;  // #V + 1; #V's groups one after the other
};

GroupsAtVertex groups_at_vertices(const std::vector<ConstraintGroup>& groups, int vertices)
{
    GroupsAtVertex at{std::vector<int>(static_cast<std::size_t>(vertices) + 1, 0), {}};
    for (const ConstraintGroup& group : groups)
        for (int v = 0; v < vertices_of(group.kind); ++v) ++at.first[group.vertex[v] + 1];
    std::partial_sum(at.first.begin(), at.first.end(), at.first.begin());
    at.group.resize(at.first.back());
    std::vector<int> next(at.first.begin(), at.first.end() - 1);
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (int v = 0; v < vertices_of(groups[g].kind); ++v)
            at.group[next[groups[g].vertex[v]]++] = static_cast<int>(g);
    return at;
}

// First-fit colours, with marks of the colours that are taken around one group.
class Colouring {
public:
    explicit Colouring(std::size_t groups) : colour_(groups, 0) {}

    void take(int neighbour, int by)
    {
        const std::size_t colour = colour_[neighbour];
        if (colour >= taken_by_.size()) taken_by_.resize(colour + 1, -1);
        taken_by_[colour] = by;
    }
    void choose(int group)
    {
        const auto free = std::find_if(taken_by_.begin(), taken_by_.end(), [&](int by) { return by != group; });
        colour_[group] = static_cast<int>(free - taken_by_.begin());
    }
    int operator[](int group) const { return colour_[group]; }

private:
    std::vector<int> colour_;    // of each group
    std::vector<int> taken_by_;  // of each colour, the last group next to which it was found
};

constexpr int tets_of_cluster = 4096;  // whose vertices stay in the cache from colour to colour
constexpr int dummies_of_slab = 4 * batch_size;

std::vector<std::array<int, 4>> corners_of(const Tets& tets)
{
    std::vector<std::array<int, 4>> corners;
    for (const auto tet : tets.rowwise()) corners.push_back({tet(0), tet(1), tet(2), tet(3)});
    return corners;
}

}  // namespace

std::vector<int> projection_sequence(const std::vector<ConstraintGroup>& groups, int vertices)
{
    const GroupsAtVertex at = groups_at_vertices(groups, vertices);
    Colouring by_vertex(groups.size()), by_edge(groups.size()), by_face(groups.size());
    std::vector<int> shared(groups.size(), 0), neighbours;
    for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
        neighbours.clear();
        for (int v = 0; v < vertices_of(groups[g].kind); ++v) {
            const int vertex = groups[g].vertex[v];
            for (int k = at.first[vertex]; at.group[k] < g; ++k)
                if (shared[at.group[k]]++ == 0) neighbours.push_back(at.group[k]);
        }
        for (const int neighbour : neighbours) {
            by_vertex.take(neighbour, g);
            if (shared[neighbour] >= 2) by_edge.take(neighbour, g);
            if (shared[neighbour] >= 3) by_face.take(neighbour, g);
            shared[neighbour] = 0;
        }
        by_vertex.choose(g);
        by_edge.choose(g);
        by_face.choose(g);
    }

    std::vector<int> sorted(groups.size()), place(groups.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    const auto colours = [&](int g) {
        const int edge_colour = constraints_of(groups[g].kind) == 1 ? -by_edge[g] : 0;
        return std::tuple(by_face[g], edge_colour, by_vertex[g], g);
    };
    std::sort(sorted.begin(), sorted.end(), [&](int a, int b) { return colours(a) < colours(b); });
    for (std::size_t i = 0; i < sorted.size(); ++i) place[sorted[i]] = static_cast<int>(i);
    return place;
}

std::vector<std::vector<int>> BatchScheduler::schedule(const std::vector<ConstraintGroup>& groups)
{
    if (groups.empty()) return {};
    const auto is_earlier = [&](int a, int b) {
        return chain_of_group_[a] != chain_of_group_[b] ? chain_of_group_[a] > chain_of_group_[b] : a < b;
    };
    std::vector<int> ready, freed = begin(groups);

    std::vector<std::vector<int>> batches;
    for (std::size_t scheduled = 0; scheduled < groups.size();) {
        std::sort(freed.begin(), freed.end(), is_earlier);
        const auto before = static_cast<std::ptrdiff_t>(ready.size());
        ready.insert(ready.end(), freed.begin(), freed.end());
        std::inplace_merge(ready.begin(), ready.begin() + before, ready.end(), is_earlier);
        freed.clear();

        const int now = static_cast<int>(batches.size());
        std::vector<int> batch;
        for (int since = now - 2; since < now && batch.empty(); ++since)
            std::erase_if(ready, [&](int g) {
                if (static_cast<int>(batch.size()) == batch_size || !rests(groups[g], since)) return false;
                batch.push_back(g);
                return true;
            });
        for (const int g : batch) finish(groups[g], now, freed);
        scheduled += batch.size();
        batches.push_back(std::move(batch));
    }
    for (const ConstraintGroup& group : groups)
        for (int v = 0; v < vertices_of_group_; ++v) last_batch_[group.vertex[v]] = never;
    return batches;
}

// From the last group to the first, so that the next one at each vertex is at the end of its list. Returns those that
// wait for none.
std::vector<int> BatchScheduler::begin(const std::vector<ConstraintGroup>& groups)
{
    vertices_of_group_ = vertices_of(groups.front().kind);
    chain_of_group_.assign(groups.size(), 0);
    turns_.assign(groups.size(), 0);
    for (int g = static_cast<int>(groups.size()) - 1; g >= 0; --g) {
        const auto& vertex = groups[g].vertex;
        for (int v = 0; v < vertices_of_group_; ++v) {
            chain_of_group_[g] = std::max(chain_of_group_[g], chain_at_vertex_[vertex[v]] + 1);
            waiting_[vertex[v]].push_back(g);
        }
        for (int v = 0; v < vertices_of_group_; ++v) chain_at_vertex_[vertex[v]] = chain_of_group_[g];
    }
    std::vector<int> free;
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (int v = 0; v < vertices_of_group_; ++v) {
            chain_at_vertex_[groups[g].vertex[v]] = 0;
            if (waiting_[groups[g].vertex[v]].back() == static_cast<int>(g)) take_turn(static_cast<int>(g), free);
        }
    return free;
}

void BatchScheduler::take_turn(int group, std::vector<int>& freed)
{
    if (++turns_[group] == vertices_of_group_) freed.push_back(group);
}

// Its vertices go on to their next groups.
void BatchScheduler::finish(const ConstraintGroup& group, int batch, std::vector<int>& freed)
{
    for (int v = 0; v < vertices_of_group_; ++v) {
        last_batch_[group.vertex[v]] = batch;
        std::vector<int>& waiting = waiting_[group.vertex[v]];
        waiting.pop_back();
        if (!waiting.empty()) take_turn(waiting.back(), freed);
    }
}

bool BatchScheduler::rests(const ConstraintGroup& group, int since) const
{
    return std::all_of(group.vertex.begin(), group.vertex.begin() + vertices_of_group_,
                       [&](int v) { return last_batch_[v] < since; });
}

std::vector<SlabClusters> clusters_of_slabs(const std::vector<ConstraintGroup>& groups, const VertexOrder& order,
                                            int cluster_size)
{
    std::vector<int> first_vertex, sorted(groups.size());
    for (const ConstraintGroup& group : groups) {
        first_vertex.push_back(order.new_of_old[group.vertex[0]]);
        for (int v = 1; v < vertices_of(group.kind); ++v)
            first_vertex.back() = std::min(first_vertex.back(), order.new_of_old[group.vertex[v]]);
    }
    std::iota(sorted.begin(), sorted.end(), 0);
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return first_vertex[a] < first_vertex[b]; });
    const std::vector<int> slab_of = order.slab_of_new(),
                           place = projection_sequence(groups, static_cast<int>(slab_of.size()));
    std::vector<std::vector<int>> slabs(order.slabs());
    for (const int g : sorted) slabs[slab_of[first_vertex[g]]].push_back(g);
    std::vector<SlabClusters> clusters(slabs.size());
    for (std::size_t slab = 0; slab < slabs.size(); ++slab)
        for (auto first = slabs[slab].begin(), end = slabs[slab].end(); first != end;) {
            const auto last = end - first < 3 * cluster_size / 2 ? end : first + cluster_size;  // no small last one
            std::sort(first, last, [&](int a, int b) { return place[a] < place[b]; });
            clusters[slab].emplace_back(first, last);
            first = last;
        }
    return clusters;
}

TetSlabs::TetSlabs(const Tets& tets, int vertices, int threads)
    : tets_(single_tets(corners_of(tets))),
      order_(order_vertices(tets, vertices, vertices_a_slab(vertices))),
      rows_((vertices + batch_size - 1) / batch_size * batch_size + order_.slabs() * dummies_of_slab),
      parallel_(order_.slabs() >= slabs_worth_threads ? threads : 1),
      of_slab_(order_.slabs())
{
    const std::vector<SlabClusters> clusters = clusters_of_slabs(tets_, order_, tets_of_cluster);
    for (int slab = 0; slab < slabs(); ++slab)
        for (const std::vector<int>& cluster : clusters[slab])
            of_slab_[slab].insert(of_slab_[slab].end(), cluster.begin(), cluster.end());
}

std::vector<std::vector<int>> TetSlabs::batches(const std::vector<int>& tets) const
{
    std::vector<ConstraintGroup> groups;
    for (const int t : tets) groups.push_back(tets_[t]);
    std::vector<std::vector<int>> batches = BatchScheduler(static_cast<int>(order_.new_of_old.size())).schedule(groups);
    for (std::vector<int>& batch : batches)
        for (int& member : batch) member = tets[member];
    return batches;
}

std::array<std::uint32_t, 4> TetSlabs::offset(int slab, int lane, int tet) const
{
    const int dummies = rows_ - (slabs() - slab) * dummies_of_slab;
    std::array<std::uint32_t, 4> offset;
    for (int i = 0; i < 4; ++i)
        offset[i] = 4u * (tet >= 0 ? order_.new_of_old[tets_[tet].vertex[i]] : dummies + 4 * lane + i);
    return offset;
}

}  // namespace pbs
