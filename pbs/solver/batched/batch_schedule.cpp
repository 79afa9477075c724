#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <utility>

namespace pbs {

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

// From the last group to the first, so that the next one at each vertex is at the end of its list. Returns those that wait for none.
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
    return std::all_of(group.vertex.begin(), group.vertex.begin() + vertices_of_group_, [&](int v) { return last_batch_[v] < since; });
}

}  // namespace pbs
