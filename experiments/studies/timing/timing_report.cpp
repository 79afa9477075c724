#include "analysis/line_fit.hpp"
#include "analysis/report_table.hpp"
#include "experiments/studies/timing/timing_records.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
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
        const RealTimeEnd end = real_time_end(vertices, total_ms);
        text += fmt::format("  {:<8} {}: 30 frames per second up to {:.3g} vertices{}; ms per frame ~ vertices^{:.2f}\n", variant,
                            precision, end.vertices, end.beyond ? " (beyond the measured sizes)" : "", end.exponent);
    }
    return text;
}

}  // namespace

RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms)
{
    constexpr double real_time_ms = 1e3 / 30.0;
    std::vector<std::pair<double, double>> sizes;  // vertices, ms
    for (std::size_t i = 0; i < vertices.size(); ++i) sizes.emplace_back(vertices[i], total_ms[i]);
    if (sizes.size() < 2) throw std::invalid_argument("real_time_end: fewer than two sizes");
    std::sort(sizes.begin(), sizes.end());
    std::size_t next = 1;  // the line passes through sizes[next - 1] and sizes[next]
    while (next + 1 < sizes.size() && sizes[next].second < real_time_ms) ++next;
    const auto [below, below_ms] = sizes[next - 1];
    const auto [above, above_ms] = sizes[next];
    const double slope = std::log(above_ms / below_ms) / std::log(above / below);
    RealTimeEnd end;
    end.vertices = below * std::pow(real_time_ms / below_ms, 1.0 / slope);
    end.beyond = end.vertices < sizes.front().first || end.vertices > sizes.back().first;
    end.exponent = analysis::observed_order(vertices, total_ms).slope.estimate;
    return end;
}

std::string timing_markdown(const std::vector<TimingRow>& rows)
{
    return fmt::format(
        "Timed on {}. Times are per frame.\n\n{}\nAt most one of the paper's two columns of times can be right: its frame rate and its CT\n"
        "of 100 steps differ by a factor of 20.\n\n```\n{}```\n",
        machines(rows), markdown_table(table_of(timing_columns, rows), analysis::report_columns(all_columns)), ends_text(rows));
}

std::string timing_text(const std::vector<TimingRow>& rows)
{
    const std::string table = text_table(table_of(timing_columns, rows), analysis::report_columns(short_columns));
    return fmt::format("Per frame, on one core of {}:\n{}{}", machines(rows), table, ends_text(rows));
}

}  // namespace experiments
