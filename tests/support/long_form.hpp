// `./check --long` sets PBS_LONG: tests then run the cases that take long too.
#pragma once

#include <cstdlib>

namespace test_support {

inline bool is_long_form()
{
    const char* value = std::getenv("PBS_LONG");
    return value && *value;
}

}  // namespace test_support
