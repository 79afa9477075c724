// The kept records, read as rows and written again, have the same columns and cells. Reference: the files, which earlier versions wrote.
#include "analysis/records/record_files.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/studies/ambiguity/readings.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/ensemble/ensemble.hpp"
#include "experiments/studies/fit/fit.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "experiments/studies/timing/equal_quality.hpp"
#include "experiments/studies/timing/features.hpp"
#include "experiments/studies/timing/frames.hpp"
#include "experiments/studies/work_precision/diagram.hpp"
#include "experiments/studies/work_precision/gains.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace {

namespace fs = std::filesystem;

// The columns of a file, in its order; some kept records lack columns. std::out_of_range for a column that is not declared.
template <typename Row>
analysis::Columns<Row> columns_in(const analysis::CsvTable& table, const analysis::Columns<Row>& all)
{
    analysis::Columns<Row> columns;
    for (const std::string& name : table.columns()) columns.push_back(all.named(name));
    return columns;
}

// Equal texts, or equal numbers in different spelling: 1.728e+07, 17280000.
bool is_same_cell(const std::string& one, const std::string& other)
{
    if (one == other) return true;
    char *end_of_one = nullptr, *end_of_other = nullptr;
    const double value = std::strtod(one.c_str(), &end_of_one), other_value = std::strtod(other.c_str(), &end_of_other);
    return !one.empty() && !other.empty() && *end_of_one == 0 && *end_of_other == 0 && value == other_value;
}

void expect_same_cells(const analysis::CsvTable& written, const analysis::CsvTable& kept, const std::string& file)
{
    const auto sorted = [](std::vector<std::string> names) {
        return std::ranges::sort(names), names;
    };  // a table of several runs unites theirs
    ASSERT_EQ(sorted(written.columns()), sorted(kept.columns())) << file;
    ASSERT_EQ(written.rows(), kept.rows()) << file;
    for (int row = 0; row < kept.rows(); ++row)
        for (const std::string& column : kept.columns())
            EXPECT_PRED2(is_same_cell, written.text_at(row, column), kept.text_at(row, column))
                << file << ", row " << row << ", " << column;
}

template <typename Row>
void expect_same_file(const analysis::Columns<Row>& columns, const std::string& file)
{
    const analysis::CsvTable table = analysis::read_csv((fs::path(PBS_KEPT_RECORDS) / file).string());
    expect_same_cells(table_of(columns, rows_of(columns, table)), table, file);
}

// A file that sums up a study.
template <typename Row>
void expect_same_sum(const analysis::Columns<Row>& all, const std::string& file)
{
    const analysis::CsvTable table = analysis::read_csv((fs::path(PBS_KEPT_RECORDS) / file).string());
    ASSERT_GT(table.rows(), 0) << file;
    const analysis::Columns<Row> columns = columns_in(table, all);
    expect_same_cells(table_of(columns, rows_of(columns, table)), table, file);
}

// The rows of all runs, without the first column, which names the run. A row without further cells states that a run has none.
std::string without_runs(const fs::path& merged)
{
    std::istringstream lines(analysis::read_text(merged.string()));
    std::string text, line;
    while (std::getline(lines, line))
        if (line.find_first_not_of(',', line.find(',')) != std::string::npos) text += line.substr(line.find(',') + 1) + '\n';
    return text;
}

// The tables NAME of all runs of a study.
template <typename Row>
void expect_same_records(const analysis::Columns<Row>& all, const std::string& study, const std::string& name, bool is_complete = true)
{
    const fs::path file = fs::path(PBS_KEPT_RECORDS) / study / "runs" / name;
    ASSERT_GT(analysis::read_csv(file.string()).rows(), 0) << file;
    const analysis::CsvTable table = analysis::parse_csv(without_runs(file), file.string());
    const analysis::Columns<Row> columns = is_complete ? all : columns_in(table, all);
    expect_same_cells(table_of(columns, rows_of(columns, table)), table, file.string());
}

