// Values that several studies measure are the same in all of them. Reference: the kept records.
#include "analysis/records/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using Wanted = std::map<std::string, std::string>;

struct KeptValue {
    std::string file;  // STUDY/RUN/TABLE, which the kept records have in STUDY/runs/TABLE
    Wanted wanted;     // cells of its row
    std::string column = "error_joint_pct";
};

bool is_wanted(const analysis::CsvTable& table, int row, const Wanted& wanted)
{
    return std::ranges::all_of(wanted, [&](const auto& cell) { return table.text_at(row, cell.first) == cell.second; });
}

// Nothing if there is no such row, or more than one.
std::optional<double> only_value(const KeptValue& of)
{
    const std::filesystem::path file = of.file, run = file.parent_path();
    const auto merged = std::filesystem::path(PBS_KEPT_RECORDS) / run.parent_path() / "runs" / file.filename();
    const analysis::CsvTable table = analysis::read_csv(merged.string());
    Wanted wanted = of.wanted;
    wanted["run"] = run.filename().string();
    std::vector<double> found;
    for (int row = 0; row < table.rows(); ++row)
        if (is_wanted(table, row, wanted)) found.push_back(table.number(row, of.column));
    return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

const double six_digits = 1e-5;  // relative: half a unit of the last kept digit on either side

const Wanted pbs_of_the_scene = {{"deformer", "pbs"},  {"iterations", "24"}, {"k_stretch", "0.2"}, {"order", "ordered"},
                                 {"precision", "f32"}, {"substeps", "1"},    {"tuned", ""},        {"wanted_vertices", ""}};

void expect_same(const std::vector<KeptValue>& values)
{
    const std::optional<double> first = only_value(values.front());
    ASSERT_TRUE(first) << values.front().file;
    for (const KeptValue& of : values) {
        const std::optional<double> value = only_value(of);
        ASSERT_TRUE(value) << of.file;
        EXPECT_NEAR(*value, *first, six_digits * *first) << of.file << " and " << values.front().file;
    }
}

// PBS after 24 iterations, on the scene's own tets, relative to the same reference.
TEST(KeptValues, OfPbsInATwistBy90DegreesAreTheSameInEachStudy)
{
    expect_same(
        {{"ensemble/limb_twist_90/parts.csv", {{"k_stretch", "0.2"}, {"iterations", "24"}}},
         {"ensemble/limb_twist_90/errors.csv", {{"member", "smooth"}, {"deformer", "pbs"}}},
         {"work_precision/limb_twist_90/points.csv", pbs_of_the_scene},
         {"work_precision/limb_twist_90/changes.csv", {{"change", "pbs"}, {"iterations", "24"}}},
         {"convergence/limb_twist/rates.csv",
          {{"pose", "twist_90"}, {"own_mesh", "1"}, {"order", "ordered"}, {"precision", "f32"}, {"k_stretch", "0.2"}, {"start", "lbs"}},
          "error_24_pct"}});
}

TEST(KeptValues, OfTheBoundOnAReferenceAreTheSameInEachStudy)
{
    for (const std::string pose : {"limb_twist_90", "limb_bend_60", "limb_twist_150", "limb_bend_90", "human_crouch", "human_standing",
                                   "human_in_the_air", "human_landing"})
        expect_same({{"work_precision/" + pose + "/points.csv", pbs_of_the_scene, "reference_error_joint_pct"},
                     {"work_precision/" + pose + "/changes.csv", {{"change", "pbs"}, {"iterations", "24"}}, "reference_error_joint_pct"},
                     {"ensemble/" + pose + "/members.csv", {{"member", "smooth"}}, "error_bound_pct"}});
}

}  // namespace
