// Which sparse solver answers K u = f: two direct ones of SuiteSparse.
#pragma once

namespace reference_fem {

enum class LinearSolver { cholmod, umfpack };

}  // namespace reference_fem
