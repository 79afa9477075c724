// The table of compared deformers. Reference: the registered kinds and the keys that they declare. The file with deformers of the user's
// own: what is read, and each wrong input with its file, line, field, value and rule.
#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
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
        EXPECT_TRUE(one.grid.front() == GridValue{}) << one.name;
        for (const int few : one.few_iterations) EXPECT_EQ(std::ranges::count(one.iterations, few), 1) << one.name;
    }
}

// Every setting in every code is accepted by the kind. Packed code in f32 comes first, then plain code in f64; a kind whose precision can
// be chosen is compared in both.
TEST(ComparedDeformers, HaveSettingsAndCodesThatTheirKindsAccept)
{
    const Scene scene = read_scene("limb_twist", {});
    for (const ComparedDeformer& one : compared_deformers()) {
        if (!is_available(one)) continue;
        SCOPED_TRACE(one.name);
        const std::vector<KeyValues> codes = codes_of(one);
        for (const KeyValues& code : codes)
            for (const GridValue& value : grid_of(one)) {
                SettingChoice choice{.value = value, .code = code};
                if (!one.iterations.empty()) choice.iterations = one.iterations.back();
                EXPECT_EQ(spec_with(one, scene, choice).kind, one.kind);
            }
        const bool may_choose = one.kind == "xpbd_small_steps" ||  // it has the keys of xpbd
                                std::ranges::count(find_deformer_kind(one.kind)->keys, "precision", &SceneKey::name) > 0;
        ASSERT_EQ(codes.size(), may_choose ? 2u : 1u);
        if (!may_choose) continue;
        const DeformerTraits first = traits_of(spec_with(one, scene, {.code = codes[0]}));
        const DeformerTraits second = traits_of(spec_with(one, scene, {.code = codes[1]}));
        EXPECT_TRUE(first.precision == "f32" && first.packed);
        EXPECT_TRUE(second.precision == "f64" && !second.packed);
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

TEST(ComparedDeformers, TakeTheirOptionsFromTheEntryTheSceneAndTheReference)
{
    const Scene scene = read_scene("limb_twist", {});
    const DeformerSpec spec =
        spec_with(entry("pbs"), scene, {.iterations = 8, .value = {{"pbs.k_stretch=0.9"}}, .code = entry("pbs").codes[1]});
    const auto& options = options_of<pbs::PbsOptions>(spec);
    EXPECT_EQ(options.iterations, 8);
    EXPECT_EQ(options.k_stretch, 0.9);
    EXPECT_EQ(options.order, pbs::Order::spread);
    EXPECT_EQ(options.precision, pbs::Precision::f64);
    EXPECT_EQ(options.k_bind, 1.0);
    EXPECT_EQ(spec_with(entry("lbs"), scene, {}).variant, "weights_paper");
    EXPECT_EQ(spec_with(entry("lbs_diffused"), scene, {}).variant, "weights_diffused");

    const DeformerSpec reference = reference_flesh(scene);
    const auto& flesh = options_of<FemOptions>(reference);
    // Those that minimise the reference's energy: their limit is the reference's only with its springs.
    for (const char* name : {"quasi_newton", "vbd", "xpbd_neo_hookean", "projective_dynamics"}) {
        const nlohmann::json elastic = to_json(spec_with(entry(name), scene, {})).at("options");
        EXPECT_EQ(elastic.at("core_radius"), flesh.used_core_radius()) << name;
        EXPECT_EQ(elastic.at("spring_factor"), flesh.used_spring_factor()) << name;
        EXPECT_EQ(elastic.at("poisson"), flesh.poisson) << name;
    }
    const auto xpbd = spec_with(entry("xpbd"), scene, {.iterations = 4, .value = {.young_factor = 4.0}});
    EXPECT_EQ(options_of<pbs::XpbdOptions>(xpbd).young_pa, 4.0 * flesh.young_pa);
    EXPECT_EQ(options_of<pbs::XpbdOptions>(xpbd).poisson, flesh.poisson);
}

TEST(SettingNames, AreIdentifiers)
{
    EXPECT_EQ(name_of(GridValue{}), "");
    EXPECT_EQ(name_of(GridValue{{"pbs.k_stretch=0.9", "pbs.variant.stiffness=exponent"}}), "k_stretch_0.9+stiffness_exponent");
    EXPECT_EQ(name_of(GridValue{.young_factor = 4.0}), "stiffness_factor_4");
}

TEST(DeformerGroups, HaveEveryDeformerOnce)
{
    std::set<std::string> deformers;
    for (const DeformerGroup& group : deformer_groups())
        for (const std::string& name : group.deformers) EXPECT_TRUE(deformers.insert(name).second) << name;
    for (const ComparedDeformer& one : compared_deformers()) EXPECT_TRUE(deformers.contains(one.name)) << one.name;
    const auto xpbd = std::ranges::find(deformer_groups(), "xpbd", &DeformerGroup::key);
    EXPECT_EQ(xpbd->deformers, (std::vector<std::string>{"xpbd", "xpbd_small_steps"}));
    std::map<std::string, std::size_t> in_class;
    for (const DeformerGroup& one : classes_of(groups_with({"mine"}))) in_class[one.key] = one.deformers.size();
    EXPECT_EQ(in_class, (std::map<std::string, std::size_t>{{"blend", 4},
                                                            {"mush", 4},
                                                            {"constraints", 4},
                                                            {"minimisers", 8},
                                                            {"minimisers_of_other_flesh", 4},
                                                            {"from_the_initial_guess", 3},
                                                            {"finite_elements", 4},
                                                            {"mine", 1}}));
}

// Reference: the keys of an entry. What takes the reference's material has young_key or poisson_key; what starts or is held by its springs
// has its own default springs, which are the reference's.
TEST(ComparedDeformers, KnowWhatTheirKeysTakeFromTheReference)
{
    const DeformerSpec reference = reference_flesh(read_scene("limb_twist", {}));
    const nlohmann::json flesh = to_json(reference).at("options");
    for (const ComparedDeformer& one : compared_deformers()) {
        SCOPED_TRACE(one.name);
        const nlohmann::json own = to_json(spec_with(one, read_scene("limb_twist", {}), {})).at("options");
        const bool is_held = own.contains("spring_factor") && own.value("iterations", 1) > 0;
        const bool has_springs = is_held && own.at("spring_factor") == 10.0 && own.at("core_radius") == 0.7;
        const bool has_start = own.value("start", "lbs") == "smooth_dqs" && (!is_held || has_springs);
        const bool has_material = !one.young_key.empty() || !one.poisson_key.empty();
        std::string known;
        for (const auto& [is_known, what] : {std::pair{has_material, "material"}, {has_springs, "attachment"}, {has_start, "start"}})
            if (is_known) known += (known.empty() ? "" : " ") + std::string(what);
        EXPECT_EQ(one.knows, known);
    }
    EXPECT_EQ(flesh.at("spring_factor"), 10.0);
    EXPECT_EQ(flesh.at("core_radius"), 0.7);
}

std::set<std::string> changed_fields(const DeformerSpec& spec, const DeformerSpec& from)
{
    const nlohmann::json ours = to_json(spec).at("options"), scene = to_json(from).at("options");
    std::set<std::string> changed;
    for (const auto& [name, value] : ours.items())
        if (value != scene.at(name)) changed.insert(name);
    return changed;
}

// Reference: the options of PBS; a change differs from the baseline in what its name says and in nothing else.
TEST(ChangesToPbs, ChangeOneThingAtATime)
{
    const Scene scene = read_scene("limb_twist", {});
    const DeformerSpec from = spec_with(entry(baseline), scene, {.code = entry(baseline).codes[0]});
    const std::map<std::string, std::set<std::string>> allowed = {{"smooth_weights", {}},
                                                                  {"bind_to_blended_position", {"bind_to", "k_bind"}},
                                                                  {"region_volumes", {"volume_of", "region_tets"}},
                                                                  {"tet_and_region_volumes", {"volume_of", "region_tets"}},
                                                                  {"k_by_edge_length", {}},  // the length is that of the mesh
                                                                  {"another_order", {"order"}},
                                                                  {control, {"k_stretch", "k_bind"}}};
    std::set<std::string> seen;
    for (const ComparedDeformer& one : changes_to_pbs()) {
        ASSERT_TRUE(allowed.contains(one.name)) << one.name;
        EXPECT_TRUE(is_available(one)) << one.name;
        EXPECT_EQ(one.smooth_weights, one.name == "smooth_weights");
        EXPECT_EQ(one.k_by_edge_length, one.name == "k_by_edge_length");
        EXPECT_EQ(std::ranges::count_if(compared_deformers(), [&](const ComparedDeformer& other) { return other.name == one.name; }), 0);
        std::set<std::string> settings;
        for (const GridValue& value : grid_of(one)) {
            const DeformerSpec spec = spec_with(one, scene, {.value = value, .code = codes_of(one).front()});
            EXPECT_TRUE(std::ranges::includes(allowed.at(one.name), changed_fields(spec, from))) << one.name;
            EXPECT_EQ(changed_fields(spec, from).empty(), allowed.at(one.name).empty()) << one.name << " " << name_of(value);
            EXPECT_TRUE(settings.insert(name_of(value)).second) << one.name << " " << name_of(value);
        }
        for (const int budget : {4, 24, 96})
            for (const auto* ladder : {&one.iterations, &one.few_iterations}) EXPECT_EQ(std::ranges::count(*ladder, budget), 1);
        seen.insert(one.name);
        if (one.name == "another_order") {
            EXPECT_EQ(settings.size(), option_names<pbs::Order>.size() - 1) << "every other order";
        }
    }
    EXPECT_EQ(seen.size(), allowed.size());
}

std::string entry_table(const std::string& name, const std::string& keys = "command = [\"sh\", \"mine.sh\"]")
{
    return "[[external]]\nname = \"" + name + "\"\n" + keys + "\n";
}

class ExternalEntries : public testing::Test {
protected:
    std::vector<DeformerSpec> entries(const std::string& tables) const
    {
        return external_entries(folder.file("mine.toml", "schema = 1\n" + tables));
    }
    void expect_refused(const std::string& tables, const std::string& place, const std::string& rule) const
    {
        expect_input_error([&] { entries(tables); }, folder / "mine.toml" + place, rule);
    }
    test_support::ScratchFolder folder;
};

TEST_F(ExternalEntries, AreTheTablesInTheirOrder)
{
    const std::string program = folder.file("mine.sh", "exit 0");
    const std::vector<DeformerSpec> read = entries(entry_table("mine") + entry_table("other", "command = [\"sh\"]\nhas_memory = true"));
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].name, "mine");
    EXPECT_EQ(read[0].threads, 1);
    const auto& options = options_of<ExternalOptions>(read[0]);
    EXPECT_EQ(options.command, (std::vector<std::string>{"sh", program}));
    ASSERT_EQ(options.file_hashes.size(), 2u);
    EXPECT_EQ(options.file_hashes[0], "") << "sh is sought on the PATH";
    EXPECT_NE(options.file_hashes[1], "");
    EXPECT_TRUE(options_of<ExternalOptions>(read[1]).has_memory);
}

