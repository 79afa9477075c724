// The verification of the reference: patch tests, manufactured solutions, closed forms and published benchmarks, each problem a run of its
// own. No claim depends on it; it shows how far the reference itself can be trusted. The rows are in DIR/verification/verification.csv,
// .json and .md.
#include "analysis/records/record_files.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/input_error.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// Loads deal.II, when the study is planned or run.
const std::vector<VerificationProblem>& problems_of_module()
{
    return *load_module_with_blas("pbskin_verification").function<decltype(pbskin_verification_problems)>("pbskin_verification_problems")();
}

pbs::Character limb(int vertices, int refinements)
{
    return pbs::make_character({.body = "limb", .vertices = vertices, .refinements = refinements});
}

struct VerificationCase {
    std::string problem;
    bool full = false;
};

RECORD_SETTINGS(VerificationCase, problem, full)

std::string solve_and_record(const VerificationCase& of, const std::string& folder)
{
    const auto& problems = problems_of_module();
    const auto problem = std::find_if(problems.begin(), problems.end(), [&](const auto& one) { return one.name == of.problem; });
    nlohmann::json json = nlohmann::json::array();
    std::string breakdown;
    for (const VerificationRow& row : problem->rows({{.full = of.full}, limb})) {
        json.push_back(to_json(row));
        if (!std::isfinite(row.value))
            breakdown += fmt::format("{} of {} on {} is not finite. ", row.quantity.description, row.elements.text(), row.mesh);
    }
    analysis::write_text_atomically((fs::path(folder) / "rows.json").string(), json.dump(2) + "\n");
    return breakdown;
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    try {
        for (const VerificationProblem& problem : problems_of_module())
            plan.runs.push_back(
                work_run<VerificationCase>(problem.name, {problem.name, full}, full ? problem.full_s : problem.quick_s, solve_and_record));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"verification", error.what() + std::string("; `cmake --build build/release` builds it")});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    StudyConclusion conclusion;
    VerificationRows rows;
    for (const std::string& file : finished.files("rows.json"))
        for (const auto& row : nlohmann::json::parse(analysis::read_text(file))) rows.push_back(reference_fem::verification_row(row));
    for (const std::string& run : finished.missing) conclusion.text += run + ": no rows, its run did not end\n";
    conclusion.holds = finished.missing.empty();
    if (rows.empty()) return {"verification: nothing was run\n", false};
    for (const VerificationRow& row : rows) conclusion.holds &= holds(row).value_or(true);
    write_verification_record(finished.folder, rows);
    conclusion.text = verification_table(rows) + conclusion.text;
    return conclusion;
}

}  // namespace

Study verification_study()
{
    return {"verification", plan, full_in_short, conclude};
}

}  // namespace experiments
