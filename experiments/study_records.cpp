#include "experiments/study_records.hpp"

#include "analysis/atomic_file.hpp"
#include "analysis/measurement.hpp"

#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string plan_file(const std::string& folder)
{
    return (fs::path(folder) / "plan.json").string();
}

nlohmann::json read_plan(const std::string& folder)
{
    return nlohmann::json::parse(analysis::read_text(plan_file(folder)));
}

void add_run(analysis::Records& records, const fs::path& folder, const std::string& name, bool beside)
{
    if (const fs::path printed = folder / "printed.csv"; fs::exists(printed))
        for (auto& figure : analysis::printed_figures(printed.string())) records.printed.push_back(std::move(figure));
    if (const fs::path measured = folder / "measurements.csv"; fs::exists(measured))
        for (auto& measurement : analysis::measurements(measured.string())) {
            measurement.run = name;
            records.measurements.push_back(std::move(measurement));
        }
    if (const fs::path metrics = folder / "metrics.csv"; fs::exists(metrics))
        for (auto& record : analysis::case_records(analysis::read_csv(metrics.string()), name)) {
            record.beside = beside;
            records.cases.push_back(std::move(record));
        }
}

}  // namespace

void write_study_plan(const std::string& folder, const StudyPlan& plan)
{
    auto runs = nlohmann::json::array(), left_out = nlohmann::json::array();
    for (const StudyRun& run : plan.runs) {
        nlohmann::json entry = {{"name", run.name}, {"cost_s", run.cost_s}};
        if (!run.work) entry["scene"] = run.scene.name;
        if (run.beside) entry["beside"] = true;
        runs.push_back(entry);
    }
    for (const analysis::LeftOut& out : plan.left_out) left_out.push_back({{"scene", out.scene}, {"reason", out.reason}});
    const char* extent = plan.extent == Extent::full ? "full" : "quick";
    fs::create_directories(folder);
    analysis::write_text_atomically(
        plan_file(folder), nlohmann::json{{"schema", 1}, {"extent", extent}, {"runs", runs}, {"left_out", left_out}}.dump(2) + "\n");
}

bool has_study_plan(const std::string& folder)
{
    return fs::exists(plan_file(folder));
}

std::vector<std::string> finished_runs(const std::string& folder)
{
    std::vector<std::string> finished;
    const nlohmann::json plan = read_plan(folder);
    for (const auto& run : plan.at("runs")) {
        const fs::path of_run = fs::path(folder) / run.at("name").get<std::string>();
        if (fs::exists(of_run / "run.json")) finished.push_back(of_run.string());
    }
    return finished;
}

analysis::Records read_study_records(const std::string& folder, const std::string& root)
{
    analysis::Records records;
    const nlohmann::json plan = read_plan(folder);
    for (const auto& out : plan.at("left_out")) records.left_out.push_back({out.at("scene"), out.at("reason")});
    for (const auto& run : plan.at("runs"))
        if (run.contains("scene")) records.planned_scenes.push_back(run.at("scene"));
    for (const auto& out : records.left_out) records.planned_scenes.push_back(out.scene);
    for (const auto& run : plan.at("runs")) {
        const fs::path of_run = fs::path(folder) / run.at("name").get<std::string>();
        if (fs::exists(of_run / "run.json"))
            add_run(records, of_run, of_run.lexically_relative(root).string(), run.value("beside", false));
        else
            records.missing_runs.push_back(run.at("name"));
    }
    return records;
}

}  // namespace experiments