// Files are recorded by their place in the command, and other words in full.
TEST_F(ExternalEntries, ChangeWithEachFileAndWord)
{
    for (const char* of : {"a", "b"}) std::filesystem::create_directory(folder.path() / of);
    const auto record = [&](const std::string& a, const std::string& b, const std::string& words) {
        folder.file("a/mine.sh", a), folder.file("b/mine.sh", b);
        return to_json(entries(entry_table("mine", "command = [\"sh\", " + words + "]"))[0]);
    };
    const std::string both = R"("a/mine.sh", "b/mine.sh")", other_order = R"("b/mine.sh", "a/mine.sh")";
    const nlohmann::json first = record("exit 0", "exit 1", both);
    EXPECT_EQ(record("exit 0", "exit 1", both), first);
    EXPECT_NE(record("exit 2", "exit 1", both), first);
    EXPECT_NE(record("exit 0", "exit 2", both), first);
    EXPECT_NE(record("exit 0", "exit 1", other_order), first);
    EXPECT_EQ(record("exit 1", "exit 0", other_order), first) << "the files themselves are the same";
    EXPECT_EQ(first.dump().find(folder.path().string()), std::string::npos) << "the record is that of any folder";
    EXPECT_NE(record("exit 0", "exit 1", both + R"(, "/nowhere/one/data")"), record("exit 0", "exit 1", both + R"(, "/nowhere/two/data")"));
}

