#include "experiments/work_precision/diagram.hpp"

#include "experiments/work_precision/point_setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

constexpr std::size_t fewest_for_a_mean = 3;

// One pose of one body, as its rows say.
Diagram diagram_of(const analysis::CsvTable& table)
{
    Diagram diagram;
    diagram.name = table.text_at(0, "body") + ", " + table.text_at(0, "pose");
    for (int row = 0; row < table.rows(); ++row) {
        const auto ms = table.number_or_nothing(row, "ms_median"), error_pct = table.number_or_nothing(row, "error_joint_pct");
        if (table.text_at(row, "outcome") == "reference") {
            diagram.reference = table.text_at(row, "reference");
            diagram.reference_ms = ms;
            diagram.reference_error_pct = table.number_or_nothing(row, "reference_error_joint_pct");
            diagram.reference_difference_pct = table.number_or_nothing(row, "error_joint_beside_pct");
        }
        if (!ms || !error_pct) continue;
        diagram.points.push_back({table.text_at(row, "deformer"), table.text_at(row, "setting"), *ms, table.number(row, "ms_q1"),
                                  table.number(row, "ms_q3"), *error_pct, table.number_or_nothing(row, "error_joint_beside_pct"),
                                  table.number_or_nothing(row, "below_reference_error").value_or(0.0) != 0.0});
    }
    return diagram;
}

std::optional<double> mean_of(const std::vector<Diagram>& poses, std::optional<double> Diagram::*figure)
{
    double sum = 0.0;
    for (const Diagram& pose : poses) {
        if (!(pose.*figure)) return std::nullopt;
        sum += *(pose.*figure);
    }
    return sum / double(poses.size());
}

// The same setting in every pose; nothing where it has no error in one of them.
std::optional<DiagramPoint> mean_of(const std::vector<Diagram>& poses, const DiagramPoint& setting)
{
    DiagramPoint mean{setting.deformer, setting.setting};
    mean.beside_pct = 0.0;
    const double share = 1.0 / double(poses.size());
    for (const Diagram& pose : poses) {
        const auto same = [&](const DiagramPoint& point) { return point.words() == setting.words(); };
        const auto found = std::find_if(pose.points.begin(), pose.points.end(), same);
        if (found == pose.points.end()) return std::nullopt;
        for (double DiagramPoint::*figure : {&DiagramPoint::ms, &DiagramPoint::ms_q1, &DiagramPoint::ms_q3, &DiagramPoint::error_pct})
            mean.*figure += share * (*found).*figure;
        mean.beside_pct =
            mean.beside_pct && found->beside_pct ? std::optional(*mean.beside_pct + share * *found->beside_pct) : std::nullopt;
    }
    return mean;
}

Diagram mean_diagram(const std::string& body, const std::vector<Diagram>& poses)
{
    Diagram mean;
    mean.name = fmt::format("{}, mean of {} poses", body, poses.size());
    const bool same = std::all_of(poses.begin(), poses.end(), [&](const Diagram& pose) { return pose.reference == poses[0].reference; });
    mean.reference = same ? poses[0].reference : "of each pose";
    mean.reference_ms = mean_of(poses, &Diagram::reference_ms);
    mean.reference_error_pct = mean_of(poses, &Diagram::reference_error_pct);
    mean.reference_difference_pct = mean_of(poses, &Diagram::reference_difference_pct);
    for (const DiagramPoint& first : poses[0].points)
        if (auto point = mean_of(poses, first)) {
            point->below_reference_error = mean.reference_error_pct && point->error_pct <= *mean.reference_error_pct;
            mean.points.push_back(*point);
        }
    return mean;
}

}  // namespace

std::vector<analysis::WorkPrecision> Diagram::of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices) const
{
    std::vector<analysis::WorkPrecision> chosen;
    indices.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::find(deformers.begin(), deformers.end(), points[i].deformer) == deformers.end()) continue;
        chosen.push_back({points[i].ms, points[i].error_pct});
        indices.push_back(i);
    }
    return chosen;
}

std::vector<Diagram> diagrams_of(const std::vector<analysis::CsvTable>& points)
{
    std::vector<Diagram> diagrams;
    std::vector<std::pair<std::string, std::vector<Diagram>>> bodies;  // in the order of the records
    const auto poses_of = [&](const std::string& body) -> std::vector<Diagram>& {
        const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& entry) { return entry.first == body; });
        return found == bodies.end() ? bodies.emplace_back(body, std::vector<Diagram>{}).second : found->second;
    };
    for (const analysis::CsvTable& table : points) {
        if (table.rows() == 0) continue;
        diagrams.push_back(diagram_of(table));
        if (diagrams.back().reference.empty()) continue;
        poses_of(table.text_at(0, "body")).push_back(diagrams.back());
        poses_of("all bodies").push_back(diagrams.back());
    }
    for (const auto& [body, poses] : bodies)
        if (poses.size() >= fewest_for_a_mean) diagrams.push_back(mean_diagram(body, poses));
    return diagrams;
}

std::vector<DiagramPoint> budgets_of(const Diagram& diagram)
{
    std::vector<DiagramPoint> budgets;
    for (const int iterations : {1, 4, 24, 96}) {
        pbs::PbsOptions options;
        options.iterations = iterations;
        for (const DiagramPoint& point : diagram.points)
            if (point.deformer == "pbs" && point.setting == words_of(options)) budgets.push_back(point);
    }
    return budgets;
}

const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms)
{
    std::vector<std::size_t> indices;
    const auto best = analysis::best_within(diagram.of(group.deformers, indices), budget_ms);
    return best ? &diagram.points[indices[*best]] : nullptr;
}

const std::vector<DeformerGroup>& deformer_groups()
{
    static const std::vector<DeformerGroup> groups = {{"LBS", {"lbs"}},
                                                      {"DQS", {"dqs"}},
                                                      {"delta mush", {"delta_mush"}},
                                                      {"PBS", {"pbs"}},
                                                      {"PBS with exponent", {"pbs_exponent"}},
                                                      {"XPBD", {"xpbd", "xpbd_small_steps"}},
                                                      {"linear FEM", {"fem_linear"}},
                                                      {"nonlinear FEM", {"fem_corotational", "fem_stable_neo_hookean"}}};
    return groups;
}

const DeformerGroup& group_of(const std::string& deformer)
{
    for (const DeformerGroup& group : deformer_groups())
        if (std::count(group.deformers.begin(), group.deformers.end(), deformer)) return group;
    throw std::logic_error("a deformer of no group: " + deformer);
}

}  // namespace experiments
