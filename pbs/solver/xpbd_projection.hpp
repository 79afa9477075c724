// The projections of extended position based dynamics in a chosen order, as projection.hpp has those of Algorithm 1: each class once, on
// positions in a layout of its own, with the multiplier of each constraint.
//   const auto projection = make_xpbd_projection(constraints, mesh.tets, options);
//   projection->load(p, q, origin);
//   projection->begin_substep(dt_s);
//   projection->project_bind_constraints(); ..stretch.. ..volume..
//   projection->store(origin, p);
#pragma once

#include "pbs/solver/xpbd_solver.hpp"

#include <memory>

namespace pbs {

class XpbdProjection {
public:
    virtual ~XpbdProjection() = default;

    // p: positions, q: posed bind points [m], #V x 3; inside, positions are relative to origin [m].
    virtual void load(const Positions& p, const Positions& q, const Vec3& origin) = 0;
    virtual void begin_substep(double dt_s) = 0;  // of this length; all multipliers become zero
    virtual void forget_multipliers() = 0;        // they become zero
    virtual void project_bind_constraints() = 0;  // all of the class once
    virtual void project_stretch_constraints() = 0;
    virtual void project_volume_constraints() = 0;
    // Positions back in p [m], #V x 3; origin as it was given to load.
    virtual void store(const Vec3& origin, Positions& p) const = 0;
};

// The order and the precision that the options name. tets: those whose edges the order `grouped` may group.
std::unique_ptr<XpbdProjection> make_xpbd_projection(const XpbdConstraints& constraints, const Tets& tets, const XpbdOptions& options);

}  // namespace pbs
