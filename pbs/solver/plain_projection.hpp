// Order `plain` as a Projection: file order, one constraint after the other, as the paper reads. Every other order is tested against it.
#pragma once

#include "pbs/solver/projection.hpp"

#include <vector>

namespace pbs {

// See Projection; no constraint sleeps.
template <typename Scalar>
class PlainProjection : public Projection<Scalar> {
public:
    // volume_form: derived, or Eq. 12-20 as printed, which take all masses for one.
    PlainProjection(ConstraintSet<Scalar> constraints, VolumeForm volume_form);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override;
    void project_bind_constraints() override;
    void project_stretch_constraints() override;
    void project_volume_constraints() override;
    void store(const Vec3& origin, Positions& p) const override;
    Residuals residuals() const override;

private:
    ConstraintSet<Scalar> constraints_;
    VolumeForm volume_form_;
    std::vector<Vector3<Scalar>> p_, q_;  // relative to the origin [m], #V
};

}  // namespace pbs
