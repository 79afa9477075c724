// Reference: the options of PBS; a change differs from the scene's options in what its name says and in nothing else.
#include "experiments/studies/improvements/change_settings.hpp"

#include "experiments/deformers/pbs/pbs_settings.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace {

using namespace experiments;

std::set<std::string> changed_fields(const pbs::PbsOptions& options)
{
    const nlohmann::json ours = pbs_fields().json(options), scene = pbs_fields().json(pbs::PbsOptions{});
    std::set<std::string> changed;
    for (const auto& [name, value] : ours.items())
        if (value != scene.at(name)) changed.insert(name);
    return changed;
}

TEST(ChangeSettings, ChangeOneThingAtATime)
{
    const std::map<std::string, std::set<std::string>> allowed = {{baseline, {}},
                                                                  {"smooth_weights", {}},
                                                                  {"bind_to_blended_position", {"bind_to", "k_bind"}},
                                                                  {"region_volumes", {"volume_of", "region_tets"}},
                                                                  {"tet_and_region_volumes", {"volume_of", "region_tets"}},
                                                                  {"k_by_edge_length", {"k_stretch_length_m"}},
                                                                  {"another_order", {"order"}},
                                                                  {control, {"k_stretch", "k_bind"}}};
    std::set<std::string> seen;
    for (const ChangeSetting& setting : change_settings({}, 0.05, {})) {
        ASSERT_TRUE(allowed.contains(setting.change)) << setting.change;
        EXPECT_TRUE(std::ranges::includes(allowed.at(setting.change), changed_fields(setting.options))) << setting.change;
        EXPECT_EQ(changed_fields(setting.options).empty(), setting.change == baseline || setting.change == "smooth_weights");
        EXPECT_EQ(setting.weights == pbs::WeightKind::smooth, setting.change == "smooth_weights");
        seen.insert(setting.change);
    }
    EXPECT_EQ(seen.size(), allowed.size());
}

TEST(ChangeSettings, AreDistinct)
{
    std::set<std::pair<std::string, std::string>> seen;
    const std::vector<ChangeSetting> settings = change_settings({}, 0.05, {});
    for (const ChangeSetting& setting : settings) seen.emplace(setting.change, setting.setting);
    EXPECT_EQ(seen.size(), settings.size());
}

TEST(ChangeSettings, EveryOtherOrderIsAmongThem)
{
    pbs::PbsOptions scene;
    scene.order = pbs::Order::grouped;
    const std::vector<ChangeSetting> settings = change_settings(scene, 0.05, {});
    EXPECT_EQ(std::ranges::count(settings, "another_order", &ChangeSetting::change),
              std::ptrdiff_t(OptionNames<pbs::Order>::table.size()) - 1);
    for (const ChangeSetting& setting : settings)
        if (setting.change == "another_order") EXPECT_NE(setting.setting, "grouped");
}

TEST(ChangeSettings, EdgeLengthsAreMultiplesOfTheMeanEdge)
{
    RangeOfChanges range;
    range.edge_lengths = {2.0};
    for (const ChangeSetting& setting : change_settings({}, 0.05, range))
        if (setting.change == "k_by_edge_length") EXPECT_EQ(setting.options.k_stretch_length_m, 0.1);
}

}  // namespace
