// Truth: which instructions each processor has, by its data sheet, and which kernels OpenBLAS 0.3.21 selects for its family and model; the
// library's own word on what it uses.
#include "experiments/process/blas_kernels.hpp"

#ifdef __x86_64__
#include "tests/support/other_processor.hpp"
#endif

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using namespace experiments;

struct Case {
    const char* processor;
    const char* selected;  // by OpenBLAS 0.3.21 as Debian 12 has it
    Processor has;
    const char* better;
};

constexpr Processor sse{}, intel_avx2{.has_avx2 = true}, intel_avx512{.has_avx2 = true, .has_avx512 = true},
    zen{.is_zen = true, .has_avx2 = true}, zen_4{.is_zen = true, .has_avx2 = true, .has_avx512 = true};

TEST(BetterCoreType, IsThatOfTheInstructionsWhereOpenBlasDoesNotKnowTheModel)
{
    for (const Case& c : {Case{"Emerald Rapids, family 6, model 207", "Prescott", intel_avx512, "SkylakeX"},
                          Case{"the same without AVX-512", "Prescott", intel_avx2, "Haswell"},
                          Case{"an AMD of a family of its own", "Barcelona", zen, "Zen"},
                          Case{"an Intel whose AVX-512 the library does not expect", "Haswell", intel_avx512, "SkylakeX"}})
        EXPECT_EQ(better_core_type(c.selected, c.has), c.better) << c.processor;
}

TEST(BetterCoreType, IsNoneWhereAllInstructionsAreUsed)
{
    for (const Case& c :
         {Case{"Sapphire Rapids, family 6, model 143", "Cooperlake", intel_avx512, ""},
          Case{"Skylake, family 6, model 85", "SkylakeX", intel_avx512, ""},
          Case{"Broadwell, family 6, model 79", "Haswell", intel_avx2, ""},
          Case{"Sandy Bridge, family 6, model 42", "Sandybridge", sse, ""}, Case{"Nehalem, family 6, model 26", "Nehalem", sse, ""},
          Case{"Prescott, family 15, model 3", "Prescott", sse, ""}, Case{"Zen 2, family 17h", "Zen", zen, ""},
          Case{"Zen 4, family 19h: OpenBLAS 0.3.21 means Zen", "Zen", zen_4, ""},
          Case{"a core type of a later OpenBLAS", "GraniteRapids", intel_avx512, ""}})
        EXPECT_EQ(better_core_type(c.selected, c.has), c.better) << c.processor;
}

// A process of its own for each, as under ctest: OpenBLAS is loaded once and the selection happens once.
class SelectBlasKernels : public testing::Test {
protected:
    void SetUp() override
    {
        unsetenv("OPENBLAS_CORETYPE");
        ASSERT_TRUE(blas_in_use().empty()) << "this program must not be linked with BLAS";
    }

    // As the module that needs BLAS does.
    static std::map<std::string, std::string> loaded_blas()
    {
        if (!dlopen("libblas.so.3", RTLD_NOW)) ADD_FAILURE() << dlerror();
        return blas_in_use();
    }
};

TEST_F(SelectBlasKernels, AUsersOwnChoiceStands)
{
    setenv("OPENBLAS_CORETYPE", "Nehalem", 1);
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(blas["core_type"], "Nehalem");
    EXPECT_EQ(blas["core_type_selected_by"], "user");
}

TEST_F(SelectBlasKernels, OnThisProcessorNoInstructionIsLeftUnused)
{
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(better_core_type(blas["core_type"], this_processor()), "");
    EXPECT_EQ(blas["core_type_selected_by"], std::getenv("OPENBLAS_CORETYPE") ? "pbskin" : "OpenBLAS");
}

#ifdef __x86_64__
// Model 255 of Intel's family 6 does not exist. This processor answers as if it were one, with its own instructions.
TEST_F(SelectBlasKernels, OnAModelThatOpenBlasDoesNotKnowTheInstructionsDecide)
{
    const std::string expected = better_core_type("Prescott", this_processor());
    if (expected.empty() || this_processor().is_zen) GTEST_SKIP() << "not an Intel processor with AVX2";
    const test_support::OtherProcessor unknown(6, 255);
    if (!unknown.works()) GTEST_SKIP() << "CPUID cannot be made to fault here";
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(blas["core_type"], expected);
    EXPECT_EQ(blas["core_type_selected_by"], "pbskin");
}

TEST_F(SelectBlasKernels, AnOpenBlasThatIsLoadedAlreadyIsLeftAsItIs)
{
    const test_support::OtherProcessor unknown(6, 255);
    auto before = loaded_blas();
    if (before.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    select_blas_kernels();
    EXPECT_EQ(blas_in_use(), before);
    EXPECT_EQ(before["core_type_selected_by"], "OpenBLAS");
    EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
}
#endif

}  // namespace
