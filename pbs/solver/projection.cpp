#include "pbs/solver/projection.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/project_plain.hpp"

#include <array>
#include <numeric>

namespace pbs {
namespace {

// One constraint after the other in the order given: in order `plain` file order, as the paper reads, against which
// every other order is tested. No constraint sleeps. volume_form: derived, or Eq. 12-20 as printed, which take all
// masses for one.
template <typename Scalar>
class PlainProjection : public Projection<Scalar> {
public:
    PlainProjection(ConstraintSet<Scalar> constraints, VolumeForm volume_form)
        : constraints_(std::move(constraints)),
          volume_form_(volume_form),
          p_(constraints_.inverse_mass.size(), Vector3<Scalar>::Zero()),
          q_(constraints_.inverse_mass.size(), Vector3<Scalar>::Zero())
    {
    }

    void load(const Positions& p, const Positions& q, const Vec3& origin) override
    {
        for (std::size_t i = 0; i < p_.size(); ++i) {
            p_[i] = (p.row(i).transpose() - origin).template cast<Scalar>();
            q_[i] = (q.row(i).transpose() - origin).template cast<Scalar>();
        }
    }
    void project_bind_constraints() override { pbs::project_bind_constraints(constraints_, q_, p_); }
    void project_stretch_constraints() override { pbs::project_stretch_constraints(constraints_, p_); }
    void project_volume_constraints() override
    {
        switch (volume_form_) {
            case VolumeForm::derived:
                pbs::project_volume_constraints(constraints_, p_);
                return pbs::project_region_constraints(constraints_, p_);
            case VolumeForm::labels_relative:
                return project_volume_constraints_printed<Printed::labels_relative>(constraints_, p_);
            case VolumeForm::labels_absolute:
                return project_volume_constraints_printed<Printed::labels_absolute>(constraints_, p_);
            case VolumeForm::as_printed:
                return project_volume_constraints_printed<Printed::as_printed>(constraints_, p_);
            case VolumeForm::sign:
                return project_volume_constraints_printed<Printed::sign>(constraints_, p_);
        }
    }
    void store(const Vec3& origin, Positions& p) const override
    {
        for (std::size_t i = 0; i < p_.size(); ++i) p.row(i) = p_[i].template cast<double>() + origin;
    }
    PositionRows<Scalar> rows() override
    {
        std::vector<int> place(p_.size());
        std::iota(place.begin(), place.end(), 0);
        return {p_.empty() ? nullptr : p_.front().data(), 3, std::move(place)};
    }
    Residuals residuals() const override { return residuals_of(constraints_, p_, q_); }

private:
    ConstraintSet<Scalar> constraints_;
    VolumeForm volume_form_;
    std::vector<Vector3<Scalar>> p_, q_;  // relative to the origin [m], #V
};

template <typename Scalar>
std::array<void (Projection<Scalar>::*)(), 3> classes_in(ClassOrder order)
{
    const auto bind = &Projection<Scalar>::project_bind_constraints;
    const auto stretch = &Projection<Scalar>::project_stretch_constraints;
    const auto volume = &Projection<Scalar>::project_volume_constraints;
    // In the order of ClassOrder.
    const std::array<void (Projection<Scalar>::*)(), 3> in_order[] = {{bind, stretch, volume}, {bind, volume, stretch},
                                                                      {stretch, bind, volume}, {stretch, volume, bind},
                                                                      {volume, bind, stretch}, {volume, stretch, bind}};
    return in_order[static_cast<int>(order)];
}

// Any projection with its classes in another order: lines 11, 12 and 13 of Algorithm 1, whose names the three calls
// have, then project the first, second and third class of `class_order`. In Algorithm 1's own order there is no need of
// it.
template <typename Scalar>
class ReorderedProjection : public Projection<Scalar> {
public:
    // Takes the projection over; everything except the order of classes is its own.
    ReorderedProjection(std::unique_ptr<Projection<Scalar>> projection, ClassOrder class_order)
        : projection_(std::move(projection)), in_place_(classes_in<Scalar>(class_order))
    {
    }

    void load(const Positions& p, const Positions& q, const Vec3& origin) override { projection_->load(p, q, origin); }
    void project_bind_constraints() override { (projection_.get()->*in_place_[0])(); }
    void project_stretch_constraints() override { (projection_.get()->*in_place_[1])(); }
    void project_volume_constraints() override { (projection_.get()->*in_place_[2])(); }
    void store(const Vec3& origin, Positions& p) const override { projection_->store(origin, p); }
    PositionRows<Scalar> rows() override { return projection_->rows(); }
    Residuals residuals() const override { return projection_->residuals(); }
    void sleep(const SleepTolerance& tolerance) override { projection_->sleep(tolerance); }
    int wake(const SleepTolerance& tolerance) override { return projection_->wake(tolerance); }
    double sleeping_share() const override { return projection_->sleeping_share(); }

private:
    std::unique_ptr<Projection<Scalar>> projection_;
    std::array<void (Projection<Scalar>::*)(), 3> in_place_;
};

template <typename Scalar>
std::unique_ptr<Projection<Scalar>> in_own_class_order(ConstraintSet<Scalar> constraints, const Tets& tets,
                                                       const PbsOptions& options)
{
    if (options.sleep && options.order != Order::ordered)
        throw InputError("pbs", 0, "sleep", "true", "expected false with order plain or spread, which project all");
    if (options.order == Order::spread) constraints = in_spread_order(std::move(constraints));
    if (options.order != Order::ordered)
        return std::make_unique<PlainProjection<Scalar>>(std::move(constraints), options.volume_form);
    if (options.volume_form != VolumeForm::derived)
        throw InputError("pbs", 0, "order", "ordered", "expected plain or spread with a printed volume_form");
    return std::make_unique<BatchedProjection<Scalar>>(constraints, tets, options);
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Projection<Scalar>> make_projection(ConstraintSet<Scalar> constraints, const Tets& tets,
                                                    const PbsOptions& options)
{
    auto projection = in_own_class_order(std::move(constraints), tets, options);
    if (options.class_order == ClassOrder::bind_stretch_volume) return projection;
    return std::make_unique<ReorderedProjection<Scalar>>(std::move(projection), options.class_order);
}

template std::unique_ptr<Projection<float>> make_projection(ConstraintSet<float>, const Tets&, const PbsOptions&);
template std::unique_ptr<Projection<double>> make_projection(ConstraintSet<double>, const Tets&, const PbsOptions&);

}  // namespace pbs
