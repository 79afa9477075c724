// Values that several studies measure are the same in all of them. Reference: the kept records.
#include "analysis/records/atomic_file.hpp"
#include "analysis/records/csv_table.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using Wanted = std::map<std::string, std::string>;

bool is_wanted(const analysis::CsvTable& table, int row, const Wanted& wanted)
{
    return std::ranges::all_of(wanted, [&](const auto& cell) { return table.text_at(row, cell.first) == cell.second; });
}

// The error of the only row with these cells; nothing if there is none, or more than one.
std::optional<double> only_error(const std::string& file, const Wanted& wanted)
{
    const analysis::CsvTable table = analysis::read_csv((std::filesystem::path(PBS_KEPT_RECORDS) / file).string());
    std::vector<double> found;
    for (int row = 0; row < table.rows(); ++row)
        if (is_wanted(table, row, wanted)) found.push_back(table.number(row, "error_joint_pct"));
    return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

std::string revision_of(const std::string& run)
{
    const auto file = std::filesystem::path(PBS_KEPT_RECORDS) / run / "run.json";
    return nlohmann::json::parse(analysis::read_text(file.string())).at("provenance").at("git_revision");
}

// PBS after 24 iterations, on the scene's own tets, against the same reference.
TEST(KeptValues, OfPbsInATwistBy90DegreesAreTheSameInEachStudy)
{
    const std::string revision = revision_of("error_split/limb_twist");
    if (revision_of("ensemble/limb_twist_90") != revision || revision_of("work_precision/limb_twist_90") != revision)
        GTEST_SKIP() << "The kept records of these studies are of different revisions.";
    const std::optional<double> split =
        only_error("error_split/limb_twist/parts.csv", {{"angle_deg", "90"}, {"k_stretch", "0.2"}, {"iterations", "24"}});
    const std::optional<double> ensemble = only_error("ensemble/limb_twist_90/errors.csv", {{"member", "smooth"}, {"deformer", "pbs"}});
    const std::optional<double> compared = only_error("work_precision/limb_twist_90/points.csv", {{"deformer", "pbs"},
                                                                                                  {"iterations", "24"},
                                                                                                  {"k_stretch", "0.2"},
                                                                                                  {"order", "ordered"},
                                                                                                  {"precision", "f32"},
                                                                                                  {"substeps", "1"},
                                                                                                  {"tuned", ""},
                                                                                                  {"wanted_vertices", ""}});
    ASSERT_TRUE(split && ensemble && compared);
    const double six_digits = 1e-5 * *split;  // half a unit of the last digit on either side
    EXPECT_NEAR(*ensemble, *split, six_digits);
    EXPECT_NEAR(*compared, *split, six_digits);
}

}  // namespace
