// The file with deformers of the user's own: what is read, and each wrong input with its file, line, field, value and
// rule.
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/work_precision/methods.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace external_methods_tests {
namespace {

using namespace experiments;
using nlohmann::json;

std::string entry_table(const std::string& name, const std::string& keys = "command = [\"sh\", \"mine.sh\"]")
{
    return "[[external]]\nname = \"" + name + "\"\n" + keys + "\n";
}

class ExternalMethods : public testing::Test {
protected:
    std::vector<ComparedMethod> read(const std::string& tables) const
    {
        return external_methods(folder.file("mine.toml", "schema = 1\n" + tables));
    }
    void expect_refused(const std::string& tables, const std::string& place, const std::string& rule) const
    {
        expect_input_error([&] { read(tables); }, folder / "mine.toml" + place, rule);
    }
    test_support::ScratchFolder folder;
};

TEST_F(ExternalMethods, AreTheTablesInTheirOrder)
{
    const std::string program = folder.file("mine.sh", "exit 0");
    const std::vector<ComparedMethod> all =
        read(entry_table("mine") + entry_table("other", "command = [\"sh\"]\nhas_memory = true"));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].name, "mine");
    EXPECT_FALSE(all[0].takes_flesh());
    EXPECT_TRUE(all[0].is_in("known") && all[0].is_in("guessed"));
    const Scene scene = read_scene("limb_twist", {"character.vertices=300"});
    const DeformerSpec own = spec_of({&all[0]}, scene, pbs::make_character(scene.character), family().back());
    EXPECT_EQ(own.name, "mine");
    EXPECT_EQ(own.threads, 1);
    const auto& given = options_of<ExternalOptions>(own);
    EXPECT_EQ(given.command, (std::vector<std::string>{"sh", program}));
    ASSERT_EQ(given.file_hashes.size(), 2u);
    EXPECT_EQ(given.file_hashes[0], "") << "sh is sought on the PATH";
    EXPECT_NE(given.file_hashes[1], "");
    EXPECT_TRUE(options_of<ExternalOptions>(all[1].external).has_memory);
}

// Files are recorded by their place in the command, and other words in full.
TEST_F(ExternalMethods, ChangeWithEachFileAndWord)
{
    for (const char* of : {"a", "b"}) std::filesystem::create_directory(folder.path() / of);
    const auto record = [&](const std::string& a, const std::string& b, const std::string& words) {
        folder.file("a/mine.sh", a), folder.file("b/mine.sh", b);
        return to_json(read(entry_table("mine", "command = [\"sh\", " + words + "]"))[0].external);
    };
    const std::string both = R"("a/mine.sh", "b/mine.sh")", other_order = R"("b/mine.sh", "a/mine.sh")";
    const json first = record("exit 0", "exit 1", both);
    EXPECT_EQ(record("exit 0", "exit 1", both), first);
    EXPECT_NE(record("exit 2", "exit 1", both), first);
    EXPECT_NE(record("exit 0", "exit 2", both), first);
    EXPECT_NE(record("exit 0", "exit 1", other_order), first);
    EXPECT_EQ(record("exit 1", "exit 0", other_order), first) << "the files themselves are the same";
    EXPECT_EQ(first.dump().find(folder.path().string()), std::string::npos) << "the record is that of any folder";
    EXPECT_NE(record("exit 0", "exit 1", both + R"(, "/nowhere/one/data")"),
              record("exit 0", "exit 1", both + R"(, "/nowhere/two/data")"));
}

struct RefusedEntry {
    std::string tables, place, rule = {};
};

class RefusedEntries : public ExternalMethods, public testing::WithParamInterface<RefusedEntry> {};

TEST_P(RefusedEntries, NameThePlaceAndTheRule)
{
    folder.file("mine.sh", "exit 0");
    folder.file("libmine.so", "no library");
    expect_refused(GetParam().tables, GetParam().place, GetParam().rule);
}

const std::string alone = "expected only [[external]] tables";
INSTANTIATE_TEST_SUITE_P(
    OfOtherTables, RefusedEntries,
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
    testing::Values(
        RefusedEntry{entry_table("reference"), ":3: external.0.name = reference", "of the comparison"},
        RefusedEntry{entry_table("vbd_from_lbs"), ":3: external.0.name = vbd_from_lbs", "of the comparison"},
        RefusedEntry{entry_table("mine") + entry_table("mine"), ":6: external.1.name = mine", "is used twice"},
        RefusedEntry{entry_table("my own"), ":3: external.0.name = my own", "letters, digits and underscores"},
        RefusedEntry{"[[external]]\ncommand = [\"sh\"]\n", ": external.0.name: missing", "states it"}));
INSTANTIATE_TEST_SUITE_P(OfTheirPrograms, RefusedEntries,
                         testing::Values(RefusedEntry{entry_table("mine", "command = [\"no_such_program\"]"),
                                                      ":4: external.0.command =", "No such file or directory"},
                                         RefusedEntry{entry_table("mine", "command = [\"mine.sh\"]"),
                                                      ":4: external.0.command =", "Permission denied"},
                                         RefusedEntry{entry_table("mine", "command = [\"./none.sh\"]"),
                                                      ":4: external.0.command =", "No such file or directory"},
                                         RefusedEntry{entry_table("mine", "library = \"libnone.so\""),
                                                      ":4: external.0.library = libnone.so", "cannot be loaded"},
                                         RefusedEntry{entry_table("mine", "library = \"libmine.so\""),
                                                      ":4: external.0.library = libmine.so", "cannot be loaded: "},
                                         RefusedEntry{entry_table("mine", ""), ": external.0.command",
                                                      "expected either a command or a library"}));

TEST_F(ExternalMethods, NeedAFileAndNamesOfTheirOwn)
{
    expect_input_error([&] { external_methods(folder / "none.toml"); }, folder / "none.toml" + ": cannot be read",
                       "[[external]]");
    expect_input_error([&] { external_methods(folder.path().string()); }, folder.path().string(), "cannot be read");
    expect_input_error([&] { external_methods(folder.file("mine.toml", entry_table("mine"))); },
                       folder / "mine.toml: schema", "write schema = 1");
    for (const ComparedMethod& one : methods())
        expect_refused(entry_table(one.name), ":3: external.0.name = " + one.name, "");
}

// Their rows would be those of a variation.
TEST_F(ExternalMethods, HaveNoNameOfAnotherStart)
{
    for (const OtherStart& start : other_starts())
        expect_refused(entry_table(start.name), ":3: external.0.name = " + start.name, "");
}

}  // namespace
}  // namespace external_methods_tests
