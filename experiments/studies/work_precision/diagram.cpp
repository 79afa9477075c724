#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/mean_diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace experiments {
namespace {

constexpr std::size_t fewest_for_a_mean = 3;

void add_members(Diagram& diagram, const std::vector<FamilyRow>& members)
{
    for (const FamilyRow& row : members)
        diagram.members.at(place_among_further(row.member.name)) = {true, row.outcome == "reached" ? row.error_bound_pct : std::nullopt};
}

bool is_chosen(const std::vector<ChosenSetting>& chosen, Comparison comparison, const SettingKey& key)
{
    return std::ranges::any_of(chosen, [&](const auto& one) { return one.comparison == comparison && one.key == key; });
}

// Returns the names of the user's own deformers, in the order of the rows.
std::vector<std::string> external_in(const CaseRows& rows)
{
    std::vector<std::string> names;
    for (const PointRow& row : rows)
        if (row.is_external) names.push_back(row.key.deformer);
    return names;
}

// One pose of one body.
Diagram diagram_of(const CaseRecords& records, Comparison comparison, const std::vector<ChosenSetting>& chosen)
{
    Diagram diagram;
    diagram.comparison = comparison;
    diagram.half = records.rows.front().half;
    diagram.pose = records.rows.front().of;
    diagram.key = case_name(diagram.pose);
    diagram.name = text_of(diagram.pose);
    diagram.groups = groups_with(external_in(records.rows));
    add_members(diagram, records.members);
    for (const PointRow& row : records.rows) {
        if (row.outcome == "reference") {
            diagram.reference = text_of(row.key);
            diagram.reference_ms = row.reach_ms;
            diagram.reference_error_pct = row.reference_error_joint_pct;
            diagram.masked_share_pct = row.masked_share_pct.value_or(0.0);
        }
        if (row.ms_median && row.error && is_chosen(chosen, comparison, row.key))
            diagram.points.push_back({row.key, *row.ms_median, row.ms_q1, row.ms_q3, row.error->joint_pct, row.error->l2_pct,
                                      row.error->linf_m, row.metrics ? std::optional(row.metrics->volume_abs_change_pct) : std::nullopt,
                                      row.below_reference_error.value_or(false), row.members});
    }
    return diagram;
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

const analysis::Columns<DiagramPoint>& diagram_point_columns()
{
    using analysis::Columns;
    static const Columns<DiagramPoint> columns =
        within(&DiagramPoint::key, point_key_columns()) +
        Columns<DiagramPoint>{{"ms_median", &DiagramPoint::ms, "ms", "median of the processor time per frame"}};
    return columns;
}

const std::vector<DeformerGroup>& groups_of(const std::vector<Diagram>& diagrams)
{
    return diagrams.empty() ? deformer_groups() : diagrams.front().groups;
}

bool is_pose(const Diagram& diagram)
{
    return diagram.poses == 1 && !diagram.reference.empty();
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

std::vector<Diagram> diagrams_of(const std::vector<CaseRecords>& cases, const std::vector<ChosenSetting>& chosen)
{
    std::vector<Diagram> diagrams;
    for (const Comparison comparison : comparisons) {
        std::vector<Family> bodies, poses;  // in the order of the records
        std::vector<Diagram> evaluated;
        for (const CaseRecords& records : cases) {
            if (records.rows.empty()) continue;
            const Diagram diagram = diagram_of(records, comparison, chosen);
            diagrams.push_back(diagram);
            if (diagram.reference.empty() || diagram.half == Half::training) continue;
            evaluated.push_back(diagram);
            add_to(bodies, diagram.pose.body, diagram);
            if (!diagram.pose.pose.empty()) add_to(poses, diagram.pose.pose, diagram);
        }
        for (const auto& [over, families] : {std::pair{"poses", bodies}, {"bodies", poses}})
            for (const auto& [name, of] : families)
                if (of.size() >= fewest_for_a_mean)
                    diagrams.push_back(mean_diagram(fmt::format("{}_mean_of_{}_{}", name, of.size(), over),
                                                    fmt::format("{}, mean of {} {}", name, of.size(), over), of));
        if (evaluated.size() > 1)
            diagrams.push_back(mean_diagram(fmt::format("mean_of_{}_evaluated_poses", evaluated.size()),
                                            fmt::format("mean of the {} evaluated poses", evaluated.size()), evaluated));
    }
    return diagrams;
}

const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms)
{
    std::vector<std::size_t> indices;
    const auto best = analysis::best_within(diagram.of(group.deformers, indices), budget_ms);
    return best ? &diagram.points[indices[*best]] : nullptr;
}

}  // namespace experiments
