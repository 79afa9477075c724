#include "experiments/studies/bench/projection_work.hpp"

namespace experiments {
namespace {

constexpr double difference = 3, dot = 5, cross = 9, scaled_and_added = 6;  // of vectors in space

constexpr ConstraintClass all_classes[] = {ConstraintClass::stretch, ConstraintClass::volume, ConstraintClass::bind};

double position_bytes(const Layout& layout)
{
    return (layout.poses == 1 ? 4.0 : 3.0) * layout.scalar_bytes;
}

}  // namespace

double flops_of(ConstraintClass of)
{
    switch (of) {
        case ConstraintClass::stretch:  // p12; its length; C; k_s; both corrections with their inverse mass
            return difference + (dot + 1) + 1 + 2 + 2 * (1 + scaled_and_added);
        case ConstraintClass::volume:  // three edges; 6 C; n2, n3, n4; n1; denominator; its rounding; k_s; four corrections
            return 3 * difference + (dot + 1) + 3 * cross + 2 * 3 + (4 * (dot + 1) + 3) + (3 * dot + 6) + 2 + 4 * (1 + scaled_and_added);
        case ConstraintClass::bind:  // p - q; its length; C; k_s; the correction
            break;
    }
    return difference + (dot + 1) + 1 + 2 + scaled_and_added;
}

double data_bytes_of(ConstraintClass of, const Layout& layout)
{
    constexpr double index = 4.0;
    const bool alone = layout.poses == 1;
    switch (of) {
        case ConstraintClass::stretch:
            return alone ? 2 * index + 2 * layout.scalar_bytes : 3 * index + 4 * layout.scalar_bytes;
        case ConstraintClass::volume:
            return alone ? 4 * index + 2 * layout.scalar_bytes : 5 * index + 5 * layout.scalar_bytes;
        case ConstraintClass::bind:
            break;
    }
    return 2 * layout.scalar_bytes;
}

double BodySize::constraints(ConstraintClass of) const
{
    return of == ConstraintClass::stretch ? edges : of == ConstraintClass::volume ? tets : vertices;
}

double bytes_of(ConstraintClass of, const Layout& layout, const BodySize& size)
{
    const double bind_point = of == ConstraintClass::bind ? 3.0 * layout.scalar_bytes : 0.0;
    return data_bytes_of(of, layout) / layout.poses + bind_point + 2.0 * position_bytes(layout) * size.vertices / size.constraints(of);
}

double bytes_an_iteration(const Layout& layout, const BodySize& size)
{
    double bytes = 0.0;
    for (const ConstraintClass of : all_classes) bytes += layout.poses * size.constraints(of) * bytes_of(of, layout, size);
    return bytes;
}

double working_set_bytes(const Layout& layout, const BodySize& size)
{
    double bytes = layout.poses * size.vertices * (position_bytes(layout) + 3.0 * layout.scalar_bytes);
    for (const ConstraintClass of : all_classes) bytes += size.constraints(of) * data_bytes_of(of, layout);
    return bytes;
}

}  // namespace experiments
