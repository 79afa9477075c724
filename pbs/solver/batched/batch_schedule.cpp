#include "pbs/solver/batched/batch_schedule.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pbs {

std::vector<std::vector<int>> BatchScheduler::schedule(const std::vector<ConstraintGroup>& groups)
{
    if (groups.empty()) return {};
    constexpr int batches_a_ranking = 8;  // how long a ranking is good enough
    vertices_of_group_ = vertices_of(groups.front().kind);
    for (const ConstraintGroup& group : groups)
        for (int v = 0; v < vertices_of_group_; ++v) ++uses_[group.vertex[v]];

    std::vector<int> left(groups.size());
    std::iota(left.begin(), left.end(), 0);
    std::vector<std::vector<int>> batches;
    while (!left.empty()) {
        const int now = static_cast<int>(batches.size());
        const bool last_quarter = 4 * left.size() < groups.size();
        if (last_quarter && now % batches_a_ranking == 0) rank_by_use(groups, left);
        std::vector<int> batch;
        for (int since = now - 2; since < now && batch.empty(); ++since)
            std::erase_if(left, [&](int g) {
                if (static_cast<int>(batch.size()) == batch_size || touched_since(groups[g], since)) return false;
                touch(groups[g], now);
                batch.push_back(g);
                return true;
            });
        batches.push_back(std::move(batch));
    }
    for (const ConstraintGroup& group : groups)
        for (int v = 0; v < vertices_of_group_; ++v) last_batch_[group.vertex[v]] = never;
    return batches;
}

void BatchScheduler::rank_by_use(const std::vector<ConstraintGroup>& groups, std::vector<int>& left)
{
    rank_.resize(groups.size());
    for (const int g : left) {
        rank_[g] = 0;
        for (int v = 0; v < vertices_of_group_; ++v) rank_[g] = std::max(rank_[g], uses_[groups[g].vertex[v]]);
    }
    std::stable_sort(left.begin(), left.end(), [&](int a, int b) { return rank_[a] > rank_[b]; });
}

bool BatchScheduler::touched_since(const ConstraintGroup& group, int batch) const
{
    for (int v = 0; v < vertices_of_group_; ++v)
        if (last_batch_[group.vertex[v]] >= batch) return true;
    return false;
}

void BatchScheduler::touch(const ConstraintGroup& group, int batch)
{
    for (int v = 0; v < vertices_of_group_; ++v) {
        last_batch_[group.vertex[v]] = batch;
        --uses_[group.vertex[v]];
    }
}

}  // namespace pbs
