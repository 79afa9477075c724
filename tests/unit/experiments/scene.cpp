// Scenes: what a file, --set and the defaults say together. Truth: the contract of scene files (README, `pbskin explain`).
#include "experiments/scene.hpp"
#include "experiments/scene_schema.hpp"
#include "experiments/scene_values.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::read_scene;
using experiments::Scene;
using experiments::SceneValues;

const std::string smallest = "schema = 1\n[character]\nbody = \"limb\"\n[motion]\njoint = \"forearm\"\nangle_deg = 90\n";

TEST(Scene, DefaultsAreThoseOfTheSchema)
{
    const SceneValues values(smallest, "scene.toml", {});
    for (const auto& key : experiments::scene_keys()) {
        if (key.default_json.empty() || key.table == "fem" || key.table.starts_with("pbs.")) continue;
        if (values.given(key.path())) continue;
        EXPECT_EQ(values.resolved().at(nlohmann::json::json_pointer("/" + (key.table.empty() ? key.name : key.table + "/" + key.name))),
                  nlohmann::json::parse(key.default_json))
            << key.path();
    }
}

TEST(Scene, EveryBuiltInSceneReads)
{
    for (const auto& scene : experiments::built_in_scenes()) {
        const Scene read = read_scene(scene.name, {});
        EXPECT_EQ(read.name, scene.name);
        EXPECT_EQ(read.reference, "fem_p2");
        EXPECT_EQ(read.deformers.size(), 5u);
    }
}

TEST(Scene, ReferencesKeepTheirOwnOptions)
{
    const Scene scene = read_scene("limb_twist", {"fem.1.poisson=0.3"});
    ASSERT_EQ(scene.deformers[3].name, "fem_p1");
    EXPECT_EQ(scene.deformers[3].fem.element_order, 1);
    EXPECT_EQ(scene.deformers[4].fem.element_order, 2);
    EXPECT_DOUBLE_EQ(scene.deformers[3].fem.poisson, 0.45);
    EXPECT_DOUBLE_EQ(scene.deformers[4].fem.poisson, 0.3);
}

TEST(Scene, OverridesWinOverTheFile)
{
    const Scene scene =
        read_scene("limb_twist", {"pbs.iterations=96", "pbs.k_stretch=0.05", "deformers.use=[\"pbs\"]", "reference.name=\"\""});
    EXPECT_EQ(scene.deformers.size(), 1u);
    EXPECT_EQ(scene.deformers[0].pbs.iterations, 96);
    EXPECT_DOUBLE_EQ(scene.deformers[0].pbs.k_stretch, 0.05);
}

TEST(Scene, ABareWordIsAText)
{
    EXPECT_EQ(read_scene("limb_twist", {"pbs.precision=f64"}).deformers[2].pbs.precision, pbs::Precision::f64);
}

TEST(Scene, JiggleIsOffUnlessItsTableIsThere)
{
    EXPECT_FALSE(read_scene("limb_twist", {}).deformers[2].pbs.jiggle);
    const auto jiggle = read_scene("limb_twist", {"pbs.jiggle.k_stretch=0.9"}).deformers[2].pbs.jiggle;
    ASSERT_TRUE(jiggle);
    EXPECT_DOUBLE_EQ(jiggle->k_stretch, 0.9);
}

TEST(Scene, PathsAreRelativeToTheFile)
{
    const SceneValues values(smallest, "scenes/arm.toml", {});
    EXPECT_EQ(values.file(), "scenes/arm.toml");
}

TEST(Scene, NearestNameIsTheOneMeant)
{
    EXPECT_EQ(experiments::nearest_name("iteration", {"iterations", "precision", "order"}), "iterations");
    EXPECT_EQ(experiments::nearest_name("k_volum", {"k_stretch", "k_volume", "k_bind"}), "k_volume");
    EXPECT_EQ(experiments::nearest_name("x", {}), "");
}

TEST(Scene, OutputNamesFrames)
{
    experiments::OutputSpec output;
    output.frames_every = 0;
    output.frames = {7};
    EXPECT_FALSE(output.writes(0));
    EXPECT_TRUE(output.writes(7));
    output.frames_every = 3;
    EXPECT_TRUE(output.writes(0));
    EXPECT_FALSE(output.writes(4));
}

TEST(Scene, EveryKeyIsDocumented)
{
    for (const auto& key : experiments::scene_keys()) {
        EXPECT_FALSE(key.meaning.empty()) << key.path();
        EXPECT_FALSE(key.rule().empty()) << key.path();
    }
}

}  // namespace
