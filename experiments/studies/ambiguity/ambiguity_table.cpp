#include "experiments/studies/ambiguity/ambiguity_table.hpp"

#include "analysis/case_judgement.hpp"
#include "analysis/statistics.hpp"
#include "experiments/studies/ambiguity/judged_figure.hpp"
#include "experiments/studies/shared/program_claims.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr const char* unchanged = "no";

// Claims of the volume study whose extent on this scene differs, by metric.
std::string changed_verdicts(const ReadMotion& a, const ReadMotion& b)
{
    std::vector<std::string> changes;
    for (const analysis::Claim& claim : claims()) {
        if (claim.study != "volume") continue;
        const bool of_lbs = claim.deformer == "lbs";
        for (const std::string& metric : claim.metrics) {
            const analysis::Extent before = analysis::judge_case(claim, of_lbs ? a.lbs : a.pbs, metric).extent,
                                   after = analysis::judge_case(claim, of_lbs ? b.lbs : b.pbs, metric).extent;
            if (before != after) changes.push_back(fmt::format("{} by {}: {} -> {}", claim.id, metric, word_for(before), word_for(after)));
        }
    }
    return changes.empty() ? unchanged : fmt::format("{}", fmt::join(changes, "; "));
}

double share_within(const std::vector<double>& change_pct)
{
    constexpr double printed_pct = 0.5;  // Sec. 4
    const auto holds = [](double change) { return std::abs(change) <= printed_pct; };
    return double(std::count_if(change_pct.begin(), change_pct.end(), holds)) / double(change_pct.size());
}

// Root mean square over frames and vertices of the zone, or all where it is empty [m].
double distance_m(const ReadMotion& a, const ReadMotion& b, const std::vector<bool>& zone)
{
    double sum = 0.0;
    long long count = 0;
    for (std::size_t frame = 0; frame < std::min(a.shapes.size(), b.shapes.size()); ++frame)
        for (Eigen::Index i = 0; i < a.shapes[frame].rows(); ++i) {
            if (!zone.empty() && !zone[i]) continue;
            sum += (a.shapes[frame].row(i) - b.shapes[frame].row(i)).squaredNorm();
            ++count;
        }
    return std::sqrt(sum / double(count));
}

}  // namespace

void AmbiguityTable::add(const Scene& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b, const ReadMotion& resting,
                         const std::vector<bool>& zone)
{
    const std::string verdict = changed_verdicts(a, b);
    const auto row = [&](const std::string& figure, double of_a, double of_b) {
        table_.add_row({scene.name, reading.place, reading.baseline, reading.name, figure, of_a, of_b, of_b - of_a, verdict});
    };
    row("mean volume change [%]", analysis::mean(a.pbs.volume_change_pct), analysis::mean(b.pbs.volume_change_pct));
    row("mean absolute volume change [%]", analysis::mean(a.pbs.volume_abs_change_pct), analysis::mean(b.pbs.volume_abs_change_pct));
    row("mean volume change of LBS [%]", analysis::mean(a.lbs.volume_change_pct), analysis::mean(b.lbs.volume_change_pct));
    row("share of frames within 0.5 %", share_within(a.pbs.volume_change_pct), share_within(b.pbs.volume_change_pct));
    row("mean number of inverted tets", analysis::mean(a.pbs.inverted_tets), analysis::mean(b.pbs.inverted_tets));
    for (std::size_t frame = 0; frame < a.pbs.angle_deg.size(); ++frame)
        if (const double angle = a.pbs.angle_deg[frame]; std::abs(angle - 90.0) < 1e-6 || std::abs(angle - 170.0) < 1e-6) {
            row(fmt::format("volume change at {:.0f} deg [%]", angle), a.pbs.volume_change_pct[frame], b.pbs.volume_change_pct[frame]);
            row(fmt::format("absolute volume change at {:.0f} deg [%]", angle), a.pbs.volume_abs_change_pct[frame],
                b.pbs.volume_abs_change_pct[frame]);
        }
    row("distance of B from A, rms [m]", 0.0, distance_m(a, b, {}));
    row("jiggle: zone off the shape that does not jiggle, rms [m]", distance_m(a, resting, zone), distance_m(b, resting, zone));
}

std::string ambiguity_markdown(const std::vector<analysis::CsvTable>& tables)
{
    std::string text =
        "| scene | place | B | signed A -> B [%] | absolute A -> B [%] | within 0.5 % A -> B | B off A [mm] | jiggle A -> B [mm] | verdict "
        "changed |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const analysis::CsvTable& table : tables)
        for (int row = 0; row < table.rows(); ++row) {
            if (table.text_at(row, "figure") != "mean volume change [%]") continue;
            int off = row;
            while (!table.text_at(off, "figure").starts_with("distance")) ++off;
            text += fmt::format(
                "| {} | {} | {} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.2f} -> {:.2f} | {:.3f} | {:.2f} -> {:.2f} | {} |\n",
                table.text_at(row, "scene"), table.text_at(row, "place"), table.text_at(row, "reading_b"), table.number(row, "a"),
                table.number(row, "b"), table.number(row + 1, "a"), table.number(row + 1, "b"), table.number(row + 3, "a"),
                table.number(row + 3, "b"), 1000.0 * table.number(off, "b"), 1000.0 * table.number(off + 1, "a"),
                1000.0 * table.number(off + 1, "b"), table.text_at(row, "verdict_changed"));
        }
    return text;
}

}  // namespace experiments
