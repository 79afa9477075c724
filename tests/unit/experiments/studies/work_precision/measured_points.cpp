// Where errors are measured. Reference: barycentric coordinates reproduce a rigid motion and an affine field exactly. Tolerance: the
// rounding of barycentric coordinates.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/deformers/registry.hpp"
#include "pbs/skinning/pose.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

namespace {

using namespace experiments;

std::shared_ptr<const pbs::Character> limb(int vertices)
{
    return std::make_shared<pbs::Character>(pbs::make_character({.body = "limb", .vertices = vertices}));
}

pbs::Positions affine(const pbs::Positions& rest)
{
    Eigen::Matrix3d gradient;
    gradient << 0.9, 0.2, -0.1, 0.0, 1.1, 0.3, 0.2, -0.2, 0.8;
    return (rest * gradient.transpose()).rowwise() + Eigen::RowVector3d(0.3, -1.0, 2.0);
}

// A point outside by d has barycentric coordinates of at most 1 + d |inverse edges|. A value is the sum of four products of them with
// numbers of which each goes through six roundings, and so does the number that it is compared with.
double carrying_error(const BodyMesh& other, double largest)
{
    const auto worst = test_support::worst_magnification(other.character().mesh);
    const double coordinate = 1.0 + other.largest_distance_outside_m() * worst.inverse_edges;
    return test_support::rounding_error(4.0 * (12.0 * worst.condition + 6.0 + 4.0) + 6.0, coordinate * largest);
}

TEST(BodyMesh, CarriesAnAffineFieldExactlyFromACoarserAndFromAFinerMesh)
{
    const auto base = limb(400);
    for (const int vertices : {300, 900}) {
        const BodyMesh other({.body = "limb"}, vertices, *base);
        EXPECT_NE(other.character().mesh.rest.rows(), base->mesh.rest.rows());
        const pbs::Positions carried = affine(other.character().mesh.rest);
        const double error_m = (other.on_base(carried) - affine(base->mesh.rest)).cwiseAbs().maxCoeff();
        EXPECT_LT(error_m, carrying_error(other, carried.cwiseAbs().maxCoeff())) << vertices;
        EXPECT_LT(other.largest_distance_outside_m(), 0.03);  // a fifth of the radius
    }
}

TEST(BodyMesh, OfTheBaseItselfAndCutIntoEightKeepsTheBasesVertices)
{
    const auto base = limb(300);
    const BodyMesh own(base), fine = BodyMesh::refined(*base);
    EXPECT_EQ(fine.character().mesh.tets.rows(), 8 * base->mesh.tets.rows());
    for (const BodyMesh* mesh : {&own, &fine}) EXPECT_EQ(mesh->on_base(mesh->character().mesh.rest), base->mesh.rest);
}

TEST(PointSettings, AreEachOnce)
{
    SettingRange range;
    range.other_vertices = {300, 600};
    range.without_fem = {5000};
    range.refined = true;
    range.quadratic_up_to = 500;
    const std::vector<Setting> settings = settings_of(read_scene("limb_twist", {}), range);
    std::set<SettingKey> keys;
    std::map<std::string, int> of_deformer;
    for (const Setting& setting : settings) {
        EXPECT_TRUE(keys.insert(key_of(setting)).second) << setting.deformer << " " << setting.tuned;
        ++of_deformer[setting.deformer];
    }
    EXPECT_EQ(of_deformer["lbs"], 2 * 4);                  // codes; one mesh and three others
    EXPECT_EQ(of_deformer["pbs"], 2 * (10 * 9 + 3 * 3));   // codes, values, iterations; and three numbers of iterations on each other mesh
    EXPECT_EQ(of_deformer["fem_linear"], 2 * 1 + 2);       // orders 1 and 2; order 1 on each other mesh
    EXPECT_EQ(of_deformer["fem_neo_hookean"], 2 + 3 + 1);  // quadratic on the mesh of 300 too; and on the tets cut into eight
    EXPECT_EQ(of_deformer["fem_stable_neo_hookean"], 1);   // the limit of the deformers that minimise an energy
    SettingRange in_short = range;
    in_short.in_short = true;
    EXPECT_LT(settings_of(read_scene("limb_twist", {}), in_short).size(), settings.size() / 2);
}

// Each change has all its settings, in one code on the case's own mesh.
TEST(PointSettings, OfChangesToPbsAreMarked)
{
    SettingRange range;
    const std::size_t without = settings_of(read_scene("limb_twist", {}), range).size();
    range.changes = true;
    range.other_vertices = {};
    const std::vector<Setting> settings = settings_of(read_scene("limb_twist", {}), range);
    std::map<std::string, std::size_t> of_change;
    for (const Setting& setting : settings)
        if (setting.change) {
            ++of_change[setting.change->name];
            EXPECT_TRUE(setting.on_own_mesh());
        }
    EXPECT_EQ(of_change.size(), changes_to_pbs().size());
    for (const ComparedDeformer& one : changes_to_pbs()) EXPECT_EQ(of_change[one.name], one.grid.size() * one.iterations.size());
    EXPECT_EQ(settings.size(), without + 26 * 8);  // values of all changes, iterations
}

// The place of a setting on its ladder depends neither on k_stretch nor on the rest of the grid.
TEST(PointSettings, OfOneRungDifferInTheirSettingAloneAndHaveADigestOfAllTheyDependOn)
{
    std::map<SettingKey, std::set<std::string>> of_place;
    std::vector<Setting> settings = settings_of(read_scene("limb_twist", {}), {});
    for (const Setting& setting : settings) EXPECT_TRUE(of_place[without_grid_value(key_of(setting))].insert(setting.tuned).second);
    for (const auto& [place, of_pbs] : of_place) EXPECT_TRUE(place.deformer != "pbs" || of_pbs.size() == 10u);
    const std::string digest = digest_of(settings);
    EXPECT_EQ(digest_of(settings_of(read_scene("limb_twist", {}), {})), digest);
    options_of<FemOptions>(settings.back().spec).nested_start = !options_of<FemOptions>(settings.back().spec).nested_start;
    EXPECT_NE(digest_of(settings), digest);
}

TEST(FrameTimes, DropAndCountTheRoundsThatFailed)
{
    const double failed = std::nan("");
    PointRow row;
    add_time(row, {failed, 1.0, 5.0, failed, 2.0});
    EXPECT_EQ(row.failed_rounds, 2);
    EXPECT_EQ(row.rounds, 3);
    EXPECT_EQ(row.ms_median, 2.0);
    for (const std::vector<double>& samples : {std::vector{failed, failed}, {1.0, 2.0}, {1.0, 2.0, 4.0}}) {
        PointRow timed;
        add_time(timed, samples);
        EXPECT_EQ(timed.ms_median.has_value(), timed.rounds > 0);
        EXPECT_EQ(timed.ms_q1.has_value(), timed.rounds >= 3);
        EXPECT_EQ(timed.ms_q3.has_value(), timed.rounds >= 3);
        EXPECT_EQ(timed.rounds + timed.failed_rounds, static_cast<int>(samples.size()));
    }
}

pbs::Pose at_rest(const pbs::Character& character)
{
    return pbs::Pose(character.skeleton.bones.size(), Eigen::Isometry3d::Identity());
}

TEST(PosedDeformers, TellARoundThatDoesNotArriveAndTheOneThatSetsOutFromThere)
{
    const BodyMesh own(limb(300));
    const Setting setting{"pbs", default_spec("pbs")};
    const pbs::Pose rest = at_rest(own.character());
    pbs::Pose nowhere = rest;
    for (Eigen::Isometry3d& bone : nowhere) bone.translation().setConstant(std::nan(""));
    const PosePair there_and_back{rest, rest}, there_and_nowhere{rest, nowhere}, nowhere_and_back{nowhere, rest};
    PosedDeformer good(setting, own, there_and_back), lost(setting, own, there_and_nowhere);
    EXPECT_TRUE(good.reach().finished);
    EXPECT_GT(good.turn().at(0), 0.0);
    EXPECT_TRUE(lost.reach().finished);
    EXPECT_TRUE(std::isnan(lost.turn().at(0)));
    EXPECT_TRUE(std::isnan(lost.turn().at(0)));  // it returns, but not from the other pose
    EXPECT_FALSE(PosedDeformer(setting, own, nowhere_and_back).reach().finished);
}

// Reference: the deformer, driven by hand. Particles that are integrated keep their state from pose to pose.
TEST(PosedDeformers, WithMemoryTakeTheWayToTheirFirstPose)
{
    const BodyMesh own(limb(300));
    DeformerSpec spec = default_spec("pbs");
    options_of<pbs::PbsOptions>(spec).lbs_entry = pbs::LbsEntry::increment;
    const std::vector<pbs::Pose> steps = pbs::joint_sweep(own.character().skeleton, 1, pbs::Vec3::UnitX(), 40.0, 3, 0.01).steps;
    const PosePair poses{steps.back(), steps.front(), 0.01, {steps.begin(), steps.end() - 1}};
    const auto by_hand = make_deformer(spec);
    by_hand->reset(own.character());
    for (const pbs::Pose& pose : steps) by_hand->advance(pose, 0.01);
    EXPECT_EQ(PosedDeformer({"pbs", spec}, own, poses).reach().positions, by_hand->positions());
    const PosePair at_once{steps.back(), steps.front(), 0.01};
    EXPECT_NE(PosedDeformer({"pbs", spec}, own, at_once).reach().positions, by_hand->positions());
}

// Reference: the definition of the counters; a frame of LBS blends each vertex once.
TEST(PosedDeformers, OfTheProjectCountTheWorkOfOneFrameInProcessorTime)
{
    const BodyMesh own(limb(300));
    const PosePair poses{at_rest(own.character()), at_rest(own.character())};
    PosedDeformer lbs({"lbs", default_spec("lbs")}, own, poses);
    lbs.reach();
    for (int turn = 0; turn < 3; ++turn) lbs.turn();
    EXPECT_EQ(lbs.work(), pbs::WorkCounters{.vertex_visits = own.character().mesh.rest.rows()});
    EXPECT_EQ(lbs.clock(), FrameClock::processor);
}

TEST(PointRows, HaveColumnsOfDeformersOfTheUsersOwnOnlyWithThem)
{
    std::vector<PointRow> rows(2);
    const std::vector<std::string> without = columns_for(rows).names();
    rows.back().is_external = true;
    const std::vector<std::string> with = columns_for(rows).names();
    EXPECT_EQ(std::vector(with.begin(), with.end() - 2), without);
    EXPECT_EQ(std::vector(with.end() - 2, with.end()), (std::vector<std::string>{"external", "clock"}));
}

WorkPrecisionCase small_case()
{
    WorkPrecisionCase of;
    of.of = {.body = "limb", .motion = "twist", .angle_deg = 30.0};
    of.scene = read_scene("limb_twist", {"character.vertices=300", "motion.angle_deg=30", "motion.frames=7"});
    of.frame = 6;
    of.half = Half::training;
    of.range.in_short = true;
    of.range.quadratic = false;
    of.range.changes = true;
    of.rounds = of.newton_rounds = {.seconds = 0.0, .fewest = 1, .most = 1};
    of.reference_is_refined = false;
    of.members = {family()[2]};
    of.longest_frame_ms = 1e-6;
    return of;
}

const MeasuredPoints& small_points()
{
    static const MeasuredPoints points = measure_points(small_case());
    return points;
}

// A ladder ends at the setting that takes too long, and the reason names the limit.
TEST(MeasuredPoints, StopAtTheLimitOfTimeAndRecordTheSplit)
{
    const WorkPrecisionCase of = small_case();
    const MeasuredPoints& points = small_points();
    int finished = 0, left_out = 0;
    for (const PointRow& row : points.rows) {
        EXPECT_EQ(row.half, Half::training);
        EXPECT_EQ(row.of, of.of);
        if (row.key.deformer != "pbs") continue;
        EXPECT_EQ(row.outcome, row.key.iterations == 4 ? "finished" : "over_time_limit");
        EXPECT_EQ(row.error.has_value(), row.outcome == "finished");
        for (std::size_t m = 0; m < row.members.size(); ++m) EXPECT_EQ(row.members[m].has_value(), m == 1 && row.error) << m;
        if (row.error) {
            EXPECT_NE(row.members[1], row.error->joint_pct) << "the bones are thinner";
        }
        ++(row.outcome == "finished" ? finished : left_out);
        EXPECT_EQ(row.reason.ends_with("1e-06 ms allowed"), row.outcome != "finished") << row.reason;
        EXPECT_EQ(row.work && row.work->projections > 0, row.outcome == "finished");
    }
    ASSERT_EQ(points.members.size(), 1u);
    EXPECT_EQ(points.members[0].outcome, "reached");
    EXPECT_FALSE(points.members[0].error_bound_pct) << "the first reference has no bound";
    EXPECT_EQ(finished, 2 * 3);      // codes, settings
    EXPECT_EQ(left_out, 2 * 3 * 2);  // and 24 and 96 iterations
}

// Reference: the solution with the law of the deformers that minimise an energy. The solution with the reference's law differs.
TEST(MeasuredPoints, HaveTheirDistanceFromTheOwnLimitOfTheDeformers)
{
    std::map<std::string, double> distance_pct;
    for (const PointRow& row : small_points().rows)
        if (row.to_linear_elements_pct) distance_pct[row.key.deformer] = *row.to_linear_elements_pct;
    EXPECT_EQ(distance_pct.at("fem_stable_neo_hookean"), 0.0);
    EXPECT_GT(distance_pct.at("fem_neo_hookean"), 0.0);
    EXPECT_LT(distance_pct.at("fem_neo_hookean"), 0.1 * distance_pct.at("lbs")) << "the laws are near each other";
}

// The ladders begin with 4 iterations of PBS and one of a change; more take too long. In the quick form the bound is the distance of
// linear elements.
TEST(MeasuredPoints, HaveTheChangesToPbsInATableOfTheirOwn)
{
    std::map<std::string, int> finished;
    for (const PointRow& row : small_points().changes) {
        if (row.outcome != "finished") continue;
        ++finished[row.key.deformer];
        EXPECT_EQ(row.key.iterations, row.key.deformer == baseline ? 4 : 1);
        EXPECT_EQ(row.reference, "quadratic");
        EXPECT_GT(row.reference_error_joint_pct.value(), 0.0);
        ASSERT_TRUE(row.from_pbs_pct[0]) << row.key.deformer;
        EXPECT_EQ(*row.from_pbs_pct[0] == 0.0, row.key.deformer == baseline) << row.key.deformer << " " << row.key.tuned;
        EXPECT_FALSE(row.from_pbs_pct[1]) << "PBS takes too long";
    }
    EXPECT_EQ(finished, (std::map<std::string, int>{{baseline, 1},
                                                    {"smooth_weights", 1},
                                                    {"bind_to_blended_position", 3},
                                                    {"region_volumes", 3},
                                                    {"tet_and_region_volumes", 3},
                                                    {"k_by_edge_length", 1},
                                                    {"another_order", 3},
                                                    {control, 3}}));
    for (const PointRow& row : small_points().rows)
        EXPECT_TRUE(std::ranges::none_of(changes_to_pbs(), [&](const ComparedDeformer& one) { return one.name == row.key.deformer; }));
}

// k / (k + (1 - k) (l / L)^2) of two edges, 1 and 2, whose mean is k: solved for (1 / L)^2 = x by hand for k = 1 / 2,
// 1 / (1 + x) + 1 / (1 + 4 x) = 1 holds for 4 x^2 = 1, L = sqrt 2.
TEST(NeutralLength, KeepsTheMeanStiffness)
{
    EXPECT_NEAR(neutral_length(0.5, {1.0, 2.0}), std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(neutral_length(0.2, {3.0, 3.0}), 3.0, 1e-11) << "of equal edges it is their length";
    const std::vector<double> lengths_m = {0.03, 0.05, 0.08};
    const double length_m = neutral_length(0.2, lengths_m);
    double mean = 0.0;
    for (const double l : lengths_m) mean += pbs::stiffness_at_length(0.2, l, length_m) / 3.0;
    EXPECT_NEAR(mean, 0.2, 1e-11);
}

}  // namespace
