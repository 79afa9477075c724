#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/studies/shared/posed_character.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {

namespace {

using analysis::Columns;
using analysis::within;

constexpr double least_error_pct = 1e-9;  // an error of zero has no logarithm

const PointRow* row_of(const CaseRows& rows, const SettingKey& key)
{
    const auto found = std::ranges::find(rows, key, &PointRow::key);
    return found == rows.end() ? nullptr : &*found;
}

// The geometric mean over the training poses; nothing without an answer in each of them.
std::optional<double> training_error_pct(const std::vector<const CaseRows*>& training, const SettingKey& setting)
{
    double sum = 0.0;
    for (const CaseRows* pose : training) {
        const PointRow* row = row_of(*pose, setting);
        if (!row || !row->error || !row->ms_median) return std::nullopt;
        sum += std::log(std::max(row->error->joint_pct, least_error_pct));
    }
    if (training.empty()) return std::nullopt;
    return std::exp(sum / double(training.size()));
}

// settings: of one choice in the order of the records, the default one first. training: the training poses that have them.
std::optional<ChosenSetting> choose(Comparison comparison, const std::vector<SettingKey>& settings,
                                    const std::vector<const CaseRows*>& training)
{
    ChosenSetting chosen{comparison, settings.front(), static_cast<int>(settings.size())};
    if (settings.size() == 1 || training.empty()) return chosen;
    for (const SettingKey& setting : settings) {
        const std::optional<double> error_pct = training_error_pct(training, setting);
        if (!error_pct || (chosen.training_error_joint_pct && *error_pct >= *chosen.training_error_joint_pct)) continue;
        chosen.training_error_joint_pct = error_pct;
        chosen.key = setting;
    }
    chosen.training_poses = static_cast<int>(training.size());
    return chosen.training_error_joint_pct ? std::optional(chosen) : std::nullopt;
}

// A mean is known where all of its values are.
void add(std::optional<double>& sum, const std::optional<double>& more, double share)
{
    sum = sum && more ? std::optional(*sum + share * *more) : std::nullopt;
}

// The same setting in every pose; nothing where it has no error in one of them.
std::optional<DiagramPoint> mean_of(const std::vector<Diagram>& poses, const DiagramPoint& setting)
{
    DiagramPoint mean{setting.key};
    mean.members.fill(0.0);
    const double share = 1.0 / double(poses.size());
    for (const Diagram& pose : poses) {
        const auto found = std::ranges::find(pose.points, setting.key, &DiagramPoint::key);
        if (found == pose.points.end()) return std::nullopt;
        for (const auto value : {&DiagramPoint::ms, &DiagramPoint::error_pct}) mean.*value += share * (*found).*value;
        for (std::size_t m = 0; m < mean.members.size(); ++m) add(mean.members[m], found->members[m], share);
    }
    return mean;
}

// The mean of the diagrams of several poses in the same comparison: the settings that have an error in each of them, with the means of
// their times and errors. A further reference takes part if it takes part in each pose.
Diagram mean_diagram(const std::string& key, const std::vector<Diagram>& poses)
{
    Diagram mean;
    mean.comparison = poses.front().comparison;
    mean.key = key;
    mean.groups = poses.front().groups;
    mean.has_reference = true;
    mean.poses = static_cast<int>(poses.size());
    mean.of_poses = poses;
    mean.members.fill({true, 0.0});
    mean.reference_error_pct = 0.0;
    for (const Diagram& pose : poses) {
        add(mean.reference_error_pct, pose.reference_error_pct, 1.0);
        for (std::size_t m = 0; m < mean.members.size(); ++m) {
            mean.members[m].takes_part = mean.members[m].takes_part && pose.members[m].takes_part;
            if (pose.members[m].bound_pct && mean.members[m].bound_pct)
                *mean.members[m].bound_pct += *pose.members[m].bound_pct / double(poses.size());
            else
                mean.members[m].bound_pct.reset();
        }
    }
    if (mean.reference_error_pct) *mean.reference_error_pct /= double(poses.size());
    for (const DiagramPoint& first : poses[0].points)
        if (const auto point = mean_of(poses, first)) mean.points.push_back(*point);
    return mean;
}

// The same setting in a pose of a mean, which has it.
const DiagramPoint* point_of(const Diagram& pose, const DiagramPoint& setting)
{
    return &*std::ranges::find(pose.points, setting.key, &DiagramPoint::key);
}

// reference: 0 is the first one, then the further ones.
analysis::PairDistances distances_on(const Diagram& diagram, const DiagramPoint& first, const DiagramPoint& second, std::size_t reference)
{
    if (reference > 0)
        return {first.members[reference - 1], second.members[reference - 1],
                diagram.shapes ? diagram.shapes->distance_pct(first.row, second.row, reference) : std::nullopt,
                diagram.members[reference - 1].bound_pct};
    return {first.error_pct, second.error_pct, diagram.shapes ? diagram.shapes->distance_pct(first.row, second.row, 0) : std::nullopt,
            diagram.reference_error_pct};
}

bool is_chosen(const std::vector<ChosenSetting>& chosen, Comparison comparison, const SettingKey& key)
{
    return std::ranges::any_of(chosen, [&](const auto& one) { return one.comparison == comparison && one.key == key; });
}

// One pose of one body.
Diagram diagram_of(const CaseRecords& records, Comparison comparison, const std::vector<ChosenSetting>& chosen)
{
    Diagram diagram;
    diagram.comparison = comparison;
    diagram.half = records.rows.front().half;
    diagram.pose = records.rows.front().of;
    diagram.key = case_name(diagram.pose);
    for (const FamilyRow& row : records.members)
        diagram.members.at(place_among_further(row.member.name)) = {true, row.outcome == "reached" ? row.error_bound_pct : std::nullopt};
    diagram.shapes = records.shapes;
    std::vector<std::string> external;
    for (const PointRow& row : records.rows) {
        if (row.is_external) external.push_back(row.key.deformer);
        if (row.outcome == "reference") {
            diagram.has_reference = true;
            diagram.reference_error_pct = row.reference_error_joint_pct;
        }
        if (row.ms_median && row.error && is_chosen(chosen, comparison, row.key))
            diagram.points.push_back(
                {row.key, *row.ms_median, row.error->joint_pct, row.members, static_cast<std::size_t>(&row - records.rows.data())});
    }
    diagram.groups = groups_with(external);
    return diagram;
}

int code_rank(const SettingKey& key)
{
    return (key.precision == "f32" ? 2 : 0) + (key.packed ? 1 : 0);
}

}  // namespace

