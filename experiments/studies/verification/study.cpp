// The verification of the reference: patch tests, manufactured solutions, closed forms and published benchmarks, each
// problem a run of its own. No claim depends on it; it shows how far the reference itself can be trusted. The rows are
// in DIR/verification/verification.csv.
#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/input_error.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

// Loads deal.II, when the study is planned or run.
const std::vector<VerificationProblem>& problems_of_module()
{
    return *load_module_with_blas("pbskin_verification")
                .function<decltype(pbskin_verification_problems)>("pbskin_verification_problems")();
}

pbs::Character limb(int vertices)
{
    return pbs::make_character({.body = "limb", .vertices = vertices});
}

struct VerificationCase {
    std::string problem;
    bool full = false;
};

RECORD_SETTINGS(VerificationCase, problem, full)

std::string solve_and_record(const VerificationCase& verification_case, const std::string& folder)
{
    const auto& problems = problems_of_module();
    const auto problem = std::find_if(problems.begin(), problems.end(),
                                      [&](const auto& one) { return one.name == verification_case.problem; });
    const VerificationRows rows = problem->rows({{.full = verification_case.full}, limb});
    std::string breakdown;
    for (const VerificationRow& row : rows)
        if (!std::isfinite(row.value))
            breakdown +=
                fmt::format("{} of {} on {} is not finite. ", row.quantity.description, row.elements.text(), row.mesh);
    table_of(reference_fem::verification_columns(), rows).write(analysis::path_in(folder, "rows.csv"));
    return breakdown;
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    try {
        for (const VerificationProblem& problem : problems_of_module())
            plan.runs.push_back(work_run<VerificationCase>(problem.name, {problem.name, full},
                                                           full ? problem.full_s : problem.quick_s, solve_and_record));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back(
            {"verification", error.what() + std::string("; `cmake --build build/release` builds it")});
    }
    return plan;
}

// Every problem has rows, and every row with bounds holds.
bool conclude(const FinishedRuns& finished)
{
    const VerificationRows rows = finished.rows(reference_fem::verification_columns(), "rows.csv");
    if (!rows.empty()) finished.write("verification.csv", reference_fem::verification_columns(), rows);
    bool all_hold = !rows.empty() && finished.missing.empty();
    for (const VerificationRow& row : rows) {
        if (holds(row).value_or(true)) continue;
        spdlog::error("pbskin: {} does not hold: {}, {}, {}: {:.6g} {}", row.problem, row.quantity.description,
                      row.elements.text(), row.mesh, row.value, row.unit);
        all_hold = false;
    }
    return all_hold;
}

}  // namespace

Study verification_study()
{
    return {"verification", plan, full_in_short, conclude};
}

}  // namespace experiments
