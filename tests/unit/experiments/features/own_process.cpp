// Work in a process of its own. Truth: the contract of the header.
#include "experiments/features/own_process.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>
#include <string>

namespace {

using experiments::in_own_process;

TEST(OwnProcess, TellsItsResult)
{
    EXPECT_EQ(in_own_process([] { return nlohmann::json{{"frames", 3}}; }).at("frames"), 3);
}

TEST(OwnProcess, TellsMoreThanAPipeHolds)
{
    const std::string text(300'000, 'x');
    EXPECT_EQ(in_own_process([&] { return nlohmann::json(text); }).get<std::string>(), text);
}

TEST(OwnProcess, LeavesNothingBehind)
{
    int mine = 1;
    in_own_process([&] { return nlohmann::json(++mine); });
    EXPECT_EQ(mine, 1);
}

TEST(OwnProcess, AFailureIsToldWithItsWords)
{
    try {
        in_own_process([]() -> nlohmann::json { throw std::runtime_error("no such clip"); });
        FAIL() << "accepted";
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("no such clip"), std::string::npos) << error.what();
    }
}

TEST(OwnProcess, ADeathIsAnError)
{
    EXPECT_THROW(in_own_process([]() -> nlohmann::json {
                     std::raise(SIGKILL);
                     return {};
                 }),
                 pbs::InputError);
}

}  // namespace
