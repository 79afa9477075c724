// Reference: the contract of exit statuses (experiments/command_line/README.md).
#include "experiments/process/terminal.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <stdexcept>

namespace {

using namespace experiments;

template <typename Exception>
Failure failure_of(const Exception& exception)
{
    try {
        throw exception;
    } catch (...) {
        return caught_failure();
    }
}

TEST(Failure, BadInputKeepsItsWords)
{
    const Failure failure = failure_of(pbs::InputError("limb.toml", 12, "pbs.k_volume", "1.4", "expected 0 <= k <= 1"));
    EXPECT_EQ(failure.message(), "limb.toml:12: pbs.k_volume = 1.4: expected 0 <= k <= 1");
    EXPECT_EQ(failure.status, exit_input);
}

TEST(Failure, WhatNobodyHasForeseenIsNoBadInput)
{
    for (const Failure& failure :
         {failure_of(std::runtime_error("basic_string::substr")), failure_of(std::string("basic_string::substr"))}) {
        EXPECT_EQ(failure.message().rfind("internal error: ", 0), 0u) << failure.message();
        EXPECT_NE(failure.message().find("please report"), std::string::npos) << failure.message();
        EXPECT_EQ(failure.status, exit_internal);
    }
    EXPECT_EQ(
        failure_of(std::runtime_error("\n----\nAn error\n\n  occurred")).message().rfind("internal error: ---- An error occurred; ", 0),
        0u);
    EXPECT_NE(failure_of(std::out_of_range("basic_string::substr")).message().find("basic_string::substr"), std::string::npos);
}

TEST(Failure, APlaceOnDiskIsNamedWithTheSystemsReason)
{
    const std::filesystem::filesystem_error error("cannot remove", "out/run.json", std::make_error_code(std::errc::read_only_file_system));
    EXPECT_EQ(failure_of(error).words, "out/run.json: Read-only file system");
    EXPECT_EQ(failure_of(error).status, exit_input);
}

TEST(Failure, MemoryAndInterruptionHaveTheirOwn)
{
    EXPECT_EQ(failure_of(std::bad_alloc()).status, exit_input);
    EXPECT_EQ(failure_of(Interrupted{}).status, exit_interrupted);
}

}  // namespace
