#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/studies/work_precision/point_setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace experiments {
namespace {

constexpr std::size_t fewest_for_a_mean = 3;

// One pose of one body.
Diagram diagram_of(const std::vector<PointRow>& rows)
{
    Diagram diagram;
    diagram.pose = rows.front().of;
    diagram.key = case_name(diagram.pose);
    diagram.name = text_of(diagram.pose);
    for (const PointRow& row : rows) {
        if (row.outcome == "reference") {
            diagram.reference = text_of(row.key);
            diagram.reference_ms = row.reach_ms;
            diagram.reference_error_pct = row.reference_error_joint_pct;
            diagram.masked_share_pct = row.masked_share_pct.value_or(0.0);
        }
        if (row.ms_median && row.error)
            diagram.points.push_back({row.key, *row.ms_median, row.ms_q1, row.ms_q3, row.error->joint_pct, row.error->l2_pct,
                                      row.error->linf_m, row.metrics.volume_abs_change_pct, row.below_reference_error.value_or(false)});
    }
    return diagram;
}

std::optional<double> mean_of(const std::vector<Diagram>& poses, std::optional<double> Diagram::*value)
{
    double sum = 0.0;
    for (const Diagram& pose : poses) {
        if (!(pose.*value)) return std::nullopt;
        sum += *(pose.*value);
    }
    return sum / double(poses.size());
}

// The same setting in every pose; nothing where it has no error in one of them.
std::optional<DiagramPoint> mean_of(const std::vector<Diagram>& poses, const DiagramPoint& setting)
{
    constexpr std::optional<double> DiagramPoint::*known_or_not[] = {&DiagramPoint::ms_q1, &DiagramPoint::ms_q3, &DiagramPoint::l2_pct,
                                                                     &DiagramPoint::linf_m, &DiagramPoint::volume_abs_change_pct};
    DiagramPoint mean{setting.key};
    for (const auto value : known_or_not) mean.*value = 0.0;
    const double share = 1.0 / double(poses.size());
    for (const Diagram& pose : poses) {
        const auto same = [&](const DiagramPoint& point) { return point.key == setting.key; };
        const auto found = std::find_if(pose.points.begin(), pose.points.end(), same);
        if (found == pose.points.end()) return std::nullopt;
        for (const auto value : {&DiagramPoint::ms, &DiagramPoint::error_pct}) mean.*value += share * (*found).*value;
        for (const auto value : known_or_not) {
            std::optional<double>& sum = mean.*value;
            const std::optional<double>& more = (*found).*value;
            sum = sum && more ? std::optional(*sum + share * *more) : std::nullopt;
        }
    }
    return mean;
}

Diagram mean_diagram(const std::string& what, const std::string& over, const std::vector<Diagram>& poses)
{
    Diagram mean;
    mean.key = fmt::format("{}_mean_of_{}_{}", what, poses.size(), over);
    mean.name = fmt::format("{}, mean of {} {}", what, poses.size(), over);
    mean.poses = static_cast<int>(poses.size());
    for (const Diagram& pose : poses) mean.masked_share_pct += pose.masked_share_pct / double(poses.size());
    const bool same = std::all_of(poses.begin(), poses.end(), [&](const Diagram& pose) { return pose.reference == poses[0].reference; });
    mean.reference = same ? poses[0].reference : "another one for each pose";
    mean.reference_ms = mean_of(poses, &Diagram::reference_ms);
    mean.reference_error_pct = mean_of(poses, &Diagram::reference_error_pct);
    for (const DiagramPoint& first : poses[0].points)
        if (auto point = mean_of(poses, first)) {
            point->below_reference_error = mean.reference_error_pct && point->error_pct <= *mean.reference_error_pct;
            mean.points.push_back(*point);
        }
    return mean;
}

using Family = std::pair<std::string, std::vector<Diagram>>;

void add_to(std::vector<Family>& families, const std::string& name, const Diagram& diagram)
{
    const auto found = std::find_if(families.begin(), families.end(), [&](const Family& family) { return family.first == name; });
    (found == families.end() ? families.emplace_back(name, std::vector<Diagram>{}) : *found).second.push_back(diagram);
}

}  // namespace

