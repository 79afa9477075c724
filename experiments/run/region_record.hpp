// regions.csv: how much volume each bone's and each joint's tets gain or lose, over the frames of a run; one row per deformer and region.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "analysis/region_volume.hpp"
#include "experiments/run/body_regions.hpp"

#include <map>

namespace experiments {

struct RegionChange {
    std::string deformer, kind, region;
    double rest_share_pct = 0.0, change_pct = 0.0, abs_change_pct = 0.0, lowest_pct = 0.0, highest_pct = 0.0, own_change_pct = 0.0;
    int frames = 0;
};
extern const analysis::Columns<RegionChange> region_columns;

class RegionRecord {
public:
    explicit RegionRecord(const pbs::Character& character);

    // One frame of a deformer; frames that are not finite are left out.
    void add(const std::string& label, const pbs::Positions& positions);

    std::vector<RegionChange> changes() const;
    analysis::CsvTable table() const { return table_of(region_columns, changes()); }

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
