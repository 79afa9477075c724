#include "experiments/process/machine.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/deferred_sigterm.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>
#include <vector>

namespace experiments {
namespace {

// A line of /proc/self/status, such as "VmHWM:   4321 kB".
double status_bytes(const std::string& field)
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(field + ":", 0) == 0) return 1024.0 * std::stod(line.substr(field.size() + 1));
    return 0.0;
}

// The columns of a line "cpu" (proc(5)). The guests' times, which follow, are contained in user and nice.
enum Column { user, nice, system, idle, iowait, irq, softirq, steal, columns };

std::optional<ProcessorTicks> ticks_now()
{
    std::ifstream file("/proc/stat");
    return processor_ticks({std::istreambuf_iterator<char>(file), {}});
}

constexpr const char* library_file = "libblas.so.3";
constexpr const char* core_type_variable = "OPENBLAS_CORETYPE";
constexpr const char* restarted_variable =
    "PBSKIN_BLAS_KERNELS";  // set by restart_with_better_blas_kernels to the core type it selected

enum InstructionSet { below_avx2, avx2, avx512, unknown };

// OpenBLAS's core types on x86-64 by the instructions that their kernels use (its driver/others/dynamic.c and
// kernel/x86_64).
InstructionSet instructions_of(std::string_view core_type)
{
    constexpr std::array older = {"Katmai", "Coppermine",  "Northwood",    "Prescott",   "Banias",
                                  "Atom",   "Core2",       "Penryn",       "Dunnington", "Nehalem",
                                  "Athlon", "Opteron",     "Opteron_SSE3", "Barcelona",  "Nano",
                                  "Bobcat", "Sandybridge", "Bulldozer",    "Piledriver", "Steamroller"};
    constexpr std::array with_avx2 = {"Haswell", "Zen", "Excavator"};
    constexpr std::array with_avx512 = {"SkylakeX", "Cooperlake", "SapphireRapids"};
    const auto is_in = [&](const auto& names) {
        return std::find(names.begin(), names.end(), core_type) != names.end();
    };
    if (is_in(older)) return below_avx2;
    if (is_in(with_avx2)) return avx2;
    return is_in(with_avx512) ? avx512 : unknown;
}

using Text = char*();

// A function that only OpenBLAS has; null where the process has loaded no OpenBLAS.
Text* openblas_text(void* library, const char* function)
{
    return library ? reinterpret_cast<Text*>(dlsym(library, function)) : nullptr;
}

void* loaded_library()
{
    void* library = dlopen(library_file, RTLD_NOW | RTLD_NOLOAD);
    if (library) dlclose(library);  // lowers a count of references: whoever loaded it still holds it
    return library;
}

bool user_selects()
{
    const char* core_type = std::getenv(core_type_variable);
    return core_type && *core_type;
}

std::atomic<bool> selected_here = false;

}  // namespace

PeakMemory peak_memory_of(const std::function<void()>& work)
{
    malloc_trim(0);                               // memory that earlier work has freed does not count
    std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak (proc(5))
    PeakMemory memory{status_bytes("VmRSS"), 0.0};
    work();
    memory.peak_bytes = peak_memory_bytes();
    return memory;
}

double peak_memory_bytes()
{
    return status_bytes("VmHWM");
}

std::optional<ProcessorTicks> processor_ticks(const std::string& proc_stat)
{
    std::vector<double> ticks;
    int processors = 0;
    std::istringstream text(proc_stat);
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        std::string name;
        words >> name;
        if (name == "cpu") ticks.assign(std::istream_iterator<double>(words), {});
        if (name.size() > 3 && name.rfind("cpu", 0) == 0 && std::isdigit(static_cast<unsigned char>(name[3])))
            ++processors;
    }
    if (ticks.size() <= idle || processors == 0) return std::nullopt;
    ticks.resize(columns, 0.0);
    return ProcessorTicks{ticks[user] + ticks[nice] + ticks[system] + ticks[irq] + ticks[softirq] + ticks[steal],
                          ticks[idle] + ticks[iowait], processors};
}

std::optional<double> busy_processors(const ProcessorTicks& before, const ProcessorTicks& after)
{
    const double busy = after.busy - before.busy, all = busy + after.idle - before.idle;
    if (!(all > 0.0)) return std::nullopt;
    return after.processors * busy / all;
}

std::optional<double> busy_processors(double seconds)
{
    const std::optional<ProcessorTicks> before = ticks_now();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    const std::optional<ProcessorTicks> after = ticks_now();
    if (!before || !after) return std::nullopt;
    return busy_processors(*before, *after);
}

Processor this_processor()
{
    Processor processor;
#ifdef __x86_64__
    processor.is_zen = __builtin_cpu_is("amdfam17h") || __builtin_cpu_is("amdfam19h");
    processor.has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    processor.has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                           __builtin_cpu_supports("avx512vl");
#endif
    return processor;
}

std::string better_core_type(const std::string& selected, const Processor& processor)
{
    const InstructionSet in_use = instructions_of(selected);
    if (processor.is_zen) return processor.has_avx2 && in_use < avx2 ? "Zen" : "";  // OpenBLAS has Zen for all of them
    if (processor.has_avx512) return in_use < avx512 ? "SkylakeX" : "";
    return processor.has_avx2 && in_use < avx2 ? "Haswell" : "";
}

void select_blas_kernels()
{
    static std::once_flag once;
    std::call_once(once, [] {
        if (user_selects() || loaded_library()) return;
        const pbs::SigtermTakenElsewhere elsewhere;  // OpenBLAS starts its threads
        const pbs::OneBlasThreadWhileLoading one_thread;
        void* library = dlopen(library_file, RTLD_NOW | RTLD_LOCAL);
        Text* core_type = openblas_text(library, "openblas_get_corename");
        const std::string better = core_type ? better_core_type(core_type(), this_processor()) : "";
        if (better.empty()) return;  // it stays loaded for the module
        dlclose(library);
        if (loaded_library()) return;  // it does not unload, so that nothing reads the variable again
        setenv(core_type_variable, better.c_str(), 1);
        selected_here = true;
    });
}

const pbs::Module& load_module_with_blas(const std::string& name)
{
    select_blas_kernels();
    const pbs::Module& module = pbs::load_module(name);
    if (std::strcmp(module.function<decltype(pbskin_headers)>("pbskin_headers")(), pbskin_headers()) != 0)
        throw pbs::InputError(module.path(), 0, "", "",
                              "was built from other headers than this program: build both again");
    return module;
}

std::map<std::string, std::string> blas_in_use()
{
    void* library = loaded_library();
    Text *configuration = openblas_text(library, "openblas_get_config"),
         *core_type = openblas_text(library, "openblas_get_corename");
    if (!configuration || !core_type) return {};
    const bool by_program = selected_here || std::getenv(restarted_variable);
    return {{"library", configuration()},
            {"core_type", core_type()},
            {"core_type_selected_by", by_program       ? "pbskin"
                                      : user_selects() ? "user"
                                                       : "OpenBLAS"}};
}

void restart_with_better_blas_kernels(char** argv)
{
    Text* core_type = openblas_text(loaded_library(), "openblas_get_corename");
    if (user_selects() || !core_type) return;
    const std::string better = better_core_type(core_type(), this_processor());
    if (better.empty()) return;
    setenv(core_type_variable, better.c_str(), 1);
    setenv(restarted_variable, better.c_str(), 1);
    execv("/proc/self/exe", argv);
    unsetenv(core_type_variable);  // the program cannot be started again and goes on with the kernels that it has
    unsetenv(restarted_variable);
}

}  // namespace experiments
