// Which BLAS the direct solvers really use: on Debian an alternative decides at run time, and the slow one costs a factor 3 to 7.
#pragma once

#include <string>

namespace reference_fem {

std::string resolved_blas();  // e.g. "OpenBLAS 0.3.21 ... (/usr/lib/x86_64-linux-gnu/openblas-pthread/libblas.so.3)"

// A sum's order depends on the number of threads; one thread makes every run the same to the bit. No effect on other BLAS than OpenBLAS.
void use_one_blas_thread();

}  // namespace reference_fem
