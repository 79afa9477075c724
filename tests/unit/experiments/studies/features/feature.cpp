// A pair of scenes differs in its feature alone, and the program reads every scene.
#include "experiments/studies/features/feature.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace experiments;

TEST(Features, EveryPairIsReadAndDiffers)
{
    for (const Feature& feature : features()) {
        SCOPED_TRACE(feature.name);
        EXPECT_FALSE(feature.without == feature.with);
        const Scene without = scene_of("limb_bend", {"motion.frames=3"}, feature.without);
        const Scene with = scene_of("limb_bend", {"motion.frames=3"}, feature.with);
        const bool same_scene = to_json(without) == to_json(with);
        EXPECT_EQ(same_scene, feature.with.threads != feature.without.threads || feature.with.progress);
    }
}

TEST(Features, TheBareSceneHasNothingThatAFeatureAdds)
{
    const Scene bare = scene_of("human_01_01", {}, {});
    ASSERT_EQ(bare.deformers.size(), 1u);
    EXPECT_EQ(bare.deformers[0].kind, "pbs");
    EXPECT_TRUE(bare.reference.empty());
    EXPECT_FALSE(bare.output.errors || bare.output.sections || bare.output.surface || bare.output.writes(0));
}

TEST(Features, HaveNamesOfTheirOwn)
{
    std::set<std::string> names;
    for (const Feature& feature : features()) EXPECT_TRUE(names.insert(feature.name).second) << feature.name;
}

}  // namespace
