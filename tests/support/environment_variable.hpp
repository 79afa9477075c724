// A variable of the environment in one scope.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace test_support {

// Sets the variable, and gives it its earlier value back at the end of its scope.
class EnvironmentVariable {
public:
    EnvironmentVariable(std::string name, const std::string& value) : name_(std::move(name))
    {
        if (const char* earlier = std::getenv(name_.c_str())) earlier_ = earlier;
        ::setenv(name_.c_str(), value.c_str(), 1);
    }
    ~EnvironmentVariable()
    {
        if (earlier_)
            ::setenv(name_.c_str(), earlier_->c_str(), 1);
        else
            ::unsetenv(name_.c_str());
    }
    EnvironmentVariable(const EnvironmentVariable&) = delete;
    EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

private:
    std::string name_;
    std::optional<std::string> earlier_;
};

}  // namespace test_support
