// bones.csv, bones_rest.csv and binding.csv. Reference: rigid motion by hand, and the limb's own geometry. Tolerances: the rounding of
// motions and of distances.

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/model_character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

using namespace experiments;

pbs::Skeleton arm()
{
    return {{{"upper", -1, pbs::Vec3(-1.0, 0.0, 0.0), pbs::Vec3::Zero()}, {"forearm", 0, pbs::Vec3::Zero(), pbs::Vec3(1.0, 0.0, 0.0)}}};
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
    // The foot of a vertex on a bone goes through two roundings of coordinates of at most 1, and its distance through six, on both sides.
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

// The cost of a run. Reference: parts that take at least a known time, and memory that is allocated.

void wait_ms(int ms)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

TEST(CostRecord, AddsUpAPartAlsoOfOneThatThrowsAndHandsItsResultOn)
{
    CostRecord cost;
    EXPECT_EQ(*cost.time("metrics", [] { return wait_ms(5), std::make_unique<int>(7); }), 7) << "a result that cannot be copied";
    cost.time("metrics", [] { wait_ms(5); });
    EXPECT_GE(cost.seconds("metrics"), 0.010);
    EXPECT_EQ(cost.seconds("frames"), 0.0);
    const auto throw_late = [] { wait_ms(3), throw std::runtime_error("disk full"); };
    EXPECT_THROW(cost.time("frames", throw_late), std::runtime_error);
    EXPECT_GE(cost.seconds("frames"), 0.003);
}

TEST(CostRecord, ADeformersPartIsTheRunsToo)
{
    CostRecord cost;
    cost.time("step", "lbs", [] { wait_ms(2); });
    cost.time("step", "pbs", [] { wait_ms(4); });
    const nlohmann::json seconds = cost.json().at("seconds");
    EXPECT_GE(seconds.at("deformers").at("pbs").at("step").get<double>(), 0.004);
    EXPECT_GE(seconds.at("step").get<double>(), 0.999 * (seconds.at("deformers").at("lbs").at("step").get<double>() + 0.004));
    EXPECT_GE(seconds.at("total").get<double>(), seconds.at("step").get<double>());
}

TEST(CostRecord, WaitingTakesNoProcessor)
{
    CostRecord cost;
    cost.time("wait", [] { wait_ms(50); });
    const nlohmann::json json = cost.json();
    EXPECT_LT(json.at("cpu_seconds").at("wait").get<double>(), 0.5 * json.at("seconds").at("wait").get<double>());
}

TEST(CostRecord, PeakMemoryStaysWhenItIsGivenBack)
{
    const CostRecord cost;
    const double before_mb = cost.json().at("peak_memory_mb").get<double>();
    std::vector<char>(64'000'000, 1);
    EXPECT_GE(cost.json().at("peak_memory_mb").get<double>(), before_mb + 50.0);
    EXPECT_GT(cost.json().at("shared_objects").get<int>(), 0);
}

// Reference: distances of a few points by hand.

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
    // Two coordinates of at most 4 mm and their difference are rounded; then there are square, mean, root and unit, and two roundings here.
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

// Reference: geometry of a bar with two bones along x: tets belong to the nearest bone, blended ones around the middle; the shares of a
// record add up to the body and its changes to those of the metrics.

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
    const BodyRegions by_bone = regions_by_bone(character_of(bent())), by_joint = regions_by_joint(character_of(bent()));
    EXPECT_EQ(by_bone.bones, (std::vector<RegionBones>{{"upper"}, {"forearm"}}));
    ASSERT_EQ(by_joint.bones, (std::vector<RegionBones>{{"upper", "forearm"}}));
    for (Eigen::Index tet = 0; tet < bent().mesh.tets.rows(); ++tet) {
        const double x = middle(tet), longest_cell = 2.0 / 24.0;
        if (std::abs(x) > 0.1) {
            EXPECT_EQ(by_bone.of_tet[tet], x > 0.0 ? 1 : 0) << x;
        }
        if (std::abs(std::abs(x) - 1.0 / 6.0) > longest_cell) {  // Eq. 2 blends within a sixth of the bone's length from the joint
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
    EXPECT_FALSE(volume_study().conclude({.folder = folder.path().string()})) << "without a finished run it does not hold";
}

// A run's records about a rigged model. Reference: a model made by hand.

// Weights of one vertex after the other: (bone, weight) pairs.
pbs::Weights weights_of(const std::vector<std::vector<std::pair<int, double>>>& vertices)
{
    pbs::Weights weights;
    weights.first = {0};
    for (const auto& vertex : vertices) {
        for (const auto& [bone, weight] : vertex) {
            weights.bone.push_back(bone);
            weights.weight.push_back(weight);
        }
        weights.first.push_back(static_cast<int>(weights.bone.size()));
    }
    return weights;
}

class ModelRecord : public testing::Test {
protected:
    ModelRecord() : model(std::make_shared<pbs::RiggedModel>())
    {
        model->rig.file = "/somewhere/hero.glb";
        model->rig.animations = {{.name = "Walk", .nodes = {}}, {.name = "Run", .nodes = {}}};
        model->animation = &model->rig.animations[1];
        for (const char* name : {"hips", "knee", "toe"})
            model->body.skeleton.bones.push_back({name, -1, pbs::Vec3::Zero(), pbs::Vec3::UnitX()});
        model->body.surface = (pbs::Positions(2, 3) << -1, 0, 2, 0.5, 0.25, 4).finished();
        model->body.skin = weights_of({{{0, 0.75}, {1, 0.25}}, {{1, 0.5}, {2, 0.5}}});
        model->body.dropped = {{"IK", "no weight"}};
        model->body.containers = {"Armature"};
        model->body.bind_pose_deg = 12.5;
        model->body.binding.metres_per_unit = 0.01;
        model->body.binding.meshes = {{.name = "coat", .points = {}, .triangles = {}, .joints = {}, .skin = {}}};
    }

    // The first point of the surface is at the first vertex of the only tet, the other one between the second and the third.
    nlohmann::json record() const
    {
        pbs::Character character;
        character.mesh.tets = (pbs::Tets(1, 4) << 0, 1, 2, 3).finished();
        character.surface = pbs::EmbeddedSurface{.triangles = {},
                                                 .tet = Eigen::VectorXi::Zero(2),
                                                 .barycentric = (Eigen::Matrix<double, 2, 4>() << 1, 0, 0, 0, 0, 0.5, 0.5, 0).finished()};
        const pbs::Weights in_tets = weights_of({{{0, 0.75}, {1, 0.25}}, {{1, 1.0}}, {{2, 1.0}}, {{0, 1.0}}});
        character.artist = pbs::ArtistSkin{in_tets, model};
        return model_record(character);
    }

    std::shared_ptr<pbs::RiggedModel> model;
};

TEST_F(ModelRecord, HoldsWhatWasTakenAndWhatWasLeftOut)
{
    const nlohmann::json expected = {{"file", "hero.glb"},
                                     {"joints", {"hips", "knee", "toe"}},
                                     {"joints_dropped", nlohmann::json::array({{{"name", "IK"}, {"reason", "no weight"}}})},
                                     {"containers", {"Armature"}},
                                     {"meshes", {"coat"}},
                                     {"animations", {"Walk", "Run"}},
                                     {"animation", "Run"},
                                     {"bind_pose_deg", 12.5},
                                     {"metres_per_unit", 0.01},
                                     {"extent_m", 2.0},
                                     {"weights_transferred_pct", 100.0}};
    EXPECT_EQ(record(), expected);

    model->animation = nullptr;
    model->body.skeleton.bones.clear();
    const nlohmann::json bare = record();
    EXPECT_TRUE(bare.at("animation").is_null());
    EXPECT_FALSE(bare.contains("weights_transferred_pct"));
    EXPECT_EQ(bare.at("joints"), nlohmann::json::array());
}

// At the first point the lesser weights are 0.75 (hips), at the other one 0.25 (knee) and 0.5 (toe).
TEST_F(ModelRecord, CountsTheWeightThatTheTetsCarry)
{
    model->body.skin = weights_of({{{0, 1.0}}, {{1, 0.25}, {2, 0.75}}});
    EXPECT_EQ(record().at("weights_transferred_pct"), 75.0);
    model->body.skin = weights_of({{{2, 1.0}}, {{0, 1.0}}});
    EXPECT_EQ(record().at("weights_transferred_pct"), 0.0);
}

// surface_rest.vtp and embedding.csv. Reference: an affine map preserves barycentric coordinates, inside a tet and outside.

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
    const pbs::Positions moved = (2.0 * mesh.rest).rowwise() + shift, carried = pbs::embedded_positions(surface, mesh.rest, mesh.tets);
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
        // Three roundings make the last share one less the others, four each product and its sums, here for corners within 2.5 m; at rest
        // four of half as much.
        const double rounding = std::sqrt(3.0) * test_support::rounding_error(3 + 4 + 4 / 2, 2.5 * magnitudes);
        EXPECT_LT((sum - (2.0 * carried.row(point) + shift)).norm(), rounding);
    }
    EXPECT_LT(table.number(2, "barycentric_0"), 0.0);

    const analysis::ScratchFolder folder;
    write_surface(surface, mesh, folder.path());
    EXPECT_GT(std::filesystem::file_size(folder / "surface_rest.vtp"), 0U);
    EXPECT_EQ(analysis::read_csv(folder / "embedding.csv").rows(), 3);
}

}  // namespace
