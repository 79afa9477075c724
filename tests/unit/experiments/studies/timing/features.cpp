// Features as pairs of scenes, and the arithmetic of their costs.
#include "experiments/studies/timing/timing.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <stdexcept>

namespace {

using namespace experiments;

// Those that the study times on the human.
std::vector<Feature> features()
{
    const nlohmann::json document = cases_document("timing");
    for (nlohmann::json one : document.at("case"))
        if (one.at("name") == "features_{body}") {
            one.update({{"body", "human"}, {"full_s", 1.0}});
            return features_of({"timing", one, true});
        }
    ADD_FAILURE() << "no such case";
    return {};
}

// A pair of scenes differs in its feature alone, and the program reads every scene.
TEST(Features, EveryPairIsReadAndDiffers)
{
    std::set<std::string> names;
    for (const Feature& feature : features()) {
        SCOPED_TRACE(feature.name);
        EXPECT_TRUE(names.insert(feature.name).second);
        EXPECT_FALSE(feature.without == feature.with);
        const Scene without = scene_of("limb_bend", {"motion.frames=3"}, feature.without);
        const Scene with = scene_of("limb_bend", {"motion.frames=3"}, feature.with);
        const bool same_scene = to_json(without) == to_json(with);
        EXPECT_EQ(same_scene, feature.with.threads != feature.without.threads || feature.with.progress);
    }
    EXPECT_EQ(names.size(), 21u);
}

TEST(Features, TheBareSceneHasNothingThatAFeatureAdds)
{
    const Scene bare = scene_of("human_01_01", {}, {});
    ASSERT_EQ(bare.deformers.size(), 1u);
    EXPECT_EQ(bare.deformers[0].kind, "pbs");
    EXPECT_TRUE(bare.reference.empty());
    EXPECT_FALSE(bare.output.errors || bare.output.sections || bare.output.surface || bare.output.writes(0));
}

// The arithmetic of the cost table. Expected: medians, quartiles and ratios by hand, on rounds whose disturbances are
// known.

// The run.json of a run of three frames in `frame_s` each, half of which is PBS's step.
nlohmann::json run(double frame_s, double start_s)
{
    const nlohmann::json seconds = {{"character", start_s},
                                    {"motion", 0.0},
                                    {"set_up", 0.0},
                                    {"metrics_set_up", 0.0},
                                    {"total", 3.0 * frame_s + start_s},
                                    {"deformers", {{"pbs", {{"step", 1.5 * frame_s}}}}}};
    return {
        {"outcome", {{"frames", 3}}},
        {"cost", {{"seconds", seconds}, {"cpu_seconds", seconds}, {"peak_memory_mb", 42.0}, {"shared_objects", 60}}}};
}

Samples costs(const std::vector<double>& frame_ms)
{
    Samples samples(7);
    for (const double ms : frame_ms) {
        const auto one = costs_of_run(run(1e-3 * ms, 0.125), scene_of("limb_bend", {"motion.frames=3"}, {}));
        for (std::size_t k = 0; k < samples.size(); ++k) samples[k].push_back(one.at(k));
    }
    return samples;
}

// The total of 125 ms and three frames is rounded; a frame, its share of the step and their multiples go through five
// roundings.
double frame_error_ms(double ms)
{
    return test_support::rounding_error(1, (125.0 + 3.0 * ms) / 3.0) + test_support::rounding_error(5, ms);
}

TEST(FeatureTable, CostsComeFromTheRunsRecord)
{
    const Samples one = costs({2.0});
    for (const int wall_or_processor : {0, 1}) {
        EXPECT_NEAR(one[wall_or_processor][0], 2.0, frame_error_ms(2.0));
        EXPECT_NEAR(one[2 + wall_or_processor][0], 1.0, test_support::rounding_error(5, 1.0));  // step
    }
    EXPECT_EQ(one[4][0], 0.125);
    EXPECT_EQ(one[5][0], 42.0);
    EXPECT_EQ(one[6][0], 60.0);
}

TEST(FeatureTable, RatiosAreThoseWithinARound)
{
    // The machine halves its speed in the second round: both runs double, and their ratio of 1.5 stays.
    const Compared compared = compare({2.0, 4.0, 2.0}, {3.0, 6.0, 3.0});
    EXPECT_EQ(compared.without.median, 2.0);
    EXPECT_EQ(compared.with.median, 3.0);
    for (const double ratio : {compared.ratio.lower, compared.ratio.median, compared.ratio.upper})
        EXPECT_EQ(ratio, 1.5);
    EXPECT_EQ(compared.ratio.rounds, 3);
    const Spread quartiles = compare({1.0, 1.0, 1.0, 1.0, 1.0}, {1.0, 2.0, 3.0, 4.0, 5.0}).ratio;
    EXPECT_EQ(quartiles.lower, 2.0);
    EXPECT_EQ(quartiles.median, 3.0);
    EXPECT_EQ(quartiles.upper, 4.0);
    EXPECT_THROW(compare({1.0, 1.0}, {1.0}), std::logic_error);
    EXPECT_THROW(compare({}, {}), std::logic_error);
}

TEST(FeatureTable, OnlyAFeatureThatMovesTheResultHasAChange)
{
    const FeatureRow still = feature_row("limb", "sleep", costs({1.0}), costs({2.0}));
    const FeatureRow moving = feature_row("limb", "sleep", costs({1.0}), costs({2.0}), ResultChange{2e-3, 0.25});
    const analysis::CsvTable table = table_of(feature_columns, std::vector<FeatureRow>{still, moving});
    EXPECT_FALSE(table.number_or_nothing(0, "largest_distance_m").has_value());
    EXPECT_EQ(table.number(1, "largest_distance_m"), 2e-3);
    EXPECT_EQ(table.number(1, "volume_difference_pct"), 0.25);
    EXPECT_EQ(table.number(1, "peak_mb_with"), 42.0);
    EXPECT_NEAR(table.number(1, "step_ms_without"), 0.5, test_support::rounding_error(5, 0.5));
    EXPECT_NEAR(table.number(1, "frame_cpu_ms_ratio"), 2.0,
                frame_error_ms(2.0) + 2.0 * frame_error_ms(1.0) + test_support::rounding_error(1, 2.0));
    EXPECT_EQ(table.integer(1, "shared_objects_with"), 60);
    EXPECT_EQ(table.integer(1, "rounds"), 1);
}

}  // namespace
