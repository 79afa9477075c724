// The table of compared deformers. Reference: the registered kinds and the keys that they declare.
#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {

using namespace experiments;

const ComparedDeformer& entry(const std::string& name)
{
    return *std::ranges::find(compared_deformers(), name, &ComparedDeformer::name);
}

TEST(ComparedDeformers, AreDeclaredOnceWithTheirDefaultSettingFirst)
{
    std::set<std::string> names;
    for (const ComparedDeformer& one : compared_deformers()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        EXPECT_EQ(one.iterations.empty(), one.iterations_key.empty()) << one.name;
        EXPECT_TRUE(one.grid.front() == SettingChange{}) << one.name;
        for (const int few : one.few_iterations) EXPECT_EQ(std::ranges::count(one.iterations, few), 1) << one.name;
    }
}

// Every setting in every code is accepted by the kind.
TEST(ComparedDeformers, HaveSettingsThatTheirKindsAccept)
{
    const Scene scene = read_scene("limb_twist", {});
    for (const ComparedDeformer& one : compared_deformers()) {
        if (!is_available(one)) continue;
        for (const KeyValues& code : codes_of(one))
            for (const SettingChange& change : grid_of(one)) {
                SettingChoice choice{.change = change, .code = code};
                if (!one.iterations.empty()) choice.iterations = one.iterations.back();
                EXPECT_EQ(spec_with(one, scene, choice).kind, one.kind);
            }
    }
}

// Only what this program does not have may be skipped: the kinds of its registry take part.
TEST(ComparedDeformers, AreAvailableWhereTheirKindIsRegistered)
{
    for (const char* name : {"lbs", "lbs_diffused", "dqs", "dqs_diffused", "delta_mush", "pbs", "xpbd", "xpbd_small_steps"})
        EXPECT_TRUE(is_available(entry(name))) << name;
    for (const char* name : {"pbs_author", "quasi_newton", "vbd", "xpbd_neo_hookean", "projective_dynamics", "direct_delta_mush"})
        EXPECT_EQ(is_available(entry(name)), find_deformer_kind(name) != nullptr) << name;
    const ComparedDeformer unknown = {.name = "wishful", .kind = "wishful"}, without_key = {.kind = "pbs", .fixed = {"pbs.wishes=3"}};
    EXPECT_FALSE(is_available(unknown));
    EXPECT_FALSE(is_available(without_key));
}

TEST(ComparedDeformers, SkipSettingsAndCodesWhoseKeysDoNotExist)
{
    const ComparedDeformer one = {
        .kind = "pbs", .grid = {{}, {{"pbs.k_stretch=0.5"}}, {{"pbs.wishes=3"}}}, .codes = {{"pbs.wishes=f32"}, {"pbs.precision=f64"}}};
    EXPECT_EQ(grid_of(one).size(), 2u);
    EXPECT_EQ(codes_of(one), (std::vector<KeyValues>{{"pbs.precision=f64"}}));
    EXPECT_EQ(codes_of({.kind = "pbs", .codes = {{"pbs.wishes=f32"}}}), std::vector<KeyValues>{{}});
}

// A kind whose precision can be chosen is compared in both.
TEST(ComparedDeformers, PutTheirPackedCodeFirstAndThenPlainF64)
{
    const Scene scene = read_scene("limb_twist", {});
    for (const ComparedDeformer& one : compared_deformers()) {
        if (!is_available(one)) continue;
        const std::vector<SceneKey>& keys = find_deformer_kind(one.kind)->keys;
        const bool has_keys_of_xpbd = one.kind == "xpbd_small_steps";
        const bool may_choose =
            has_keys_of_xpbd || std::ranges::any_of(keys, [](const SceneKey& key) { return key.name == "precision"; });
        const std::vector<KeyValues> codes = codes_of(one);
        EXPECT_EQ(codes.size(), may_choose ? 2u : 1u) << one.name;
        if (codes.size() < 2) continue;
        const DeformerTraits first = traits_of(spec_with(one, scene, {.code = codes[0]}));
        const DeformerTraits second = traits_of(spec_with(one, scene, {.code = codes[1]}));
        EXPECT_EQ(first.precision, "f32") << one.name;
        EXPECT_EQ(second.precision, "f64") << one.name;
        EXPECT_TRUE(first.packed) << one.name;
        EXPECT_FALSE(second.packed) << one.name;
    }
}

TEST(ComparedDeformers, TakeTheirOptionsFromTheEntryAndTheScene)
{
    const Scene scene = read_scene("limb_twist", {});
    const DeformerSpec spec =
        spec_with(entry("pbs"), scene, {.iterations = 8, .change = {{"pbs.k_stretch=0.9"}}, .code = entry("pbs").codes[1]});
    const auto& options = options_of<pbs::PbsOptions>(spec);
    EXPECT_EQ(options.iterations, 8);
    EXPECT_EQ(options.k_stretch, 0.9);
    EXPECT_EQ(options.order, pbs::Order::plain);
    EXPECT_EQ(options.precision, pbs::Precision::f64);
    EXPECT_EQ(options.k_bind, 1.0);
}

// Those that minimise the reference's energy: their limit is the reference's only with its springs.
TEST(ComparedDeformers, HaveTheSpringsOfTheReference)
{
    const Scene scene = read_scene("limb_twist", {});
    const DeformerSpec reference = reference_flesh(scene);
    const auto& flesh = options_of<FemOptions>(reference);
    for (const char* name : {"quasi_newton", "vbd", "xpbd_neo_hookean", "projective_dynamics"}) {
        const nlohmann::json options = to_json(spec_with(entry(name), scene, {})).at("options");
        EXPECT_EQ(options.at("core_radius"), core_radius_of(flesh)) << name;
        EXPECT_EQ(options.at("spring_factor"), spring_factor_of(flesh)) << name;
        EXPECT_EQ(options.at("poisson"), flesh.poisson) << name;
    }
}

TEST(ComparedDeformers, MultiplyTheReferencesYoungsModulus)
{
    const Scene scene = read_scene("limb_twist", {});
    const DeformerSpec flesh = reference_flesh(scene);
    const double young_pa = options_of<FemOptions>(flesh).young_pa;
    const auto xpbd = spec_with(entry("xpbd"), scene, {.iterations = 4, .change = {.young_factor = 4.0}});
    EXPECT_EQ(options_of<pbs::XpbdOptions>(xpbd).young_pa, 4.0 * young_pa);
    EXPECT_EQ(options_of<pbs::XpbdOptions>(xpbd).poisson, options_of<FemOptions>(flesh).poisson);
}

TEST(ComparedDeformers, BlendWithWeightsOfTheirOwn)
{
    const Scene scene = read_scene("limb_twist", {});
    EXPECT_EQ(spec_with(entry("lbs"), scene, {}).variant, "weights_paper");
    EXPECT_EQ(spec_with(entry("lbs_diffused"), scene, {}).variant, "weights_diffused");
}

TEST(SettingNames, AreIdentifiers)
{
    EXPECT_EQ(name_of(SettingChange{}), "");
    EXPECT_EQ(name_of(SettingChange{{"pbs.k_stretch=0.9", "pbs.variant.stiffness=exponent"}}), "k_stretch_0.9+stiffness_exponent");
    EXPECT_EQ(name_of(SettingChange{.young_factor = 4.0}), "stiffness_factor_4");
}

}  // namespace
