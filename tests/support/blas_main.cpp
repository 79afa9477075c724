// The main of programs that link BLAS. Like pbskin, they start again where OpenBLAS does not know the processor and
// selects kernels of 2004, which take twice the time.
#include "experiments/process/machine.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv)
{
    experiments::restart_with_better_blas_kernels(argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
