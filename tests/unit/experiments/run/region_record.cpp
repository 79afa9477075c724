// Reference: geometry of a bar with two bones along x: tets belong to the nearest bone, blended ones around the middle; the shares of a
// record add up to the body and its changes to those of the metrics.
#include "experiments/run/region_record.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/studies/volume/region_table.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(RegionRecord, BonesAddUpToTheMetricsOfTheBody)
{
    RegionRecord record(character_of(bent()));
    record.add("lbs", bent().lbs);
    const analysis::CsvTable table = record.table();
    const auto metrics = analysis::MeshMetrics(bent().mesh.rest, bent().mesh.tets).measure(bent().lbs);
    EXPECT_NEAR(sum_of(table, "bone", "rest_share_pct"), 100.0, 1e-10);
    EXPECT_NEAR(sum_of(table, "bone", "change_pct"), metrics.volume_change_pct, 1e-10);
    EXPECT_NEAR(sum_of(table, "bone", "abs_change_pct"), metrics.volume_abs_change_pct, 1e-10);
    // LBS moves everything except the joint rigidly.
    EXPECT_NEAR(sum_of(table, "joint", "change_pct"), metrics.volume_change_pct, 1e-10);
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
        EXPECT_NEAR(table.number(row, "change_pct"), 0.5 * table.number(row, "lowest_pct"), 1e-12);
        EXPECT_NEAR(table.number(row, "highest_pct"), 0.0, 1e-12);
        EXPECT_NEAR(table.number(row, "own_change_pct") * table.number(row, "rest_share_pct") / 100.0, table.number(row, "change_pct"),
                    1e-12);
    }
}

TEST(RegionTable, NamesTheGreatestLossFirst)
{
    const auto change = [](const char* deformer, const char* region, double change_pct, double own_change_pct) {
        return RegionChange{deformer, "bone", {region}, 50.0, change_pct, 0.0, 0.0, 0.0, own_change_pct, 1};
    };
    const std::vector<RegionChange> regions = {change("lbs", "shin", -1.0, -2.0), change("lbs", "thigh", -3.0, -4.0),
                                               change("dqs", "head", -9.0, -9.0)};
    const std::string text = region_text({{"clip", regions}}, 1);
    EXPECT_NE(text.find("-4.00  thigh -3.00 (-4.0)"), std::string::npos) << text;
    EXPECT_EQ(text.find("shin"), std::string::npos);
    EXPECT_EQ(text.find("head"), std::string::npos);
    EXPECT_EQ((RegionBones{"thigh.L", "shin.L"}.text()), "thigh.L - shin.L");
    const analysis::CsvTable all = region_csv({{"clip", regions}, {"sweep", regions}});
    EXPECT_EQ(all.rows(), 6);
    EXPECT_EQ(all.text_at(3, "run"), "sweep");
}

}  // namespace