const Columns<ChosenSetting> chosen_columns = Columns<ChosenSetting>{{"comparison", &ChosenSetting::comparison}} +
                                              within(&ChosenSetting::key, point_key_columns()) +
                                              MEMBER_COLUMNS(ChosenSetting, tried, training_poses, training_error_joint_pct);

BestCodes best_codes(const std::vector<CaseRows>& cases)
{
    BestCodes best;
    for (const CaseRows& rows : cases)
        for (const PointRow& row : rows)
            if (!row.is_of_reference()) best[row.key.deformer] = std::max(best[row.key.deformer], code_rank(row.key));
    return best;
}

bool takes_part(Comparison comparison, const SettingKey& key, const BestCodes& best)
{
    if (comparison == Comparison::plain_f64) return key.is_plain();
    const auto found = best.find(key.deformer);
    return found == best.end() || code_rank(key) == found->second;
}

namespace {

// One setting of each choice, or none.
using Choose = std::optional<ChosenSetting> (*)(Comparison, const std::vector<SettingKey>&, const std::vector<const CaseRows*>&);

std::vector<ChosenSetting> settings_by(Choose choose, const std::vector<CaseRows>& cases)
{
    const BestCodes best = best_codes(cases);
    std::vector<ChosenSetting> chosen;
    for (const Comparison comparison : comparisons) {
        std::vector<std::pair<SettingKey, std::vector<SettingKey>>> places;  // in the order of the records
        for (const CaseRows& rows : cases)
            for (const PointRow& row : rows) {
                if (row.is_of_reference() || !takes_part(comparison, row.key, best)) continue;
                const SettingKey place = without_grid_value(row.key);
                auto found = std::ranges::find(places, place, [](const auto& one) { return one.first; });
                if (found == places.end()) found = places.insert(places.end(), {place, {}});
                if (std::ranges::find(found->second, row.key) == found->second.end()) found->second.push_back(row.key);
            }
        for (const auto& [place, settings] : places) {
            std::vector<const CaseRows*> training;
            for (const CaseRows& rows : cases)
                if (!rows.empty() && rows.front().half == Half::training &&
                    std::ranges::any_of(rows, [&](const PointRow& row) { return without_grid_value(row.key) == place; }))
                    training.push_back(&rows);
            if (const auto choice = choose(comparison, settings, training)) chosen.push_back(*choice);
        }
    }
    return chosen;
}

}  // namespace

