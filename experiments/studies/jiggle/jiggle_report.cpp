#include "experiments/studies/jiggle/jiggle_report.hpp"

#include "analysis/records/csv_table.hpp"
#include "analysis/records/folder_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;

std::string jolt_text(const std::string& run)
{
    const CsvTable zone = analysis::read_csv(analysis::path_in(run, "zone.csv")),
                   responses = analysis::read_csv(analysis::path_in(run, "responses.csv"));
    std::string text =
        fmt::format("{}: the zone is {:.0f} % of the vertices, {:.0f} % of it skin, in {} pieces;", fs::path(run).filename().string(),
                    100.0 * zone.number(0, "share_of_vertices"), 100.0 * zone.number(0, "share_on_skin"), zone.integer(0, "pieces"));
    for (int row = 0; row < std::min(zone.rows(), 5); ++row)
        text += fmt::format(" {} {:.0f} %", zone.text_at(row, "bone"), 100.0 * zone.number(row, "share_of_zone"));
    text +=
        "\n\n| deformer | k_stretch | step [ms] | iterations | masses | k_bind | outcome | frequency [Hz] | damping ratio | overshoot / "
        "jolt | left / "
        "peak |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < responses.rows(); ++row)
        text +=
            fmt::format("| {} | {} | {:.3g} | {} | {} | {} | {} | {:.2f} | {:.3f} | {:.2f} | {:.3f} |\n",
                        responses.text_at(row, "deformer"), responses.number(row, "k_stretch"), responses.number(row, "time_step_ms"),
                        responses.integer(row, "iterations"), responses.text_at(row, "masses"), responses.number(row, "k_bind"),
                        responses.text_at(row, "outcome"), responses.number(row, "frequency_hz"), responses.number(row, "damping_ratio"),
                        responses.number(row, "overshoot_over_jolt"), responses.number(row, "left_over_peak"));
    return text + "\n";
}

std::string walk_text(const std::string& run)
{
    const CsvTable walk = analysis::read_csv(analysis::path_in(run, "walk.csv"));
    std::string text = fs::path(run).filename().string() +
                       "\n\n| k_stretch | lag, rms [mm] | most [mm] | speed left after 1 s, share |\n|---|---|---|---|\n";
    for (int row = 0; row < walk.rows(); ++row)
        text += fmt::format("| {} | {:.2f} | {:.2f} | {:.4f} |\n", walk.number(row, "k_stretch"), walk.number(row, "moving_lag_rms_mm"),
                            walk.number(row, "most_lag_rms_mm"), walk.number(row, "last_speed_share"));
    return text + "\n";
}

}  // namespace

std::string jiggle_report(const std::string& run)
{
    return fs::exists(analysis::path_in(run, "walk.csv")) ? walk_text(run) : jolt_text(run);
}

}  // namespace experiments
