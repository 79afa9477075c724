// Which sparse direct solver of SuiteSparse factors the stiffness matrix.
#pragma once

namespace reference_fem {

enum class DirectSolver { cholmod, umfpack };

}  // namespace reference_fem
