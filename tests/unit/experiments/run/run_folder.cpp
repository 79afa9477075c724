// A run's record of a rigged model. Reference: a model made by hand.
#include "experiments/characters/model_character.hpp"
#include "experiments/run/run_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <vector>

namespace {

using namespace experiments;

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

    // The first point of the surface is at the first vertex of the only tet, the other one between the second and the
    // third.
    nlohmann::json record() const
    {
        pbs::Character character;
        character.mesh.tets = (pbs::Tets(1, 4) << 0, 1, 2, 3).finished();
        character.surface = pbs::EmbeddedSurface{
            .triangles = {},
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
    const nlohmann::json expected = {
        {"file", "hero.glb"},
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

}  // namespace
