#include "pbs/solver/plain_projection.hpp"

namespace pbs {
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