struct RefusedEntry {
    std::string tables, place, rule = {};
};

class RefusedEntries : public ExternalEntries, public testing::WithParamInterface<RefusedEntry> {};

TEST_P(RefusedEntries, NameThePlaceAndTheRule)
{
    folder.file("mine.sh", "exit 0");
    folder.file("libmine.so", "no library");
    expect_refused(GetParam().tables, GetParam().place, GetParam().rule);
}

const std::string alone = "expected only [[external]] tables";
INSTANTIATE_TEST_SUITE_P(OfOtherTables, RefusedEntries,
                         testing::Values(RefusedEntry{"", ": external: missing", "expected at least one [[external]] table"},
                                         RefusedEntry{"[external]\nname = \"mine\"\n", ":2: external:", "expected [[external]] tables"},
                                         RefusedEntry{entry_table("mine") + "[deformers]\nuse = [\"mine\"]\n", ":5: deformers:", alone},
                                         RefusedEntry{entry_table("mine") + "deformers.use = [\"mine\"]\n", ":5: external.0.deformers",
                                                      "unknown key"},
                                         RefusedEntry{"deformers.use = [\"mine\"]\n" + entry_table("mine"), ":2: deformers:", alone},
                                         RefusedEntry{entry_table("mine") + "[[fem]]\nname = \"solid\"\n", ":5: fem.0:", alone},
                                         RefusedEntry{entry_table("mine") + "[[fem]]\nmodel = \"linear\"\n", ":5: fem.0:", alone},
                                         RefusedEntry{entry_table("mine") + "[[lbs]]\n", ":5: lbs.0:", alone},
                                         RefusedEntry{entry_table("mine") + "[pbs]\n", ":5: pbs:", alone},
                                         RefusedEntry{entry_table("mine") + "[reference]\nname = \"mine\"\n", ":5: reference:", alone},
                                         RefusedEntry{entry_table("mine") + "[[mine]]\n", ":5: mine", "unknown key"}));
