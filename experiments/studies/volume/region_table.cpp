#include "experiments/studies/volume/region_table.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

struct RegionOfRun {
    std::string run;
    RegionChange region;
};

// The regions of one deformer and kind, the greatest loss first.
std::vector<RegionChange> by_loss(std::vector<RegionChange> regions, const std::string& deformer, const std::string& kind)
{
    std::erase_if(regions, [&](const RegionChange& region) { return region.deformer != deformer || region.kind != kind; });
    std::stable_sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.change_pct < b.change_pct; });
    return regions;
}

struct LossRow {
    std::string run, deformer, kind;
    double change_pct = 0.0;
    std::string greatest = {};
};
const analysis::Columns<LossRow> loss_columns = {
    {"run", &LossRow::run, "", "name of the run"},
    {"deformer", &LossRow::deformer, "", "name of the deformer"},
    {"kind", &LossRow::kind, "", "bone or joint"},
    {"change_pct", &LossRow::change_pct, "%", "sum over the regions, mean over the frames"},
    {"greatest", &LossRow::greatest, "", "the regions that lose most, and what they lose of the body and of themselves"}};

LossRow loss_row(const RunRegions& run, const std::string& deformer, const std::string& kind, int most)
{
    LossRow row{run.run, deformer, kind};
    for (const RegionChange& region : by_loss(run.regions, deformer, kind)) {
        row.change_pct += region.change_pct;
        if (most-- <= 0) continue;
        row.greatest += row.greatest.empty() ? "" : ", ";
        row.greatest += fmt::format("{} {:.2f} ({:.1f})", region.bones.text(), region.change_pct, region.own_change_pct);
    }
    return row;
}

}  // namespace

std::string region_text(const std::vector<RunRegions>& runs, int most)
{
    std::vector<LossRow> rows;
    for (const RunRegions& run : runs)
        for (const char* deformer : {"lbs", "pbs"})
            for (const char* kind : {"bone", "joint"})
                if (const LossRow row = loss_row(run, deformer, kind, most); !row.greatest.empty()) rows.push_back(row);
    return text_table(table_of(loss_columns, rows), {{"mean over frames", "run"},
                                                     {"", "deformer"},
                                                     {"by", "kind"},
                                                     {"all [%]", "change_pct", "{:.2f}"},
                                                     {"greatest losses [% of the body] (of the region itself)", "greatest"}});
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
