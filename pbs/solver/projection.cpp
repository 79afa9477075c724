#include "pbs/solver/projection.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/plain_projection.hpp"

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

}  // namespace pbs
