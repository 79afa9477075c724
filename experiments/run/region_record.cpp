#include "experiments/run/region_record.hpp"

#include <algorithm>

namespace experiments {

const analysis::Columns<RegionChange> region_columns = {
    {"deformer", &RegionChange::deformer, "", "label of the deformer"},
    {"kind", &RegionChange::kind, "", "what the region belongs to: bone or joint"},
    {"region", &RegionChange::region, "", "name of the bone, or of the two bones of the joint: thigh.L - shin.L"},
    {"rest_share_pct", &RegionChange::rest_share_pct, "%", "the region's share of the body's rest volume"},
    {"change_pct", &RegionChange::change_pct, "%", "mean change of volume over the frames, of the body's rest volume; the bones' add up"},
    {"abs_change_pct", &RegionChange::abs_change_pct, "%", "mean sum of the tets' absolute changes, of the body's rest volume"},
    {"lowest_pct", &RegionChange::lowest_pct, "%", "lowest change_pct of a frame"},
    {"highest_pct", &RegionChange::highest_pct, "%", "highest change_pct of a frame"},
    {"own_change_pct", &RegionChange::own_change_pct, "%", "mean change of volume over the frames, of the region's own rest volume"},
    {"frames", &RegionChange::frames, "", "number of frames whose positions are finite"}};

RegionRecord::RegionRecord(const pbs::Character& character)
{
    for (const BodyRegions& regions : {regions_by_bone(character), regions_by_joint(character)})
        kinds_.push_back({regions, analysis::RegionRuler(character.mesh.rest, character.mesh.tets, regions.of_tet)});
}

void RegionRecord::add(const std::string& label, const pbs::Positions& positions)
{
    if (!positions.allFinite()) return;
    const bool is_first = frames_[label]++ == 0;
    if (is_first) {
        labels_.push_back(label);
        for (const Kind& kind : kinds_) sums_[label].emplace_back(kind.regions.names.size());
    }
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        const auto changes = kinds_[k].ruler.measure(positions);
        for (std::size_t r = 0; r < changes.size(); ++r) {
            const double to_pct = 100.0 / kinds_[k].ruler.rest_volume_m3(), change_pct = to_pct * changes[r].change_m3;
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
            for (std::size_t r = 0; r < regions.names.size(); ++r) {
                const Sums& sums = sums_.at(label)[k][r];
                if (sums.rest == 0.0) continue;  // a bone that carries no tet
                const int frames = frames_.at(label);
                changes.push_back({label, regions.kind, regions.names[r], sums.rest, sums.change / frames, sums.abs_change / frames,
                                   sums.lowest, sums.highest, 100.0 * sums.change / frames / sums.rest, frames});
            }
        }
    return changes;
}

}  // namespace experiments
