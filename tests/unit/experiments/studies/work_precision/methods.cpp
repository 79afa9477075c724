// The table of compared methods. Reference: the registered kinds and their options, and the members of the family as
// the study's page lists them.
#include "experiments/studies/work_precision/methods.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/system/files.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

namespace methods_tests {
namespace {

using namespace experiments;
using nlohmann::json;

const std::set<std::string> minimisers = {"quasi_newton", "vbd", "warped_newton", "xpbd_neo_hookean",
                                          "projective_dynamics"};

const ComparedMethod& method(const std::string& name)
{
    return *std::ranges::find(methods(), name, &ComparedMethod::name);
}

// The tables of this name in cases.toml of a study.
json listed(const std::string& study, const std::string& tables)
{
    return cases_document(study).at(tables);
}

const Scene& twist()
{
    static const Scene scene =
        read_scene("limb_twist", {"character.vertices=300", "motion.angle_deg=60", "motion.frames=2"});
    return scene;
}

const pbs::Character& limb()
{
    static const pbs::Character character = pbs::make_character(twist().character);
    return character;
}

DeformerSpec spec(const std::string& name, const KeyValues& keys = {}, const EnsembleMember& member = family().front())
{
    return spec_of({&method(name), keys}, twist(), limb(), member);
}

json options(const std::string& name, const KeyValues& keys = {}, const EnsembleMember& member = family().front())
{
    return to_json(spec(name, keys, member)).at("options");
}

TEST(Methods, AreDeclaredOnceForKindsThatThisProgramHas)
{
    std::set<std::string> names;
    for (const ComparedMethod& one : methods()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        EXPECT_NE(find_deformer_kind(one.kind), nullptr) << one.name;
        EXPECT_EQ(one.iterations.empty(), one.iterations_key.empty()) << one.name;
        EXPECT_TRUE(std::ranges::is_sorted(one.iterations)) << one.name;
        EXPECT_FALSE(one.grid.empty()) << one.name;
        EXPECT_FALSE(one.tables.empty()) << one.name;
        for (const std::string& table : one.tables) EXPECT_TRUE(table == "known" || table == "guessed") << one.name;
    }
    for (const json& table : listed("work_precision", "method"))
        EXPECT_EQ(names.contains(table.at("name")), find_deformer_kind(table.at("kind")) != nullptr)
            << table.at("name");
    for (const char* name : {"lbs", "dqs", "delta_mush", "direct_delta_mush", "pbs", "xpbd"})
        EXPECT_TRUE(names.contains(name)) << name;
}

// A pose of the limb that is twisted by 60 degrees.
TEST(Methods, DeformTheLimb)
{
    const pbs::Motion motion = make_motion(twist().motion, limb().skeleton, "");
    for (const ComparedMethod& one : methods()) {
        if (one.is_learned()) continue;  // for tets of other sizes
        SCOPED_TRACE(one.name);
        const Setting setting = tried_settings(one, one.grid.front()).front();
        const std::unique_ptr<Deformer> deformer = make_deformer(spec_of(setting, twist(), limb(), family().front()));
        deformer->reset(limb());
        EXPECT_EQ(deformer->advance(motion.steps.back(), motion.time_step_s).outcome, pbs::Outcome::finished);
        EXPECT_TRUE(deformer->positions().allFinite());
        EXPECT_GT((deformer->positions() - limb().mesh.rest).rowwise().norm().maxCoeff(), 0.01);
    }
}

// The files of man and lady are left out: they belong to tets that other versions of CGAL do not make.
TEST(Methods, TheirFilesBelongToTheBodiesOfTheReferences)
{
    for (const char* body : {"limb", "human", "frankie"}) {
        if (!pbs::body_is_installed(body)) continue;  // Frankie is in a package of the full form
        const Scene scene = std::string(body) == "limb"
                                ? read_scene("limb_twist", {})
                                : read_scene("human_01_01", {std::string("character.body=") + body});
        const pbs::Character character =
            pbs::with_weights(pbs::WeightKind::diffused, pbs::make_character(scene.character));
        const std::string file = file_of_correctives(body);
        EXPECT_GT(parse_correctives(pbs::read_text_file(file), file, character).modes(), 7) << body;
    }
}

// The limb has the size of its references here. Correctives keep the volume that LBS loses.
TEST(Methods, ThatAreLearnedHaveAFileOfTheBody)
{
    const Scene scene = read_scene("limb_twist", {"motion.angle_deg=60", "motion.frames=2"});
    const pbs::Character character = pbs::make_character(scene.character);
    const pbs::Motion motion = make_motion(scene.motion, character.skeleton, "");
    const std::unique_ptr<Deformer> deformer =
        make_deformer(spec_of({&method("correctives"), {}}, scene, character, family().front()));
    deformer->reset(character);
    EXPECT_EQ(deformer->advance(motion.steps.back(), motion.time_step_s).outcome, pbs::Outcome::finished);
    pbs::Positions lbs;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, motion.steps.back(), lbs);
    const auto loss = [&](const pbs::Positions& x) {
        return 1.0 - pbs::tet_volumes(x, character.mesh.tets).sum() /
                         pbs::tet_volumes(character.mesh.rest, character.mesh.tets).sum();
    };
    EXPECT_GT(loss(lbs), 0.03);
    EXPECT_LT(std::abs(loss(deformer->positions())), 0.01);
}

// A key without an effect would make two settings the same.
TEST(Methods, TryEachSettingOnceInSinglePrecisionAndOnOneThread)
{
    for (const ComparedMethod& one : methods()) {
        SCOPED_TRACE(one.name);
        std::set<std::string> tried;
        for (const KeyValues& of_grid : one.grid)
            for (const Setting& setting : tried_settings(one, of_grid)) {
                const DeformerSpec made = spec_of(setting, twist(), limb(), family().front());
                EXPECT_TRUE(tried.insert(to_json(made).dump()).second) << setting.text();
                EXPECT_EQ(made.label, one.name);
                EXPECT_EQ(made.threads, 1);
                const DeformerTraits traits = traits_of(made);
                EXPECT_TRUE(one.kind == "pbs_author" || traits.precision == "f32") << setting.text();
                EXPECT_TRUE(one.kind == "pbs_author" || made.kind == "xpbd_small_steps" || one.is_learned() ||
                            traits.packed)
                    << setting.text();
                if (traits.iterations && made.kind != "xpbd_small_steps") {
                    const std::string iterations = one.iterations_key + "=" + std::to_string(*traits.iterations);
                    EXPECT_EQ(std::ranges::count(setting.keys, iterations), 1) << setting.text();
                }
            }
        EXPECT_EQ(tried.size(), one.grid.size() * std::max<std::size_t>(one.iterations.size(), 1));
    }
}

TEST(Settings, AreTriedByIncreasingIterationsAndReadFromTheirText)
{
    const std::vector<Setting> settings = tried_settings(method("xpbd"), {"young_factor=4", "kind=xpbd_small_steps"});
    ASSERT_EQ(settings.size(), 9u);
    EXPECT_EQ(settings[0].text(), "pbs.iterations=1 young_factor=4 kind=xpbd_small_steps");
    EXPECT_EQ(settings[8].text(), "pbs.iterations=192 young_factor=4 kind=xpbd_small_steps");
    EXPECT_EQ(keys_in(settings[8].text()), settings[8].keys);
    EXPECT_EQ(tried_settings(method("lbs"), {}).size(), 1u);
    EXPECT_EQ(tried_settings(method("lbs"), {})[0].text(), "");
    EXPECT_TRUE(keys_in("").empty());
}

TEST(Settings, OfListedDeformersReachThemInEachScene)
{
    for (const BuiltInScene& scene : built_in_scenes())
        for (const char* name : {"lbs", "dqs"}) {
            const DeformerTraits traits =
                traits_of(spec_of({&method(name), {}}, read_scene(scene.name, {}), limb(), family().front()));
            EXPECT_EQ(traits.precision, "f32") << scene.name;
            EXPECT_TRUE(traits.packed) << scene.name;
        }
}

struct Flesh {
    std::string attachment;
    double spring_factor, core_radius, poisson;
};

// As README.md of the references lists them.
const std::map<std::string, Flesh> flesh_of_members = {{"smooth", {"smooth", 10.0, 0.7, 0.45}},
                                                       {"stiffer_springs", {"smooth", 100.0, 0.7, 0.45}},
                                                       {"thinner_bones", {"smooth", 10.0, 0.5, 0.45}},
                                                       {"stiffer_springs_thinner_bones", {"smooth", 100.0, 0.5, 0.45}},
                                                       {"nu_0.3", {"smooth", 10.0, 0.7, 0.3}},
                                                       {"nu_0.49", {"smooth", 10.0, 0.7, 0.49}},
                                                       {"rigid_capsules", {"embedded", 1e4, 0.35, 0.45}},
                                                       {"held_parts", {"held", 10.0, 0.7, 0.45}}};

TEST(FleshOfAMember, ReachesTheOptionsOfThoseThatTakeIt)
{
    ASSERT_EQ(family().size(), flesh_of_members.size());
    for (const EnsembleMember& member : family()) {
        const Flesh& flesh = flesh_of_members.at(member.name);
        for (const std::string& name : minimisers) {
            SCOPED_TRACE(name + " with " + member.name);
            const json given = options(name, {}, member);
            EXPECT_EQ(given.at("attachment"), flesh.attachment);
            EXPECT_EQ(given.at("spring_factor"), flesh.spring_factor);
            EXPECT_EQ(given.at("core_radius"), flesh.core_radius);
            EXPECT_EQ(given.at("poisson"), flesh.poisson);
            EXPECT_EQ(given.at("start"), "smooth_dqs");
        }
        const json xpbd = options("xpbd", {}, member);
        EXPECT_EQ(xpbd.at("poisson"), flesh.poisson);
        EXPECT_EQ(xpbd.at("young_pa"), 1e5) << "that of the scenes' finite elements";
    }
}

// Reference: the options that exist. Flesh changes the spec of a method if and only if the table states that it takes
// some.
TEST(FleshOfAMember, IsTakenByThoseThatStateIt)
{
    for (const ComparedMethod& one : methods()) {
        SCOPED_TRACE(one.name);
        const json given = options(one.name);
        const std::vector<std::string> all = {"material", "attachment", "start"};
        const bool has_springs = given.contains("spring_factor"),
                   is_elastic = has_springs || given.contains("young_pa");
        if (one.is_learned())
            EXPECT_EQ(one.takes, std::vector<std::string>{"learned"});
        else
            EXPECT_EQ(one.takes, has_springs  ? all
                                 : is_elastic ? std::vector<std::string>{"material"}
                                              : std::vector<std::string>{});
        EXPECT_EQ(one.takes_flesh(), is_elastic);
        EXPECT_EQ(minimisers.contains(one.name), has_springs);
        EXPECT_EQ(options(one.name, {}, family()[4]) != given, is_elastic) << "another Poisson's ratio";
    }
}

TEST(Settings, OfXpbdMultiplyYoungsModulusAndTakeAnotherDeformer)
{
    const DeformerSpec stiff = spec("xpbd", {"pbs.iterations=4", "young_factor=16"});
    EXPECT_EQ(stiff.kind, "xpbd");
    EXPECT_EQ(options_of<pbs::XpbdOptions>(stiff).young_pa, 16e5);
    EXPECT_EQ(options_of<pbs::XpbdOptions>(stiff).iterations, 4);
    const DeformerSpec small_steps =
        spec("xpbd", {"pbs.iterations=8", "kind=xpbd_small_steps", "young_factor=256"}, family()[4]);
    EXPECT_EQ(small_steps.kind, "xpbd_small_steps");
    EXPECT_EQ(small_steps.name, "xpbd");
    EXPECT_EQ(options_of<pbs::XpbdOptions>(small_steps).young_pa, 256e5);
    EXPECT_EQ(options_of<pbs::XpbdOptions>(small_steps).poisson, 0.3);
    EXPECT_EQ(options_of<pbs::XpbdOptions>(small_steps).substeps * options_of<pbs::XpbdOptions>(small_steps).iterations,
              8);
}

TEST(Settings, OfWeightsAreThoseOfTheDeformer)
{
    EXPECT_FALSE(spec("lbs").weights);
    EXPECT_EQ(spec("lbs", {"skinning.weights=diffused"}).weights, pbs::WeightKind::diffused);
    EXPECT_EQ(spec("dqs", {"skinning.weights=smooth"}).weights, pbs::WeightKind::smooth);
    EXPECT_EQ(spec("delta_mush", {"delta_mush.weights=diffused"}).weights, pbs::WeightKind::diffused);
    EXPECT_EQ(spec("pbs_smooth_weights").weights, pbs::WeightKind::smooth);
}

TEST(Settings, LaterValuesOfAKeyAreTheOnesThatCount)
{
    EXPECT_EQ(options_of<pbs::PbsOptions>(spec("pbs", {"pbs.k_bind=0.5", "pbs.k_bind=0.25"})).k_bind, 0.25);
    EXPECT_EQ(options_of<pbs::PbsOptions>(spec("pbs")).precision, pbs::Precision::f32);
    EXPECT_EQ(options_of<pbs::PbsOptions>(spec("pbs", {"pbs.precision=f64"})).precision, pbs::Precision::f64)
        << "over the method's own";
    EXPECT_EQ(options("vbd", {"vbd.poisson=0.2"}).at("poisson"), 0.2) << "over the flesh";
}

TEST(OtherStarts, ChangeTheSettingOfAMethodWhateverTheFleshIs)
{
    ASSERT_EQ(other_starts().size(), listed("work_precision", "start").size());
    std::set<std::string> names;
    for (const OtherStart& start : other_starts()) {
        SCOPED_TRACE(start.name);
        EXPECT_TRUE(names.insert(start.name).second);
        EXPECT_EQ(std::ranges::count(methods(), start.name, &ComparedMethod::name), 0)
            << "rows are told apart by their method";
        const ComparedMethod& of = method(start.of);
        KeyValues keys = tried_settings(of, of.grid.front()).back().keys;
        for (const EnsembleMember& member : {family().front(), family()[6]}) {
            const json from = options(start.of, keys, member);
            KeyValues changed = keys;
            changed.insert(changed.end(), start.overrides.begin(), start.overrides.end());
            const json made = options(start.of, changed, member);
            if (start.name.ends_with("_of_wrong_material")) {
                EXPECT_EQ(json({made.at("spring_factor"), made.at("core_radius"), made.at("poisson")}),
                          json({100.0, 0.5, 0.3}));
                EXPECT_EQ(made.at("start"), from.at("start"));
            } else if (start.name == "initial_guess_alone") {
                EXPECT_EQ(made.at("iterations"), 0);
            } else {
                EXPECT_EQ(made.at("start"), start.name.ends_with("_from_lbs") ? "lbs" : "smooth_dqs");
            }
            EXPECT_NE(made, from);
        }
    }
    for (const std::string& name : minimisers)
        for (const char* change : {"_from_lbs", "_of_wrong_material"})
            EXPECT_TRUE(names.contains(name + change)) << name << change;
}

std::set<std::string> changed_fields(const DeformerSpec& changed, const DeformerSpec& from)
{
    const json ours = to_json(changed).at("options"), scene = to_json(from).at("options");
    std::set<std::string> fields;
    for (const auto& [name, value] : ours.items())
        if (value != scene.at(name)) fields.insert(name);
    return fields;
}

// Reference: the options of PBS with the same constants k_stretch and k_bind; a change differs from it in what its name
// says and in nothing else.
TEST(ChangesToPbs, ChangeOneThingAtATime)
{
    const std::map<std::string, std::set<std::string>> allowed = {{"pbs_smooth_weights", {}},
                                                                  {"pbs_bound_to_blended_position", {"bind_to"}},
                                                                  {"pbs_region_volumes", {"volume_of", "region_tets"}},
                                                                  {"pbs_k_by_edge_length", {"k_stretch_length_m"}}};
    for (const auto& [name, fields] : allowed) {
        SCOPED_TRACE(name);
        for (const KeyValues& of_grid : method(name).grid) {
            KeyValues constants = of_grid;
            std::erase_if(constants, [](const std::string& key) {
                return !key.starts_with("pbs.k_stretch=") && !key.starts_with("pbs.k_bind=");
            });
            const DeformerSpec changed = spec(name, of_grid), from = spec("pbs", constants);
            const std::set<std::string> found = changed_fields(changed, from);
            EXPECT_TRUE(std::ranges::includes(fields, found)) << testing::PrintToString(of_grid);
            EXPECT_EQ(found.empty(), fields.empty()) << testing::PrintToString(of_grid);
            EXPECT_EQ(changed.weights.has_value(), name == "pbs_smooth_weights");
        }
        EXPECT_FALSE(method(name).is_in("known"));
    }
    for (const ComparedMethod& one : methods())
        if (one.kind == "pbs") {
            EXPECT_TRUE(one.name == "pbs" || allowed.contains(one.name)) << one.name;
            EXPECT_FALSE(options_of<pbs::PbsOptions>(spec(one.name)).jiggle) << one.name;
        }
}

// The edges of the mesh have the stiffness k in the mean.
TEST(ChangesToPbs, KeepTheMeanStiffnessWhereItDependsOnTheLengthOfAnEdge)
{
    const auto& changed = spec("pbs_k_by_edge_length");
    const auto& pbs = options_of<pbs::PbsOptions>(changed);
    double sum = 0.0;
    int count = 0;
    std::set<std::pair<int, int>> edges;
    for (const auto& tet : limb().mesh.tets.rowwise())
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) edges.insert(std::minmax({tet(a), tet(b)}));
    for (const auto& [a, b] : edges) {
        sum += pbs::stiffness_at_length(pbs.k_stretch, (limb().mesh.rest.row(a) - limb().mesh.rest.row(b)).norm(),
                                        pbs.k_stretch_length_m);
        ++count;
    }
    EXPECT_NEAR(sum / count, pbs.k_stretch, 1e-10);
}

