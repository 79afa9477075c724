// The volume study (claims C01, C02): how much volume each deformer loses, by pose, and at which bones and joints.
//
//   limb_twist   0 - 180 deg    o=======o~~~~~~~o)  the forearm turns about its own axis
//   limb_bend    0 - 150 deg    o=======o           the forearm turns about z, also with Eq. 12-20 as printed
//   BODY_CLIP                                       CMU's clips on the installed bodies
//   BODY_range_MOVEMENT                             joints through their range of motion, for the held-out cases
//
// README.md describes the runs, deformers and records. Besides the scene's own order of projection PBS has each other
// order and precision, so that the report can say whether the verdict depends on it.
#include "experiments/run/region_record.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

// PBS with other settings, as the tables [[added]] state them.
std::vector<DeformerSpec> added_to(const StudyCase& study_case)
{
    static const nlohmann::json tables = cases_document("volume").at("added");
    std::vector<DeformerSpec> added;
    const auto add = [&](const std::string& name, const Overrides& further = {}) {
        const auto named =
            std::ranges::find_if(tables, [&](const nlohmann::json& table) { return table.at("name") == name; });
        if (named == tables.end()) throw std::logic_error("volume/cases.toml: no table `added` of the name " + name);
        for (const nlohmann::json& pbs : named->at("pbs")) added.push_back(study_case.further_pbs(pbs, further));
    };
    for (const std::string& name : study_case.value<std::vector<std::string>>("add", {})) add(name);
    if (study_case.has("k_in_zone"))
        add("jiggle", {fmt::format("pbs.jiggle.k_stretch={}", study_case.value<double>("k_in_zone"))});
    return added;
}

void add_case(const StudyCase& study_case, StudyPlan& plan)
{
    const std::vector<DeformerSpec> added = added_to(study_case);
    const auto add_run = [&](const std::string& name, const Overrides& overrides) {
        StudyRun& run = plan.runs.emplace_back(study_case.scene_run(name, overrides));
        run.beside = study_case.value("beside", false);
        run.bad_frames_are_results = study_case.value("goes_on", false);
        run.scene.deformers.insert(run.scene.deformers.end(), added.begin(), added.end());
    };
    if (!study_case.value("through_movements", false)) return add_run(study_case.name, {});
    for (const std::string& movement : movements_of(pbs::make_character(study_case.scene().character).skeleton))
        add_run(study_case.name + "_" + movement, {fmt::format("motion.movements=['{}']", movement)});
}

StudyPlan plan(bool full)
{
    return plan_of_cases("volume", full, add_case);
}

bool conclude(const FinishedRuns& finished)
{
    std::vector<std::string> columns = region_columns.names();
    columns.insert(columns.begin(), "run");
    analysis::CsvTable regions(columns, "regions.csv");
    for (const std::string& file : finished.files("regions.csv")) {
        const std::string run = std::filesystem::path(file).parent_path().filename().string();
        for (const analysis::CsvTable::Row& row : analysis::read_csv(file)) {
            std::vector<analysis::CsvTable::Cell> cells = {run};
            for (const auto& column : region_columns) cells.emplace_back(row.text(column.name));
            regions.add_row(cells);
        }
    }
    finished.write("regions.csv", regions);
    return true;
}

}  // namespace

Study volume_study()
{
    return {"volume", plan, quick_and_full, conclude, false, nullptr, add_case};
}

}  // namespace experiments
