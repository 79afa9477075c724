// Reference: geometry of a bar with two bones along x: tets belong to the nearest bone, blended ones around the middle; the shares of a
// record add up to the body and its changes to those of the metrics.
#include "experiments/run/run_records.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/limb_character.hpp"
#include "tests/support/motion_rounding.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

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

TEST(BodyRegions, ATetLiesWithItsNearestBone)
{
    const BodyRegions regions = regions_by_bone(character_of(bent()));
    EXPECT_EQ(regions.bones, (std::vector<RegionBones>{{"upper"}, {"forearm"}}));
    for (Eigen::Index tet = 0; tet < bent().mesh.tets.rows(); ++tet)
        if (std::abs(middle(tet)) > 0.1) {
            EXPECT_EQ(regions.of_tet[tet], middle(tet) > 0.0 ? 1 : 0) << middle(tet);
        }
}

TEST(BodyRegions, AJointHasTheBlendedTetsAlone)
{
    const BodyRegions regions = regions_by_joint(character_of(bent()));
    ASSERT_EQ(regions.bones, (std::vector<RegionBones>{{"upper", "forearm"}}));
    for (Eigen::Index tet = 0; tet < bent().mesh.tets.rows(); ++tet) {
        const double longest_cell = 2.0 / 24.0;  // Eq. 2 blends within a sixth of the bone's length from the joint
        if (std::abs(middle(tet)) < 1.0 / 6.0 - longest_cell) {
            EXPECT_EQ(regions.of_tet[tet], 0);
        }
        if (std::abs(middle(tet)) > 1.0 / 6.0 + longest_cell) {
            EXPECT_EQ(regions.of_tet[tet], -1);
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

// The volume change [m^3] that rounding gives to tets that move rigidly: that of the volumes before and after, and that of the positions e,
// which changes a volume a x b . c / 6 by at most 6 e L^2 / 6, L the longest edge.
double rigid_change_error_m3()
{
    const pbs::TetMesh& mesh = bent().mesh;
    const double cell_edge = std::hypot(2.0 / 24.0, 0.3 / 4.0, 0.3 / 4.0), farthest = mesh.rest.rowwise().norm().maxCoeff();
    return test_support::volume_error(mesh.rest, mesh.tets) + test_support::volume_error(bent().lbs, mesh.tets) +
           static_cast<double>(mesh.tets.rows()) * test_support::motion_error(2, farthest) * cell_edge * cell_edge;
}

TEST(RegionRecord, BonesAddUpToTheMetricsOfTheBody)
{
    RegionRecord record(character_of(bent()));
    record.add("lbs", bent().lbs);
    const analysis::CsvTable table = record.table();
    const auto metrics = analysis::MeshMetrics(bent().mesh.rest, bent().mesh.tets).measure(bent().lbs);
    // Sums over the tets of rest volumes and of changes, and six roundings of products, quotients and the sum over the bones.
    const double roundings = 2.0 * static_cast<double>(bent().mesh.tets.rows()) + 6.0;
    const double of_change_pct = test_support::rounding_error(roundings, metrics.volume_abs_change_pct);
    EXPECT_NEAR(sum_of(table, "bone", "rest_share_pct"), 100.0, test_support::rounding_error(roundings, 100.0));
    EXPECT_NEAR(sum_of(table, "bone", "change_pct"), metrics.volume_change_pct, of_change_pct);
    EXPECT_NEAR(sum_of(table, "bone", "abs_change_pct"), metrics.volume_abs_change_pct, of_change_pct);
    // LBS moves everything except the joint rigidly.
    const double rest_m3 = pbs::tet_volumes(bent().mesh.rest, bent().mesh.tets).sum();
    EXPECT_NEAR(sum_of(table, "joint", "change_pct"), metrics.volume_change_pct, of_change_pct + 100.0 * rigid_change_error_m3() / rest_m3);
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

TEST(RegionTable, NamesTheThreeGreatestLossesFirst)
{
    const auto change = [](const char* deformer, const char* region, double change_pct, double own_change_pct) {
        return RegionChange{deformer, "bone", {region}, 50.0, change_pct, 0.0, 0.0, 0.0, own_change_pct, 1};
    };
    const std::vector<RegionChange> regions = {change("lbs", "shin", -1.0, -2.0), change("lbs", "thigh", -3.0, -4.0),
                                               change("lbs", "hand", -0.25, -0.5), change("lbs", "foot", -0.5, -0.5),
                                               change("dqs", "head", -9.0, -9.0)};
    const test_support::ScratchFolder folder;
    FinishedRuns runs{.folder = folder.path().string(), .folders = {folder / "clip", folder / "sweep"}};
    for (const std::string& run : runs.folders) {
        std::filesystem::create_directory(run);
        table_of(region_columns, regions).write(run + "/regions.csv");
    }
    const std::string text = volume_study().conclude(runs).text;
    EXPECT_NE(text.find("-4.75  thigh -3.00 (-4.0), shin -1.00 (-2.0), foot -0.50 (-0.5)"), std::string::npos) << text;
    EXPECT_EQ(text.find("hand"), std::string::npos);
    EXPECT_EQ(text.find("head"), std::string::npos);
    EXPECT_EQ((RegionBones{"thigh.L", "shin.L"}.text()), "thigh.L - shin.L");
    const analysis::CsvTable all = analysis::read_csv(folder / "regions.csv");
    EXPECT_EQ(all.rows(), 10);
    EXPECT_EQ(all.text_at(5, "run"), "sweep");
}

}  // namespace
