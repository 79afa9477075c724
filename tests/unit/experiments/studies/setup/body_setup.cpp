// Reference: differences of scenes, and shares and means of a few frames, by hand.
#include "experiments/studies/setup/body_setup.hpp"

#include "experiments/characters/bodies.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace {

using namespace experiments;

TEST(BodySetup, BodyAndVerticesAloneAreTheBodyAndEveryFurtherKeyIsAKeyOfTheScene)
{
    const auto changed = [](const Scene& scene) { return keys_changed(shared_scene(5.0).resolved, scene.resolved); };
    const Scene ring = scene_of({"ring", 1200}, 5.0);
    EXPECT_TRUE(changed(ring).empty());
    EXPECT_EQ(ring.character.body, "ring");
    EXPECT_EQ(ring.character.vertices, 1200);
    for (const auto& further : further_keys())
        EXPECT_EQ(changed(scene_of({"ring", 0, further}, 5.0)).size(), further.size());
}

TEST(BodySetup, EveryBodyTakesTheSharedClip)
{
    for (const char* body : {"human", "ring"}) {
        if (!pbs::body_is_installed(body)) continue;
        const Scene scene = scene_of({body, 600}, 5.0);
        EXPECT_GT(make_case_motion(scene.motion, pbs::make_character(scene.character), scene.file).motion.steps.size(),
                  1u)
            << body;
    }
}

TEST(BodySetup, CountsEveryFurtherKeyThatIsChangedAddedOrMissing)
{
    const auto further = [](const std::vector<std::string>& keys) { return scene_of({"ring", 0, keys}, 5.0).resolved; };
    const nlohmann::json character = {{"character", {{"body", "human"}, {"vertices", 0}, {"skeleton_scale", 1.0}}}},
                         other_character = {{"character",
                                             {{"body", "ring"}, {"vertices", 1200}, {"skeleton_scale", 0.5}}}},
                         pbs = {{"pbs", {{"iterations", 24}}}},
                         pbs_with_jiggle = {{"pbs", {{"iterations", 24}, {"jiggle", 0.5}}}};
    using Keys = std::vector<std::string>;
    for (const auto& [shared, own, changed] :
         {std::tuple(shared_scene(5.0).resolved, further({"pbs.k_volume=0.5", "pbs.gravity_m_s2=[0.0, 0.0, -9.81]"}),
                     Keys{"pbs.gravity_m_s2", "pbs.k_volume"}),
          {character, other_character, Keys{"character.skeleton_scale"}},
          {pbs, pbs_with_jiggle, Keys{"pbs.jiggle"}},
          {pbs_with_jiggle, pbs, Keys{"pbs.jiggle"}}})
        EXPECT_EQ(keys_changed(shared, own), changed);
}

TEST(BodySetup, WhatBreaksDownOrIsRefusedIsTriedWithFurtherKeysAndWhatNeverRunsIsNotLeftOut)
{
    const auto ran = tried_setups({"ring"}, [](const BodySetup&) { return std::string(); });
    ASSERT_EQ(ran.size(), 1u);
    EXPECT_TRUE(ran[0].setup.further.empty());
    const auto tried = tried_setups({"ring"}, [](const BodySetup& setup) -> std::string {
        if (setup.further.empty()) throw pbs::InputError("", 0, "skinning.weights", "paper", "expected a bone");
        return setup.further == further_keys()[2] ? "" : "pbs is not finite at frame 3";
    });
    ASSERT_EQ(tried.size(), 3u);
    EXPECT_NE(tried[0].failure.find("expected a bone"), std::string::npos);
    EXPECT_EQ(tried[1].failure, "pbs is not finite at frame 3");
    EXPECT_EQ(tried[2].failure, "");
    EXPECT_EQ(tried[2].setup.further, further_keys()[2]);

    const auto never_ran = tried_setups({"ring"}, [](const BodySetup&) { return std::string("broken"); });
    EXPECT_EQ(never_ran.size(), further_keys().size());
    const auto measurements = not_set_up({.body = "ring"});
    ASSERT_EQ(measurements.size(), 2u);
    EXPECT_TRUE(std::isnan(measurements[0].value));
    EXPECT_EQ(measurements[1].value, 0.0);
}

// The tets that lack a skeleton are accepted with the skeleton of the surface that lacks tets.
TEST(BodySetup, UnsuitableBodiesAreRefusedForWhatTheyLackAlone)
{
    const test_support::ScratchFolder folder;
    const auto keys = [&](const char* body) { return with_files({body}, folder.path().string()).further; };
    const auto failures = [&](const std::vector<std::string>& further) {
        const auto make = [](const BodySetup& setup) {
            const Scene scene = scene_of(setup, 5.0);
            make_case_motion(scene.motion, pbs::make_character(scene.character), scene.file);
            return std::string();
        };
        std::string failures;
        for (const TriedSetup& tried : tried_setups({"", 0, further}, make)) failures += tried.failure + "\n";
        return failures;
    };
    std::vector<std::string> whole = keys("open_surface");
    EXPECT_NE(failures(whole).find("expected at least one tetrahedron"), std::string::npos) << failures(whole);
    EXPECT_NE(failures(keys("without_bones")).find("expected the skeleton of the mesh"), std::string::npos);
    whole[0] = keys("without_bones").at(0);
    EXPECT_EQ(failures(whole), "\n");
    EXPECT_TRUE(keys("ring").empty());
    for (const char* body : {"open_surface", "without_bones"}) EXPECT_TRUE(is_unsuitable(body));
    EXPECT_FALSE(is_unsuitable("ring"));
}

analysis::Measurement measurement(const std::vector<analysis::Measurement>& all, const std::string& quantity)
{
    return *std::find_if(all.begin(), all.end(), [&](const auto& measured) { return measured.quantity == quantity; });
}

TEST(BodySetup, AnInvertedTetOrABrokenFrameIsNoGoodFrame)
{
    analysis::CsvTable metrics({"volume_change_pct", "inverted_tets"});
    metrics.add_row({-1.0, 0});
    metrics.add_row({-3.0, 2});
    metrics.add_row({1.0, 0});
    metrics.add_row({1.0, 0});
    const nlohmann::json run = {{"cost", {{"cpu_seconds", {{"character", 3.0}, {"motion", 0.25}, {"set_up", 0.5}}}}}};
    const auto measurements = setup_measurements({.body = "body"}, metrics, run, {"pbs.k_volume"});
    EXPECT_EQ(measurement(measurements, "keys_changed").value, 1.0);
    EXPECT_DOUBLE_EQ(measurement(measurements, "share_of_sound_frames").value, 0.75);
    EXPECT_LT(measurement(measurements, "share_of_sound_frames").low, 0.75);
    EXPECT_DOUBLE_EQ(measurement(measurements, "mean_volume_change_pct").value, -0.5);
    EXPECT_DOUBLE_EQ(measurement(measurements, "largest_volume_change_pct").value, -3.0);
    EXPECT_DOUBLE_EQ(measurement(measurements, "set_up_s").value, 3.75);

    metrics.add_row({std::nan(""), 0});
    const auto broken = setup_measurements({.body = "body"}, metrics, run, {});
    EXPECT_DOUBLE_EQ(measurement(broken, "share_of_sound_frames").value, 0.6);
    EXPECT_TRUE(std::isnan(measurement(broken, "largest_volume_change_pct").value));
}

}  // namespace
