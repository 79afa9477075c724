// What studies conclude follows from the rows that are kept with it. Reference: the kept values, which
// tests/regression/decisions.py and tests/claims/concluded.py compute a second time from the same rows.
#include "analysis/records/record_files.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "experiments/studies/work_precision/conclusions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>

namespace kept_values {
namespace {

using namespace experiments;
using analysis::CsvTable;

CsvTable kept(const std::string& name)
{
    const std::string file = PBS_KEPT_RECORDS "/" + name;
    return analysis::parse_csv(kept_text(file), file);
}

// points.csv of the chosen settings. errors.csv repeats a point at each time that has the setting.
CsvTable kept_points()
{
    const auto columns = MEMBER_COLUMNS(PointRow, method, pose, body, stratum, ms, skin_mm) +
                         analysis::within(&PointRow::errors, member_error_columns());
    const CsvTable errors = kept("work_precision/errors.csv");
    std::vector<PointRow> points = rows_of(columns, errors), unique;
    std::set<std::tuple<std::string, std::string, GivenFlesh, std::string>> seen;
    for (int row = 0; row < errors.rows(); ++row) {
        PointRow& point = points[row];
        const bool is_known = errors[row].has({{"table", ComparisonTable::known}});
        if (std::ranges::find(methods(), point.method, &ComparedMethod::name)->takes_flesh())
            point.flesh = is_known ? GivenFlesh::own : GivenFlesh::standard;
        for (const ChosenSetting& chosen : kept_settings())
            if (chosen.method == point.method && chosen.budget_ms == errors.number(row, "budget_ms"))
                point.setting = chosen.setting;
        if (seen.emplace(point.method, point.setting, point.flesh, point.pose).second) unique.push_back(point);
    }
    return table_of(point_columns, unique);
}

// Both compute from the same digits. log and exp of another processor's library may round in another direction.
bool is_close(const std::string& now, const std::string& before)
{
    const double a = std::atof(now.c_str()), b = std::atof(before.c_str());
    return now == before || (a != 0.0 && std::abs(a - b) <= 1e-9 * std::abs(b));
}

// At the times of the tables, whose points are kept. left_out: columns that need more of a point than its errors.
void expect_kept(const CsvTable& now, const std::string& name, const std::set<std::string>& left_out = {})
{
    const auto is_of_tables = [](const CsvTable::Row& row) {
        return std::ranges::count(comparison_times().tables_ms, row.number("budget_ms")) > 0;
    };
    const CsvTable table = now.where(is_of_tables), before = kept(name).where(is_of_tables);
    ASSERT_GT(table.rows(), 0);
    ASSERT_EQ(table.columns(), before.columns()) << name;
    ASSERT_EQ(table.rows(), before.rows()) << name;
    for (int row = 0; row < table.rows(); ++row)
        for (const std::string& column : table.columns())
            EXPECT_TRUE(left_out.contains(column) || is_close(table.text_at(row, column), before.text_at(row, column)))
                << name << ", row " << row << ", " << column << ": " << table.text_at(row, column) << ", kept "
                << before.text_at(row, column);
}

TEST(KeptComparison, FollowsFromTheErrorsOfEachPose)
{
    const Comparison comparison = concluded(kept_points(), kept("work_precision/references.csv"), kept_settings());
    expect_kept(comparison.methods, "work_precision/methods.csv", {"times_pbs", "inverted_poses"});
    expect_kept(comparison.pairs, "work_precision/pairs.csv");
    expect_kept(comparison.decisions, "work_precision/decisions.csv");
    expect_kept(comparison.curves, "work_precision/curves.csv");
    expect_kept(comparison.profiles, "work_precision/profiles.csv");
    expect_kept(comparison.errors, "work_precision/errors.csv");
}

// Relative. Rows are kept with six digits: a quotient of two of them moves by half a unit of the last digit of each.
constexpr double of_a_quotient = 2.1 * 5e-6;

// by run
std::map<std::string, CsvTable> kept_runs(const std::string& name)
{
    std::map<std::string, CsvTable> runs;
    for (const CsvTable& run : kept(name).groups({"run"})) runs.emplace(run[0].text("run"), run);
    return runs;
}

// now: values of one run. Returns how many of them were compared.
std::size_t expect_kept(const std::vector<analysis::Measurement>& now, const CsvTable& before, double tolerance)
{
    const analysis::ScratchFolder folder;
    before.write(folder / "measurements.csv");
    const auto recorded = analysis::measurements(folder / "measurements.csv");
    for (const analysis::Measurement& value : now) {
        const analysis::Measurement* same = find_measurement(recorded, value.quantity, value.of);
        EXPECT_TRUE(same) << value.quantity << ", " << text_of(value.of);
        for (const auto number :
             {&analysis::Measurement::value, &analysis::Measurement::low, &analysis::Measurement::high})
            EXPECT_TRUE(!same || (std::isnan(value.*number) && std::isnan(same->*number)) ||
                        std::abs(value.*number - same->*number) <= tolerance * std::abs(same->*number))
                << value.quantity << ", " << text_of(value.of) << ": " << value.*number << ", kept " << same->*number;
    }
    return now.size();
}

TEST(KeptJiggle, FollowsFromTheResponses)
{
    const std::map<std::string, CsvTable> responses = kept_runs("jiggle/runs/responses.csv"),
                                          measurements = kept_runs("jiggle/runs/measurements.csv");
    std::size_t values = 0;
    for (const auto& [run, rows] : responses) {
        if (!run.ends_with("_jolt")) continue;  // another run records the finite elements alone
        const CsvTable& recorded = measurements.at(run);
        values += expect_kept(jiggle_values(recorded[0].text("body"), rows_of(response_columns, rows)), recorded,
                              of_a_quotient);
    }
    EXPECT_GT(values, 200u);
}

TEST(KeptStiffness, FollowsFromTheStiffnessOfEachSetting)
{
    const std::map<std::string, CsvTable> stiffnesses = kept_runs("stiffness/runs/stiffness.csv"),
                                          measurements = kept_runs("stiffness/runs/measurements.csv");
    const CsvTable exponents = kept("stiffness/exponents.csv");
    std::size_t values = 0;
    int compared = 0;
    for (const Varied varied : {Varied::iterations, Varied::time_step, Varied::resolution}) {
        std::vector<StiffnessRow> all;
        for (const auto& [run, rows] : stiffnesses) {
            if (!run.starts_with(name_of(varied))) continue;
            const auto of_run = rows_of(stiffness_columns, rows);
            all.insert(all.end(), of_run.begin(), of_run.end());
            values += expect_kept(stiffness_ratios(of_run, varied), measurements.at(run), of_a_quotient);
        }
        const CsvTable now = stiffness_exponents(all, varied), before = exponents.where("varied", varied);
        ASSERT_EQ(now.rows(), before.rows());
        for (int row = 0; row < now.rows(); ++row, ++compared)
            for (const std::string& column : now.columns()) {
                if (column == "exponent_low" || column == "exponent_high")
                    continue;  // of few points, they are far more sensitive
                if (column == "exponent")
                    EXPECT_NEAR(now.number(row, column), before.number(row, column), of_a_quotient) << row;
                else
                    EXPECT_EQ(now.text_at(row, column), before.text_at(row, column)) << row << ", " << column;
            }
    }
    EXPECT_GT(values, 100u);
    EXPECT_EQ(compared, exponents.rows());
}

}  // namespace
}  // namespace kept_values
