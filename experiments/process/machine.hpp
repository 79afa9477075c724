// The machine: processor time, memory, how many processors other work keeps busy, and the kernels of OpenBLAS.
#pragma once

#include "pbs/system/module.hpp"

#include <ctime>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace experiments {

// Processor time [s]: other work on the machine stretches it less than wall time.
inline double clock_s(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Processor time of the calling thread.
inline double thread_cpu_s()
{
    return clock_s(CLOCK_THREAD_CPUTIME_ID);
}

// Processor time of all threads of the process.
inline double process_cpu_s()
{
    return clock_s(CLOCK_PROCESS_CPUTIME_ID);
}

// Resident memory of this process, as Linux counts it.
//   const PeakMemory memory = peak_memory_of([&] { solver.advance(...); });
struct PeakMemory {
    double before_bytes = 0.0;
    double peak_bytes = 0.0;  // the maximum while the work ran; zero if the system does not report it

    double growth_bytes() const { return peak_bytes - before_bytes; }
};

PeakMemory peak_memory_of(const std::function<void()>& work);

double peak_memory_bytes();  // of this process since it started, or since peak_memory_of began

// The processors that other work keeps busy, measured while this thread sleeps.
//   const double busy = busy_processors(0.5);   // 1 if another program computes on one core

// The processor time of a machine, summed over its processors, in ticks of the kernel.
struct ProcessorTicks {
    double busy = 0.0;  // waiting for a disk is idle; time that a host takes for other guests is busy
    double idle = 0.0;
    int processors = 0;
};

// Reads the text of /proc/stat (proc(5)). Returns nothing if no line "cpu" has at least four numbers, or if no
// processor is listed.
std::optional<ProcessorTicks> processor_ticks(const std::string& proc_stat);

// Returns the mean number of busy processors between two moments, or nothing if no tick lies between them.
std::optional<double> busy_processors(const ProcessorTicks& before, const ProcessorTicks& after);

// Measures while it sleeps for `seconds`. Returns nothing if the system does not report its processors, or if no tick
// passes meanwhile.
std::optional<double> busy_processors(double seconds);

// The kernels of OpenBLAS. It selects them by the processor's family and model while it is loaded, and for a processor
// that is newer than the library it falls back to the oldest ones ("Prescott", SSE3): Debian 12's OpenBLAS 0.3.21 does
// so on an Intel Xeon of model 207, which has AVX-512. Its environment variable OPENBLAS_CORETYPE overrides the
// selection, and is read at that moment only.
//   load_module_with_blas("pbskin_fem");     // selects the right kernels first
//   provenance.blas = blas_in_use();
// On a processor other than x86-64 and with a BLAS other than OpenBLAS nothing is done.

// The properties of a processor that the selection depends on. An instruction set counts only where the operating
// system saves its registers.
struct Processor {
    bool is_zen = false;      // AMD, family 17h or later
    bool has_avx2 = false;    // AVX2 and FMA: what the kernels Haswell and Zen need
    bool has_avx512 = false;  // AVX-512 F, CD, BW, DQ and VL: what the kernels SkylakeX need
};
Processor this_processor();

// The core type to request from OpenBLAS instead of `selected`, its own selection. Empty where `selected` uses all the
// instructions that the processor has, or is not known here.
std::string better_core_type(const std::string& selected, const Processor& processor);

// If libblas.so.3 is OpenBLAS, loads it, and loads it again with OPENBLAS_CORETYPE set where there is a better core
// type. A core type that the user has set in OPENBLAS_CORETYPE is kept, and so is an OpenBLAS that the process has
// loaded before. Only the first call has an effect. Thread-safe.
void select_blas_kernels();
// pbs::load_module after select_blas_kernels. InputError for a module that was built from other headers than this
// program.
const pbs::Module& load_module_with_blas(const std::string& name);

// For the provenance of a record: `library` (OpenBLAS's own description), `core_type` that is in use, and
// `core_type_selected_by`: "pbskin", "OpenBLAS", or "user" where the environment held OPENBLAS_CORETYPE. Empty where
// this process has loaded no OpenBLAS.
std::map<std::string, std::string> blas_in_use();

// For a program that is linked with BLAS; call it first in main. Where there is a better core type and the user has not
// set one, the program starts again with OPENBLAS_CORETYPE set; otherwise the function returns.
void restart_with_better_blas_kernels(char** argv);

}  // namespace experiments

// The hash of the headers that the program and its modules share (cmake/shared_headers.cmake). Modules that
// load_module_with_blas loads have a function of this name.
extern "C" const char* pbskin_headers();
