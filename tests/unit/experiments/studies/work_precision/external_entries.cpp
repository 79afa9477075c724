// The file with deformers of the user's own: what is read, and each wrong input with its file, line, field, value and rule.
#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace {

using namespace experiments;

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

TEST_F(ExternalEntries, ChangeWithTheirPrograms)
{
    const auto hash = [&](const std::string& content) {
        folder.file("mine.sh", content);
        return options_of<ExternalOptions>(entries(entry_table("mine"))[0]).file_hashes.at(1);
    };
    EXPECT_EQ(hash("exit 0"), hash("exit 0"));
    EXPECT_NE(hash("exit 0"), hash("exit 1"));
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

TEST_F(ExternalEntries, NeedAFileWithTheirTablesAlone)
{
    expect_input_error([&] { external_entries(folder / "none.toml"); }, folder / "none.toml" + ": cannot be read", "[[external]]");
    expect_input_error([&] { external_entries(folder.path().string()); }, folder.path().string(), "cannot be read");
    expect_refused("", ": external: missing", "expected at least one [[external]] table");
    expect_refused("[external]\nname = \"mine\"\n", ":2: external:", "expected [[external]] tables");
    expect_refused(entry_table("mine") + "[deformers]\nuse = [\"mine\"]\n", ":5: deformers:", "expected only [[external]] tables");
    expect_refused(entry_table("mine") + "deformers.use = [\"mine\"]\n", ":5: external.0.deformers", "unknown key");
    expect_refused("deformers.use = [\"mine\"]\n" + entry_table("mine"), ":2: deformers:", "expected only [[external]] tables");
    for (const char* keys : {"name = \"solid\"\n", "model = \"linear\"\n"})
        expect_refused(entry_table("mine") + "[[fem]]\n" + keys, ":5: fem.0:", "expected only [[external]] tables");
    expect_refused(entry_table("mine") + "[[lbs]]\n", ":5: lbs.0:", "expected only [[external]] tables");
    expect_refused(entry_table("mine") + "[pbs]\n", ":5: pbs:", "expected only [[external]] tables");
    expect_refused(entry_table("mine") + "[reference]\nname = \"mine\"\n", ":5: reference:", "expected only [[external]] tables");
    expect_refused(entry_table("mine") + "[[mine]]\n", ":5: mine", "unknown key");
    expect_input_error([&] { external_entries(folder.file("mine.toml", entry_table("mine"))); }, folder / "mine.toml: schema",
                       "write schema = 1");
}

TEST_F(ExternalEntries, HaveNamesOfTheirOwn)
{
    for (const ComparedDeformer& one : compared_deformers()) expect_refused(entry_table(one.name), ":3: external.0.name = " + one.name, "");
    for (const DeformerGroup& group : deformer_groups()) expect_refused(entry_table(group.key), ":3: external.0.name", "");
    for (const char* name : {"fem_linear", "reference", "all"})
        expect_refused(entry_table(name), std::string(":3: external.0.name = ") + name, "of the comparison");
    expect_refused(entry_table("mine") + entry_table("mine"), ":6: external.1.name = mine", "is used twice");
    expect_refused(entry_table("my own"), ":3: external.0.name = my own", "letters, digits and underscores");
    expect_refused("[[external]]\ncommand = [\"sh\"]\n", ": external.0.name: missing", "states it");
}

TEST_F(ExternalEntries, CanBeStartedOrLoaded)
{
    expect_refused(entry_table("mine", "command = [\"no_such_program\"]"), ":4: external.0.command =", "No such file or directory");
    folder.file("mine.sh", "exit 0");
    expect_refused(entry_table("mine", "command = [\"mine.sh\"]"), ":4: external.0.command =", "Permission denied");
    expect_refused(entry_table("mine", "command = [\"./none.sh\"]"), ":4: external.0.command =", "No such file or directory");
    expect_refused(entry_table("mine", "library = \"libmine.so\""), ":4: external.0.library = libmine.so", "cannot be loaded");
    folder.file("libmine.so", "no library");
    expect_refused(entry_table("mine", "library = \"libmine.so\""), ":4: external.0.library = libmine.so", "cannot be loaded: ");
    expect_refused(entry_table("mine", ""), ": external.0.command", "expected either a command or a library");
}

}  // namespace
