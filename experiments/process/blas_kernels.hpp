// The kernels of OpenBLAS. It selects them by the processor's family and model while it is loaded, and for a processor that is newer than
// the library it falls back to the oldest ones ("Prescott", SSE3): Debian 12's OpenBLAS 0.3.21 does so on an Intel Xeon of model 207, which
// has AVX-512. Its environment variable OPENBLAS_CORETYPE overrides the selection, and is read at that moment only.
//   load_module_with_blas("pbskin_fem");     // selects the right kernels first
//   provenance.blas = blas_in_use();
// On a processor other than x86-64 and with a BLAS other than OpenBLAS nothing is done.
#pragma once

#include "pbs/geometry/module.hpp"

#include <map>
#include <string>

namespace experiments {

// The properties of a processor that the selection depends on. An instruction set counts only where the operating system saves its
// registers.
struct Processor {
    bool is_zen = false;      // AMD, family 17h or later
    bool has_avx2 = false;    // AVX2 and FMA: what the kernels Haswell and Zen need
    bool has_avx512 = false;  // AVX-512 F, CD, BW, DQ and VL: what the kernels SkylakeX need
};
Processor this_processor();

// The core type to request from OpenBLAS instead of `selected`, its own selection. Empty where `selected` uses all the instructions that
// the processor has, or is not known here.
std::string better_core_type(const std::string& selected, const Processor& processor);

// If libblas.so.3 is OpenBLAS, loads it, and loads it again with OPENBLAS_CORETYPE set where there is a better core type. A core type that
// the user has set in OPENBLAS_CORETYPE is kept, and so is an OpenBLAS that the process has loaded before. Only the first call has an
// effect. Thread-safe.
void select_blas_kernels();
const pbs::Module& load_module_with_blas(const std::string& name);  // pbs::load_module after select_blas_kernels

// For the provenance of a record: `library` (OpenBLAS's own description), `core_type` that is in use, and `core_type_selected_by`:
// "pbskin", "OpenBLAS", or "user" where the environment held OPENBLAS_CORETYPE. Empty where this process has loaded no OpenBLAS.
std::map<std::string, std::string> blas_in_use();

// For a program that is linked with BLAS; call it first in main. Where there is a better core type and the user has not set one, the
// program starts again with OPENBLAS_CORETYPE set; otherwise the function returns.
void restart_with_better_blas_kernels(char** argv);

}  // namespace experiments
