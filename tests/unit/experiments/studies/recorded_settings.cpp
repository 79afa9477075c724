// --resume repeats a run when anything changed that its work depends on. A struct of settings that leaves a member out
// is refused when it is recorded, which the plan of each study does (contract.cpp). Reference: the members of the
// structs here, each changed in turn.
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/timing.hpp"
#include "experiments/studies/work_precision/measuring.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace recorded_settings_tests {
namespace {

using namespace experiments;

struct Inner {
    double value = 0.5;
};
struct Settings {
    bool flag = false;
    int count = 1;
    double length_m = 0.25;
    std::string name = "limb";
    Stratum stratum = Stratum::training;
    pbs::Vec3 axis = pbs::Vec3::UnitX();
    std::vector<int> sizes = {1, 2};
    std::vector<Inner> inner = {{}, {}};
    analysis::CaseKey of = {.body = "limb", .motion = "bend"};
    int threads = 1;  // on which no result depends
};

RECORD_SETTINGS(Inner, value)

OptionFields<Settings> most_fields()
{
    return OptionFields<Settings>("settings")
        .record("flag", &Settings::flag)
        .record("count", &Settings::count)
        .record("length_m", &Settings::length_m)
        .record("name", &Settings::name)
        .record("stratum", &Settings::stratum)
        .record("axis", &Settings::axis)
        .record("sizes", &Settings::sizes)
        .record("inner", &Settings::inner);
}

TEST(RecordedSettings, AreRefusedUnlessTheyHaveEachMember)
{
    EXPECT_THROW(most_fields().complete(1), std::logic_error);
    EXPECT_THROW(most_fields().record("flag", &Settings::flag).complete(1), std::logic_error) << "twice the same";
    EXPECT_NO_THROW(most_fields().record("of", &Settings::of).complete(1));
    EXPECT_THROW(most_fields().record("of", &Settings::of).complete(), std::logic_error);
}

TEST(RecordedSettings, DifferWithTheValueOfEachMember)
{
    const OptionFields<Settings> fields = most_fields().record("of", &Settings::of);
    const nlohmann::json recorded = fields.json({});
    using Change = void (*)(Settings&);
    const std::vector<Change> changes = {[](Settings& other) { other.flag = true; },
                                         [](Settings& other) { other.count = 2; },
                                         [](Settings& other) { other.length_m += 0x1p-50; },
                                         [](Settings& other) { other.name = "limbs"; },
                                         [](Settings& other) { other.stratum = Stratum::fold; },
                                         [](Settings& other) { other.axis.z() = 1.0; },
                                         [](Settings& other) { other.sizes[1] = 3; },
                                         [](Settings& other) { other.sizes.push_back(2); },
                                         [](Settings& other) { other.inner[1].value = 1.0; }};
    for (std::size_t place = 0; place < changes.size(); ++place) {
        Settings other;
        changes[place](other);
        EXPECT_NE(fields.json(other), recorded) << place;
    }
    for (const analysis::CaseKeyField& field : analysis::case_key_fields()) {
        Settings other;
        if (field.text)
            other.of.*field.text = "other";
        else
            other.of.*field.number = 1.5;
        EXPECT_NE(fields.json(other), recorded) << field.name;
    }
}

template <typename Case>
std::string no_work(const Case&, const std::string&)
{
    return "";
}

// Its settings are those of a table of three columns, and its methods those of cases.toml and a file of the user's.
TEST(RecordedSettings, OfAComparison)
{
    const ReferencePose pose{"limb_bend_60",
                             {.body = "limb", .motion = "bend", .angle_deg = 60.0},
                             Stratum::movement,
                             read_scene("limb_bend", {}),
                             12};
    const ComparisonCase of{.name = "limb",
                            .body = "limb",
                            .clip = "01_01",
                            .poses = {pose},
                            .settings = {{1.0, "pbs", "pbs.iterations=4"}}};
    static_assert(member_count<ComparisonCase>() == 8);
    const test_support::ScratchFolder scratch;
    const std::string folder = scratch / "run";
    carry_out(work_run("run", of, 1.0, no_work<ComparisonCase>), folder);
    const auto is_repeated = [&](const auto& change) {
        ComparisonCase changed = of;
        change(changed);
        return !is_finished(work_run("run", changed, 1.0, no_work<ComparisonCase>), folder);
    };
    EXPECT_FALSE(is_repeated([](ComparisonCase&) {}));
    using Change = void (*)(ComparisonCase&);
    for (const Change change : std::vector<Change>{
             [](ComparisonCase& other) { other.name += "_2"; }, [](ComparisonCase& other) { other.body = "human"; },
             [](ComparisonCase& other) { other.what = Measured::training; },
             [](ComparisonCase& other) { other.clip = "01_03"; },
             [](ComparisonCase& other) { other.poses.push_back(other.poses[0]); },
             [](ComparisonCase& other) { other.poses[0].frame = 11; }, [](ComparisonCase& other) { other.rounds = 5; },
             [](ComparisonCase& other) { other.settings[0].budget_ms = 2.0; },
             [](ComparisonCase& other) { other.settings[0].method = "xpbd"; },
             [](ComparisonCase& other) { other.settings[0].setting = "pbs.iterations=8"; },
             [](ComparisonCase& other) { other.settings.clear(); },
             [](ComparisonCase& other) { other.external = {ComparedMethod{.external = default_spec("external")}}; }})
        EXPECT_TRUE(is_repeated(change));
    EXPECT_FALSE(is_repeated([](ComparisonCase& other) { other.settings[0].training_ms = 0.5; }))
        << "a report of the choice";
}

// Programs and libraries are recorded by their content.
TEST(RecordedSettings, OfADeformerOfTheUsersOwn)
{
    DeformerSpec spec = default_spec("external");
    spec.options = ExternalOptions{.command = {"python3", "mine.py"}, .file_hashes = {"", "1f"}};
    const nlohmann::json recorded = to_json(spec);
    EXPECT_EQ(to_json(ComparisonCase{.external = {ComparedMethod{.external = spec}}}).at("external"),
              nlohmann::json::array({recorded}));
    const auto with = [&](void (*change)(ExternalOptions & options)) {
        DeformerSpec other = spec;
        change(options_of<ExternalOptions>(other));
        return to_json(other);
    };
    EXPECT_EQ(with([](ExternalOptions& options) { options.scene = "moved.toml"; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.command.push_back("4"); }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.command = {}, options.library = "libmine.so"; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.has_memory = true; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.file_hashes[1] = "2e"; }), recorded);
    DeformerSpec renamed = spec;
    renamed.name = "yours";
    EXPECT_NE(to_json(renamed), recorded);
}

TEST(RecordedSettings, OfATimedSceneHaveTheRefinementsOfItsMesh)
{
    TimedCase timed{.name = "man_1654", .scene = read_scene("limb_bend", {}), .model = "Man"};
    const nlohmann::json recorded = to_json(timed);
    timed.scene.character.refinements = 2;
    EXPECT_NE(to_json(timed), recorded);
}

}  // namespace
}  // namespace recorded_settings_tests
