// The registration of the finite element reference.
#pragma once

#include "experiments/deformers/registry.hpp"

namespace experiments {

DeformerKind fem_kind();

}  // namespace experiments
