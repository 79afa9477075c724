// Whether `./check --long` runs the tests. It sets PBS_LONG, so that tests do what takes long.
#pragma once

#include <cstdlib>

namespace test_support {

inline bool is_long_form()
{
    const char* value = std::getenv("PBS_LONG");
    return value && *value;
}

}  // namespace test_support