const analysis::Columns<DiagramPoint>& measures()
{
    static const analysis::Columns<DiagramPoint> columns = {
        {"error_joint_pct", &DiagramPoint::error_pct, "%", "error over the blended vertices"},
        {"error_l2_pct", &DiagramPoint::l2_pct, "%", "error over all vertices"},
        {"error_linf_m", &DiagramPoint::linf_m, "m", "largest distance to the reference"},
        {"volume_abs_change_pct", &DiagramPoint::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"}};
    return columns;
}

double value_of(const DiagramPoint& point, const std::string& measure)
{
    const analysis::CsvTable::Cell cell = measures().named(measure).cell(point);
    return cell.kind == analysis::CsvTable::Cell::Kind::real ? cell.real : std::numeric_limits<double>::quiet_NaN();
}

std::vector<analysis::WorkPrecision> Diagram::of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices,
                                                 const std::string& measure) const
{
    std::vector<analysis::WorkPrecision> chosen;
    indices.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::find(deformers.begin(), deformers.end(), points[i].key.deformer) == deformers.end()) continue;
        chosen.push_back({points[i].ms, value_of(points[i], measure)});
        indices.push_back(i);
    }
    return chosen;
}

std::vector<Diagram> diagrams_of(const std::vector<std::vector<PointRow>>& points)
{
    std::vector<Diagram> diagrams;
    std::vector<Family> bodies, poses;  // in the order of the records
    for (const std::vector<PointRow>& rows : points) {
        if (rows.empty()) continue;
        diagrams.push_back(diagram_of(rows));
        if (diagrams.back().reference.empty()) continue;
        const analysis::CaseKey of = diagrams.back().pose;
        add_to(bodies, of.body, diagrams.back());
        if (!of.pose.empty()) add_to(poses, of.pose, diagrams.back());
    }
    for (const auto& [over, families] : {std::pair{"poses", bodies}, {"bodies", poses}})
        for (const auto& [name, of] : families)
            if (of.size() >= fewest_for_a_mean) diagrams.push_back(mean_diagram(name, over, of));
    return diagrams;
}

std::vector<DiagramPoint> budgets_of(const Diagram& diagram)
{
    std::vector<DiagramPoint> budgets;
    for (const int iterations : {1, 4, 24, 96}) {
        PointSetting setting{"pbs", default_spec("pbs")};
        options_of<pbs::PbsOptions>(setting.spec).iterations = iterations;
        const SettingKey key = key_of(setting);
        for (const DiagramPoint& point : diagram.points)
            if (point.key == key) budgets.push_back(point);
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
    static const std::vector<DeformerGroup> groups = {{"lbs", "LBS", {"lbs"}},
                                                      {"dqs", "DQS", {"dqs"}},
                                                      {"delta_mush", "delta mush", {"delta_mush"}},
                                                      {"pbs", "PBS", {"pbs"}},
                                                      {"pbs_exponent", "PBS with exponent", {"pbs_exponent"}},
                                                      {"xpbd", "XPBD", {"xpbd", "xpbd_small_steps"}},
                                                      {"linear_fem", "linear FEM", {"fem_linear"}},
                                                      {"nonlinear_fem", "nonlinear FEM", {"fem_corotational", "fem_neo_hookean"}}};
    return groups;
}

const DeformerGroup& group_of(const std::string& deformer)
{
    for (const DeformerGroup& group : deformer_groups())
        if (std::count(group.deformers.begin(), group.deformers.end(), deformer)) return group;
    throw std::logic_error("a deformer of no group: " + deformer);
}

const DeformerGroup& group_named(const std::string& key)
{
    for (const DeformerGroup& group : deformer_groups())
        if (group.key == key) return group;
    throw std::logic_error("no group of deformers: " + key);
}

}  // namespace experiments
