#include "analysis/records/report_table.hpp"
#include "analysis/statistics/fits.hpp"
#include "experiments/studies/timing/timing_records.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <utility>

namespace experiments {
namespace {

const std::string short_columns =
    "body vertices variant precision lbs_ms:.3f bind_ms:.3f stretch_ms:.3f volume_ms:.3f total_wall_ms:.3g frames_per_s:.0f "
    "drawn_frames_per_s:.0f paper_frames_per_s:.1f";
const std::string all_columns =
    short_columns +
    " total_wall_ms_low:.3g total_wall_ms_high:.3g total_ms:.3g rest_ms:.3g surface_ms:.3g paper_ms:.2f paper_ct_ms:.2f model "
    "vertices_over_table_1:.2f edges_over_table_1:.2f tets_over_table_1:.2f";

std::string machines(const std::vector<TimingRow>& rows)
{
    std::set<std::string> names;
    for (const TimingRow& row : rows) names.insert(row.mesh.cpu_model);
    return fmt::format("{}", fmt::join(names, "; "));
}

std::string ends_text(const std::vector<TimingRow>& rows)
{
    std::string text;
    for (const auto& [variant, precision] : {std::pair("plain", "f64"), std::pair("plain", "f32"), std::pair("ordered", "f32")}) {
        std::vector<double> vertices, total_ms;
        for (const TimingRow& row : rows)
            if (row.mesh.model.empty() && row.timing.variant == variant && row.timing.precision == precision) {
                vertices.push_back(row.mesh.vertices);
                total_ms.push_back(row.timing.total_wall_ms.median);
            }
        if (vertices.size() < 2) continue;
        const analysis::PowerLawEnd end = analysis::power_law_end(vertices, total_ms, 1e3 / 30.0);
        text += fmt::format("  {:<8} {}: 30 frames per second up to {:.3g} vertices{}; ms per frame ~ vertices^{:.2f}\n", variant,
                            precision, end.size, end.beyond ? " (beyond the measured sizes)" : "", end.exponent);
    }
    return text;
}

}  // namespace

std::string timing_markdown(const std::vector<TimingRow>& rows)
{
    return fmt::format("Timed on {}. Times are per frame.\n\n{}\n```\n{}```\n", machines(rows),
                       markdown_table(table_of(timing_columns, rows), analysis::report_columns(all_columns)), ends_text(rows));
}

std::string timing_text(const std::vector<TimingRow>& rows)
{
    const std::string table = text_table(table_of(timing_columns, rows), analysis::report_columns(short_columns));
    return fmt::format("Per frame, on one core of {}:\n{}{}", machines(rows), table, ends_text(rows));
}

}  // namespace experiments
