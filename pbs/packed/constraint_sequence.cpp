#include "pbs/packed/constraint_sequence.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace pbs {
namespace {

// Earlier constraints at each vertex, ascending, as one array.
struct ConstraintsAtVertex {
    std::vector<int> first, constraint;  // #V + 1; #V's constraints one after the other
};

ConstraintsAtVertex constraints_at_vertices(const std::vector<PackedConstraint>& constraints, int vertices)
{
    ConstraintsAtVertex at{std::vector<int>(static_cast<std::size_t>(vertices) + 1, 0), {}};
    for (const PackedConstraint& constraint : constraints)
        for (int v = 0; v < corners(constraint.kind); ++v) ++at.first[constraint.vertex[v] + 1];
    std::partial_sum(at.first.begin(), at.first.end(), at.first.begin());
    at.constraint.resize(at.first.back());
    std::vector<int> next(at.first.begin(), at.first.end() - 1);
    for (std::size_t g = 0; g < constraints.size(); ++g)
        for (int v = 0; v < corners(constraints[g].kind); ++v)
            at.constraint[next[constraints[g].vertex[v]]++] = static_cast<int>(g);
    return at;
}

// First-fit colours, with marks of the colours that are taken around one constraint.
class Colouring {
public:
    explicit Colouring(std::size_t constraints) : colour_(constraints, 0) {}

