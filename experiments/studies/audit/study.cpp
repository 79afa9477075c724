// The paper against itself: its mesh sizes, its Table 1 and its equations for the volume constraint. Writes DIR/audit/print/printed.csv,
// by which C13 to C15 are judged, and audit.md.
#include "analysis/records/record_files.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/audit/printed_equations.hpp"
#include "experiments/studies/shared/table_1.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

// The random tets on which the printed equations are evaluated.
struct AuditCase {
    int tets = 200;
    unsigned seed = 1;
};

nlohmann::json to_json(const AuditCase& of)
{
    static const auto fields =
        OptionFields<AuditCase>("audit").record("tets", &AuditCase::tets).record("seed", &AuditCase::seed).complete();
    return fields.json(of);
}

std::string audit_print(const AuditCase& of, const std::string& folder)
{
    std::vector<analysis::PrintedValue> all;
    for (const auto& values : {mesh_size_values(), table_1_values(), equation_values(of.tets, of.seed)})
        all.insert(all.end(), values.begin(), values.end());
    analysis::printed_table(all).write(analysis::path_in(folder, "printed.csv"));
    return {};
}

std::string bound_text(const analysis::PrintedValue& value)
{
    if (std::isinf(value.most)) return fmt::format("{:.6g} or more", value.least);
    if (value.least == value.most) return fmt::format("{:.6g}", value.least);
    return fmt::format("{:.6g} to {:.6g}", value.least, value.most);
}

StudyPlan plan(bool)
{
    return {{work_run("print", AuditCase{}, 1.0, audit_print)}, {}};
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string page = "| claim | quantity | of | printed | follows from the rest | consistent |\n|---|---|---|---|---|---|\n";
    for (const std::string& file : finished.files("printed.csv"))
        for (const analysis::PrintedValue& value : analysis::printed_values(file))
            page += fmt::format("| {} | {} | {} | {:.6g} | {} | {} |\n", value.claim, value.quantity, text_of(value.of), value.printed,
                                bound_text(value), value.is_consistent() ? "yes" : "no");
    finished.write("audit.md", page);
    return {"", !finished.none()};
}

}  // namespace

Study audit_study()
{
    return {"audit", plan, quick_and_full, conclude};
}

}  // namespace experiments
