// The message with which bad input is refused, for tests.
//   EXPECT_EQ(test_support::refusal_of([&] { read_csv("m.csv"); }),
//             "m.csv: the file is empty: expected a line of column names");
//   test_support::expect_refused("expected a number", [&] { table.number(1, "b"); });
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace test_support {

// The message of the pbs::InputError that `work` throws, or "accepted".
template <typename Work>
std::string refusal_of(const Work& work)
{
    try {
        work();
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

// The message has to contain `part`.
template <typename Work>
void expect_refused(const std::string& part, const Work& work)
{
    const std::string message = refusal_of(work);
    EXPECT_TRUE(message != "accepted" && message.find(part) != std::string::npos)
        << "expected \"" << part << "\", not \"" << message << '"';
}

}  // namespace test_support
