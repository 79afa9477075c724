// Scenes as the combination of a file, --set and the defaults. Reference: the contract of scene files (experiments/scene/manual.md) and the
// options' own defaults.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::FemOptions;
using experiments::options_of;
using experiments::read_scene;
using experiments::Scene;

const std::string motion = "[motion]\njoint = \"forearm\"\nangle_deg = 90\n";
// these keys have no default
const std::string stated = "[pbs]\nk_stretch = 0.2\nk_volume = 1.0\nk_bind = 1.0\ngravity_m_s2 = [0.0, 0.0, 0.0]\n";
const std::string smallest = "schema = 1\n[character]\nbody = \"limb\"\n" + motion + stated;

TEST(Scene, DefaultsOfPbsAreThoseOfItsOptions)
{
    const test_support::ScratchFolder folder;
    const auto read = read_scene(folder.file("scene.toml", smallest + "[deformers]\nuse = [\"pbs\"]\n"), {}).deformers.at(0);
    experiments::DeformerSpec untouched = read;
    untouched.options = pbs::PbsOptions{};  // `stated` has the same values where the scene has no default
    EXPECT_EQ(to_json(read), to_json(untouched));
}

TEST(Scene, DefaultsOfFemAreThoseOfItsOptions)
{
    const test_support::ScratchFolder folder;
    const auto read = read_scene(folder.file("scene.toml", smallest + "[deformers]\nuse = [\"fem\"]\n[[fem]]\n"), {}).deformers.at(0);
    experiments::DeformerSpec untouched = read;
    untouched.options = FemOptions{};
    EXPECT_EQ(to_json(read), to_json(untouched));
}

TEST(Scene, EveryBuiltInSceneReads)
{
    for (const auto& scene : experiments::built_in_scenes()) {
        const Scene read = read_scene(scene.name, {});
        EXPECT_EQ(read.name, scene.name);
        EXPECT_FALSE(read.reference.empty());
        EXPECT_GE(read.deformers.size(), 4u);
    }
}

TEST(Scene, ReferencesKeepTheirOwnOptions)
{
    const Scene scene = read_scene("limb_twist", {"fem.1.poisson=0.3"});
    ASSERT_EQ(scene.deformers[3].name, "fem_p1");
    EXPECT_EQ(options_of<FemOptions>(scene.deformers[3]).element_order, 1);
    EXPECT_EQ(options_of<FemOptions>(scene.deformers[4]).element_order, 2);
    EXPECT_DOUBLE_EQ(options_of<FemOptions>(scene.deformers[3]).poisson, 0.45);
    EXPECT_DOUBLE_EQ(options_of<FemOptions>(scene.deformers[4]).poisson, 0.3);
}

TEST(Scene, OverridesWinOverTheFile)
{
    const Scene scene =
        read_scene("limb_twist", {"pbs.iterations=96", "pbs.k_stretch=0.05", "deformers.use=[\"pbs\"]", "reference.name=\"\""});
    EXPECT_EQ(scene.deformers.size(), 1u);
    EXPECT_EQ(options_of<pbs::PbsOptions>(scene.deformers[0]).iterations, 96);
    EXPECT_DOUBLE_EQ(options_of<pbs::PbsOptions>(scene.deformers[0]).k_stretch, 0.05);
}

TEST(Scene, ABareWordIsAText)
{
    EXPECT_EQ(options_of<pbs::PbsOptions>(read_scene("limb_twist", {"pbs.precision=f64"}).deformers[2]).precision, pbs::Precision::f64);
}

TEST(Scene, JiggleIsOffUnlessItsTableIsThere)
{
    EXPECT_FALSE(options_of<pbs::PbsOptions>(read_scene("limb_twist", {}).deformers[2]).jiggle);
    const auto jiggle = options_of<pbs::PbsOptions>(read_scene("limb_twist", {"pbs.jiggle.k_stretch=0.9"}).deformers[2]).jiggle;
    ASSERT_TRUE(jiggle);
    EXPECT_DOUBLE_EQ(jiggle->k_stretch, 0.9);
}

TEST(Scene, PathsAreRelativeToTheFile)
{
    const test_support::ScratchFolder folder;
    const std::string files = "schema = 1\n[character]\nmesh = \"meshes/arm.msh\"\nskeleton = \"/rigs/arm.skeleton.toml\"\n";
    const Scene scene = read_scene(folder.file("arm.toml", files + motion + stated), {"skinning.weights=weights.csv"});
    EXPECT_EQ(scene.character.mesh_file, folder / "meshes/arm.msh");
    EXPECT_EQ(scene.character.skeleton_file, "/rigs/arm.skeleton.toml");
    EXPECT_EQ(scene.character.weights_file, folder / "weights.csv");
}

TEST(Scene, ReadsRefinementAndErrorBar)
{
    EXPECT_EQ(read_scene("limb_twist", {}).character.refinements, 0);
    EXPECT_EQ(read_scene("limb_twist", {}).error_bar, experiments::ErrorBar::none);
    const Scene scene = read_scene("limb_twist", {"character.refine=2", "reference.error_bar=both"});
    EXPECT_EQ(scene.character.refinements, 2);
    EXPECT_EQ(scene.error_bar, experiments::ErrorBar::both);
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
    for (const auto& key : experiments::scene_schema().keys) {
        EXPECT_FALSE(key.meaning.empty()) << key.path();
        EXPECT_FALSE(key.rule().empty()) << key.path();
    }
}

}  // namespace
