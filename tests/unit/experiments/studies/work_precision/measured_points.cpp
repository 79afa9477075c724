// Where errors are measured. Reference: barycentric coordinates reproduce a rigid motion and an affine field exactly. Tolerance: the
// rounding of barycentric coordinates.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/work_precision/body_mesh.hpp"

#include "experiments/studies/work_precision/measured_points.hpp"
#include "experiments/studies/work_precision/point_row.hpp"
#include "experiments/studies/work_precision/posed_deformer.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/tet_rounding.hpp"

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

TEST(PointSettings, AreEachOnceInWordsAndKeysAndEightOrMoreOfEachDeformerWithSomethingToSet)
{
    SettingRange range;
    range.coarser_vertices = {300, 400, 500, 600};
    range.refined = true;
    range.quadratic = range.quadratic_corotational = false;
    range.quadratic_up_to = 500;
    const std::vector<PointSetting> settings = point_settings(read_scene("limb_twist", {}), range);
    std::set<std::string> words;
    std::vector<SettingKey> keys;
    std::map<std::string, int> of_deformer;
    for (const PointSetting& setting : settings) {
        EXPECT_TRUE(words.insert(text_of(key_of(setting))).second) << text_of(key_of(setting));
        EXPECT_EQ(std::count(keys.begin(), keys.end(), key_of(setting)), 0) << text_of(key_of(setting));
        keys.push_back(key_of(setting));
        ++of_deformer[setting.deformer];
    }
    for (const auto& [deformer, count] : of_deformer) EXPECT_GE(count, deformer == "lbs" || deformer == "dqs" ? 1 : 8) << deformer;
    EXPECT_EQ(of_deformer["lbs"], 5);  // and those on the other meshes
    EXPECT_EQ(of_deformer.size(), 10u);
}

TEST(PointSettings, HaveADigestOfAllTheyHangOn)
{
    std::vector<PointSetting> settings = point_settings(read_scene("limb_twist", {}), {});
    const std::string digest = digest_of(settings);
    EXPECT_EQ(digest_of(point_settings(read_scene("limb_twist", {}), {})), digest);
    options_of<FemOptions>(settings.back().spec).nested_start = !options_of<FemOptions>(settings.back().spec).nested_start;
    EXPECT_NE(digest_of(settings), digest);
}

TEST(FrameTimes, DropAndCountTheRoundsThatFailed)
{
    const double failed = std::nan("");
    const FrameTime time = frame_time({failed, 1.0, 5.0, failed, 2.0});
    EXPECT_EQ(time.failed_rounds, 2);
    ASSERT_TRUE(time.ms);
    EXPECT_EQ(time.ms->rounds, 3);
    EXPECT_EQ(time.ms->median, 2.0);
    EXPECT_FALSE(frame_time({failed, failed}).ms);
}

TEST(PointRows, QuartilesAreOfThreeRoundsOrMore)
{
    const BodyMesh own(limb(300));
    const PointSetting setting{"lbs", default_spec("lbs")};
    const ReachedPoint point{&setting, &own, {own.character().mesh.rest, true}, own.character().mesh.rest};
    for (const std::vector<double>& samples : {std::vector{1.0, 2.0}, {1.0, 2.0, 4.0}}) {
        const PointRow row = point_row(point, nullptr, {.of = {}, .time = frame_time(samples)});
        EXPECT_EQ(row.ms_q1.has_value(), samples.size() == 3u);
        EXPECT_EQ(row.ms_q3.has_value(), samples.size() == 3u);
        EXPECT_EQ(row.rounds, static_cast<int>(samples.size()));
    }
}

TEST(PosedDeformers, TellARoundThatDoesNotArriveAndTheOneThatSetsOutFromThere)
{
    const auto body = limb(300);
    const PointSetting setting{"pbs", default_spec("pbs"), 2};
    pbs::Pose rest(body->skeleton.bones.size(), Eigen::Isometry3d::Identity()), nowhere = rest;
    for (Eigen::Isometry3d& bone : nowhere) bone.translation().setConstant(std::nan(""));
    const PosePair there_and_back{rest, rest}, there_and_nowhere{rest, nowhere}, nowhere_and_back{nowhere, rest};
    PosedDeformer good(setting, *body, there_and_back), lost(setting, *body, there_and_nowhere);
    EXPECT_TRUE(good.reach().finished);
    EXPECT_GT(good.turn().at(0), 0.0);
    EXPECT_TRUE(lost.reach().finished);
    EXPECT_TRUE(std::isnan(lost.turn().at(0)));
    EXPECT_TRUE(std::isnan(lost.turn().at(0)));  // it returns, but not from the other pose
    EXPECT_FALSE(PosedDeformer(setting, *body, nowhere_and_back).reach().finished);
}

}  // namespace
