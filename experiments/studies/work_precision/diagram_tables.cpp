#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/studies/shared/posed_character.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

constexpr double profile_tolerances_pct[] = {10.0, 5.0, 2.0};

struct FrontRow {
    Comparison comparison;
    std::string diagram, front;
    DiagramPoint point;
    std::optional<double> reference_error_joint_pct;
};
const Columns<FrontRow> front_columns =
    Columns<FrontRow>{{"comparison", &FrontRow::comparison}, {"case", &FrontRow::diagram}, {"front", &FrontRow::front}} +
    within(&FrontRow::point, diagram_point_columns()) + MEMBER_COLUMNS(FrontRow, reference_error_joint_pct);

const std::string all_name = "all";

std::vector<std::string> all_deformers(const Diagram& diagram)
{
    std::vector<std::string> all;
    for (const DeformerGroup& group : diagram.groups) all.insert(all.end(), group.deformers.begin(), group.deformers.end());
    return all;
}

void add_front(std::vector<FrontRow>& rows, const Diagram& diagram, const std::string& name, const std::vector<std::string>& deformers)
{
    std::vector<std::size_t> indices;
    for (const std::size_t on_front : analysis::pareto_front(diagram.of(deformers, indices)))
        rows.push_back({diagram.comparison, diagram.key, name, diagram.points[indices[on_front]], diagram.reference_error_pct});
}

// The least time of a point of the group with an error of at most the tolerance. Nothing: the pose is not solved.
std::optional<double> time_to_solve(const Diagram& diagram, const DeformerGroup& group, double tolerance_pct)
{
    std::optional<double> least_ms;
    std::vector<std::size_t> indices;
    for (const analysis::WorkPrecision& point : diagram.of(group.deformers, indices))
        if (point.error <= tolerance_pct && (!least_ms || point.cost < *least_ms)) least_ms = point.cost;
    return least_ms;
}

void add_steps(std::vector<ProfileStep>& steps, const std::vector<const Diagram*>& poses, const DeformerGroup& group, double tolerance_pct)
{
    std::vector<double> solved, certain;
    for (const Diagram* pose : poses) {
        if (const auto ms = time_to_solve(*pose, group, tolerance_pct)) solved.push_back(*ms);
        if (!pose->reference_error_pct) continue;
        if (const auto ms = time_to_solve(*pose, group, tolerance_pct - *pose->reference_error_pct)) certain.push_back(*ms);
    }
    std::set<double> times(solved.begin(), solved.end());
    times.insert(certain.begin(), certain.end());
    const auto until = [](const std::vector<double>& of, double ms) {
        return static_cast<int>(std::ranges::count_if(of, [&](double one) { return one <= ms; }));
    };
    for (const double ms : times) {
        ProfileStep& step = steps.emplace_back(ProfileStep{poses.front()->comparison, tolerance_pct, group.key, ms});
        step.solved = until(solved, ms);
        step.certain = until(certain, ms);
        step.poses = static_cast<int>(poses.size());
        step.share_pct = 100.0 * step.solved / step.poses;
    }
}

std::string why_missing(const PointRow& row, bool has_reference)
{
    if (row.outcome != "finished") return row.outcome;
    if (!row.ms_median) return "not_converged";  // from one pose to the other
    return has_reference ? "" : "no_reference";
}

// The row of the case's reference, reached or not. Null where there is none.
const PointRow* reference_in(const CaseRows& rows)
{
    const auto found = std::ranges::find_if(rows, &PointRow::is_of_reference);
    return found == rows.end() ? nullptr : &*found;
}

// Returns the points of the deformer in the case that take part in the comparison.
std::vector<const PointRow*> points_of(const CaseRows& rows, const std::string& deformer, Comparison comparison, const BestCodes& best)
{
    std::vector<const PointRow*> points;
    for (const PointRow& row : rows)
        if (row.key.deformer == deformer && takes_part(comparison, row.key, best)) points.push_back(&row);
    return points;
}

// The deformers of any case, in the order of the records.
std::vector<std::string> deformers_of(const std::vector<CaseRows>& cases)
{
    std::vector<std::string> deformers;
    for (const CaseRows& rows : cases)
        for (const PointRow& row : rows)
            if (!row.is_of_reference() && std::ranges::find(deformers, row.key.deformer) == deformers.end())
                deformers.push_back(row.key.deformer);
    return deformers;
}

