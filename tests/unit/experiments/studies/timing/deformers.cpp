// Reference: the registry, whose kinds and keys are counted here once more, and a deformer whose time is given.
#include "experiments/studies/timing/bench.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/settings/scene_values.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <set>

namespace {

using namespace experiments;

const BenchBody& bar()
{
    static const BenchBody body = make_bench_body("bar", test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {6, 2, 2}));
    return body;
}

constexpr Rounds two_rounds = {.seconds = 0.0, .fewest = 2, .most = 2};

// PBS has three orders in two precisions.
TEST(DeformerSettings, EveryOrderAndPrecision)
{
    const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind("pbs"));
    ASSERT_EQ(settings.size(), 6u);
    std::set<std::pair<std::string, std::string>> different;
    for (const DeformerSetting& setting : settings) {
        different.insert({setting.order, setting.precision});
        const auto& options = options_of<pbs::PbsOptions>(setting.spec);
        EXPECT_EQ(name_of(options.order), setting.order);
        EXPECT_EQ(name_of(options.precision), setting.precision);
        EXPECT_EQ(settings[setting.plain].order, "plain");
        EXPECT_EQ(settings[setting.plain].precision, setting.precision);
        ASSERT_TRUE(setting.twice);
        EXPECT_EQ(options_of<pbs::PbsOptions>(*setting.twice).iterations, 2 * options.iterations);
        EXPECT_EQ(options_of<pbs::PbsOptions>(*setting.twice).order, options.order);
    }
    EXPECT_EQ(different.size(), 6u);
}

// The ratio of a blend is to the plain blend, not to packed code in f64.
TEST(DeformerSettings, OfABlendAreItsPrecisionsAndThePlainBlend)
{
    for (const char* kind : {"lbs", "dqs"}) {
        const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind(kind));
        std::set<std::pair<std::string, std::string>> different;
        for (const DeformerSetting& setting : settings) {
            EXPECT_FALSE(setting.twice);
            EXPECT_FALSE(traits_of(settings[setting.plain].spec).packed);
            different.insert({setting.order, setting.precision});
        }
        EXPECT_EQ(settings.size(), 3u);
        EXPECT_EQ(different, (std::set<std::pair<std::string, std::string>>{{"packed", "f32"}, {"packed", "f64"}, {"plain", "f64"}}));
    }
}

TEST(DeformerSettings, WithoutKeysOfItsCodeThereIsOneWithItsDefaults)
{
    const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind("pbs_author"));
    ASSERT_EQ(settings.size(), 1u);
    EXPECT_EQ(settings[0].plain, 0u);
    EXPECT_EQ(settings[0].order, "");
    EXPECT_EQ(settings[0].precision, "f64");
    EXPECT_TRUE(settings[0].twice);
}

// Each order in each precision; the baseline is the plain code of the same precision.
TEST(DeformerSettings, EveryOrderAndPrecisionOfXpbd)
{
    for (const char* kind : {"xpbd", "xpbd_small_steps"}) {
        const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind(kind));
        ASSERT_EQ(settings.size(), std::string(kind) == "xpbd" ? 6u : 1u) << kind;
        for (const DeformerSetting& setting : settings) {
            EXPECT_EQ(traits_of(setting.spec).packed, setting.order != "plain" && setting.order != "") << kind;
            EXPECT_EQ(traits_of(setting.spec).precision, setting.precision) << kind;
            EXPECT_EQ(traits_of(settings[setting.plain].spec).packed, false) << kind;
            EXPECT_EQ(settings[setting.plain].precision, setting.precision) << kind;
        }
    }
}

