// Where errors are measured and by which reference. Truth: a rigid motion and an affine field are carried exactly by barycentric
// coordinates; the grid convergence index worked by hand; the choice of the reference by its header.
#include "experiments/work_precision/reached_reference.hpp"

#include "experiments/frame_measurement.hpp"
#include "experiments/work_precision/measured_points.hpp"
#include "pbs/geometry/topology.hpp"

#include <gtest/gtest.h>

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

TEST(BodyMesh, CarriesAnAffineFieldExactlyFromACoarserAndFromAFinerMesh)
{
    const auto base = limb(400);
    for (const int vertices : {300, 900}) {
        const BodyMesh other({.body = "limb"}, vertices, *base);
        EXPECT_NE(other.character().mesh.rest.rows(), base->mesh.rest.rows());
        const double error_m = (other.on_base(affine(other.character().mesh.rest)) - affine(base->mesh.rest)).cwiseAbs().maxCoeff();
        EXPECT_LT(error_m, 1e-12) << vertices;                // some hundred roundings of numbers up to 3
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

class Choice : public testing::Test {
protected:
    void add(int element_order, const BodyMesh& mesh, int vertices, bool refined, double moved_m, bool finished = true)
    {
        PointSetting setting{"fem_stable_neo_hookean", "P" + std::to_string(element_order), {}};
        setting.spec.kind = "fem";
        setting.spec.fem.model = reference_fem::Model::stable_neo_hookean;
        setting.spec.fem.element_order = element_order;
        setting.vertices = vertices;
        setting.refined = refined;
        settings_.push_back(std::make_unique<PointSetting>(setting));
        pbs::Positions moved = base_->mesh.rest;
        moved.col(1).array() += moved_m;
        ReachedPoint point;
        point.setting = settings_.back().get();
        point.mesh = &mesh;
        point.shape.finished = finished;
        point.on_base = moved;
        points_.push_back(point);
    }
    ReachedReference choose() const
    {
        return choose_reference(points_, base_->mesh.rest.rows(), analysis::ErrorRuler(error_domain(*base_, {})));
    }

    std::shared_ptr<const pbs::Character> base_ = limb(400);
    BodyMesh own_{base_}, coarse_{{.body = "limb"}, 300, *base_}, finer_{{.body = "limb"}, 900, *base_};
    std::vector<std::unique_ptr<PointSetting>> settings_;
    std::vector<ReachedPoint> points_;
};

TEST_F(Choice, AQuadraticSolutionIsTheReferenceTheCoarserQuadraticOneStandsBeside)
{
    add(1, own_, 0, false, 0.0);
    add(2, own_, 0, false, 0.0);
    add(2, finer_, 900, false, 0.0);
    add(2, coarse_, 300, false, 0.01);
    const ReachedReference reference = choose();
    EXPECT_EQ(reference.point, &points_[1]);
    EXPECT_EQ(reference.beside, &points_[3]);
    const auto nodes = [](const BodyMesh& mesh) {
        return double(mesh.character().mesh.rest.rows() + pbs::edges_of(mesh.character().mesh.tets).rows());
    };
    const double ratio = std::cbrt(nodes(own_) / nodes(coarse_));
    ASSERT_TRUE(reference.bar);
    EXPECT_NEAR(reference.bar->linf_m, 3.0 * 0.01 / (ratio - 1.0), 1e-12);
}

TEST_F(Choice, OneThatIsNotReachedGivesWayToTheLinearOne)
{
    add(1, own_, 0, false, 0.0);
    add(2, own_, 0, false, 0.0, false);
    add(2, coarse_, 300, false, 0.01);
    const ReachedReference reference = choose();
    EXPECT_EQ(reference.point, &points_[0]);
    EXPECT_EQ(reference.beside, nullptr);  // of another element order on another mesh
    EXPECT_FALSE(reference.bar);
}

TEST_F(Choice, BesideALinearOneStandsThatOnTetsCutIntoEight)
{
    const BodyMesh fine = BodyMesh::refined(*base_);
    add(1, own_, 0, false, 0.0);
    add(1, coarse_, 300, false, 0.02);
    add(1, fine, 0, true, 0.01);
    const ReachedReference reference = choose();
    EXPECT_EQ(reference.point, &points_[0]);
    EXPECT_EQ(reference.beside, &points_[2]);
    const double ratio = std::cbrt(double(fine.character().mesh.rest.rows()) / double(base_->mesh.rest.rows()));
    ASSERT_TRUE(reference.bar);
    EXPECT_NEAR(reference.bar->linf_m, 3.0 * 0.01 * ratio / (ratio - 1.0), 1e-12);  // of the coarser of the two
}

TEST_F(Choice, WithoutASolutionThereIsNone)
{
    add(1, own_, 0, false, 0.0, false);
    EXPECT_EQ(choose().point, nullptr);
    points_.clear();
    EXPECT_EQ(choose().point, nullptr);
}

TEST(PointSettings, AreEachOnceInWordsAndEightOrMoreOfEachDeformerWithSomethingToSet)
{
    SettingRange range;
    range.coarser_vertices = {600};
    range.refined = true;
    const std::vector<PointSetting> settings = point_settings(read_scene("limb_twist", {}), range);
    std::set<std::string> words;
    std::map<std::string, int> of_kind;
    for (const PointSetting& setting : settings) {
        EXPECT_TRUE(words.insert(setting.deformer + ": " + setting.words).second) << setting.deformer << ": " << setting.words;
        ++of_kind[setting.spec.kind];
    }
    for (const char* kind : {"delta_mush", "pbs", "fem"}) EXPECT_GE(of_kind[kind], 8) << kind;
    EXPECT_GE(of_kind["xpbd"], 8);
    EXPECT_EQ(of_kind["lbs"], 2);  // and on the other mesh
}

}  // namespace
