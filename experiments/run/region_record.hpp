// regions.csv: how much volume each bone's and each joint's tets gain or lose, over the frames of a run. One row a deformer and region:
//   kind, region                     bone, thigh.L; joint, thigh.L - shin.L
//   rest_share_pct                   of the body's rest volume
//   change_pct, abs_change_pct       mean over frames, of the body's rest volume: rows of the bones add up to the body's
//   lowest_pct, highest_pct          of change_pct over the frames
//   own_change_pct                   mean over frames, of the region's own rest volume
#pragma once

#include "analysis/records/csv_table.hpp"
#include "analysis/region_volume.hpp"
#include "experiments/run/body_regions.hpp"

#include <map>

namespace experiments {

class RegionRecord {
public:
    explicit RegionRecord(const pbs::Character& character);

    // One frame of a deformer; frames that are not finite are left out.
    void add(const std::string& label, const pbs::Positions& positions);

    analysis::CsvTable table() const;

private:
    struct Sums {
        double rest = 0.0, change = 0.0, abs_change = 0.0, lowest = 0.0, highest = 0.0;  // [% of the body]
    };
    struct Kind {
        BodyRegions regions;
        analysis::RegionRuler ruler;
    };

    std::vector<Kind> kinds_;
    std::vector<std::string> labels_;  // in order of first appearance
    std::map<std::string, int> frames_;
    std::map<std::string, std::vector<std::vector<Sums>>> sums_;  // label -> kind -> region
};

}  // namespace experiments