// k / (k + (1 - k) (l / L)^2) of two edges, 1 and 2, whose mean is k: solved for (1 / L)^2 = x by hand for k = 1 / 2,
// 1 / (1 + x) + 1 / (1 + 4 x) = 1 holds for 4 x^2 = 1, L = sqrt 2.
TEST(NeutralLength, KeepsTheMeanStiffness)
{
    EXPECT_NEAR(neutral_length(0.5, {1.0, 2.0}), std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(neutral_length(0.2, {3.0, 3.0}), 3.0, 1e-11) << "of equal edges it is their length";
    const std::vector<double> lengths_m = {0.03, 0.05, 0.08};
    const double length_m = neutral_length(0.2, lengths_m);
    double mean = 0.0;
    for (const double l : lengths_m) mean += pbs::stiffness_at_length(0.2, l, length_m) / 3.0;
    EXPECT_NEAR(mean, 0.2, 1e-11);
}

TEST(Comparison, HasItsTimesMembersAndPosesFromOtherTables)
{
    const ComparisonTimes& times = comparison_times();
    EXPECT_TRUE(std::ranges::is_sorted(times.budgets_ms));
    for (const double ms : times.tables_ms) EXPECT_EQ(std::ranges::count(times.budgets_ms, ms), 1) << ms;
    std::vector<std::string> members;
    for (const EnsembleMember& member : training_members()) members.push_back(member.name);
    EXPECT_EQ(members, (std::vector<std::string>{"smooth", "nu_0.49", "rigid_capsules"}));
    std::set<std::string> movements;
    for (const json& pose : listed("references", "case"))
        if (pose.value("stratum", "") == "movement") movements.insert(pose.at("name"));
    EXPECT_EQ(start_poses().size(), 12u);
    for (const std::string& pose : start_poses()) EXPECT_TRUE(movements.contains(pose)) << pose;
}

// The settings that are compiled in are some of those that are tried, one for each method and time, and within it.
TEST(KeptSettings, AreThoseOfMethodsAndTimesThatAreTried)
{
    std::set<std::pair<double, std::string>> chosen_for;
    for (const ChosenSetting& chosen : kept_settings()) {
        SCOPED_TRACE(chosen.method + " " + chosen.setting);
        EXPECT_TRUE(chosen_for.insert({chosen.budget_ms, chosen.method}).second) << chosen.budget_ms;
        EXPECT_EQ(std::ranges::count(comparison_times().budgets_ms, chosen.budget_ms), 1);
        EXPECT_LE(chosen.training_ms, chosen.budget_ms);
        EXPECT_GT(chosen.training_error_pct, 0.0);
        const auto of = std::ranges::find(methods(), chosen.method, &ComparedMethod::name);
        if (of == methods().end()) continue;  // a program without finite elements lacks some methods
        bool is_tried = false;
        for (const KeyValues& of_grid : of->grid)
            for (const Setting& setting : tried_settings(*of, of_grid))
                is_tried = is_tried || setting.text() == chosen.setting;
        EXPECT_TRUE(is_tried);
    }
    for (const double ms : comparison_times().tables_ms)
        for (const char* name : {"lbs", "pbs"})
            EXPECT_TRUE(chosen_for.contains({ms, name})) << name << " within " << ms << " ms";
}

}  // namespace
}  // namespace methods_tests