TEST(KeptTables, OfRuns)
{
    expect_same_records(experiments::metric_columns(), "volume", "metrics.csv", false);
    expect_same_records(experiments::region_columns, "volume", "regions.csv");
}

TEST(KeptTables, OfArtefacts)
{
    expect_same_records(experiments::section_columns, "artefacts", "sections.csv");
    expect_same_records(experiments::profile_columns, "artefacts", "profiles.csv");
    expect_same_records(experiments::intersection_columns, "artefacts", "intersections.csv");
    expect_same_records(experiments::smoothness_columns, "artefacts", "smoothness.csv");
    expect_same_records(experiments::weight_iteration_columns, "artefacts", "iterations.csv");
}

TEST(KeptTables, OfJiggle)
{
    expect_same_records(experiments::response_columns, "jiggle", "responses.csv");
    expect_same_records(experiments::zone_columns, "jiggle", "zone.csv");
    expect_same_records(experiments::walk_columns, "jiggle", "walk.csv");
}

TEST(KeptTables, OfBodiesUnderLoad)
{
    expect_same_records(experiments::stiffness_columns, "stiffness", "stiffness.csv");
    expect_same_sum(experiments::exponent_columns(), "stiffness/exponents.csv");
    expect_same_records(experiments::sag_columns, "fit", "sag.csv");
}

TEST(KeptTables, OfAmbiguity)
{
    expect_same_records(experiments::claim_change_columns(), "ambiguity", "ambiguity.csv", false);
    expect_same_records(experiments::volume_change_columns, "ambiguity", "figures.csv");
}

TEST(KeptTables, OfTimedStudies)
{
    expect_same_records(experiments::timing_columns, "timing", "timing.csv");
    expect_same_records(experiments::feature_columns, "timing", "features.csv");
    expect_same_records(experiments::change_columns, "work_precision", "changes.csv");
}

TEST(KeptTables, OfTheOrders)
{
    expect_same_records(experiments::order_columns, "timing", "orders.csv");
    expect_same_records(experiments::target_columns, "timing", "targets.csv");
    expect_same_sum(experiments::answer_columns, "timing/answers.csv");
}

TEST(KeptTables, OfTheVerification)
{
    expect_same_file(reference_fem::verification_columns(), "verification/verification.csv");
}

TEST(KeptTables, OfTheOtherStudies)
{
    expect_same_records(experiments::rate_columns, "convergence", "rates.csv");
    expect_same_records(experiments::towards_columns, "convergence", "towards.csv");
    expect_same_records(experiments::cell_columns, "stability", "cells.csv");
    expect_same_records(experiments::start_columns, "stability", "starts.csv");
    expect_same_records(experiments::part_columns, "ensemble", "parts.csv");
    expect_same_records(experiments::attachment_columns, "ensemble", "attachments.csv");
}

TEST(KeptTables, OfTheComparison)
{
    expect_same_records(experiments::point_columns, "work_precision", "points.csv", false);  // without those of other programs
    expect_same_records(experiments::family_columns, "work_precision", "members.csv");
    expect_same_sum(experiments::chosen_columns, "work_precision/settings.csv");
    expect_same_sum(experiments::budget_columns, "work_precision/best_within.csv");
    expect_same_sum(experiments::data_profile_columns, "work_precision/data_profiles.csv");
    expect_same_sum(experiments::omission_columns, "work_precision/omissions.csv");
}

TEST(KeptTables, ThatSumUpAStudy)
{
    expect_same_sum(experiments::cell_columns, "stability/map_time_step_k_stretch.csv");
    expect_same_sum(experiments::cell_columns, "stability/map_iterations_twist.csv");
    expect_same_sum(experiments::start_columns, "stability/starts.csv");
    expect_same_sum(experiments::equal_time_columns, "work_precision/equal_time.csv");
    expect_same_sum(experiments::gain_columns, "work_precision/gains.csv");
    expect_same_sum(experiments::curve_columns, "work_precision/curves.csv");
    expect_same_sum(experiments::pair_columns, "ensemble/pairs.csv");
    expect_same_sum(experiments::member_columns, "ensemble/members.csv");
}

