// Reference: what a reader returns, or the way in which it was made to die.

#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/module.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <stdexcept>

namespace {

using Reader = std::function<void(const std::string&)>;

std::string message_of(const Reader& read, const std::string& path = "x.vtu")
{
    return test_support::refusal_of([&] { pbs::try_reading(path, read); });
}

TEST(GuardedReading, ReadsInAChildAndThenHere)
{
    int reads_here = 0;
    const auto read = [&](const std::string& path) { return path + std::to_string(++reads_here); };
    EXPECT_EQ(pbs::read_guarded("x", read), "x1") << "what the child did stays in the child";
    EXPECT_EQ(reads_here, 1);
    const auto dying = [&](const std::string&) -> int {
        ++reads_here;
        std::raise(SIGABRT);
        return 1;
    };
    EXPECT_THROW(pbs::read_guarded("x", dying), pbs::InputError);
    EXPECT_EQ(reads_here, 1) << "read here although the child died";
}

TEST(GuardedReading, WhatTheReaderThrowsComesBack)
{
    EXPECT_EQ(message_of([](const std::string& path) { throw pbs::InputError(path, 3, "tet", "-1", "expected 0 or more"); }),
              "x.vtu:3: tet = -1: expected 0 or more");
    EXPECT_EQ(message_of([](const std::string&) { throw std::runtime_error("no header"); }), "x.vtu: no header");
    EXPECT_EQ(message_of([](const std::string&) { throw std::bad_alloc(); }),
              "x.vtu: damaged: asks for more memory than such a file can need");
}

TEST(GuardedReading, ADeathIsAnErrorThatNamesIt)
{
    const auto dying = [](int signal) { return [signal](const std::string&) { std::raise(signal); }; };
    EXPECT_EQ(message_of(dying(SIGSEGV)), "x.vtu: damaged: the reader broke down on it: Segmentation fault");
    EXPECT_EQ(message_of(dying(SIGABRT)), "x.vtu: damaged: the reader broke down on it: Aborted");
    EXPECT_EQ(message_of([](const std::string&) { _exit(7); }), "x.vtu: damaged: the reader ended in the middle, with exit status 7");
    EXPECT_EQ(message_of([](const std::string&) { _exit(0); }), "x.vtu: damaged: the reader ended in the middle, with exit status 0");
}

struct Stop {};

long open_files()
{
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

TEST(GuardedReading, WhatTheQuestionThrowsEndsTheReaderAndLeavesNothing)
{
    const long before = open_files();
    int asked = 0;
    pbs::ask_while_reading([&asked] {
        if (++asked == 3) throw Stop{};
    });
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(pbs::try_reading("x.vtu", [](const std::string&) { sleep(60); }), Stop);
    pbs::ask_while_reading([] {});
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child was left";
    EXPECT_EQ(open_files(), before);
}

std::uintmax_t available_bytes()
{
    std::ifstream file("/proc/meminfo");
    std::uintmax_t kilobytes = 0;
    for (std::string word; file >> word;)
        if (word == "MemAvailable:" && file >> kilobytes) break;
    return 1024 * kilobytes;
}

// The limit holds for any file size, since a sparse file may have any size at no cost.
TEST(GuardedReading, MoreThanHalfOfTheMemoryIsNotGiven)
{
    if (std::getenv("PBS_SANITIZED")) GTEST_SKIP() << "sanitizers reserve terabytes: no limit on addresses";
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("sparse.vtu", "");
    std::filesystem::resize_file(path, std::uintmax_t(1) << 36);
    const auto taking = [](std::uintmax_t bytes) {
        return [bytes](const std::string&) {
            std::string room;
            room.reserve(bytes);
        };
    };
    EXPECT_EQ(message_of(taking(available_bytes() / 3), path), "accepted");
    EXPECT_EQ(message_of(taking(available_bytes() * 2 / 3), path), path + ": damaged: asks for more memory than such a file can need");
}

TEST(GuardedReading, AFileThatShrinksWhileItIsMapped)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder / "shrinking.vtu";
    std::ofstream(path) << std::string(100'000, 'x');
    const Reader read = [](const std::string& file) {
        const int descriptor = open(file.c_str(), O_RDONLY);
        const void* bytes = mmap(nullptr, 100'000, PROT_READ, MAP_PRIVATE, descriptor, 0);
        std::filesystem::resize_file(file, 10);
        if (std::string(static_cast<const char*>(bytes), 100'000).empty()) std::abort();
    };
    EXPECT_EQ(message_of(read, path), path + ": damaged: the reader broke down on it: Bus error");
}

// Reference: the state of this process's own children.

TEST(Process, IsGoneOnceItHasEndedThoughNobodyHasAskedHow)
{
    EXPECT_FALSE(pbs::process_is_gone(getpid()));
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        pause();
        _exit(0);
    }
    EXPECT_FALSE(pbs::process_is_gone(child));
    kill(child, SIGKILL);
    siginfo_t how;
    ASSERT_EQ(waitid(P_PID, child, &how, WEXITED | WNOWAIT), 0);  // it stays a zombie
    EXPECT_TRUE(pbs::process_is_gone(child));
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_TRUE(pbs::process_is_gone(child));
}

// Reference: the folders that the header specifies for the search for modules.

class Modules : public ::testing::Test {
protected:
    void TearDown() override { unsetenv("PBSKIN_MODULES"); }
};

TEST_F(Modules, AMissingOneSaysWhereItWasLookedFor)
{
    for (const char* words : {"/lib/pbskin", "PBSKIN_MODULES"})
        expect_input_error([] { pbs::load_module("pbskin_no_such_module"); }, "libpbskin_no_such_module.so: ", words);
}

TEST_F(Modules, TheEnvironmentVariableNamesTheOnlyFolder)
{
    setenv("PBSKIN_MODULES", "/no/such/folder", 1);
    expect_input_error([] { pbs::load_module("pbskin_no_such_module"); }, "", "looked in /no/such/folder)");
}

TEST_F(Modules, AFileThatIsNoLibraryIsRefusedInTheLoadersWords)
{
    const test_support::ScratchFolder folder;
    folder.file("libpbskin_text.so", "no library");
    setenv("PBSKIN_MODULES", folder.path().c_str(), 1);
    expect_input_error([] { pbs::load_module("pbskin_text"); }, folder / "libpbskin_text.so", "cannot be loaded");
}

#ifdef PBS_WITH_CHOLMOD
TEST_F(Modules, AreLoadedOnceAndFoundBesideTheExecutable)
{
    const pbs::Module& cholmod = pbs::load_module("pbskin_cholmod");
    EXPECT_EQ(&cholmod, &pbs::load_module("pbskin_cholmod"));
    EXPECT_NE(cholmod.function<void()>("pbskin_cholmod_factor"), nullptr);
}

TEST_F(Modules, AFunctionThatIsNotThereIsRefusedByName)
{
    expect_input_error([] { pbs::load_module("pbskin_cholmod").function<void()>("pbskin_no_such_function"); }, "",
                       "pbskin_no_such_function");
}
#endif

}  // namespace
