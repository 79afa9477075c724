#include "reference_fem/blas.hpp"

#include <climits>
#include <cstdlib>
#include <dlfcn.h>

extern "C" void dgemm_();

namespace reference_fem {
namespace {

// OpenBLAS's own functions, looked up at run time: the program must also run on another BLAS.
template <typename Function>
Function* find(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

std::string file_of(void (*function)())
{
    Dl_info info{};
    if (!dladdr(reinterpret_cast<void*>(function), &info) || !info.dli_fname) return "unknown file";
    char resolved[PATH_MAX];
    return realpath(info.dli_fname, resolved) ? resolved : info.dli_fname;
}

}  // namespace

std::string resolved_blas()
{
    auto* config = find<char*()>("openblas_get_config");
    const std::string library = config ? config() : "not OpenBLAS";
    const std::string file = file_of(&dgemm_);
    return library + " (" + file.substr(file.rfind('/') + 1) + ")";
}

void use_one_blas_thread()
{
    if (auto* set_threads = find<void(int)>("openblas_set_num_threads")) set_threads(1);
}

}  // namespace reference_fem
