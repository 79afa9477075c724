// Reference: the registry, whose kinds and keys are counted here once more, and a deformer whose time is given.
#include "experiments/studies/timing/bench.hpp"

#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace experiments;

const BenchBody& bar()
{
    static const BenchBody body =
        make_bench_body("bar", test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {6, 2, 2}));
    return body;
}

constexpr Rounds two_rounds = {.seconds = 0.0, .fewest = 2, .most = 2};

using Code = std::pair<std::string, std::string>;  // order and precision, as the table states them

struct SettingsOfKinds {
    std::vector<std::string> kinds;
    std::set<Code> codes;
    bool iterates = true;
};

class DeformerSettings : public testing::TestWithParam<SettingsOfKinds> {};

// A ratio is to plain code: of the same precision where there is such code, otherwise in f64.
TEST_P(DeformerSettings, AreTheCodesOfTheKindEachWithItsPlainOne)
{
    const auto& [kinds, codes, iterates] = GetParam();
    for (const std::string& kind : kinds) {
        SCOPED_TRACE(kind);
        const std::vector<DeformerSetting> settings = deformer_settings(*find_deformer_kind(kind));
        EXPECT_EQ(settings.size(), codes.size());
        std::set<Code> found;
        for (const DeformerSetting& setting : settings) {
            found.insert({setting.order, setting.precision});
            const DeformerTraits traits = traits_of(setting.spec);
            const nlohmann::json options = to_json(setting.spec).at("options");
            EXPECT_EQ(traits.precision, setting.precision);
            EXPECT_EQ(traits.packed, setting.order != "plain" && setting.order != "spread" && setting.order != "");
            if (setting.order != "" && options.contains("order")) {
                EXPECT_EQ(options.at("order"), setting.order);
            }
            const DeformerSetting& plain = settings.at(setting.plain);
            EXPECT_FALSE(traits_of(plain.spec).packed);
            EXPECT_EQ(plain.precision, codes.contains({"plain", setting.precision}) ? setting.precision : "f64");
            ASSERT_EQ(setting.twice.has_value(), iterates);
            if (!iterates) continue;
            nlohmann::json expected = options, twice = to_json(*setting.twice).at("options");
            EXPECT_EQ(traits_of(*setting.twice).iterations, 2 * *traits.iterations);
            expected.erase("iterations"), twice.erase("iterations");
            EXPECT_EQ(twice, expected);
        }
        EXPECT_EQ(found, codes);
    }
}

const std::set<Code> every_order = {{"plain", "f32"}, {"spread", "f32"}, {"ordered", "f32"},
                                    {"plain", "f64"}, {"spread", "f64"}, {"ordered", "f64"}};
const std::set<Code> packed_and_plain = {{"packed", "f32"}, {"packed", "f64"}, {"plain", "f64"}};
INSTANTIATE_TEST_SUITE_P(
    OfKinds, DeformerSettings,
    testing::Values(SettingsOfKinds{{"pbs"}, every_order}, SettingsOfKinds{{"xpbd"}, every_order, false},
                    SettingsOfKinds{{"lbs", "dqs"}, packed_and_plain, false},
                    SettingsOfKinds{{"quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean", "projective_dynamics"},
                                    packed_and_plain},
                    SettingsOfKinds{{"pbs_author"}, {{"", "f64"}}},
                    SettingsOfKinds{{"xpbd_small_steps"}, {{"", "f64"}}, false}));

struct GivenOptions {
    pbs::Precision precision = pbs::Precision::f64;
};

// A deformer that works for 2 ms in f64 and 1 ms in f32, or longer where a virtual machine counts the time of others,
// too.
class GivenTime : public Deformer {
public:
    explicit GivenTime(const GivenOptions& options)
        : seconds_(options.precision == pbs::Precision::f32 ? 1e-3 : 2e-3), taken_ms_(taken_ms[options.precision])
    {
    }
    void reset(const pbs::Character& character) override { positions_ = character.mesh.rest; }
    pbs::StepSummary advance(const pbs::Pose&, double) override
    {
        const double start = thread_cpu_s();
        double taken = 0.0;
        while (taken < seconds_) taken = thread_cpu_s() - start;
        taken_ms_.push_back(1e3 * taken);
        return {};
    }
    const pbs::Positions& positions() const override { return positions_; }

    static inline std::map<pbs::Precision, std::vector<double>> taken_ms;  // of each frame

private:
    double seconds_;
    std::vector<double>& taken_ms_;
    pbs::Positions positions_;
};

// Every registered kind has a row, also one that is registered later, except those that only a scene's tables define.
TEST(DeformerTimings, TakeUpWhatIsRegistered)
{
    add_deformer_kind(
        kind_of<GivenTime>("given_time", "works for a given time",
                           OptionFields<GivenOptions>("given_time")
                               .add("precision", &GivenOptions::precision, {.meaning = "floating point"})));
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
    // The time of a frame is one of its times, or between them, and little more: a reading of the clock takes less than
    // a tenth of a millisecond.
    const double ms_frame = given[0].at("ms_frame");
    const auto f32 = std::ranges::minmax(GivenTime::taken_ms[pbs::Precision::f32]),
               f64 = std::ranges::minmax(GivenTime::taken_ms[pbs::Precision::f64]);
    EXPECT_GE(f32.min, 1.0);
    EXPECT_GE(f64.min, 2.0);
    EXPECT_GE(ms_frame, f32.min);
    EXPECT_LE(ms_frame, f32.max + 0.1);
    EXPECT_GE(given[0].at("ratio_to_plain"), f64.min / (f32.max + 0.1));
    EXPECT_LE(given[0].at("ratio_to_plain"), (f64.max + 0.1) / f32.min);
    EXPECT_EQ(given[1].at("ratio_to_plain"), 1.0);
    EXPECT_FALSE(given[0].contains("ms_iteration"));
    EXPECT_NEAR(given[0].at("ns_tet").get<double>() * double(bar().mesh().tets.rows()), 1e6 * ms_frame, 1e-6 * 1e6);
}

}  // namespace
