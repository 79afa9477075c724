#include "experiments/studies/timing/timing_report.hpp"

#include "analysis/line_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace experiments {
namespace {

std::string machines(const analysis::CsvTable& table)
{
    std::set<std::string> names;
    for (int row = 0; row < table.rows(); ++row) names.insert(table.text_at(row, "cpu_model"));
    return fmt::format("{}", fmt::join(names, "; "));
}

std::string with_quartiles(const analysis::CsvTable& table, int row, const std::string& part)
{
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", table.number(row, part + "_ms"), table.number(row, part + "_ms_low"),
                       table.number(row, part + "_ms_high"));
}

std::string or_none(std::optional<double> value, const char* format)
{
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

bool is_ladder(const analysis::CsvTable& table, int row)
{
    return table.text_at(row, "model").empty();
}

std::string ends_text(const analysis::CsvTable& table)
{
    std::string text;
    for (const auto& [variant, precision] : {std::pair("plain", "f64"), std::pair("plain", "f32"), std::pair("ordered", "f32")}) {
        std::vector<double> vertices, total_ms;
        for (int row = 0; row < table.rows(); ++row)
            if (is_ladder(table, row) && table.text_at(row, "variant") == variant && table.text_at(row, "precision") == precision) {
                vertices.push_back(table.number(row, "vertices"));
                total_ms.push_back(table.number(row, "total_wall_ms"));
            }
        if (vertices.size() < 2) continue;
        const RealTimeEnd end = real_time_end(vertices, total_ms);
        text += fmt::format("  {:<8} {}: 30 frames a second up to {:.3g} vertices{}; ms a frame ~ vertices^{:.2f}\n", variant, precision,
                            end.vertices, end.beyond ? " (beyond what was measured)" : "", end.exponent);
    }
    return text;
}

}  // namespace

RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms)
{
    constexpr double real_time_ms = 1e3 / 30.0;
    std::vector<std::size_t> order(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return vertices[a] < vertices[b]; });
    std::size_t next = 1;  // the line through order[next - 1] and order[next]
    while (next + 1 < order.size() && total_ms[order[next]] < real_time_ms) ++next;
    const std::size_t a = order[next - 1], b = order[next];
    const double slope = std::log(total_ms[b] / total_ms[a]) / std::log(vertices[b] / vertices[a]);
    RealTimeEnd end;
    end.vertices = vertices[a] * std::pow(real_time_ms / total_ms[a], 1.0 / slope);
    end.beyond = end.vertices < vertices[order.front()] || end.vertices > vertices[order.back()];
    end.exponent = analysis::observed_order(vertices, total_ms).slope.estimate;
    return end;
}

std::string timing_markdown(const analysis::CsvTable& table)
{
    std::string text = fmt::format("Timed on {}.\n\n", machines(table));
    text +=
        "| mesh | stands for | V, E, T over Table 1's | order | LBS | bind | stretch | volume | rest | frame, processor [ms] | frame, wall "
        "[ms] | surface | frames/s | with the surface | Table 1: frames/s | ms by its frame rate | ms by its CT |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < table.rows(); ++row) {
        const auto ratio = [&](const char* of) {
            return or_none(table.number_or_nothing(row, std::string(of) + "_over_table_1"), "{:.2f}");
        };
        text += fmt::format(
            "| {} ({}, {}, {}) | {} | {}, {}, {} | {} {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} | {} | {} | {} | {} |\n",
            table.text_at(row, "body"), table.integer(row, "vertices"), table.integer(row, "edges"), table.integer(row, "tets"),
            is_ladder(table, row) ? "-" : table.text_at(row, "model"), ratio("vertices"), ratio("edges"), ratio("tets"),
            table.text_at(row, "variant"), table.text_at(row, "precision"), with_quartiles(table, row, "lbs"),
            with_quartiles(table, row, "bind"), with_quartiles(table, row, "stretch"), with_quartiles(table, row, "volume"),
            with_quartiles(table, row, "rest"), with_quartiles(table, row, "total"), with_quartiles(table, row, "total_wall"),
            or_none(table.number_or_nothing(row, "surface_ms"), "{:.3g}"), table.number(row, "frames_per_s"),
            or_none(table.number_or_nothing(row, "drawn_frames_per_s"), "{:.0f}"),
            or_none(table.number_or_nothing(row, "paper_frames_per_s"), "{:.1f}"),
            or_none(table.number_or_nothing(row, "paper_ms"), "{:.2f}"), or_none(table.number_or_nothing(row, "paper_ct_ms"), "{:.2f}"));
    }
    return text +
           "\nAt most one of the paper's two columns of times can be right: its frame rate and its CT of 100 steps differ by a factor of "
           "20.\n\n```\n" +
           ends_text(table) + "```\n";
}

std::string timing_text(const analysis::CsvTable& table)
{
    std::string text = fmt::format("{:<24} {:<12} {:>7} {:>7} {:>7} {:>7} {:>22} {:>9} {:>9} {:>9}\n", "ms a frame, one core", "", "LBS",
                                   "bind", "stretch", "volume", "frame, wall", "frames/s", "drawn/s", "Table 1");
    for (int row = 0; row < table.rows(); ++row)
        text += fmt::format("  {:<22} {:<12} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>22} {:>9.0f} {:>9} {:>9}\n",
                            fmt::format("{} {}", table.text_at(row, "body"), table.integer(row, "vertices")),
                            table.text_at(row, "variant") + " " + table.text_at(row, "precision"), table.number(row, "lbs_ms"),
                            table.number(row, "bind_ms"), table.number(row, "stretch_ms"), table.number(row, "volume_ms"),
                            with_quartiles(table, row, "total_wall"), table.number(row, "frames_per_s"),
                            or_none(table.number_or_nothing(row, "drawn_frames_per_s"), "{:.0f}"),
                            or_none(table.number_or_nothing(row, "paper_frames_per_s"), "{:.1f}"));
    return text + fmt::format("on {}\n", machines(table)) + ends_text(table);
}

}  // namespace experiments
