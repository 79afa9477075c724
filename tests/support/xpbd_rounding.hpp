// How far rounding may move the positions of a step of XPBD, for tolerances. The roundings of a projection are at most those of a PBS
// projection of stiffness 1 (projection_rounding.hpp), because a compliance makes the correction smaller, and as many again for the term of
// the multiplier, which balances C. Random disturbances of the blend measure by which factor the projections that follow multiply them, as
// in step_rounding.hpp.
#pragma once

#include "pbs/solver/xpbd_solver.hpp"
#include "tests/support/step_rounding.hpp"

namespace test_support {

inline pbs::Positions stepped_by_xpbd(const TwoBoneLimb& limb, const pbs::Positions& lbs, const pbs::XpbdOptions& options)
{
    pbs::XpbdSolver solver(limb.mesh, limb.binding.distance, {}, options);
    solver.advance(lbs, limb.bind_points, 0.01);
    return solver.positions();
}

// Between two evaluations in the precision of the options [m], for coordinates as large as those of the limb.
inline double xpbd_rounding_m(const TwoBoneLimb& limb, const pbs::XpbdOptions& options)
{
    pbs::PbsOptions rigid;
    rigid.k_stretch = rigid.k_volume = rigid.k_bind = 1.0;
    rigid.masses = pbs::Masses::lumped;
    rigid.iterations = options.iterations * options.substeps;
    rigid.precision = options.precision;
    return 2.0 * 2.0 * 6.0 * added_rounding_m(limb, rigid) * step_condition<pbs::XpbdSolver>(limb, options);
}

}  // namespace test_support
