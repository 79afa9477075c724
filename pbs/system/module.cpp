#include "pbs/system/module.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/deferred_sigterm.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

namespace pbs {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> module_folders()
{
    if (const char* folder = std::getenv("PBSKIN_MODULES"); folder && *folder) return {folder};
    const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
    return {bin.parent_path() / "lib", bin.parent_path() / "lib" / "pbskin"};
}

Module open_module(const std::string& name)
{
    const std::string file = "lib" + name + ".so";
    std::string looked_in;
    for (const fs::path& folder : module_folders()) {
        const fs::path path = folder / file;
        looked_in += (looked_in.empty() ? "" : ", ") + folder.string();
        std::error_code ignored;
        if (!fs::exists(path, ignored)) continue;
        const SigtermTakenElsewhere elsewhere;  // OpenBLAS starts its threads while it is loaded
        const OneBlasThreadWhileLoading one_thread;
        // Functions are bound at their first call. Binding those that are never called takes a quarter of the time to
        // load deal.II.
        if (void* handle = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL)) return {path.string(), handle};
        throw InputError(path.string(), 0, "", "", std::string("this module cannot be loaded: ") + dlerror());
    }
    throw InputError(
        file, 0, "", "",
        "this module of the program is missing (looked in " + looked_in +
            "): build it with its option on, or name its folder in the environment variable PBSKIN_MODULES");
}

}  // namespace

void* Module::address(const char* symbol) const
{
    if (void* found = dlsym(handle_, symbol)) return found;
    throw InputError(path_, 0, "", "",
                     std::string("has no function ") + symbol + ": expected a module of this program's version");
}

const Module& load_module(const std::string& name)
{
    static std::mutex mutex;
    static std::map<std::string, Module> loaded;
    const std::lock_guard lock(mutex);
    auto entry = loaded.find(name);
    if (entry == loaded.end()) entry = loaded.emplace(name, open_module(name)).first;
    return entry->second;
}

}  // namespace pbs
