// theta of each deformer that has a stiffness, in one pose: with its default setting and the longest of its few rungs.
//   for (const ThetaRow& row : sought_thetas(of, mesh, poses, reference)) ...
#pragma once

#include "experiments/studies/work_precision/work_precision_case.hpp"
#include "experiments/studies/work_precision/posed_deformer.hpp"

namespace experiments {

// mesh: the case's own. The reference must be reached.
std::vector<ThetaRow> sought_thetas(const WorkPrecisionCase& of, const BodyMesh& mesh, const PosePair& poses,
                                    const PosedReference& reference);

}  // namespace experiments