// The omissions in some of the cases, added up by deformer and reason, under the name of the case or of the mean.
std::vector<Omission> omissions_in(const std::vector<const CaseRows*>& some, Comparison comparison, const std::string& name,
                                   const std::vector<CaseRows>& all)
{
    const BestCodes best = best_codes(all);
    const std::vector<std::string> deformers = deformers_of(all);
    std::vector<Omission> omissions;
    const auto add = [&](const std::string& deformer, const std::string& why, int missing, const std::string& reason) {
        auto found = std::ranges::find_if(omissions, [&](const Omission& one) { return one.deformer == deformer && one.why == why; });
        if (found == omissions.end()) {
            found = omissions.insert(omissions.end(), {comparison, name, deformer, why, 0, 0, reason});
            for (const CaseRows* rows : some) found->points += static_cast<int>(points_of(*rows, deformer, comparison, best).size());
        }
        found->missing += missing;
    };
    for (const CaseRows* rows : some) {
        const PointRow* reference = reference_in(*rows);
        for (const std::string& deformer : deformers) {
            const std::vector<const PointRow*> points = points_of(*rows, deformer, comparison, best);
            const bool is_run = std::ranges::any_of(*rows, [&](const PointRow& row) { return row.key.deformer == deformer; });
            if (points.empty()) add(deformer, is_run ? "no_such_code" : "not_run", 0, "");
            for (const PointRow* row : points)
                if (const std::string why = why_missing(*row, reference && reference->outcome == "reference"); !why.empty())
                    add(deformer, why, 1, why == "no_reference" && reference ? reference->reason : row->reason);
        }
    }
    return omissions;
}

}  // namespace

analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams)
{
    std::vector<FrontRow> rows;
    for (const Diagram& diagram : diagrams) {
        add_front(rows, diagram, all_name, all_deformers(diagram));
        for (const std::string& deformer : all_deformers(diagram)) add_front(rows, diagram, deformer, {deformer});
    }
    return table_of(front_columns, rows);
}

const analysis::Columns<ProfileStep> data_profile_columns =
    MEMBER_COLUMNS(ProfileStep, comparison, tolerance_pct, group, ms, solved, certain, poses, share_pct);

std::vector<ProfileStep> data_profiles(const std::vector<Diagram>& diagrams)
{
    std::vector<ProfileStep> steps;
    for (const Comparison comparison : comparisons) {
        if (diagrams.empty()) break;
        std::vector<const Diagram*> poses;
        for (const Diagram& diagram : diagrams)
            if (diagram.comparison == comparison && diagram.poses == 1 && diagram.has_reference && diagram.half == Half::evaluation)
                poses.push_back(&diagram);
        for (const double tolerance_pct : profile_tolerances_pct)
            for (const DeformerGroup& group : diagrams.front().groups) add_steps(steps, poses, group, tolerance_pct);
    }
    return steps;
}

const analysis::Columns<Omission> omission_columns =
    analysis::Columns<Omission>{{"comparison", &Omission::comparison}, {"case", &Omission::of}} +
    MEMBER_COLUMNS(Omission, deformer, why, missing, points, reason);

std::vector<Omission> omissions_of(const std::vector<CaseRows>& cases)
{
    std::vector<Omission> omissions;
    for (const Comparison comparison : comparisons)
        for (const CaseRows& rows : cases)
            if (!rows.empty())
                std::ranges::move(omissions_in({&rows}, comparison, case_name(rows.front().of), cases), std::back_inserter(omissions));
    return omissions;
}

std::vector<Omission> omissions_of_means(const std::vector<CaseRows>& cases, const std::vector<Diagram>& diagrams)
{
    std::vector<Omission> omissions;
    for (const Diagram& mean : diagrams) {
        std::vector<const CaseRows*> poses;
        for (const CaseRows& rows : cases)
            if (!rows.empty() && std::ranges::count(mean.of_poses, case_name(rows.front().of), &Diagram::key)) poses.push_back(&rows);
        std::ranges::move(omissions_in(poses, mean.comparison, mean.key, cases), std::back_inserter(omissions));
    }
    return omissions;
}

}  // namespace experiments
