// regions.csv: the volume that the tets of each bone and of each joint gain or lose over the frames of a run, with one
// row per deformer and region.
//   RegionRecord record(character);
//   record.add("pbs", positions);                 // once per frame
//   record.table().write("regions.csv");
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/characters/character.hpp"

#include <string>
#include <vector>

namespace experiments {

// The bone that a region belongs to, or the two bones of a joint.
struct RegionBones {
    std::string bone, second_bone = {};
    auto operator<=>(const RegionBones&) const = default;
    std::string text() const { return second_bone.empty() ? bone : bone + " - " + second_bone; }
};

// A character's tets cut into regions, by the weights of Eq. 2 whatever weights the character is skinned with.
struct BodyRegions {
    std::string kind;  // bone, joint
    std::vector<RegionBones> bones;
    std::vector<int> of_tet;  // index into `bones`; -1: none, #T
};

// Each tet belongs to the bone that has most weight over its four corners; among equals, to the one that most corners
// are nearest to.
BodyRegions regions_by_bone(const pbs::Character& character);

// Each tet with a blended corner belongs to the joint of the two bones with most weight, in the order of the skeleton.
// Joints without tets are left out.
BodyRegions regions_by_joint(const pbs::Character& character);

struct RegionChange {
    std::string deformer, kind;
    RegionBones bones;
    double rest_share_pct = 0.0, change_pct = 0.0, abs_change_pct = 0.0, lowest_pct = 0.0, highest_pct = 0.0,
           own_change_pct = 0.0;
    int frames = 0;
};
extern const analysis::Columns<RegionChange> region_columns;

class RegionRecord {
public:
    explicit RegionRecord(const pbs::Character& character);

    // Adds one frame of a deformer. Frames that are not finite are left out.
    void add(const std::string& label, const pbs::Positions& positions);

    std::vector<RegionChange> changes() const;
    analysis::CsvTable table() const { return table_of(region_columns, changes()); }

private:
    struct Kind {
        BodyRegions regions;
        analysis::RegionMetrics region_metrics;
    };

    std::vector<Kind> kinds_;
    // of each deformer's frames, in order of first appearance: by kind and region
    std::vector<std::vector<RegionChange>> sums_;
};

}  // namespace experiments
