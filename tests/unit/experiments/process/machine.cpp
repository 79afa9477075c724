// Reference: which instructions each processor has, by its data sheet, and which kernels OpenBLAS 0.3.21 selects for
// its family and model; the library's own report of the kernels it uses.

#include "experiments/process/machine.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#ifdef __x86_64__
#include <cpuid.h>
#include <sys/syscall.h>
#include <ucontext.h>

#include <csignal>
#endif

namespace {

using namespace experiments;

struct Case {
    const char* processor;
    const char* selected;  // by OpenBLAS 0.3.21 of Debian 12
    Processor has;
    const char* better;
};

constexpr Processor sse{}, intel_avx2{.has_avx2 = true}, intel_avx512{.has_avx2 = true, .has_avx512 = true},
    zen{.is_zen = true, .has_avx2 = true}, zen_4{.is_zen = true, .has_avx2 = true, .has_avx512 = true};

// None where all instructions are used, and those of the processor where OpenBLAS does not know the model.
TEST(BetterCoreType, IsThatOfTheInstructionsThatAreLeftUnused)
{
    for (const Case& c :
         {Case{"Emerald Rapids, family 6, model 207", "Prescott", intel_avx512, "SkylakeX"},
          Case{"the same without AVX-512", "Prescott", intel_avx2, "Haswell"},
          Case{"an AMD of a family of its own", "Barcelona", zen, "Zen"},
          Case{"an Intel whose AVX-512 the library does not expect", "Haswell", intel_avx512, "SkylakeX"},
          Case{"Sapphire Rapids, family 6, model 143", "Cooperlake", intel_avx512, ""},
          Case{"Skylake, family 6, model 85", "SkylakeX", intel_avx512, ""},
          Case{"Broadwell, family 6, model 79", "Haswell", intel_avx2, ""},
          Case{"Sandy Bridge, family 6, model 42", "Sandybridge", sse, ""},
          Case{"Nehalem, family 6, model 26", "Nehalem", sse, ""},
          Case{"Prescott, family 15, model 3", "Prescott", sse, ""}, Case{"Zen 2, family 17h", "Zen", zen, ""},
          Case{"Zen 4, family 19h: OpenBLAS 0.3.21 selects Zen", "Zen", zen_4, ""},
          Case{"a core type of a later OpenBLAS", "GraniteRapids", intel_avx512, ""}})
        EXPECT_EQ(better_core_type(c.selected, c.has), c.better) << c.processor;
}

// A process loads OpenBLAS once and selects its kernels once, so each test starts this program anew for itself alone:
// whatever ran before, BLAS is not loaded there yet.
class SelectBlasKernels : public testing::Test {
protected:
    // True in the process that runs the test's body; elsewhere false, after that process has run.
    static bool is_own_process()
    {
        if (std::getenv(mark)) {
            unsetenv("OPENBLAS_CORETYPE");
            EXPECT_TRUE(blas_in_use().empty()) << "this program must not be linked with BLAS";
            return true;
        }
        const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
        const std::string filter = std::string("--gtest_filter=") + test.test_suite_name() + "." + test.name();
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            setenv(mark, "1", 1);
            execl("/proc/self/exe", "/proc/self/exe", filter.c_str(), static_cast<char*>(nullptr));
            _exit(127);
        }
        int status = -1;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFEXITED(status)) << "status " << status;
        if (WEXITSTATUS(status) == skipped)
            report_skip();
        else
            EXPECT_EQ(WEXITSTATUS(status), 0) << "see the output of the test's own process above";
        return false;
    }

    void TearDown() override
    {
        if (!std::getenv(mark) || !IsSkipped()) return;
        std::fflush(nullptr);
        _exit(skipped);
    }

    static constexpr const char* mark = "PBS_TEST_OWN_PROCESS";
    static constexpr int skipped = 77;
    static void report_skip() { GTEST_SKIP() << "in the test's own process, see above"; }

    // Loads BLAS as a module that needs it does.
    static std::map<std::string, std::string> loaded_blas()
    {
        if (!dlopen("libblas.so.3", RTLD_NOW)) ADD_FAILURE() << dlerror();
        return blas_in_use();
    }
};

TEST_F(SelectBlasKernels, AUsersOwnChoiceStands)
{
    if (!is_own_process()) return;
    setenv("OPENBLAS_CORETYPE", "Nehalem", 1);
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(blas["core_type"], "Nehalem");
    EXPECT_EQ(blas["core_type_selected_by"], "user");
}

TEST_F(SelectBlasKernels, OnThisProcessorNoInstructionIsLeftUnused)
{
    if (!is_own_process()) return;
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(better_core_type(blas["core_type"], this_processor()), "");
    EXPECT_EQ(blas["core_type_selected_by"], std::getenv("OPENBLAS_CORETYPE") ? "pbskin" : "OpenBLAS");
}

#ifdef __x86_64__
// Simulates another processor model for this process. The instruction CPUID is made to fault (Linux, arch_prctl(2),
// ARCH_SET_CPUID), and a handler answers in its place with the family and model changed and everything else unchanged.
class OtherProcessor {
public:
    // family and model as in /proc/cpuinfo, both below 256. There may be one object at a time; it acts on the thread
    // that makes it and on threads which that thread starts.
    OtherProcessor(unsigned family, unsigned model)
    {
        const unsigned base_family = family < 15 ? family : 15;
        signature_ = (family - base_family) << 20 | base_family << 8 | (model >> 4) << 16 | (model & 15) << 4;
        struct sigaction action = {};
        action.sa_sigaction = answer;
        action.sa_flags = SA_SIGINFO | SA_NODEFER;
        sigaction(SIGSEGV, &action, &before_);
        works_ = fault(true);
    }
    ~OtherProcessor()
    {
        fault(false);
        sigaction(SIGSEGV, &before_, nullptr);
    }
    OtherProcessor(const OtherProcessor&) = delete;
    OtherProcessor& operator=(const OtherProcessor&) = delete;

