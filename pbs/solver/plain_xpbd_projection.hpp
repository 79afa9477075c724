// Order `plain` as an XpbdProjection: one constraint after the other in the order given. The packed orders are tested against it.
#pragma once

#include "pbs/solver/xpbd_solver.hpp"

#include <vector>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
class PlainXpbdProjection : public XpbdProjection {
public:
    explicit PlainXpbdProjection(const XpbdConstraints& constraints);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override;
    void begin_substep(double dt_s) override;
    void forget_multipliers() override;
    void project_bind_constraints() override;
    void project_stretch_constraints() override;
    void project_volume_constraints() override;
    void store(const Vec3& origin, Positions& p) const override;

private:
    using Point = Vector3<Scalar>;
    template <typename Constraint>
    struct Multiplied {
        Constraint constraint;
        Scalar compliance;  // alpha
        Scalar multiplier;  // lambda of this substep
    };

    Scalar dt2_ = Scalar(0);  // the square of the substep [s^2]
    std::vector<Scalar> w_;   // inverse masses [1/kg], #V
    std::vector<Multiplied<BindConstraint<Scalar>>> bind_;
    std::vector<Multiplied<StretchConstraint<Scalar>>> stretch_;
    std::vector<Multiplied<VolumeConstraint<Scalar>>> volume_;
    std::vector<Point> x_, q_;  // relative to the origin [m], #V
};

}  // namespace pbs
