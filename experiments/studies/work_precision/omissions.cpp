#include "experiments/studies/work_precision/omissions.hpp"

#include <algorithm>

namespace experiments {
namespace {

bool is_reference(const PointRow& row)
{
    return row.outcome == "reference" || row.outcome == "not_reached";
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
    const auto found = std::ranges::find_if(rows, is_reference);
    return found == rows.end() ? nullptr : &*found;
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
    {"points", &Omission::points, "", "number of its points in this case"},
    {"reason", &Omission::reason, "", "of the first of them, for readers; of no_reference: the worst tet of the reference's last state"}};

std::vector<Omission> omissions_of(const std::vector<CaseRows>& cases)
{
    const BestCodes best = best_codes(cases);
    std::vector<std::string> deformers;  // of any case, in the order of the records
    for (const CaseRows& rows : cases)
        for (const PointRow& row : rows)
            if (!is_reference(row) && std::ranges::find(deformers, row.key.deformer) == deformers.end())
                deformers.push_back(row.key.deformer);
    std::vector<Omission> omissions;
    for (const Comparison comparison : comparisons)
        for (const CaseRows& rows : cases) {
            if (rows.empty()) continue;
            const PointRow* reference = reference_in(rows);
            for (const std::string& deformer : deformers) {
                std::vector<const PointRow*> points;
                bool is_run = false;
                for (const PointRow& row : rows) {
                    if (row.key.deformer != deformer) continue;
                    is_run = true;
                    if (takes_part(comparison, row.key, best)) points.push_back(&row);
                }
                Omission blank{comparison, case_name(rows.front().of), deformer};
                if (points.empty()) {
                    blank.why = is_run ? "no_such_code" : "not_run";
                    omissions.push_back(blank);
                    continue;
                }
                for (const Omission& omission : omissions_in(points, reference, blank)) omissions.push_back(omission);
            }
        }
    return omissions;
}

std::vector<Omission> omissions_of_means(const std::vector<Omission>& of_cases, const std::vector<Diagram>& diagrams)
{
    std::vector<Omission> all;
    for (const Diagram& mean : diagrams) {
        std::vector<Omission> of_mean;
        for (const Omission& one : of_cases) {
            const bool is_of_mean = one.comparison == mean.comparison && std::ranges::find(mean.cases, one.of) != mean.cases.end();
            if (!is_of_mean) continue;
            const auto same = std::ranges::find_if(
                of_mean, [&](const Omission& other) { return other.deformer == one.deformer && other.why == one.why; });
            if (same != of_mean.end()) {
                same->missing += one.missing;
                same->points += one.points;
                continue;
            }
            of_mean.push_back(one);
            of_mean.back().of = mean.key;
        }
        all.insert(all.end(), of_mean.begin(), of_mean.end());
    }
    return all;
}

}  // namespace experiments
