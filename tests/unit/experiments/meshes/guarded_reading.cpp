// Reference: what a reader returns, or the way in which it was made to die.

#include "experiments/meshes/guarded_reading.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

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
#include <thread>

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
    EXPECT_EQ(pbs::read_guarded("x", "reader", read), "x1") << "what the child did stays in the child";
    EXPECT_EQ(reads_here, 1);
    const auto dying = [&](const std::string&) -> int {
        ++reads_here;
        std::raise(SIGABRT);
        return 1;
    };
    EXPECT_THROW(pbs::read_guarded("x", "dying reader", dying), pbs::InputError);
    EXPECT_EQ(reads_here, 1) << "read here although the child died";
}

TEST(GuardedReading, TriesTheSameBytesOnceForEachReader)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("x.vtu", "bytes"), tries = folder.file("tries", "");
    // a file that was just written may change without a new time
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto read = [&](const std::string&) {
        std::ofstream(tries, std::ios::app) << "x";
        return 1;
    };
    const pbs::SourceFile file(path);
    EXPECT_EQ(file.text(), "bytes");
    for (const char* reader : {"first", "second", "first", "second"}) pbs::read_guarded(path, reader, read);
    EXPECT_EQ(std::filesystem::file_size(tries), 6u) << "four times here, and twice in a child";
}

TEST(GuardedReading, WhatTheReaderThrowsComesBack)
{
    EXPECT_EQ(
        message_of([](const std::string& path) { throw pbs::InputError(path, 3, "tet", "-1", "expected 0 or more"); }),
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
    EXPECT_EQ(message_of([](const std::string&) { _exit(7); }),
              "x.vtu: damaged: the reader ended in the middle, with exit status 7");
    EXPECT_EQ(message_of([](const std::string&) { _exit(0); }),
              "x.vtu: damaged: the reader ended in the middle, with exit status 0");
}

long open_files()
{
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

TEST(GuardedReading, LeavesNothingBehindHoweverItEnds)
{
    const long before = open_files();
    EXPECT_EQ(message_of([](const std::string&) {}), "accepted");
    EXPECT_NE(message_of([](const std::string&) { std::raise(SIGKILL); }), "accepted");
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
    EXPECT_EQ(message_of(taking(available_bytes() * 2 / 3), path),
              path + ": damaged: asks for more memory than such a file can need");
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

}  // namespace
