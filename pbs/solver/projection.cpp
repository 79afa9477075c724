#include "pbs/solver/projection.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/plain_projection.hpp"
#include "pbs/solver/project_plain.hpp"
#include "pbs/solver/step_summary.hpp"

namespace pbs {
namespace {

template <typename Scalar>
std::unique_ptr<Projection<Scalar>> in_own_class_order(ConstraintSet<Scalar> constraints, const Tets& tets, const PbsOptions& options)
{
    if (options.sleep && options.order == Order::plain)
        throw InputError("pbs", 0, "sleep", "true", "expected false with order plain, which projects all");
    if (options.order == Order::plain) return std::make_unique<PlainProjection<Scalar>>(std::move(constraints), options.volume_form);
    if (options.volume_form != VolumeForm::derived)
        throw InputError("pbs", 0, "order", "ordered or grouped", "expected plain with a printed volume_form");
    return std::make_unique<BatchedProjection<Scalar>>(constraints, tets, options);
}

}  // namespace

template <typename Scalar>
std::unique_ptr<Projection<Scalar>> make_projection(ConstraintSet<Scalar> constraints, const Tets& tets, const PbsOptions& options)
{
    auto projection = in_own_class_order(std::move(constraints), tets, options);
    if (options.class_order == ClassOrder::bind_stretch_volume) return projection;
    return std::make_unique<ReorderedProjection<Scalar>>(std::move(projection), options.class_order);
}

template std::unique_ptr<Projection<float>> make_projection(ConstraintSet<float>, const Tets&, const PbsOptions&);
template std::unique_ptr<Projection<double>> make_projection(ConstraintSet<double>, const Tets&, const PbsOptions&);

template <typename Scalar>
PlainProjection<Scalar>::PlainProjection(ConstraintSet<Scalar> constraints, VolumeForm volume_form)
    : constraints_(std::move(constraints)),
      volume_form_(volume_form),
      p_(constraints_.inverse_mass.size(), Vector3<Scalar>::Zero()),
      q_(constraints_.inverse_mass.size(), Vector3<Scalar>::Zero())
{
}

template <typename Scalar>
void PlainProjection<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    for (std::size_t i = 0; i < p_.size(); ++i) {
        p_[i] = (p.row(i).transpose() - origin).template cast<Scalar>();
        q_[i] = (q.row(i).transpose() - origin).template cast<Scalar>();
    }
}

template <typename Scalar>
void PlainProjection<Scalar>::project_bind_constraints()
{
    pbs::project_bind_constraints(constraints_, q_, p_);
}

template <typename Scalar>
void PlainProjection<Scalar>::project_stretch_constraints()
{
    pbs::project_stretch_constraints(constraints_, p_);
}

template <typename Scalar>
void PlainProjection<Scalar>::project_volume_constraints()
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

template <typename Scalar>
void PlainProjection<Scalar>::store(const Vec3& origin, Positions& p) const
{
    for (std::size_t i = 0; i < p_.size(); ++i) p.row(i) = p_[i].template cast<double>() + origin;
}

template <typename Scalar>
Residuals PlainProjection<Scalar>::residuals() const
{
    return residuals_of(constraints_, p_, q_);
}

template class PlainProjection<float>;
template class PlainProjection<double>;

namespace {

template <typename Scalar>
std::array<void (Projection<Scalar>::*)(), 3> classes_in(ClassOrder order)
{
    const auto bind = &Projection<Scalar>::project_bind_constraints;
    const auto stretch = &Projection<Scalar>::project_stretch_constraints;
    const auto volume = &Projection<Scalar>::project_volume_constraints;
    switch (order) {
        case ClassOrder::bind_volume_stretch:
            return {bind, volume, stretch};
        case ClassOrder::stretch_bind_volume:
            return {stretch, bind, volume};
        case ClassOrder::stretch_volume_bind:
            return {stretch, volume, bind};
        case ClassOrder::volume_bind_stretch:
            return {volume, bind, stretch};
        case ClassOrder::volume_stretch_bind:
            return {volume, stretch, bind};
        case ClassOrder::bind_stretch_volume:
            break;
    }
    return {bind, stretch, volume};
}

}  // namespace

template <typename Scalar>
ReorderedProjection<Scalar>::ReorderedProjection(std::unique_ptr<Projection<Scalar>> projection, ClassOrder class_order)
    : projection_(std::move(projection)), in_place_(classes_in<Scalar>(class_order))
{
}

template class ReorderedProjection<float>;
template class ReorderedProjection<double>;

}  // namespace pbs
