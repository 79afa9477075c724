// Reference: the names and contents that the folder had before the run.
#include "analysis/records/record_files.hpp"
#include "experiments/run/earlier_results.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

namespace {

namespace fs = std::filesystem;
using Contents = std::map<std::string, std::string>;

class EarlierResults : public testing::Test {
protected:
    void write(const Contents& files) const
    {
        for (const auto& [name, text] : files) {
            fs::create_directories((scratch.path() / name).parent_path());
            analysis::write_text_atomically(scratch / name, text);
        }
    }
    Contents contents() const
    {
        Contents files;
        for (const auto& file : fs::recursive_directory_iterator(scratch.path()))
            if (file.is_regular_file())
                files[file.path().lexically_relative(scratch.path()).string()] =
                    analysis::read_text(file.path().string());
        return files;
    }

    const test_support::ScratchFolder scratch;
    const Contents users_own = {{"frames/mine.txt", "mine"}, {"scene.toml", "a scene"}};
    const Contents first = {{"run.json", "1"},
                            {"metrics.csv", "1"},
                            {"frames/pbs_000001.vtu", "1"},
                            {"frames/pbs.glb", "1"},
                            {"skin/artist_000001.vtp", "1"},
                            {"try.json", "1"},
                            {"report.html", "1"}};
    const Contents second = {{"metrics.csv", "2"}, {"frames/pbs_000002.vtu", "2"}, {"iterations.csv", "2"}};
};

Contents together(Contents files, const Contents& others)
{
    files.insert(others.begin(), others.end());
    return files;
}

TEST_F(EarlierResults, AreBackAfterARunThatFails)
{
    write(users_own);
    write(first);
    {
        const experiments::EarlierResults earlier(scratch.path());
        EXPECT_FALSE(fs::exists(scratch / "metrics.csv"));
        write(second);
    }
    EXPECT_EQ(contents(), together(users_own, first));
    EXPECT_FALSE(fs::exists(scratch / ".earlier"));
}

TEST_F(EarlierResults, LeaveWithARunThatFinishes)
{
    write(users_own);
    write(first);
    {
        experiments::EarlierResults earlier(scratch.path());
        write(second);
        write({{"run.json", "2"}});
        earlier.replace();
    }
    EXPECT_EQ(contents(), together(together(users_own, second), {{"run.json", "2"}}));
    EXPECT_FALSE(fs::exists(scratch / ".earlier"));
}

// A killed run leaves the folder like one that was interrupted. The next run fails, too.
TEST_F(EarlierResults, OutliveARunThatIsKilled)
{
    write(first);
    {
        experiments::EarlierResults earlier(scratch.path());
        write(second);
        EXPECT_EQ(earlier.path(), scratch / ".earlier");
        earlier.keep_aside();
    }
    EXPECT_EQ(analysis::read_text(scratch / "metrics.csv"), "2");
    EXPECT_EQ(analysis::read_text(scratch / ".earlier/metrics.csv"), "1");
    {
        const experiments::EarlierResults earlier(scratch.path());
        EXPECT_FALSE(fs::exists(scratch / "metrics.csv"));
    }
    EXPECT_EQ(contents(), first);
}

// The second one is killed after its run.json: its results are the earlier ones of the third.
TEST_F(EarlierResults, AreThoseOfTheLastRunThatFinished)
{
    write(first);
    {
        experiments::EarlierResults earlier(scratch.path());
        write(second);
        write({{"run.json", "2"}});
        earlier.keep_aside();
    }
    experiments::EarlierResults(scratch.path());
    EXPECT_EQ(contents(), together(second, {{"run.json", "2"}}));
}

// The first one was killed while it moved the results aside, the second one while it put them back: run.json is the
// last, then the first.
TEST_F(EarlierResults, OutliveAKillWhileTheyAreMoved)
{
    for (const bool record_is_aside : {false, true}) {
        write(first);
        fs::create_directories(scratch.path() / ".earlier/frames");
        fs::rename(scratch / "frames/pbs.glb", scratch / ".earlier/frames/pbs.glb");
        fs::rename(scratch / "metrics.csv", scratch / ".earlier/metrics.csv");
        if (record_is_aside)  // all are, and the rows of the run that was killed are in their place
            for (const auto& [name, text] : first)
                if (fs::exists(scratch / name)) {
                    fs::create_directories((scratch.path() / ".earlier" / name).parent_path());
                    fs::rename(scratch / name, scratch.path() / ".earlier" / name);
                }
        {
            const experiments::EarlierResults earlier(scratch.path());
        }
        EXPECT_EQ(contents(), first) << record_is_aside;
    }
}

TEST_F(EarlierResults, OutliveAnInterruptedTrialBesideThem)
{
    write(first);
    for (int trial = 0; trial < 2; ++trial) {
        experiments::EarlierResults earlier(scratch.path());
        write(second);
        write({{"run.json", R"({"outcome": {"interrupted": true}})"}});
        earlier.keep_aside();
    }
    EXPECT_EQ(analysis::read_text(scratch / ".earlier/run.json"), "1");
    {
        const experiments::EarlierResults earlier(scratch.path());
    }
    EXPECT_EQ(contents(), first);
}

TEST_F(EarlierResults, AreNotTheRowsOfAnUnfinishedRun)
{
    write(users_own);
    write(second);
    const experiments::EarlierResults earlier(scratch.path());
    EXPECT_EQ(contents(), users_own);
    EXPECT_EQ(earlier.path(), "");
}

}  // namespace
