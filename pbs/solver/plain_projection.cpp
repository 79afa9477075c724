#include "pbs/solver/plain_projection.hpp"

#include "pbs/solver/project_plain.hpp"
#include "pbs/solver/step_summary.hpp"

namespace pbs {

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

}  // namespace pbs
