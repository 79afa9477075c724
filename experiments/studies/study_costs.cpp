#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>

namespace experiments {
namespace {

struct RecordedCost {
    std::optional<double> cpu_s;  // of its process with all threads; records of some versions lack it
    std::optional<double> wall_s;
};

std::optional<double> number_at(const nlohmann::json& run, const char* pointer)
{
    const nlohmann::json::json_pointer place(pointer);
    return run.contains(place) && run.at(place).is_number() ? std::optional(run.at(place).get<double>()) : std::nullopt;
}

const analysis::Columns<RunCost> cost_columns =
    analysis::Columns<RunCost>{{"run", &RunCost::run, "", "name of the run"},
                               {"expected_cpu_s", &RunCost::expected_s, "s", "processor time that the plan expects"},
                               {"cpu_s", &RunCost::cpu_s, "s", "processor time that it took"}} +
    analysis::Columns<RunCost>{{"wall_s", &RunCost::wall_s, "s", "wall time that it took"}}.in_group("wall");

// Nothing if the run did not finish.
std::optional<RecordedCost> recorded_cost(const std::filesystem::path& folder)
{
    if (!std::filesystem::exists(folder / "run.json")) return std::nullopt;
    const auto run = nlohmann::json::parse(analysis::read_text((folder / "run.json").string()), nullptr, false);
    const char* cpu_s = run.contains("cost") ? "/cost/cpu_seconds/total" : "/outcome/cpu_seconds";
    return RecordedCost{number_at(run, cpu_s), number_at(run, "/outcome/wall_s")};
}

}  // namespace

StudyCosts::StudyCosts(const std::string& folder) : file_((std::filesystem::path(folder) / "costs.csv").string())
{
    if (!std::filesystem::exists(file_)) return;
    runs_ = rows_of(cost_columns, analysis::read_csv(file_));
}

void StudyCosts::add(const std::string& run, double expected_s, double cpu_s)
{
    std::erase_if(runs_, [&](const RunCost& cost) { return cost.run == run; });
    runs_.push_back({run, expected_s, cpu_s});
}

void StudyCosts::complete(const std::string& folder, const StudyPlan& plan)
{
    std::vector<RunCost> ordered;
    for (const StudyRun& run : plan.runs) {
        const auto recorded = recorded_cost(std::filesystem::path(folder) / run.name);
        if (!recorded) continue;
        const auto row = std::find_if(runs_.begin(), runs_.end(), [&](const RunCost& cost) { return cost.run == run.name; });
        if (row == runs_.end() && !recorded->cpu_s) continue;
        ordered.push_back(row != runs_.end() ? *row : RunCost{run.name, run.cost_s, *recorded->cpu_s});
        ordered.back().wall_s = recorded->wall_s;
    }
    runs_ = ordered;
}

void StudyCosts::write() const
{
    table_of(cost_columns, runs_).write(file_);
}

double StudyCosts::expected_s() const
{
    return std::accumulate(runs_.begin(), runs_.end(), 0.0, [](double sum, const RunCost& cost) { return sum + cost.expected_s; });
}

double StudyCosts::cpu_s() const
{
    return std::accumulate(runs_.begin(), runs_.end(), 0.0, [](double sum, const RunCost& cost) { return sum + cost.cpu_s; });
}

ExpectedCost expected_cost(const Study& study, const std::vector<StudyRun>& runs, int jobs)
{
    ExpectedCost cost{.study = study.name, .runs = static_cast<int>(runs.size())};
    double longest_s = 0.0;
    for (const StudyRun& run : runs) {
        cost.cpu_s += run.cost_s;
        longest_s = std::max(longest_s, run.cost_s);
    }
    cost.wall_s = std::max(longest_s, cost.cpu_s / (study.alone ? 1 : jobs));
    return cost;
}

std::string expected_cost_table(const std::vector<ExpectedCost>& costs)
{
    std::string table = fmt::format("{:<16} {:>6} {:>16} {:>10}\n", "study", "runs", "expected cpu [s]", "wall [min]");
    ExpectedCost sum{.study = "all"};
    const auto line = [](const ExpectedCost& cost) {
        return fmt::format("{:<16} {:>6} {:>16.0f} {:>10.1f}\n", cost.study, cost.runs, cost.cpu_s, cost.wall_s / 60.0);
    };
    for (const ExpectedCost& cost : costs) {
        table += line(cost);
        sum.runs += cost.runs;
        sum.cpu_s += cost.cpu_s;
        sum.wall_s += cost.wall_s;
    }
    return table + line(sum);
}

std::string cost_table(const std::vector<std::pair<std::string, StudyCosts>>& studies)
{
    std::string table = fmt::format("{:<16} {:>18} {:>12} {:>7}\n", "study", "expected cpu [s]", "cpu [s]", "ratio");
    for (const auto& [name, costs] : studies) {
        constexpr double too_short_to_matter_s = 5.0;
        const double ratio = costs.cpu_s() / std::max(costs.expected_s(), 1e-9);
        const bool is_outside = std::abs(costs.cpu_s() - costs.expected_s()) > too_short_to_matter_s && (ratio > 2.0 || ratio < 0.5);
        table += fmt::format("{:<16} {:>18.0f} {:>12.0f} {:>7.2f}{}\n", name, costs.expected_s(), costs.cpu_s(), ratio,
                             is_outside ? "  not within a factor of 2" : "");
    }
    return table;
}

}  // namespace experiments
