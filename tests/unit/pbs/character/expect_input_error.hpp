// Runs a function that must throw an InputError and compares the beginning and one part of the message.
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

inline void expect_input_error(const std::function<void()>& run, const std::string& begins, const std::string& holds)
{
    try {
        run();
        ADD_FAILURE() << "nothing was refused; expected " << begins << " ... " << holds;
    } catch (const pbs::InputError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with(begins)) << message << "\nexpected to begin with: " << begins;
        EXPECT_NE(message.find(holds), std::string::npos) << message << "\nexpected to hold: " << holds;
    }
}
