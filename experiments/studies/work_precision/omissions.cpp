#include "experiments/studies/work_precision/omissions.hpp"

#include "experiments/studies/shared/posed_character.hpp"

#include <algorithm>

namespace experiments {
namespace {

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

// Returns the omissions of one deformer in one case. `points` are its points that take part in the comparison.
std::vector<Omission> omissions_in(const std::vector<const PointRow*>& points, const PointRow* reference, const Omission& blank)
{
    std::vector<Omission> omissions;
    for (const PointRow* row : points) {
        const std::string why = why_missing(*row, reference && reference->outcome == "reference");
        if (why.empty()) continue;
        auto found = std::ranges::find(omissions, why, &Omission::why);
        if (found == omissions.end()) {
            found = omissions.insert(omissions.end(), blank);
            found->why = why;
            found->reason = why == "no_reference" && reference ? reference->reason : row->reason;
        }
        ++found->missing;
        found->points = static_cast<int>(points.size());
    }
    return omissions;
}

}  // namespace

const analysis::Columns<Omission> omission_columns = {
    {"comparison", &Omission::comparison, "", "packed_f32 or plain_f64"},
    {"case", &Omission::of, "", "name of the case's run, or of the mean over several, which has the omissions of all of its poses"},
    {"deformer", &Omission::deformer, "", "name of the deformer"},
    {"why", &Omission::why, "", "not_finite, not_converged, over_time_limit, not_applicable, no_such_code, not_run or no_reference"},
    {"missing", &Omission::missing, "", "number of its points that are missing for this reason"},
    {"points", &Omission::points, "", "number of its points in this case, or in all poses of the mean"},
    {"reason", &Omission::reason, "", "of the first of them, for readers; of no_reference: the worst tet of the reference's last state"}};

std::vector<Omission> omissions_of(const std::vector<CaseRows>& cases)
{
    const BestCodes best = best_codes(cases);
    std::vector<std::string> deformers;  // of any case, in the order of the records
    for (const CaseRows& rows : cases)
        for (const PointRow& row : rows)
            if (!row.is_of_reference() && std::ranges::find(deformers, row.key.deformer) == deformers.end())
                deformers.push_back(row.key.deformer);
    std::vector<Omission> omissions;
    for (const Comparison comparison : comparisons)
        for (const CaseRows& rows : cases) {
            if (rows.empty()) continue;
            const PointRow* reference = reference_in(rows);
            for (const std::string& deformer : deformers) {
                const std::vector<const PointRow*> points = points_of(rows, deformer, comparison, best);
                Omission blank{comparison, case_name(rows.front().of), deformer};
                if (points.empty()) {
                    const bool is_run = std::ranges::any_of(rows, [&](const PointRow& row) { return row.key.deformer == deformer; });
                    blank.why = is_run ? "no_such_code" : "not_run";
                    omissions.push_back(blank);
                    continue;
                }
                for (const Omission& omission : omissions_in(points, reference, blank)) omissions.push_back(omission);
            }
        }
    return omissions;
}

std::vector<Omission> omissions_of_means(const std::vector<CaseRows>& cases, const std::vector<Diagram>& diagrams)
{
    const BestCodes best = best_codes(cases);
    const std::vector<Omission> of_cases = omissions_of(cases);
    std::vector<Omission> all;
    for (const Diagram& mean : diagrams) {
        const auto is_of_mean = [&](const std::string& of) { return std::ranges::find(mean.cases, of) != mean.cases.end(); };
        const auto points_in_all = [&](const std::string& deformer) {
            std::size_t points = 0;
            for (const CaseRows& rows : cases)
                if (!rows.empty() && is_of_mean(case_name(rows.front().of)))
                    points += points_of(rows, deformer, mean.comparison, best).size();
            return static_cast<int>(points);
        };
        std::vector<Omission> of_mean;
        for (const Omission& one : of_cases) {
            if (one.comparison != mean.comparison || !is_of_mean(one.of)) continue;
            const auto same = std::ranges::find_if(
                of_mean, [&](const Omission& other) { return other.deformer == one.deformer && other.why == one.why; });
            if (same != of_mean.end()) {
                same->missing += one.missing;
                continue;
            }
            of_mean.push_back(one);
            of_mean.back().of = mean.key;
            of_mean.back().points = points_in_all(one.deformer);
        }
        all.insert(all.end(), of_mean.begin(), of_mean.end());
    }
    return all;
}

}  // namespace experiments
