// The volume of regions. Reference: the geometry of a bar with two bones along x, in which tets belong to the nearest
// bone and blended ones lie around the middle; the shares of a record add up to the body and its changes to those of
// the metrics.
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/run/region_record.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

namespace {

using namespace experiments;

const test_support::TwoBoneLimb& bent()
{
    static const auto limb = test_support::two_bone_limb({24, 4, 4}, {0, 0, 1}, 90.0);
    return limb;
}

double middle(Eigen::Index tet)
{
    double x = 0.0;
    for (const int vertex : bent().mesh.tets.row(tet)) x += bent().mesh.rest(vertex, 0) / 4.0;
    return x;
}

TEST(BodyRegions, ATetLiesWithItsNearestBoneAndAJointHasTheBlendedTetsAlone)
{
    const BodyRegions by_bone = regions_by_bone(character_of(bent())),
                      by_joint = regions_by_joint(character_of(bent()));
    EXPECT_EQ(by_bone.bones, (std::vector<RegionBones>{{"upper"}, {"forearm"}}));
    ASSERT_EQ(by_joint.bones, (std::vector<RegionBones>{{"upper", "forearm"}}));
    for (Eigen::Index tet = 0; tet < bent().mesh.tets.rows(); ++tet) {
        const double x = middle(tet), longest_cell = 2.0 / 24.0;
        if (std::abs(x) > 0.1) {
            EXPECT_EQ(by_bone.of_tet[tet], x > 0.0 ? 1 : 0) << x;
        }
        // Eq. 2 blends within a sixth of the bone's length from the joint
        if (std::abs(std::abs(x) - 1.0 / 6.0) > longest_cell) {
            EXPECT_EQ(by_joint.of_tet[tet], std::abs(x) < 1.0 / 6.0 ? 0 : -1) << x;
        }
    }
}

double sum_of(const analysis::CsvTable& table, const std::string& kind, const std::string& column)
{
    double sum = 0.0;
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "kind") == kind) sum += table.number(row, column);
    return sum;
}

// The volume change [m^3] that rounding gives to tets that move rigidly: that of the volumes before and after, and that
// of the positions e, which changes a volume a x b . c / 6 by at most 6 e L^2 / 6, L the longest edge.
double rigid_change_error_m3()
{
    const pbs::TetMesh& mesh = bent().mesh;
    const double cell_edge = std::hypot(2.0 / 24.0, 0.3 / 4.0, 0.3 / 4.0),
                 farthest = mesh.rest.rowwise().norm().maxCoeff();
    return test_support::volume_error(mesh.rest, mesh.tets) + test_support::volume_error(bent().lbs, mesh.tets) +
           static_cast<double>(mesh.tets.rows()) * test_support::motion_error(2, farthest) * cell_edge * cell_edge;
}

TEST(RegionRecord, BonesAddUpToTheMetricsOfTheBody)
{
    RegionRecord record(character_of(bent()));
    record.add("lbs", bent().lbs);
    const analysis::CsvTable table = record.table();
    const auto metrics = analysis::MeshMetrics(bent().mesh.rest, bent().mesh.tets).measure(bent().lbs);
    // Sums over the tets of rest volumes and of changes, and six roundings of products, quotients and the sum over the
    // bones.
    const double roundings = 2.0 * static_cast<double>(bent().mesh.tets.rows()) + 6.0;
    const double of_change_pct = test_support::rounding_error(roundings, metrics.volume_abs_change_pct);
    EXPECT_NEAR(sum_of(table, "bone", "rest_share_pct"), 100.0, test_support::rounding_error(roundings, 100.0));
    EXPECT_NEAR(sum_of(table, "bone", "change_pct"), metrics.volume_change_pct, of_change_pct);
    EXPECT_NEAR(sum_of(table, "bone", "abs_change_pct"), metrics.volume_abs_change_pct, of_change_pct);
    // LBS moves everything except the joint rigidly.
    const double rest_m3 = pbs::tet_volumes(bent().mesh.rest, bent().mesh.tets).sum();
    EXPECT_NEAR(sum_of(table, "joint", "change_pct"), metrics.volume_change_pct,
                of_change_pct + 100.0 * rigid_change_error_m3() / rest_m3);
    EXPECT_LT(metrics.volume_change_pct, -0.1);
}

TEST(RegionRecord, MeansAndExtremesOverFramesAndNoBrokenFrame)
{
    RegionRecord record(character_of(bent()));
    record.add("pbs", bent().mesh.rest);
    record.add("pbs", bent().lbs);
    pbs::Positions broken = bent().lbs;
    broken(0, 0) = std::nan("");
    record.add("pbs", broken);
    record.add("other", broken);
    const analysis::CsvTable table = record.table();
    ASSERT_EQ(table.rows(), 3);
    for (int row = 0; row < 3; ++row) {
        EXPECT_EQ(table.integer(row, "frames"), 2);
        const double change_pct = table.number(row, "change_pct");
        EXPECT_EQ(change_pct, 0.5 * table.number(row, "lowest_pct"));
        EXPECT_EQ(table.number(row, "highest_pct"), 0.0);  // at rest
        // Two products and three quotients, of which one is by the two frames.
        EXPECT_NEAR(table.number(row, "own_change_pct") * table.number(row, "rest_share_pct") / 100.0, change_pct,
                    test_support::rounding_error(4, std::abs(change_pct)));
    }
}

TEST(RegionTable, OfAStudyHasTheRegionsOfEveryRun)
{
    const std::vector<RegionChange> regions = {{"lbs", "bone", {"shin"}, 50.0, -1.0, 0.0, 0.0, 0.0, -2.0, 1},
                                               {"dqs", "bone", {"head"}, 50.0, -9.0, 0.0, 0.0, 0.0, -9.0, 1}};
    const test_support::ScratchFolder folder;
    FinishedRuns runs{.folder = folder.path().string(), .folders = {folder / "clip", folder / "sweep"}};
    for (const std::string& run : runs.folders) {
        std::filesystem::create_directory(run);
        table_of(region_columns, regions).write(run + "/regions.csv");
    }
    EXPECT_TRUE(volume_study().conclude(runs));
    const analysis::CsvTable all = analysis::read_csv(folder / "regions.csv");
    EXPECT_EQ(all.rows(), 4);
    EXPECT_EQ(all.text_at(1, "run"), "clip");
    EXPECT_EQ(all.text_at(2, "run"), "sweep");
    EXPECT_EQ(all.number(3, "change_pct"), -9.0);
}

}  // namespace
