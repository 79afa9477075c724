#include "experiments/run/region_record.hpp"

#include "pbs/skinning/weights.hpp"

#include <algorithm>

namespace experiments {
namespace {

const analysis::Columns<RegionBones> region_bone_columns = {
    {"bone", &RegionBones::bone, "", "name of the bone, or of the joint's first bone"},
    {"second_bone", &RegionBones::second_bone, "", "name of the joint's second bone; empty where the region belongs to one bone"}};

}  // namespace

using Changes = analysis::Columns<RegionChange>;
const Changes region_columns =
    Changes{{"deformer", &RegionChange::deformer, "", "label of the deformer"},
            {"kind", &RegionChange::kind, "", "what the region belongs to: bone or joint"}} +
    within(&RegionChange::bones, region_bone_columns) +
    Changes{
        {"rest_share_pct", &RegionChange::rest_share_pct, "%", "the region's share of the body's rest volume"},
        {"change_pct", &RegionChange::change_pct, "%",
         "mean change of volume over the frames, of the body's rest volume; the bones' add up"},
        {"abs_change_pct", &RegionChange::abs_change_pct, "%", "mean sum of the tets' absolute changes, of the body's rest volume"},
        {"lowest_pct", &RegionChange::lowest_pct, "%", "lowest change_pct of a frame"},
        {"highest_pct", &RegionChange::highest_pct, "%", "highest change_pct of a frame"},
        {"own_change_pct", &RegionChange::own_change_pct, "%", "mean change of volume over the frames, of the region's own rest volume"},
        {"frames", &RegionChange::frames, "", "number of frames whose positions are finite"}};

namespace {

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
    const bool is_first = frames_[label]++ == 0;
    if (is_first) {
        labels_.push_back(label);
        for (const Kind& kind : kinds_) sums_[label].emplace_back(kind.regions.bones.size());
    }
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        const auto changes = kinds_[k].region_metrics.measure(positions);
        for (std::size_t r = 0; r < changes.size(); ++r) {
            const double to_pct = 100.0 / kinds_[k].region_metrics.rest_volume_m3(), change_pct = to_pct * changes[r].change_m3;
            Sums& sums = sums_[label][k][r];
            sums.rest = to_pct * changes[r].rest_m3;
            sums.change += change_pct;
            sums.abs_change += to_pct * changes[r].abs_change_m3;
            sums.lowest = is_first ? change_pct : std::min(sums.lowest, change_pct);
            sums.highest = is_first ? change_pct : std::max(sums.highest, change_pct);
        }
    }
}

std::vector<RegionChange> RegionRecord::changes() const
{
    std::vector<RegionChange> changes;
    for (const std::string& label : labels_)
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const BodyRegions& regions = kinds_[k].regions;
            for (std::size_t r = 0; r < regions.bones.size(); ++r) {
                const Sums& sums = sums_.at(label)[k][r];
                if (sums.rest == 0.0) continue;  // a bone that carries no tet
                const int frames = frames_.at(label);
                changes.push_back({label, regions.kind, regions.bones[r], sums.rest, sums.change / frames, sums.abs_change / frames,
                                   sums.lowest, sums.highest, 100.0 * sums.change / frames / sums.rest, frames});
            }
        }
    return changes;
}

}  // namespace experiments
