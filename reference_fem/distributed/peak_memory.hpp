// The most memory this process has had resident, as the kernel counts it (VmHWM).
#pragma once

namespace reference_fem {

// In units of 2^20 bytes, since the process began; it never decreases.
double peak_memory_mb();

}  // namespace reference_fem