TEST(KeptTables, OfSetups)
{
    expect_same_records(experiments::trial_columns, "setup", "trials.csv");
    expect_same_records(experiments::key_columns, "setup", "changed_keys.csv");
}

// No two rows of verification.csv share these; description and mesh are words for readers.
TEST(KeptTables, OfTheVerificationIdentifyEachRow)
{
    const analysis::CsvTable table = analysis::read_csv((fs::path(PBS_KEPT_RECORDS) / "verification/verification.csv").string());
    std::set<std::vector<std::string>> keys;
    for (int row = 0; row < table.rows(); ++row) {
        std::vector<std::string> key;
        for (const char* column : {"problem", "quantity", "setting", "element_order", "formulation", "material", "poisson", "h_m", "dofs"})
            key.push_back(table.text_at(row, column));
        EXPECT_TRUE(keys.insert(key).second) << "row " << row << ": " << testing::PrintToString(key);
    }
    EXPECT_GT(keys.size(), 200u);
}

// The columns for readers: sentences, sources, units and names of hardware. Everything else identifies a row or is a number.
bool has_words(const std::string& file, const std::string& column)
{
    static const std::set<std::string> of_any_file = {"bound",  "bound_from", "cpu_model", "description", "note",
                                                      "reason", "remark",     "source",    "unit",        "verdict_changed"};
    static const std::set<std::string> of_one_file = {"points.csv beside", "verification.csv mesh"};
    return of_any_file.contains(column) || of_one_file.contains(file + " " + column);
}

// A joint is named by its two bones: upper|forearm. undecided_against lists the keys of groups.
TEST(KeptTables, HaveIdentifiersInTheirKeys)
{
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.+-";
    int cells = 0;
    for (const auto& entry : fs::recursive_directory_iterator(PBS_KEPT_RECORDS)) {
        if (entry.path().extension() != ".csv") continue;
        const analysis::CsvTable table = analysis::read_csv(entry.path().string());
        for (const std::string& column : table.columns()) {
            if (has_words(entry.path().filename().string(), column)) continue;
            const std::string allowed = letters + (column == "joint" ? "|" : column == "undecided_against" ? " " : "");
            for (int row = 0; row < table.rows(); ++row, ++cells)
                EXPECT_EQ(table.text_at(row, column).find_first_not_of(allowed), std::string::npos)
                    << entry.path() << ", row " << row << ", " << column << ": " << table.text_at(row, column);
        }
    }
    EXPECT_GT(cells, 100000);
}

// Their columns are the fields of a key that any row has, and those of every row.
TEST(KeptTables, OfMeasuredAndPrintedValues)
{
    const analysis::ScratchFolder scratch;
    const std::string table = scratch / "table.csv";
    int measured = 0, printed = 0;
    for (const auto& entry : fs::recursive_directory_iterator(PBS_KEPT_RECORDS)) {
        const std::string file = entry.path().string(), name = entry.path().filename().string();
        if (name == "measurements.csv" || name == "printed.csv") analysis::write_text_atomically(table, without_runs(file));
        if (name == "measurements.csv") {
            expect_same_cells(analysis::measurement_table(analysis::measurements(table)), analysis::read_csv(table), file);
            ++measured;
        }
        if (name == "setup.csv")
            expect_same_cells(analysis::measurement_table(analysis::measurements(file)), analysis::read_csv(file), file);
        if (name == "printed.csv") {
            expect_same_cells(analysis::printed_table(analysis::printed_values(table)), analysis::read_csv(table), file);
            ++printed;
        }
    }
    EXPECT_GT(measured, 6);
    EXPECT_EQ(printed, 1);
}

}  // namespace
