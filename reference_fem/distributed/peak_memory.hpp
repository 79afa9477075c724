// The most memory this process has had resident, as the kernel counts it (VmHWM).
#pragma once

namespace reference_fem {

double peak_memory_mb();

}  // namespace reference_fem
