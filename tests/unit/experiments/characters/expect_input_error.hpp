// Runs a function that must throw an InputError and compares the beginning and one part of the message.
#pragma once

#include "tests/support/refusal.hpp"

#include <functional>

inline void expect_input_error(const std::function<void()>& run, const std::string& begins, const std::string& holds)
{
    const std::string message = test_support::refusal_of(run);
    EXPECT_NE(message, "accepted") << "expected " << begins << " ... " << holds;
    EXPECT_TRUE(message.starts_with(begins)) << message << "\nexpected to begin with: " << begins;
    EXPECT_NE(message.find(holds), std::string::npos) << message << "\nexpected to hold: " << holds;
}
