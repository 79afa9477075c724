// Work in a separate process. Reference: the contract of the header.
#include "experiments/process/child_process.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
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

template <typename Exception>
std::string words_of(const std::function<nlohmann::json()>& work)
{
    try {
        in_own_process(work);
    } catch (const Exception& error) {
        return error.what();
    }
    return "accepted";
}

TEST(OwnProcess, AFailureIsToldWithItsWordsAndItsKind)
{
    EXPECT_EQ(words_of<pbs::InputError>([]() -> nlohmann::json { throw pbs::InputError("a.bvh", 0, "", "", "no such clip"); }),
              "a.bvh: no such clip");
    const auto internal = []() -> nlohmann::json { throw std::out_of_range("no such row"); };
    EXPECT_EQ(words_of<std::runtime_error>(internal), "no such row");
    EXPECT_THROW(words_of<pbs::InputError>(internal), std::runtime_error);
    EXPECT_THROW(in_own_process([]() -> nlohmann::json { throw std::string("not an exception"); }), std::runtime_error);
}

TEST(OwnProcess, WordsThatAreNotUtf8ArriveAllTheSame)
{
    EXPECT_EQ(in_own_process([] { return nlohmann::json("li\xffmb"); }), "li\xef\xbf\xbdmb");
    EXPECT_EQ(words_of<pbs::InputError>([]() -> nlohmann::json { throw pbs::InputError("li\xffmb", 0, "", "", "cannot be read"); }),
              "li\xef\xbf\xbdmb: cannot be read");
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
