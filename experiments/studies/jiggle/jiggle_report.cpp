#include "experiments/studies/jiggle/jiggle_report.hpp"

#include "analysis/records/folder_files.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string jolt_text(const std::string& run)
{
    const auto zone = rows_of(zone_columns, analysis::read_csv(analysis::path_in(run, "zone.csv")));
    const auto responses = rows_of(response_columns, analysis::read_csv(analysis::path_in(run, "responses.csv")));
    const ZoneRow& all = zone.at(0);
    std::string text = fmt::format("{}: the zone is {:.0f} % of the vertices, {:.0f} % of it skin, in {} pieces;",
                                   fs::path(run).filename().string(), 100.0 * all.share_of_vertices, 100.0 * all.share_on_skin, all.pieces);
    for (std::size_t i = 0; i < std::min(zone.size(), std::size_t{5}); ++i)
        text += fmt::format(" {} {:.0f} %", zone[i].bone.name, 100.0 * zone[i].bone.share_of_zone);
    text +=
        "\n\n| deformer | k_stretch | step [ms] | iterations | masses | k_bind | outcome | frequency [Hz] | damping ratio | overshoot / "
        "jolt | left / "
        "peak |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const ResponseRow& row : responses)
        text += fmt::format("| {} | {} | {:.3g} | {} | {} | {} | {} | {:.2f} | {:.3f} | {:.2f} | {:.3f} |\n", row.deformer,
                            row.setting.k_stretch, row.time_step_ms, row.setting.iterations, row.masses, row.setting.k_bind, row.outcome,
                            row.response.swing.frequency_hz.estimate, row.response.swing.damping_ratio.estimate,
                            row.response.overshoot_over_jolt, row.response.left_over_peak);
    return text + "\n";
}

std::string walk_text(const std::string& run)
{
    std::string text = fs::path(run).filename().string() +
                       "\n\n| k_stretch | lag, rms [mm] | most [mm] | speed left after 1 s, share |\n|---|---|---|---|\n";
    for (const auto& [k_stretch, response] : rows_of(walk_columns, analysis::read_csv(analysis::path_in(run, "walk.csv"))))
        text += fmt::format("| {} | {:.2f} | {:.2f} | {:.4f} |\n", k_stretch, response.moving_lag_mm, response.most_lag_mm,
                            response.last_speed_share);
    return text + "\n";
}

}  // namespace

std::string jiggle_report(const std::string& run)
{
    return fs::exists(analysis::path_in(run, "walk.csv")) ? walk_text(run) : jolt_text(run);
}

}  // namespace experiments
