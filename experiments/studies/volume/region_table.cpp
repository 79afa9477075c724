#include "experiments/studies/volume/region_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

struct RegionOfRun {
    std::string run;
    RegionChange region;
};

// Regions of one deformer and kind, the greatest loss first.
std::vector<RegionChange> by_loss(std::vector<RegionChange> regions, const std::string& deformer, const std::string& kind)
{
    std::erase_if(regions, [&](const RegionChange& region) { return region.deformer != deformer || region.kind != kind; });
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.change_pct < b.change_pct; });
    return regions;
}

std::string line_of(const RunRegions& run, const std::string& deformer, const std::string& kind, int most)
{
    const std::vector<RegionChange> regions = by_loss(run.regions, deformer, kind);
    if (regions.empty()) return {};
    double sum = 0.0;
    std::string text;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        sum += regions[i].change_pct;
        if (static_cast<int>(i) < most)
            text += fmt::format("{}{} {:.2f} ({:.1f})", i ? ", " : "", regions[i].region, regions[i].change_pct, regions[i].own_change_pct);
    }
    return fmt::format("{:<16} {:<4} {:<6} {:>7.2f}  {}\n", run.run, deformer, kind, sum, text);
}

}  // namespace

std::string region_text(const std::vector<RunRegions>& runs, int most)
{
    std::string text = fmt::format("{:<16} {:<4} {:<6} {:>7}  {}\n", "mean over frames", "", "by", "all [%]",
                                   "greatest losses [% of the body] (of the region itself)");
    for (const RunRegions& run : runs)
        for (const char* deformer : {"lbs", "pbs"})
            for (const char* kind : {"bone", "joint"}) text += line_of(run, deformer, kind, most);
    return text;
}

analysis::CsvTable region_csv(const std::vector<RunRegions>& runs)
{
    static const analysis::Columns<RegionOfRun> columns =
        analysis::Columns<RegionOfRun>{{"run", &RegionOfRun::run, "", "name of the run"}} +
        analysis::within(&RegionOfRun::region, region_columns);
    std::vector<RegionOfRun> all;
    for (const RunRegions& run : runs)
        for (const RegionChange& region : run.regions) all.push_back({run.run, region});
    return table_of(columns, all);
}

}  // namespace experiments