INSTANTIATE_TEST_SUITE_P(
    OfTheirNames, RefusedEntries,
    testing::Values(RefusedEntry{entry_table("fem_linear"), ":3: external.0.name = fem_linear", "of the comparison"},
                    RefusedEntry{entry_table("reference"), ":3: external.0.name = reference", "of the comparison"},
                    RefusedEntry{entry_table("all"), ":3: external.0.name = all", "of the comparison"},
                    RefusedEntry{entry_table("mine") + entry_table("mine"), ":6: external.1.name = mine", "is used twice"},
                    RefusedEntry{entry_table("my own"), ":3: external.0.name = my own", "letters, digits and underscores"},
                    RefusedEntry{"[[external]]\ncommand = [\"sh\"]\n", ": external.0.name: missing", "states it"}));
INSTANTIATE_TEST_SUITE_P(
    OfTheirPrograms, RefusedEntries,
    testing::Values(
        RefusedEntry{entry_table("mine", "command = [\"no_such_program\"]"), ":4: external.0.command =", "No such file or directory"},
        RefusedEntry{entry_table("mine", "command = [\"mine.sh\"]"), ":4: external.0.command =", "Permission denied"},
        RefusedEntry{entry_table("mine", "command = [\"./none.sh\"]"), ":4: external.0.command =", "No such file or directory"},
        RefusedEntry{entry_table("mine", "library = \"libnone.so\""), ":4: external.0.library = libnone.so", "cannot be loaded"},
        RefusedEntry{entry_table("mine", "library = \"libmine.so\""), ":4: external.0.library = libmine.so", "cannot be loaded: "},
        RefusedEntry{entry_table("mine", ""), ": external.0.command", "expected either a command or a library"}));

TEST_F(ExternalEntries, NeedAFileAndNamesOfTheirOwn)
{
    expect_input_error([&] { external_entries(folder / "none.toml"); }, folder / "none.toml" + ": cannot be read", "[[external]]");
    expect_input_error([&] { external_entries(folder.path().string()); }, folder.path().string(), "cannot be read");
    expect_input_error([&] { external_entries(folder.file("mine.toml", entry_table("mine"))); }, folder / "mine.toml: schema",
                       "write schema = 1");
    for (const ComparedDeformer& one : compared_deformers()) expect_refused(entry_table(one.name), ":3: external.0.name = " + one.name, "");
    for (const DeformerGroup& group : deformer_groups()) expect_refused(entry_table(group.key), ":3: external.0.name", "");
}

}  // namespace