    void take(int neighbour, int by)
    {
        const std::size_t colour = colour_[neighbour];
        if (colour >= taken_by_.size()) taken_by_.resize(colour + 1, -1);
        taken_by_[colour] = by;
    }
    void choose(int constraint)
    {
        const auto free = std::find_if(taken_by_.begin(), taken_by_.end(), [&](int by) { return by != constraint; });
        colour_[constraint] = static_cast<int>(free - taken_by_.begin());
    }
    int operator[](int constraint) const { return colour_[constraint]; }

private:
    std::vector<int> colour_;    // of each constraint
    std::vector<int> taken_by_;  // of each colour, the last constraint next to which it was found
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

std::vector<PackedConstraint> packed_edges(const std::vector<std::array<int, 2>>& edges)
{
    std::vector<PackedConstraint> constraints;
    constraints.reserve(edges.size());
    for (const auto& [i, j] : edges)
        constraints.push_back({ConstraintKind::edge, {i, j}, static_cast<int>(constraints.size())});
    return constraints;
}

std::vector<PackedConstraint> packed_tets(const std::vector<std::array<int, 4>>& tets)
{
    std::vector<PackedConstraint> constraints;
    constraints.reserve(tets.size());
    for (const std::array<int, 4>& tet : tets)
        constraints.push_back({ConstraintKind::tet, tet, static_cast<int>(constraints.size())});
    return constraints;
}

std::vector<int> projection_sequence(const std::vector<PackedConstraint>& constraints, int vertices)
{
    const ConstraintsAtVertex at = constraints_at_vertices(constraints, vertices);
    Colouring by_vertex(constraints.size()), by_edge(constraints.size()), by_face(constraints.size());
    std::vector<int> shared(constraints.size(), 0), neighbours;
    for (int g = 0; g < static_cast<int>(constraints.size()); ++g) {
        neighbours.clear();
        for (int v = 0; v < corners(constraints[g].kind); ++v) {
            const int vertex = constraints[g].vertex[v];
            for (int k = at.first[vertex]; at.constraint[k] < g; ++k)
                if (shared[at.constraint[k]]++ == 0) neighbours.push_back(at.constraint[k]);
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

    std::vector<int> sorted(constraints.size()), place(constraints.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    const auto colours = [&](int g) { return std::tuple(by_face[g], -by_edge[g], by_vertex[g], g); };
    std::sort(sorted.begin(), sorted.end(), [&](int a, int b) { return colours(a) < colours(b); });
    for (std::size_t i = 0; i < sorted.size(); ++i) place[sorted[i]] = static_cast<int>(i);
    return place;
}

std::vector<std::vector<int>> BatchScheduler::schedule(const std::vector<PackedConstraint>& constraints)
{
    if (constraints.empty()) return {};
    const auto is_earlier = [&](int a, int b) {
        return chain_of_constraint_[a] != chain_of_constraint_[b] ? chain_of_constraint_[a] > chain_of_constraint_[b]
                                                                  : a < b;
    };
    std::vector<int> ready, freed = begin(constraints);

    std::vector<std::vector<int>> batches;
    for (std::size_t scheduled = 0; scheduled < constraints.size();) {
        std::sort(freed.begin(), freed.end(), is_earlier);
        const auto before = static_cast<std::ptrdiff_t>(ready.size());
        ready.insert(ready.end(), freed.begin(), freed.end());
        std::inplace_merge(ready.begin(), ready.begin() + before, ready.end(), is_earlier);
        freed.clear();

        const int now = static_cast<int>(batches.size());
        std::vector<int> batch;
        for (int since = now - 2; since < now && batch.empty(); ++since)
            std::erase_if(ready, [&](int g) {
                if (static_cast<int>(batch.size()) == batch_size || !rests(constraints[g], since)) return false;
                batch.push_back(g);
                return true;
            });
        for (const int g : batch) finish(constraints[g], now, freed);
        scheduled += batch.size();
        batches.push_back(std::move(batch));
    }
    for (const PackedConstraint& constraint : constraints)
        for (int v = 0; v < corners_; ++v) last_batch_[constraint.vertex[v]] = never;
    return batches;
}

// From the last constraint to the first, so that the next one at each vertex is at the end of its list. Returns those
// that wait for none.
std::vector<int> BatchScheduler::begin(const std::vector<PackedConstraint>& constraints)
{
    corners_ = corners(constraints.front().kind);
    chain_of_constraint_.assign(constraints.size(), 0);
    turns_.assign(constraints.size(), 0);
    for (int g = static_cast<int>(constraints.size()) - 1; g >= 0; --g) {
        const auto& vertex = constraints[g].vertex;
        for (int v = 0; v < corners_; ++v) {
            chain_of_constraint_[g] = std::max(chain_of_constraint_[g], chain_at_vertex_[vertex[v]] + 1);
            waiting_[vertex[v]].push_back(g);
        }
        for (int v = 0; v < corners_; ++v) chain_at_vertex_[vertex[v]] = chain_of_constraint_[g];
    }
    std::vector<int> free;
    for (std::size_t g = 0; g < constraints.size(); ++g)
        for (int v = 0; v < corners_; ++v) {
            chain_at_vertex_[constraints[g].vertex[v]] = 0;
            if (waiting_[constraints[g].vertex[v]].back() == static_cast<int>(g)) take_turn(static_cast<int>(g), free);
        }
    return free;
}

void BatchScheduler::take_turn(int constraint, std::vector<int>& freed)
{
    if (++turns_[constraint] == corners_) freed.push_back(constraint);
}

// Its vertices go on to their next constraints.
void BatchScheduler::finish(const PackedConstraint& constraint, int batch, std::vector<int>& freed)
{
    for (int v = 0; v < corners_; ++v) {
        last_batch_[constraint.vertex[v]] = batch;
        std::vector<int>& waiting = waiting_[constraint.vertex[v]];
        waiting.pop_back();
        if (!waiting.empty()) take_turn(waiting.back(), freed);
    }
}

bool BatchScheduler::rests(const PackedConstraint& constraint, int since) const
{
    return std::all_of(constraint.vertex.begin(), constraint.vertex.begin() + corners_,
                       [&](int v) { return last_batch_[v] < since; });
}

std::vector<SlabClusters> clusters_of_slabs(const std::vector<PackedConstraint>& constraints, const VertexOrder& order,
                                            int cluster_size)
{
    std::vector<int> first_vertex, sorted(constraints.size());
    for (const PackedConstraint& constraint : constraints) {
        first_vertex.push_back(order.new_of_old[constraint.vertex[0]]);
        for (int v = 1; v < corners(constraint.kind); ++v)
            first_vertex.back() = std::min(first_vertex.back(), order.new_of_old[constraint.vertex[v]]);
    }
    std::iota(sorted.begin(), sorted.end(), 0);
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return first_vertex[a] < first_vertex[b]; });
    const std::vector<int> slab_of = order.slab_of_new(),
                           place = projection_sequence(constraints, static_cast<int>(slab_of.size()));
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
    : tets_(packed_tets(corners_of(tets))),
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
    std::vector<PackedConstraint> constraints;
    for (const int t : tets) constraints.push_back(tets_[t]);
    std::vector<std::vector<int>> batches =
        BatchScheduler(static_cast<int>(order_.new_of_old.size())).schedule(constraints);
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