std::vector<ChosenSetting> choose_settings(const std::vector<CaseRows>& cases)
{
    return settings_by(choose, cases);
}

std::vector<ChosenSetting> default_settings(const std::vector<CaseRows>& cases)
{
    const auto first = [](Comparison comparison, const std::vector<SettingKey>& settings, const std::vector<const CaseRows*>&) {
        return std::optional(ChosenSetting{comparison, settings.front(), static_cast<int>(settings.size())});
    };
    return settings_by(first, cases);
}

const analysis::Columns<DiagramPoint>& diagram_point_columns()
{
    static const Columns<DiagramPoint> columns =
        within(&DiagramPoint::key, point_key_columns()) +
        Columns<DiagramPoint>{{"ms_median", &DiagramPoint::ms}, {"error_joint_pct", &DiagramPoint::error_pct}};
    return columns;
}

std::vector<analysis::WorkPrecision> Diagram::of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices) const
{
    std::vector<analysis::WorkPrecision> chosen;
    indices.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::find(deformers.begin(), deformers.end(), points[i].key.deformer) == deformers.end()) continue;
        chosen.push_back({points[i].ms, points[i].error_pct});
        indices.push_back(i);
    }
    return chosen;
}

std::vector<Diagram> diagrams_of(const std::vector<CaseRecords>& cases, const std::vector<ChosenSetting>& chosen)
{
    std::vector<Diagram> diagrams;
    for (const Comparison comparison : comparisons) {
        std::vector<Diagram> evaluated;
        for (const CaseRecords& records : cases) {
            if (records.rows.empty()) continue;
            diagrams.push_back(diagram_of(records, comparison, chosen));
            if (diagrams.back().has_reference && diagrams.back().half == Half::evaluation) evaluated.push_back(diagrams.back());
        }
        if (evaluated.size() > 1) diagrams.push_back(mean_diagram(fmt::format("mean_of_{}_evaluated_poses", evaluated.size()), evaluated));
    }
    return diagrams;
}

const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms)
{
    std::vector<std::size_t> indices;
    const auto best = analysis::best_within(diagram.of(group.deformers, indices), budget_ms);
    return best ? &diagram.points[indices[*best]] : nullptr;
}

const analysis::Columns<ReferenceOrder>& reference_order_columns()
{
    using analysis::PairDistances;
    static const Columns<ReferenceOrder> columns =
        Columns<ReferenceOrder>{{"member", &ReferenceOrder::member}} +
        within(&ReferenceOrder::distances, Columns<PairDistances>{{"first_error_pct", &PairDistances::first_error},
                                                                  {"second_error_pct", &PairDistances::second_error},
                                                                  {"distance_pct", &PairDistances::distance},
                                                                  {"error_bound_pct", &PairDistances::bound}}) +
        Columns<ReferenceOrder>{{"order", &ReferenceOrder::order}};
    return columns;
}

std::vector<ReferenceOrder> orders_on(const Diagram& diagram, const DiagramPoint& first, const DiagramPoint& second)
{
    const std::vector<EnsembleMember> all = family();
    std::vector<ReferenceOrder> orders;
    for (std::size_t reference = 0; reference <= further_members; ++reference) {
        if (reference > 0 && !diagram.members[reference - 1].takes_part) continue;
        std::vector<analysis::PairDistances> of_poses;
        for (const Diagram& pose : diagram.of_poses)
            of_poses.push_back(distances_on(pose, *point_of(pose, first), *point_of(pose, second), reference));
        const analysis::PairDistances distances = distances_on(diagram, first, second, reference);
        if (of_poses.empty()) of_poses.push_back(distances);
        orders.push_back({all[reference].name, distances, analysis::order_of_means(of_poses)});
    }
    return orders;
}

}  // namespace experiments
