#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/solver/batched/batched_xpbd_projection.hpp"

namespace pbs {
namespace {

template <typename Scalar>
std::unique_ptr<XpbdProjection> in_precision(const XpbdConstraints& constraints, const Tets& tets, const XpbdOptions& options)
{
    if (options.order == Order::plain) return std::make_unique<PlainXpbdProjection<Scalar>>(constraints);
    return std::make_unique<BatchedXpbdProjection<Scalar>>(constraints, tets, options.order, options.threads);
}

}  // namespace

std::unique_ptr<XpbdProjection> make_xpbd_projection(const XpbdConstraints& constraints, const Tets& tets, const XpbdOptions& options)
{
    return options.precision == Precision::f32 ? in_precision<float>(constraints, tets, options)
                                               : in_precision<double>(constraints, tets, options);
}

}  // namespace pbs
