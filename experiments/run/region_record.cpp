#include "experiments/run/region_record.hpp"

#include "experiments/characters/skinning_weights.hpp"
#include "pbs/skinning/weights.hpp"

#include <algorithm>
#include <map>

namespace experiments {
namespace {

const analysis::Columns<RegionBones> region_bone_columns = MEMBER_COLUMNS(RegionBones, bone, second_bone);

constexpr double nearest_bonus = 1e-6;  // decides for a corner's nearest bone if weights are equal

// Weight of each bone over the four corners of a tet, #bones, and whether one of them is blended.
struct TetWeights {
    std::vector<double> of_bone;
    bool blended = false;
};

TetWeights weights_of_tet(const pbs::Character& character, const pbs::Weights& weights, Eigen::Index tet)
{
    TetWeights sum{std::vector<double>(character.skeleton.bones.size(), 0.0)};
    for (const int vertex : character.mesh.tets.row(tet)) {
        sum.blended = sum.blended || weights.blended(vertex);
        sum.of_bone[character.binding.bone[vertex]] += nearest_bonus;
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry)
            sum.of_bone[weights.bone[entry]] += weights.weight[entry];
    }
    return sum;
}

int heaviest(const std::vector<double>& weights)
{
    return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace

const analysis::Columns<RegionChange> region_columns =
    MEMBER_COLUMNS(RegionChange, deformer, kind) + within(&RegionChange::bones, region_bone_columns) +
    MEMBER_COLUMNS(RegionChange, rest_share_pct, change_pct, abs_change_pct, lowest_pct, highest_pct, own_change_pct,
                   frames);

BodyRegions regions_by_bone(const pbs::Character& character)
{
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"bone", {}, {}};
    for (const auto& bone : character.skeleton.bones) regions.bones.push_back({bone.name});
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet)
        regions.of_tet.push_back(heaviest(weights_of_tet(character, weights, tet).of_bone));
    return regions;
}

BodyRegions regions_by_joint(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"joint", {}, {}};
    std::map<RegionBones, int> index_of;
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet) {
        TetWeights sum = weights_of_tet(character, weights, tet);
        regions.of_tet.push_back(-1);
        if (!sum.blended) continue;
        const int first = heaviest(sum.of_bone);
        sum.of_bone[first] = 0.0;
        const int second = heaviest(sum.of_bone);
        const RegionBones two = {bones[std::min(first, second)].name, bones[std::max(first, second)].name};
        const auto [entry, is_new] = index_of.emplace(two, static_cast<int>(regions.bones.size()));
        if (is_new) regions.bones.push_back(two);
        regions.of_tet.back() = entry->second;
    }
    return regions;
}

RegionRecord::RegionRecord(const pbs::Character& character)
{
    for (const BodyRegions& regions : {regions_by_bone(character), regions_by_joint(character)})
        kinds_.push_back({regions, analysis::RegionMetrics(character.mesh.rest, character.mesh.tets, regions.of_tet)});
}

void RegionRecord::add(const std::string& label, const pbs::Positions& positions)
{
    if (!positions.allFinite()) return;
    auto sums = std::ranges::find_if(sums_, [&](const auto& changes) { return changes.front().deformer == label; });
    const bool is_first = sums == sums_.end();
    if (is_first) {
        sums = sums_.emplace(sums_.end());
        for (const Kind& kind : kinds_)
            for (const RegionBones& bones : kind.regions.bones) sums->push_back({label, kind.regions.kind, bones});
    }
    auto first = sums->begin();  // region of the kind
    for (const Kind& kind : kinds_) {
        const auto changes = kind.region_metrics.measure(positions);
        for (std::size_t r = 0; r < changes.size(); ++r) {
            const double to_pct = 100.0 / kind.region_metrics.rest_volume_m3(),
                         change_pct = to_pct * changes[r].change_m3;
            RegionChange& sum = first[r];
            sum.rest_share_pct = to_pct * changes[r].rest_m3;
            sum.change_pct += change_pct;
            sum.abs_change_pct += to_pct * changes[r].abs_change_m3;
            sum.lowest_pct = is_first ? change_pct : std::min(sum.lowest_pct, change_pct);
            sum.highest_pct = is_first ? change_pct : std::max(sum.highest_pct, change_pct);
            ++sum.frames;
        }
        first += kind.regions.bones.size();
    }
}

std::vector<RegionChange> RegionRecord::changes() const
{
    std::vector<RegionChange> changes;
    for (const auto& sums : sums_)
        for (RegionChange change : sums) {
            if (change.rest_share_pct == 0.0) continue;  // a bone that carries no tet
            change.own_change_pct = 100.0 * change.change_pct / change.frames / change.rest_share_pct;
            change.change_pct /= change.frames;
            change.abs_change_pct /= change.frames;
            changes.push_back(change);
        }
    return changes;
}

}  // namespace experiments