// Packed in both precisions, and plain in f64, the baseline of both.
TEST(DeformerSettings, PackedAndPlainCode)
{
    for (const char* kind : {"quasi_newton", "vbd", "xpbd_neo_hookean", "projective_dynamics"}) {
        const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind(kind));
        ASSERT_EQ(settings.size(), 3u) << kind;
        std::set<std::pair<std::string, std::string>> different;
        for (const DeformerSetting& setting : settings) {
            different.insert({setting.order, setting.precision});
            EXPECT_EQ(setting.precision, traits_of(setting.spec).precision);
            EXPECT_EQ(setting.order == "packed", traits_of(setting.spec).packed);
            EXPECT_EQ(settings[setting.plain].order, "plain");
            ASSERT_TRUE(setting.twice);
            EXPECT_EQ(*traits_of(*setting.twice).iterations, 2 * *traits_of(setting.spec).iterations);
        }
        EXPECT_EQ(different, (std::set<std::pair<std::string, std::string>>{{"packed", "f32"}, {"packed", "f64"}, {"plain", "f64"}}));
    }
}

struct GivenOptions {
    std::string precision = "f64";
};

// A deformer that works for 2 ms in f64 and 1 ms in f32.
class GivenTime : public Deformer {
public:
    explicit GivenTime(double seconds) : seconds_(seconds) {}
    void reset(const pbs::Character& character) override { positions_ = character.mesh.rest; }
    pbs::StepSummary advance(const pbs::Pose&, double) override
    {
        const double start = thread_cpu_s();
        while (thread_cpu_s() - start < seconds_) {
        }
        return {};
    }
    const pbs::Positions& positions() const override { return positions_; }

private:
    double seconds_;
    pbs::Positions positions_;
};

DeformerKind given_kind()
{
    return {.name = "given_time",
            .meaning = "works for a given time",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<GivenTime>(options_of<GivenOptions>(spec).precision == "f32" ? 1e-3 : 2e-3);
            },
            .options = GivenOptions{},
            .keys = {{.table = "given_time",
                      .name = "precision",
                      .type = KeyType::text,
                      .default_json = "\"f64\"",
                      .choices = {"f32", "f64"},
                      .meaning = "floating point"}},
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { options_of<GivenOptions>(spec).precision = values.text(table + ".precision"); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits { return {.precision = options_of<GivenOptions>(spec).precision}; }};
}

// Every registered kind has a row, also one that is registered later, except those that only a scene's tables define.
TEST(DeformerTimings, TakeUpWhatIsRegistered)
{
    add_deformer_kind(given_kind());
    const nlohmann::json timings = time_deformers(bar(), two_rounds);
    std::set<std::string> timed;
    std::vector<nlohmann::json> given;
    for (const nlohmann::json& timing : timings) {
        const std::string deformer = timing.at("deformer");
        timed.insert(deformer);
        EXPECT_EQ(timing.contains("ms_frame"), !timing.contains("left_out")) << deformer;
        if (timing.contains("ms_frame")) {
            EXPECT_GT(timing.at("ms_frame"), 0.0) << deformer;
        }
        if (timing.value("order", "") == "plain") {
            EXPECT_EQ(timing.at("ratio_to_plain"), 1.0);
        }
        if (deformer == "given_time") given.push_back(timing);
    }
    for (const DeformerKind& kind : deformer_kinds())
        EXPECT_EQ(timed.contains(kind.name), !kind.needs_list || kind.name == "fem") << kind.name;

    ASSERT_EQ(given.size(), 2u);
    EXPECT_EQ(given[0].at("precision"), "f32");
    // A frame takes at least its time, and little more: a reading of the clock takes less than a tenth of a millisecond.
    const double ms_frame = given[0].at("ms_frame");
    EXPECT_GE(ms_frame, 1.0);
    EXPECT_LE(ms_frame, 1.1);
    EXPECT_NEAR(given[0].at("ratio_to_plain"), 2.0, 0.2);
    EXPECT_EQ(given[1].at("ratio_to_plain"), 1.0);
    EXPECT_FALSE(given[0].contains("ms_iteration"));
    EXPECT_NEAR(given[0].at("ns_tet").get<double>() * double(bar().mesh().tets.rows()), 1e6 * ms_frame, 1e-6 * 1e6);
}

}  // namespace
