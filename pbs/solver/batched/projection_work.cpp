#include "pbs/solver/batched/projection_work.hpp"

namespace pbs {
namespace {

constexpr double difference = 3, dot = 5, cross = 9, scaled_and_added = 6;  // operations on vectors in space

// Operations of one projection, and how many indices and scalars a constraint has for one pose and when many poses share it.
struct Work {
    double operations;
    double indices, scalars, shared_indices, shared_scalars;
};
// p12; its length; C; k_s; both corrections with their inverse mass
constexpr Work stretch_work = {difference + (dot + 1) + 1 + 2 + 2 * (1 + scaled_and_added), 2, 2, 3, 4};
// three edges; 6 C; n2, n3, n4; n1; denominator; its rounding; k_s; four corrections
constexpr Work volume_work = {
    3 * difference + (dot + 1) + 3 * cross + 2 * 3 + (4 * (dot + 1) + 3) + (3 * dot + 6) + 2 + 4 * (1 + scaled_and_added), 4, 2, 5, 5};
// p - q; its length; C; k_s; the correction
constexpr Work bind_work = {difference + (dot + 1) + 1 + 2 + scaled_and_added, 0, 2, 0, 2};

constexpr ConstraintClass all_classes[] = {ConstraintClass::stretch, ConstraintClass::volume, ConstraintClass::bind};

const Work& work_of(ConstraintClass of)
{
    return of == ConstraintClass::stretch ? stretch_work : of == ConstraintClass::volume ? volume_work : bind_work;
}

double position_bytes(const ProjectionLayout& layout)
{
    return (layout.poses == 1 ? 4.0 : 3.0) * layout.scalar_bytes;
}

// A constraint's own data, shared by all poses.
double data_bytes_of(ConstraintClass of, const ProjectionLayout& layout)
{
    constexpr double index_bytes = 4.0;
    const Work& work = work_of(of);
    if (layout.poses == 1) return work.indices * index_bytes + work.scalars * layout.scalar_bytes;
    return work.shared_indices * index_bytes + work.shared_scalars * layout.scalar_bytes;
}

}  // namespace

double flops_of(ConstraintClass of)
{
    return work_of(of).operations;
}

double BodySize::constraints(ConstraintClass of) const
{
    return of == ConstraintClass::stretch ? edges : of == ConstraintClass::volume ? tets : vertices;
}

double bytes_of(ConstraintClass of, const ProjectionLayout& layout, const BodySize& size)
{
    const double bind_point = of == ConstraintClass::bind ? 3.0 * layout.scalar_bytes : 0.0;
    return data_bytes_of(of, layout) / layout.poses + bind_point + 2.0 * position_bytes(layout) * size.vertices / size.constraints(of);
}

double bytes_per_iteration(const ProjectionLayout& layout, const BodySize& size)
{
    double bytes = 0.0;
    for (const ConstraintClass of : all_classes) bytes += layout.poses * size.constraints(of) * bytes_of(of, layout, size);
    return bytes;
}

double working_set_bytes(const ProjectionLayout& layout, const BodySize& size)
{
    double bytes = layout.poses * size.vertices * (position_bytes(layout) + 3.0 * layout.scalar_bytes);
    for (const ConstraintClass of : all_classes) bytes += size.constraints(of) * data_bytes_of(of, layout);
    return bytes;
}

}  // namespace pbs
