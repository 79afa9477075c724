// C09 from a small limb jolted along its bones by 2 mm, with the correct solver and with broken ones, all in the order
// plain. Reference:
// - nothing projected: nothing pulls the flesh after the skeleton, so it lags behind by the whole jolt for ever and
// swings at no setting.
// - stretch dropped: k_stretch has nothing to act on, so every value of it gives the same series, to the bit.
// - volume sign: the projections add energy, so at no setting does the flesh come to rest as well as with the correct
// solver.
// - one class dropped: fewer constraints hold the flesh, so every frequency falls (Rayleigh), and it still swings. A
//   jolt along the spheres of the bind constraints was expected not to involve them, but they hold the parts to which
//   the flesh is attached.
// - any: half the time step still gives twice the frequency, since Algorithm 1 contains steps but no time.
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/broken_solver.hpp"
#include "tests/support/study_claims.hpp"

#include <gtest/gtest.h>

#include <map>

namespace jiggle_tests {
namespace {

using namespace analysis;
using namespace experiments;
using namespace test_support;

const JoltCase small_limb{.scene = "limb_twist",
                          .overrides = {"character.vertices=300", "pbs.k_stretch=1", "pbs.jiggle.k_stretch=0.1",
                                        "pbs.jiggle.k_bind=1", "pbs.order=plain", "pbs.precision=f64"},
                          .settings = {{},
                                       {"pbs.jiggle.k_stretch=0.05"},
                                       {"pbs.jiggle.k_stretch=0.2"},
                                       {"pbs.jiggle.k_stretch=0.5"},
                                       {"pbs.time_step_s=0.005"},
                                       {"pbs.iterations=48"}},
                          .jolt = {.direction = pbs::Vec3::UnitX()}};

const std::vector<ResponseRow>& jolted(Broken how)
{
    static std::map<Broken, std::vector<ResponseRow>> kept;
    if (const auto found = kept.find(how); found != kept.end()) return found->second;
    const pbs::Character character = pbs::make_character(scene_of(small_limb).character);
    const std::vector<int> probe = zone_contents(character).pieces.front();
    Jolt jolt = small_limb.jolt;
    jolt.length_m = 0.002;
    std::vector<ResponseRow>& measured = kept[how];
    for (const Overrides& setting : small_limb.settings) {
        const Scene scene = scene_of(small_limb, setting);
        DeformerSpec spec = spec_of(scene, "pbs");
        auto& options = options_of<pbs::PbsOptions>(spec);
        options = broken(options, how);
        options.precision = pbs::Precision::f64;
        jolt.time_step_s = scene.motion.time_step_s;
        measured.push_back(setting_of(scene));
        measured.back().response = jolt_response(character, spec, probe, jolt);
    }
    return measured;
}

bool holds(const std::string& id, Broken how)
{
    return judged(claim(id), claim(id).own, jiggle_values("limb", jolted(how))).held == 1;
}

double value(Broken how, const std::string& quantity)
{
    return values_of(jiggle_values("limb", jolted(how)), quantity).at(0).value;
}

const char* const share = "share_of_settings_that_swing";
const char* const amplitudes = "amplitude_ratio_over_k_stretch";

TEST(BrokenJiggle, AsItIsItComesToRestAndKStretchSetsTheFrequency)
{
    EXPECT_TRUE(holds("C09a", Broken::nothing));
    EXPECT_EQ(value(Broken::nothing, share), 1.0);
    EXPECT_GT(value(Broken::nothing, amplitudes), 1.0);
    EXPECT_GT(values_of(jiggle_values("limb", jolted(Broken::nothing)), "frequency_ratio_over_k_stretch").at(0).low,
              1.0);
    EXPECT_GT(value(Broken::nothing, "rank_correlation_of_frequency_and_k_stretch"), 0.9);
}

TEST(BrokenJiggle, WithNothingProjectedItStaysBehindForEver)
{
    for (const ResponseRow& one : jolted(Broken::nothing_projected)) {
        EXPECT_FALSE(one.response.swing.found()) << text_of(key_of("limb", one));
        EXPECT_EQ(one.response.left_over_peak, 1.0) << text_of(key_of("limb", one));
    }
    EXPECT_EQ(value(Broken::nothing_projected, share), 0.0);
    EXPECT_FALSE(holds("C09a", Broken::nothing_projected));
    EXPECT_FALSE(holds("C09b", Broken::nothing_projected));
}

TEST(BrokenJiggle, WithoutStretchKStretchSaysNothing)
{
    const auto& dropped = jolted(Broken::stretch_dropped);
    const auto& sound = jolted(Broken::nothing);
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_EQ(dropped[i].response.excursion_m, dropped[0].response.excursion_m);
        EXPECT_NE(sound[i].response.excursion_m, sound[0].response.excursion_m);
    }
    EXPECT_EQ(value(Broken::stretch_dropped, amplitudes), 1.0);
    EXPECT_FALSE(holds("C09b", Broken::stretch_dropped));
}

TEST(BrokenJiggle, TheSignTurnedRoundDoesNotComeToRest)
{
    const auto &turned = jolted(Broken::volume_sign), &sound = jolted(Broken::nothing);
    for (std::size_t i = 0; i < sound.size(); ++i) {
        const bool rests = turned[i].response.left_over_peak <= sound[i].response.left_over_peak;
        EXPECT_FALSE(turned[i].response.finished && rests) << text_of(key_of("limb", sound[i]));
    }
    EXPECT_TRUE(holds("C09a", Broken::nothing));
    EXPECT_FALSE(holds("C09a", Broken::volume_sign));
}

TEST(BrokenJiggle, WithOneClassLessItSwingsMoreSlowlyAndAStepIsAStep)
{
    const auto frequency = [](Broken how) {
        return values_of(jiggle_values("limb", jolted(how)), "frequency_hz",
                         {.k_stretch = 0.1, .iterations = 24.0, .time_step_s = 0.01})
            .at(0);
    };
    for (const Broken how : {Broken::bind_dropped, Broken::stretch_dropped, Broken::volume_dropped}) {
        EXPECT_TRUE(holds("C09a", how)) << name_of(how);
        EXPECT_LT(frequency(how).high, frequency(Broken::nothing).low) << name_of(how);
    }
    for (const Broken how : {Broken::nothing, Broken::bind_dropped, Broken::stretch_dropped, Broken::volume_dropped})
        EXPECT_EQ(value(how, "frequency_ratio_at_half_time_step"), 2.0) << name_of(how);  // halves are exact
}

// The study's own controls on a small limb: LBS has no amplitude, undamped elements do not come to rest, damped ones
// do, and swing less far the stiffer they are.
TEST(JiggleControls, OfTheStudyBehave)
{
    const test_support::ScratchFolder folder;
    JoltCase of = small_limb;
    of.young_pa = {5.0e4, 2.0e3, 5.0e3, 2.0e4};
    EXPECT_EQ(record_jolts(of, folder.path().string()), "");
    const auto measured = measurements(folder / "measurements.csv");
    for (const char* id : {"C09a", "C09b"})
        for (const Judged& control : verdict_from(id, measured).others) {
            EXPECT_EQ(control.n, 1) << control.selection.name;
            EXPECT_TRUE(control.behaves) << control.selection.name;
        }
}

}  // namespace
}  // namespace jiggle_tests
