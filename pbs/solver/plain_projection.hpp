// Order `plain` as a Projection: file order, one constraint after the other, as the paper reads. Every other order is tested against it.
#pragma once

#include "pbs/solver/projection.hpp"

#include <array>
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

// Any projection with its classes in another order: lines 11, 12 and 13 of Algorithm 1 then project the first, second and third class of
// `class_order`. In Algorithm 1's own order there is no need of it.

// The names of the three calls are those of the lines, not of the classes that they then project.
template <typename Scalar>
class ReorderedProjection : public Projection<Scalar> {
public:
    // Takes the projection over; all but the order of classes is its own.
    ReorderedProjection(std::unique_ptr<Projection<Scalar>> projection, ClassOrder class_order);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override { projection_->load(p, q, origin); }
    void project_bind_constraints() override { project(0); }
    void project_stretch_constraints() override { project(1); }
    void project_volume_constraints() override { project(2); }
    void store(const Vec3& origin, Positions& p) const override { projection_->store(origin, p); }
    Residuals residuals() const override { return projection_->residuals(); }
    void sleep(const SleepTolerance& tolerance) override { projection_->sleep(tolerance); }
    int wake(const SleepTolerance& tolerance) override { return projection_->wake(tolerance); }
    double sleeping_share() const override { return projection_->sleeping_share(); }

private:
    using Project = void (Projection<Scalar>::*)();

    void project(int place) { (projection_.get()->*in_place_[place])(); }

    std::unique_ptr<Projection<Scalar>> projection_;
    std::array<Project, 3> in_place_;
};

}  // namespace pbs
