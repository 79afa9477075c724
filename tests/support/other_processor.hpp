// Simulates another processor model for this process. The instruction CPUID is made to fault (Linux, arch_prctl(2), ARCH_SET_CPUID), and a
// handler answers in its place with the family and model changed and everything else unchanged.
#pragma once

#include <cpuid.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <csignal>

namespace test_support {

class OtherProcessor {
public:
    // family and model as in /proc/cpuinfo, both below 256. There may be one object at a time; it acts on the thread that makes it and on
    // threads which that thread starts.
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
        if (instruction[0] != 0x0f || instruction[1] != 0xa2) {  // a fault of another kind, which occurs again without this handler
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

}  // namespace test_support
