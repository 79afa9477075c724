// The tables for programs that draw the frames of a run. References: rigid motion by hand and the limb's own geometry
// (bones and binding), affine maps, which preserve barycentric coordinates inside a tet and outside (embedding), and
// distances of a few points by hand. Tolerances: the rounding of motions and of distances.
#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/run/drawn_frames.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

namespace {

using namespace experiments;

pbs::Skeleton arm()
{
    return {{{"upper", -1, pbs::Vec3(-1.0, 0.0, 0.0), pbs::Vec3::Zero()},
             {"forearm", 0, pbs::Vec3::Zero(), pbs::Vec3(1.0, 0.0, 0.0)}}};
}

TEST(BoneRecord, ABoneStandsWhereItsSkeletonAndThePosePutIt)
{
    std::vector<PosedBone> bones;
    add_bones(bones, 0, 0.0, {}, {});
    EXPECT_TRUE(bones.empty()) << "no bones, no rows";
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, pbs::Vec3::UnitZ()));
    add_bones(bones, 7, 0.28, arm(), pose);
    ASSERT_EQ(bones.size(), 2u);
    EXPECT_EQ(bones[0].place.parent, "");
    EXPECT_EQ(bones[1].place.parent, "upper");
    EXPECT_EQ(bones[1].frame, 7);
    EXPECT_LE((bones[1].place.tail - pbs::Vec3::UnitY()).norm(), test_support::motion_error(1, 1.0));
    EXPECT_EQ(bones[0].place.head, pbs::Vec3(-1.0, 0.0, 0.0));
    EXPECT_EQ(table_of(bone_columns, bones_at_rest(arm())).text(),
              "bone,parent,head_x_m,head_y_m,head_z_m,tail_x_m,tail_y_m,tail_z_m\n"
              "upper,,-1,0,0,0,0,0\n"
              "forearm,upper,0,0,0,1,0,0\n");
}

TEST(BoneRecord, AVertexBelongsToItsNearestBone)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 300});
    const std::vector<BoundVertex> vertices = bound_vertices(limb);
    ASSERT_EQ(std::ssize(vertices), limb.mesh.rest.rows());
    // The foot of a vertex on a bone goes through two roundings of coordinates of at most 1, and its distance through
    // six, on both sides.
    const double rounding_m = test_support::rounding_error(2 + 6, 1.0);
    int blended = 0;
    for (const BoundVertex& bound : vertices) {
        const double x = limb.mesh.rest(bound.vertex, 0), across = limb.mesh.rest.row(bound.vertex).tail(2).norm();
        // The distances sqrt(across^2 + x^2) and across to the two bones differ by at most x^2 / (2 across).
        if (x * x <= 2.0 * across * rounding_m) continue;
        const double beyond = std::max(0.0, std::abs(x) - 1.0);
        EXPECT_EQ(bound.bone, x <= 0.0 ? "upper" : "forearm") << x;
        EXPECT_NEAR(bound.rest_distance_m, std::hypot(across, beyond), rounding_m);
        blended += bound.blended;
    }
    EXPECT_GT(blended, 0);
    EXPECT_LT(blended, std::ssize(vertices));
}

pbs::EmbeddedSurface triangle(const pbs::TetMesh& mesh)
{
    pbs::Positions points(3, 3);
    points << 0.1, 0.2, 0.3, 0.4, 0.4, 0.1, 0.9, 0.9, 0.9;  // the last point lies outside
    pbs::Triangles triangles(1, 3);
    triangles << 0, 1, 2;
    return pbs::embed(points, triangles, mesh);
}

TEST(SurfaceRecord, ItsSharesCarryThePointsAlongAndBothFilesStandInTheFolder)
{
    const pbs::TetMesh mesh = test_support::unit_tet();
    const pbs::EmbeddedSurface surface = triangle(mesh);
    const analysis::CsvTable table = embedding_table(surface);
    const Eigen::RowVector3d shift(0.5, -2.0, 0.25);
    const pbs::Positions moved = (2.0 * mesh.rest).rowwise() + shift,
                         carried = pbs::embedded_positions(surface, mesh.rest, mesh.tets);
    ASSERT_EQ(table.rows(), 3);
    for (int point = 0; point < 3; ++point) {
        EXPECT_EQ(table.integer(point, "point"), point);
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        double magnitudes = 0.0;
        for (int corner = 0; corner < 4; ++corner) {
            const double share = table.number(point, "barycentric_" + std::to_string(corner));
            sum += share * moved.row(mesh.tets(table.integer(point, "tet"), corner));
            magnitudes += std::abs(share);
        }
        // Three roundings make the last share one less the others, four each product and its sums, here for corners
        // within 2.5 m; at rest four of half as much.
        const double rounding = std::sqrt(3.0) * test_support::rounding_error(3 + 4 + 4 / 2, 2.5 * magnitudes);
        EXPECT_LT((sum - (2.0 * carried.row(point) + shift)).norm(), rounding);
    }
    EXPECT_LT(table.number(2, "barycentric_0"), 0.0);

    const analysis::ScratchFolder folder;
    write_surface(surface, mesh, {{1, 0.75}}, folder.path());
    EXPECT_GT(std::filesystem::file_size(folder / "surface_rest.vtp"), 0U);
    const analysis::CsvTable written = analysis::read_csv(folder / "embedding.csv");
    ASSERT_EQ(written.rows(), 3);
    for (int point = 0; point < 3; ++point) EXPECT_EQ(written.number(point, "joint_share"), point == 1 ? 0.75 : 0.0);
}

pbs::Positions two_points(double x_m)
{
    pbs::Positions points = pbs::Positions::Zero(2, 3);
    points(1, 0) = x_m;  // the first point does not move
    return points;
}

TEST(DistanceRecord, EachPairOfAFrameOnceAndNoneOfTwoFrames)
{
    DistanceRecord record;
    record.add(0, 0.0, "lbs", "mesh", two_points(0.0));
    record.add(0, 0.0, "pbs", "mesh", two_points(0.004));
    record.add(0, 0.0, "pbs_jiggle", "mesh", two_points(0.001));
    const analysis::CsvTable& table = record.table();
    ASSERT_EQ(table.rows(), 3);
    EXPECT_EQ(table.text_at(2, "deformer"), "pbs_jiggle");
    EXPECT_EQ(table.text_at(2, "other"), "pbs");
    // Two coordinates of at most 4 mm and their difference are rounded; then there are square, mean, root and unit, and
    // two roundings here.
    const double rounding_mm = test_support::rounding_error(3 + 6 + 2, 4.0);
    EXPECT_NEAR(table.number(2, "largest_mm"), 3.0, rounding_mm);
    EXPECT_NEAR(table.number(2, "rms_mm"), 3.0 / std::sqrt(2.0), rounding_mm);
    EXPECT_EQ(table.integer(2, "points"), 2);

    record.add(10, 0.1, "lbs", "mesh", two_points(1.0));
    EXPECT_EQ(record.table().rows(), 3);
    record.add(10, 0.1, "pbs", "mesh", two_points(1.0));
    ASSERT_EQ(record.table().rows(), 4);
    EXPECT_EQ(record.table().integer(3, "frame"), 10);
    EXPECT_EQ(record.table().number(3, "largest_mm"), 0.0);
}

}  // namespace
