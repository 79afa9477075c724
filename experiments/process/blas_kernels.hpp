// The kernels of OpenBLAS. It selects them by the processor's family and model while it is loaded, and for a processor that is newer than
// the library it falls back to the oldest ones ("Prescott", SSE3): Debian 12's OpenBLAS 0.3.21 does so on an Intel Xeon of model 207, which
// has AVX-512. Its environment variable OPENBLAS_CORETYPE overrides the selection, and is read at that moment only.
//   load_module_with_blas("pbskin_fem");     // selects the right kernels first
//   provenance.blas = blas_in_use();
// A processor other than x86-64 and a BLAS other than OpenBLAS are left alone.
#pragma once

#include "pbs/geometry/module.hpp"

#include <map>
#include <string>

namespace experiments {

// What decides on kernels. The instructions count only where the operating system saves their registers.
struct Processor {
    bool is_zen = false;      // AMD, family 17h or later
    bool has_avx2 = false;    // AVX2 and FMA: what the kernels Haswell and Zen need
    bool has_avx512 = false;  // AVX-512 F, CD, BW, DQ and VL: what the kernels SkylakeX need
};
Processor this_processor();

// The core type to ask OpenBLAS for in place of `selected`, its own selection: empty where that uses all the instructions that the
// processor has, or has a name that is not known here.
std::string better_core_type(const std::string& selected, const Processor& processor);

// Loads OpenBLAS, if it is what libblas.so.3 is, and loads it anew with OPENBLAS_CORETYPE set where there is a better core type. A user's
// own OPENBLAS_CORETYPE stands, and so does an OpenBLAS that the process has loaded before. Only the first call does anything; from any
// thread.
void select_blas_kernels();
const pbs::Module& load_module_with_blas(const std::string& name);  // pbs::load_module after select_blas_kernels

// For the provenance of a record: `library` (OpenBLAS's own description), `core_type` that is in use, and `core_type_selected_by`:
// "pbskin", "OpenBLAS", or "user" where the environment held OPENBLAS_CORETYPE. Empty where this process has loaded no OpenBLAS.
std::map<std::string, std::string> blas_in_use();

// For a program that is linked with BLAS, before anything else in main: where there is a better core type, the program starts again with
// OPENBLAS_CORETYPE set. Returns if it does not.
void restart_with_better_blas_kernels(char** argv);

}  // namespace experiments
