// The kept records are read as tables, have identifiers in their keys, and their conclusions follow from their values.
// Reference: the files, which earlier versions wrote.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/studies/work_precision/conclusions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

namespace {

namespace fs = std::filesystem;

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
    // a table of several runs unites theirs
    ASSERT_TRUE(std::ranges::is_permutation(written.columns(), kept.columns())) << file;
    ASSERT_EQ(written.rows(), kept.rows()) << file;
    for (int row = 0; row < kept.rows(); ++row)
        for (const std::string& column : kept.columns())
            EXPECT_PRED2(is_same_cell, written.text_at(row, column), kept.text_at(row, column))
                << file << ", row " << row << ", " << column;
}

// The rows of all runs, without the first column, which names the run. A row without further cells states that a run
// has none.
std::string without_runs(const fs::path& merged)
{
    std::istringstream lines(experiments::kept_text(merged.string()));
    std::string text, line;
    while (std::getline(lines, line))
        if (line.find_first_not_of(',', line.find(',')) != std::string::npos)
            text += line.substr(line.find(',') + 1) + '\n';
    return text;
}

// measurements.csv of measurements.csv.gz.
std::string name_of_table(const fs::path& file)
{
    return file.extension() == ".gz" ? file.stem().string() : file.filename().string();
}

// A table that is kept as NAME.csv or NAME.csv.gz.
analysis::CsvTable whole_table(fs::path file)
{
    if (!fs::exists(file)) file += ".gz";
    return analysis::parse_csv(experiments::kept_text(file.string()), file.string());
}

// A kept table. A table of all runs of a study, in the folder runs, is returned without its first column.
analysis::CsvTable kept_table(const std::string& name)
{
    const fs::path file = fs::path(PBS_KEPT_RECORDS) / name;
    const analysis::CsvTable table = whole_table(file);
    EXPECT_GT(table.rows(), 0) << file;
    return file.parent_path().filename() == "runs"
               ? analysis::parse_csv(without_runs(fs::exists(file) ? file : fs::path(file.string() + ".gz")),
                                     file.string())
               : table;
}

// No two rows of verification.csv share these; description and mesh are words for readers.
TEST(KeptTables, OfTheVerificationIdentifyEachRow)
{
    const analysis::CsvTable table = kept_table("verification/verification.csv");
    std::set<std::vector<std::string>> keys;
    for (int row = 0; row < table.rows(); ++row) {
        std::vector<std::string> key;
        for (const char* column :
             {"problem", "quantity", "setting", "element_order", "formulation", "material", "poisson", "h_m", "dofs"})
            key.push_back(table.text_at(row, column));
        EXPECT_TRUE(keys.insert(key).second) << "row " << row << ": " << testing::PrintToString(key);
    }
    EXPECT_GT(keys.size(), 200u);
}

// The columns for readers: sentences, sources, units and names of hardware. Everything else identifies a row or is a
// number.
bool has_words(const std::string& file, const std::string& column)
{
    static const std::set<std::string> of_any_file = {"bound", "bound_from",     "cpu_model", "description",
                                                      "note",  "reason",         "remark",    "source",
                                                      "unit",  "verdict_changed"};
    static const std::set<std::string> of_one_file = {"points.csv beside", "trials.csv failure",
                                                      "trials.csv further_keys", "verification.csv mesh"};
    return of_any_file.contains(column) || of_one_file.contains(file + " " + column);
}

// A joint is named by its two bones: upper|forearm. either_of and takes are lists, and a setting is a list of
// KEY=VALUE.
TEST(KeptTables, HaveIdentifiersInTheirKeys)
{
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.+-";
    int cells = 0;
    for (const auto& entry : fs::recursive_directory_iterator(PBS_KEPT_RECORDS)) {
        const std::string file = entry.path().string(), name = name_of_table(entry.path());
        if (!name.ends_with(".csv")) continue;
        const std::string text = experiments::kept_text(file);
        const analysis::CsvTable table = analysis::parse_csv(text, file);
        EXPECT_EQ(table.text(), text) << file << " as it is read and written again";
        for (const std::string& column : table.columns()) {
            if (has_words(name, column)) continue;
            const std::string allowed = letters + (column == "joint"                            ? "|"
                                                   : column == "setting"                        ? "= "
                                                   : column == "either_of" || column == "takes" ? " "
                                                                                                : "");
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
        const std::string file = entry.path().string(), name = name_of_table(entry.path());
        if (name == "measurements.csv" || name == "printed.csv")
            analysis::write_text_atomically(table, without_runs(file));
        if (name == "measurements.csv") {
            expect_same_cells(analysis::measurement_table(analysis::measurements(table)), analysis::read_csv(table),
                              file);
            ++measured;
        }
        if (name == "setup.csv")
            expect_same_cells(analysis::measurement_table(analysis::measurements(file)), analysis::read_csv(file),
                              file);
        if (name == "printed.csv") {
            expect_same_cells(analysis::printed_table(analysis::printed_values(table)), analysis::read_csv(table),
                              file);
            ++printed;
        }
    }
    EXPECT_GT(measured, 6);
    EXPECT_EQ(printed, 1);
}

// Every value on record that a study concludes from others follows from these, to the last digit. Reference: what
// earlier versions concluded while they measured. They are compared as written, since a control without amplitude
// concludes that a ratio is no number.
TEST(KeptTables, OfConclusionsFollowFromTheMeasuredValues)
{
    const experiments::OpenedRecords opened(PBS_KEPT_RECORDS);
    std::map<std::string, int> concluded;  // by study
    for (const experiments::Study& study : experiments::studies()) {
        if (!study.conclusions) continue;
        for (const std::string& run :
             experiments::finished_runs((fs::path(opened.folder()) / study.name).string()).folders) {
            const fs::path file = fs::path(run) / "measurements.csv";
            if (!fs::exists(file)) continue;
            const auto recorded = analysis::measurements(file.string());
            for (const analysis::Measurement& now : study.conclusions(recorded)) {
                const analysis::Measurement* before = find_measurement(recorded, now.quantity, now.of);
                ASSERT_TRUE(before) << run << ": " << now.quantity << ", " << text_of(now.of);
                EXPECT_EQ(analysis::measurement_table({now}).text(), analysis::measurement_table({*before}).text())
                    << run << ": " << now.quantity << ", " << text_of(now.of);
                ++concluded[study.name];
            }
        }
    }
    for (const auto& [study, at_least] :
         {std::pair("convergence", 4), std::pair("jiggle", 50), std::pair("timing", 25)})
        EXPECT_GE(concluded[study], at_least) << study;
}

const double six_digits = 1e-5;  // relative: half a unit of the last kept digit on either side

TEST(KeptValues, OfMotionFollowFromThePlayedFrames)
{
    const analysis::CsvTable kept = kept_table("work_precision/motion.csv"),
                             concluded = experiments::concluded_motion(kept_table("work_precision/runs/played.csv"),
                                                                       experiments::kept_settings());
    ASSERT_EQ(concluded.rows(), kept.rows());
    for (int i = 0; i < kept.rows(); ++i) {
        for (const char* column : {"clip", "budget_ms", "method", "setting", "member", "frames"})
            EXPECT_EQ(concluded.text_at(i, column), kept.text_at(i, column));
        for (const char* column : {"cold_share", "played_share", "cold_skin_mm", "played_skin_mm"})
            EXPECT_NEAR(concluded.number(i, column), kept.number(i, column), six_digits * kept.number(i, column))
                << concluded.text_at(i, "method") << ", " << concluded.text_at(i, "setting");
    }
}

}  // namespace
