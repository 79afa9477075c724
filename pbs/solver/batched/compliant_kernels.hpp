// The inner loops of XPBD in the orders `ordered` and `grouped`, compiled for the machine (PBS_NATIVE): raw pointers only. They are twins
// of project_batches (pbs_kernels.hpp): the same batches and vertices, with a compliance and a multiplier for each constraint. A batch's
// stiffness is 1 / alpha here: of an edge [N/m], and of six times the volume of a tet [N/m^5]; zero: there is no constraint. vertices: x,
// y, z [m] and w [1/kg] of each, 16 bytes aligned in float, 32 in double.
#pragma once

#include "pbs/packed/batch.hpp"

namespace pbs {

// Projects `count` batches, Batch<Scalar, kind>, one after the other. dt2: the square of the substep [s^2]. multipliers: lambda of each
// constraint of each batch in each lane, by batches, then constraints, 64 bytes aligned.
template <typename Scalar>
void project_compliant_batches(GroupKind kind, const void* batches, int count, Scalar dt2, Scalar* multipliers, Scalar* vertices);

}  // namespace pbs
