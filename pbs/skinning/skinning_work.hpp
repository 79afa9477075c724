// The work of skinning, counted by hand from blend_kernels.cpp and delta_mush_kernels.cpp by the rules of iteration_work.hpp.
#pragma once

#include "pbs/geometry/iteration_work.hpp"

namespace pbs {

// A frame of LBS or DQS. entries and rows of the weights that are blended for one vertex alone; matrices that several vertices share do not
// count. Rest positions come in, in the precision of the blend, and posed ones go out in double.
IterationWork work_of_linear_blend(const BodyCounts& body, double scalar_bytes);
IterationWork work_of_dual_quaternion_blend(const BodyCounts& body, double scalar_bytes);

// A frame of delta mush: LBS, `iterations` steps of Laplacian smoothing, and one rotation per vertex. entries and rows: those of LBS.
IterationWork work_of_delta_mush(const BodyCounts& body, double scalar_bytes, int iterations);

// A frame of direct delta mush: moments blended and one rotation per vertex. entries: pairs of a vertex and a bone.
IterationWork work_of_direct_mush(const BodyCounts& body, double scalar_bytes);

}  // namespace pbs
