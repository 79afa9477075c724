// Reference: the actual files of the kernels and of CMake.
#include "tests/architecture/expect_lawful.hpp"
#include "tests/architecture/kernel_laws.hpp"

using namespace architecture;

TEST(KernelLaws, SeeRawPointersAlone)
{
    expect_lawful(kernel_includes);
}
TEST(KernelLaws, AloneAreBuiltForTheMachine)
{
    expect_lawful(machine_flags);
}
TEST(KernelLaws, AloneSeeRegisters)
{
    expect_lawful(registers_at_home);
}

namespace {

const std::string kernel_library = "add_library(pbs_kernels OBJECT solver/k.cpp)\n";

}  // namespace

TEST(KernelLawsBite, EigenThroughAHeader)
{
    const SourceTree planted = {{"pbs/CMakeLists.txt", kernel_library},
                                {"pbs/solver/k.cpp", "#include \"pbs/solver/k.hpp\"\n"},
                                {"pbs/solver/k.hpp", "#include <cstdint>\n#include <Eigen/Core>\n"}};
    expect_found(kernel_includes, planted, "pbs/solver/k.cpp:1: a kernel sees <Eigen/Core>");
}

TEST(KernelLawsBite, AContainer)
{
    const SourceTree planted = {{"pbs/CMakeLists.txt", kernel_library}, {"pbs/solver/k.cpp", "#include <array>\n#include <vector>\n"}};
    expect_found(kernel_includes, planted, "a kernel sees <vector>");
}

TEST(KernelLawsBite, NoKernelsFound)
{
    expect_found(kernel_includes, {{"pbs/CMakeLists.txt", "add_library(other k.cpp)\n"}}, "no sources");
}

TEST(KernelLawsBite, FlagsForEverybody)
{
    const std::string lawful = "target_compile_options(pbs_kernels PRIVATE -march=native)\n";
    expect_found(machine_flags, {{"pbs/CMakeLists.txt", lawful + "add_compile_options(-march=native)  # -march\n"}},
                 "pbs/CMakeLists.txt:2:");
}

TEST(KernelLawsBite, RegistersElsewhere)
{
    const SourceTree planted = {{"pbs/CMakeLists.txt", kernel_library},
                                {"pbs/solver/k.cpp", "#include \"pbs/solver/lanes.hpp\"\n"},
                                {"pbs/solver/x.cpp", "#include \"pbs/solver/lanes.hpp\"\n"},
                                {"pbs/solver/lanes.hpp", "#include <experimental/simd>\n"}};
    expect_found(registers_at_home, planted, "pbs/solver/x.cpp:1: no kernel, and sees <experimental/simd>");
}
