// Modules: parts of the program in shared objects of their own, loaded on first use, because the library behind them is
// slow to load (deal.II alone brings some 200 shared objects) and most runs never need it.
//   using Factor = void(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order,
//                       CholeskyFactor& factor);
//   load_module("pbskin_cholmod").function<Factor>("pbskin_cholmod_ordered_factor")(lower, order, factor);
// lib<name>.so is looked for in the folder named by the environment variable PBSKIN_MODULES, otherwise next to the
// executable's folder in ../lib (a build) and ../lib/pbskin (an installation). A module that is not there is an
// InputError saying where it was looked for.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace pbs {

// A shared object that load_module has loaded.
class Module {
public:
    // handle: dlopen's.
    Module(std::string path, void* handle) : path_(std::move(path)), handle_(handle) {}

    // The function of that C name; its type is the caller's word. An InputError where there is none of that name.
    template <typename Function>
    Function* function(const char* symbol) const
    {
        return reinterpret_cast<Function*>(address(symbol));
    }

    const std::string& path() const { return path_; }  // where it was found

private:
    void* address(const char* symbol) const;

    std::string path_;
    void* handle_;
};

// Loaded once and kept to the end of the program; may be called from any thread. An InputError where it is not there or
// does not load. A function that its libraries lack is noticed only when it is called: the loader then ends the
// program.
const Module& load_module(const std::string& name);

// While this exists, OpenBLAS is loaded with one thread; the reference sets it to one anyway. Where the address space
// is limited (ulimit -v), its further threads find no memory and ask for it for ever, and whoever loads or unloads the
// library waits for them. Programs that are started later get the user's variable.
class OneBlasThreadWhileLoading {
public:
    OneBlasThreadWhileLoading()
    {
        if (const char* number = std::getenv(variable)) before_ = number;
        setenv(variable, "1", 1);
    }
    ~OneBlasThreadWhileLoading() { before_ ? setenv(variable, before_->c_str(), 1) : unsetenv(variable); }
    OneBlasThreadWhileLoading(const OneBlasThreadWhileLoading&) = delete;
    OneBlasThreadWhileLoading& operator=(const OneBlasThreadWhileLoading&) = delete;

private:
    static constexpr const char* variable = "OPENBLAS_NUM_THREADS";
    std::optional<std::string> before_;
};

}  // namespace pbs
