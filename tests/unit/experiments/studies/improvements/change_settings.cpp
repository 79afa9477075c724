// Reference: the options of PBS; a change differs from the scene's options in what its name says and in nothing else.
#include "experiments/studies/improvements/change_settings.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace {

using namespace experiments;

const std::vector<double> lengths_m = {0.03, 0.05, 0.08};

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
    for (const ChangeSetting& setting : change_settings({}, lengths_m, {})) {
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
    const std::vector<ChangeSetting> settings = change_settings({}, lengths_m, {});
    for (const ChangeSetting& setting : settings) seen.emplace(setting.change, setting.setting);
    EXPECT_EQ(seen.size(), settings.size());
}

TEST(ChangeSettings, EveryOtherOrderIsAmongThem)
{
    pbs::PbsOptions scene;
    scene.order = pbs::Order::grouped;
    const std::vector<ChangeSetting> settings = change_settings(scene, lengths_m, {});
    EXPECT_EQ(std::ranges::count(settings, "another_order", &ChangeSetting::change),
              std::ptrdiff_t(OptionNames<pbs::Order>::table.size()) - 1);
    EXPECT_EQ(std::ranges::count(settings, "grouped", &ChangeSetting::setting), 0);
}

// k / (k + (1 - k) (l / L)^2) of two edges, 1 and 2, whose mean is k: solved for (1 / L)^2 = x by hand for k = 1 / 2,
// 1 / (1 + x) + 1 / (1 + 4 x) = 1 holds for 4 x^2 = 1, L = sqrt 2.
TEST(ChangeSettings, NeutralLengthKeepsTheMeanStiffness)
{
    EXPECT_NEAR(neutral_length(0.5, {1.0, 2.0}), std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(neutral_length(0.2, {3.0, 3.0}), 3.0, 1e-11) << "of equal edges it is their length";
    for (const ChangeSetting& setting : change_settings({}, lengths_m, {})) {
        if (setting.change != "k_by_edge_length") continue;
        double mean = 0.0;
        for (const double l : lengths_m) mean += pbs::stiffness_at_length(0.2, l, setting.options.k_stretch_length_m) / 3.0;
        EXPECT_NEAR(mean, 0.2, 1e-11);
    }
}

}  // namespace
