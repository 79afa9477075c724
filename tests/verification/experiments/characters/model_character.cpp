// Reference: an ellipsoid of known volume with two joints on its long axis, whose weights are linear along it.
#include "experiments/characters/model_character.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/weight_sums.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using namespace pbs;

constexpr double long_m = 0.6, short_m = 0.2;  // half axes of the ellipsoid along y and across

double upper_weight(double y)
{
    return std::clamp(0.5 + y, 0.0, 1.0);
}

// Joints "root" at y = -0.5 and "elbow" at y = 0; balls: spheres of 0.1 m beside the ellipsoid, which follow the root.
test_support::GltfDocument ellipsoid_document(int balls, bool with_skin)
{
    std::vector<float> points, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> corners;
    for (int body = 0; body <= balls; ++body) {
        const SurfaceMesh sphere = test_support::icosphere(1.0, body == 0 ? 2 : 1);
        const auto first = static_cast<int>(points.size() / 3);
        for (const auto& p : sphere.points.rowwise()) {
            const Vec3 place = body == 0 ? Vec3(short_m * p(0), long_m * p(1), short_m * p(2))
                                         : Vec3(0.1 * p.transpose() + Vec3(0.8 * body, 0.3, 0));
            const double upper = body == 0 ? upper_weight(place.y()) : 0.0;
            for (int axis = 0; axis < 3; ++axis) points.push_back(float(place(axis)));
            for (const double weight : {1.0 - upper, upper, 0.0, 0.0}) weights.push_back(float(weight));
            joints.insert(joints.end(), {0, 1, 0, 0});
        }
        for (const int corner : sphere.triangles.reshaped<Eigen::RowMajor>())
            corners.push_back(std::uint16_t(first + corner));
    }
    test_support::GltfDocument gltf = test_support::two_joint_document();
    gltf.json["nodes"][0]["translation"] = {0, -0.5, 0};
    gltf.json["nodes"][1]["translation"] = {0, 0.5, 0};
    auto& primitive = gltf.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = gltf.put("VEC3", points);
    primitive["indices"] = gltf.put("SCALAR", corners);
    primitive["attributes"]["WEIGHTS_0"] = gltf.put("VEC4", weights);
    primitive["attributes"]["JOINTS_0"] = gltf.put("VEC4", joints);
    gltf.json["skins"][0]["inverseBindMatrices"] = gltf.put<float>(
        "MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    if (!with_skin) {
        gltf.json["nodes"][2].erase("skin");
        gltf.json.erase("animations");
    }
    return gltf;
}

Character made_from(const test_support::ScratchFolder& folder, const test_support::GltfDocument& gltf,
                    RemarkList& remarks)
{
    const std::string path = folder.file("hero.gltf", gltf.text());
    return make_model_character({.file = path, .animation = {}, .vertices = 150}, remarks);
}

// Tets are cached in a folder of the test.
class ModelCharacter : public testing::Test {
protected:
    void SetUp() override { ::setenv("PBSKIN_CACHE", folder.path().c_str(), 1); }
    void TearDown() override { ::unsetenv("PBSKIN_CACHE"); }

    const test_support::ScratchFolder folder;
    RemarkList remarks;
};

TEST_F(ModelCharacter, HasTheVolumeTheBonesTheWeightsAndTheSurfaceOfItsModel)
{
    const Character hero = made_from(folder, ellipsoid_document(0, true), remarks);
    EXPECT_TRUE(remarks.empty()) << remarks.front().text;
    // The facets of the surface cut off some percent of the ellipsoid, and the wrap adds a layer of some 2 mm.
    const double ellipsoid_m3 = 4.0 / 3.0 * M_PI * long_m * short_m * short_m;
    EXPECT_NEAR(tet_volumes(hero.mesh.rest, hero.mesh.tets).sum() / ellipsoid_m3, 1.0, 0.1);
    ASSERT_EQ(hero.skeleton.bones.size(), 2u);
    EXPECT_EQ(hero.skeleton.bones[1].name, "elbow");
    EXPECT_LE((hero.skeleton.bones[0].head - Vec3(0, -0.5, 0)).norm(), 1e-6);
    // Triangles and cells cut the corners that upper_weight has at both ends.
    ASSERT_TRUE(hero.artist);
    ASSERT_EQ(hero.artist->weights.vertices(), hero.mesh.rest.rows());
    const Weights& weights = hero.artist->weights;
    for (int v = 0; v < weights.vertices(); ++v)
        EXPECT_NEAR(test_support::weight_in(weights, v, 1), upper_weight(hero.mesh.rest(v, 1)), 0.05)
            << "at y = " << hero.mesh.rest(v, 1);
    ASSERT_TRUE(hero.surface);
    EXPECT_LE((embedded_positions(*hero.surface, hero.mesh.rest, hero.mesh.tets) - hero.artist->model->body.surface)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    EXPECT_EQ(hero.artist->model->animation->name, "Bend");
    EXPECT_EQ(hero.inputs.at(0).first, "hero.gltf");
}

TEST_F(ModelCharacter, PartsWithoutABoneAreLeftOutWithARemark)
{
    const Character hero = made_from(folder, ellipsoid_document(1, true), remarks);
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_NE(remarks[0].text.find("1 of 2 separate parts have no bone inside; they are left out"), std::string::npos)
        << remarks[0].text;
    EXPECT_LT(hero.mesh.rest.col(0).maxCoeff(), 0.5);
}

// The ball follows the root, and the flesh next to it mostly the elbow.
TEST_F(ModelCharacter, TheSurfaceOfAPartThatIsLeftOutFollowsItsJoint)
{
    const Character hero = made_from(folder, ellipsoid_document(1, true), remarks);
    const Positions& rest = hero.artist->model->body.surface;
    Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].rotate(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitX()));
    const Positions moved = surface_positions(hero, hero.mesh.rest * 2.0, pose);
    int balls = 0;
    for (Eigen::Index p = 0; p < rest.rows(); ++p) {
        const bool is_ball = rest(p, 0) > 0.5;
        balls += is_ball;
        // the file's points are floats
        EXPECT_LE((moved.row(p) - (is_ball ? 1.0 : 2.0) * rest.row(p)).norm(), 1e-6) << p;
    }
    EXPECT_EQ(balls, 42);
}

TEST_F(ModelCharacter, WithoutJointsNeedsASkeleton)
{
    expect_input_error([&] { made_from(folder, ellipsoid_document(0, false), remarks); },
                       (folder / "hero.gltf") + ": skins = 0: ", "expected a skeleton (character.skeleton");
}

TEST(ReadModel, ChoosesTheAnimationByNameAndAppliesTheScale)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.gltf", test_support::two_joint_document().text());
    const auto model = read_model(path, "Bend", 2.0);
    EXPECT_EQ(model->animation, &model->rig.animations[0]);
    EXPECT_LE((model->body.surface - 2.0 * model->rig.meshes[0].points).cwiseAbs().maxCoeff(), 1e-14);
    expect_input_error([&] { read_model(path, "Walk", 1.0); }, path + ": animation = Walk: ", "expected one of Bend");
}

}  // namespace