    bool works() const { return works_; }  // false if this processor or kernel cannot make CPUID fault

private:
    static constexpr int set_cpuid = 0x1012;  // ARCH_SET_CPUID of <asm/prctl.h>

    static bool fault(bool wanted) { return syscall(SYS_arch_prctl, set_cpuid, wanted ? 0ul : 1ul) == 0; }

    static void answer(int, siginfo_t*, void* context)
    {
        greg_t* registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
        const auto* instruction = reinterpret_cast<const unsigned char*>(registers[REG_RIP]);
        // a fault of another kind, which occurs again without this handler
        if (instruction[0] != 0x0f || instruction[1] != 0xa2) {
            signal(SIGSEGV, SIG_DFL);
            return;
        }
        unsigned a = 0, b = 0, c = 0, d = 0;
        const unsigned leaf = static_cast<unsigned>(registers[REG_RAX]);
        fault(false);
        __cpuid_count(leaf, static_cast<unsigned>(registers[REG_RCX]), a, b, c, d);
        fault(true);
        if (leaf == 1) a = (a & ~0x0fff0ff0u) | signature_;
        registers[REG_RAX] = a;
        registers[REG_RBX] = b;
        registers[REG_RCX] = c;
        registers[REG_RDX] = d;
        registers[REG_RIP] += 2;
    }

    static inline unsigned signature_ = 0;
    struct sigaction before_ = {};
    bool works_ = false;
};

// Model 255 of Intel's family 6 does not exist. This processor pretends to be one, with its own instructions.
TEST_F(SelectBlasKernels, OnAModelThatOpenBlasDoesNotKnowTheInstructionsDecide)
{
    if (!is_own_process()) return;
    const std::string expected = better_core_type("Prescott", this_processor());
    if (expected.empty() || this_processor().is_zen) GTEST_SKIP() << "not an Intel processor with AVX2";
    const OtherProcessor unknown(6, 255);
    if (!unknown.works()) GTEST_SKIP() << "CPUID cannot be made to fault here";
    select_blas_kernels();
    auto blas = loaded_blas();
    if (blas.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    EXPECT_EQ(better_core_type(blas["core_type"], this_processor()), "");
    // which goes by the instructions itself since, for instance, 0.3.29
    if (blas["core_type_selected_by"] != "OpenBLAS") {
        EXPECT_EQ(blas["core_type"], expected);
        EXPECT_EQ(blas["core_type_selected_by"], "pbskin");
    }
}

TEST_F(SelectBlasKernels, AnOpenBlasThatIsLoadedAlreadyIsLeftAsItIs)
{
    if (!is_own_process()) return;
    const OtherProcessor unknown(6, 255);
    auto before = loaded_blas();
    if (before.empty()) GTEST_SKIP() << "libblas.so.3 is not OpenBLAS";
    select_blas_kernels();
    EXPECT_EQ(blas_in_use(), before);
    EXPECT_EQ(before["core_type_selected_by"], "OpenBLAS");
    EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
}
#endif

// Processors kept busy, from texts of /proc/stat. Reference: the columns of proc(5), added by hand.

// user nice system idle iowait irq softirq steal guest guest_nice
const std::string before_it =
    "cpu  100 10 20 1000 5 1 2 3 50 0\ncpu0 50 5 10 500 2 0 1 1 25 0\ncpu1 50 5 10 500 3 1 1 2 25 0\nctxt 7\n";
const std::string after_it =
    "cpu  130 15 25 1050 11 2 3 7 60 0\ncpu0 65 8 12 525 5 1 2 3 30 0\ncpu1 65 7 13 525 6 1 1 4 30 0\nctxt 9\n";

TEST(OtherWork, IsTheBusyShareOfAllProcessorsAndOldKernelsReportFourColumns)
{
    const auto before = processor_ticks(before_it), after = processor_ticks(after_it);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->busy, 136.0);
    EXPECT_EQ(before->idle, 1005.0);
    EXPECT_EQ(before->processors, 2);
    // 46 ticks busy and 56 idle on two processors.
    EXPECT_DOUBLE_EQ(*busy_processors(*before, *after), 2.0 * 46.0 / 102.0);
    const auto ticks = processor_ticks("cpu 10 20 30 40\ncpu0 10 20 30 40\n");
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->busy, 60.0);
    EXPECT_EQ(ticks->idle, 40.0);
}

TEST(OtherWork, IsUnknownWithoutProcessorsOrTicks)
{
    EXPECT_FALSE(processor_ticks(""));
    EXPECT_FALSE(processor_ticks("cpu 10 20 30\ncpu0 10 20 30\n"));
    EXPECT_FALSE(processor_ticks("cpu 10 20 30 40\ncpufreq 1\n"));
    EXPECT_FALSE(processor_ticks("intr 10 20 30 40\n"));
    const ProcessorTicks moment{1.0, 2.0, 4};
    EXPECT_FALSE(busy_processors(moment, moment));
}

}  // namespace
