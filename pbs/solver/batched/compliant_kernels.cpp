#include "pbs/solver/batched/pbs_kernels.hpp"

#include "pbs/solver/batched/pbs_kernels.cpp"

namespace pbs {
namespace {

// Eq. 18 of Macklin 2016 times k = dt^2 / alpha:  d lambda = (-k C - lambda) / (k sum w |g|^2 + 1).  k: zero where there is no constraint.
// An edge without length has no gradient and stays. With p12 = l g1, both are divided by l at once.
template <typename Scalar>
[[gnu::always_inline]] inline void project_compliant_stretch(const Lanes<Scalar>& rest_length, const Lanes<Scalar>& k,
                                                             Lanes<Scalar>& lambda, Vertices<Scalar>& p1, Vertices<Scalar>& p2)
{
    const LaneVector<Scalar> p12 = p1 - p2;
    const Lanes<Scalar> l = length(p12);
    const Lanes<Scalar> C = l - rest_length;
    const Lanes<Scalar> step_l = quotient(Lanes<Scalar>(-k * C - lambda), Lanes<Scalar>((k * (p1.w + p2.w) + Scalar(1)) * l));
    lambda += step_l * l;
    add(Lanes<Scalar>(p1.w * step_l), p12, p1);
    add(Lanes<Scalar>(-p2.w * step_l), p12, p2);
}

// The same with n = 6 g and 6 C. A tet without a gradient stays, and its multiplier too.
template <typename Scalar>
[[gnu::always_inline]] inline void project_compliant_volume(const Lanes<Scalar>& six_rest_volume, const Lanes<Scalar>& k,
                                                            Lanes<Scalar>& lambda, Vertices<Scalar>& p1, Vertices<Scalar>& p2,
                                                            Vertices<Scalar>& p3, Vertices<Scalar>& p4)
{
    const LaneVector<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const LaneVector<Scalar> n4 = cross(p21, p31);
    const Lanes<Scalar> six_C = dot(n4, p41) - six_rest_volume;
    const LaneVector<Scalar> n2 = cross(p31, p41);
    const LaneVector<Scalar> n3 = cross(p41, p21);
    const LaneVector<Scalar> minus_n1 = n2 + n3 + n4;
    const Lanes<Scalar> w_n2 = p1.w * dot(minus_n1, minus_n1) + p2.w * dot(n2, n2) + p3.w * dot(n3, n3) + p4.w * dot(n4, n4);
    Lanes<Scalar> step = (-k * six_C - lambda) / (k * w_n2 + Scalar(1));
    where(!(w_n2 > Scalar(0)), step) = Scalar(0);
    lambda += step;
    add(Lanes<Scalar>(-step * p1.w), minus_n1, p1);
    add(Lanes<Scalar>(step * p2.w), n2, p2);
    add(Lanes<Scalar>(step * p3.w), n3, p3);
    add(Lanes<Scalar>(step * p4.w), n4, p4);
}

// As many groups of a batch as there are lanes, from lane `first` on. lambda: of the batch.
template <typename Scalar, GroupKind kind>
[[gnu::always_inline]] inline void project_part(const Batch<Scalar, kind>& batch, int first, const Lanes<Scalar>& dt2, Scalar* lambda,
                                                Scalar* vertices)
{
    using Shape = GroupShape<kind>;
    Vertices<Scalar> p[Shape::vertices];
#pragma GCC unroll 8
    for (int v = 0; v < Shape::vertices; ++v) p[v] = gather(static_cast<const Scalar*>(vertices), batch.offset[v] + first);
#pragma GCC unroll 8
    for (int c = 0; c < Shape::constraints; ++c) {
        const Lanes<Scalar> rest = load(batch.rest[c] + first), k = dt2 * load(batch.stiffness[c] + first);
        Scalar* of_lanes = lambda + c * batch_size + first;
        Lanes<Scalar> multiplier = load(static_cast<const Scalar*>(of_lanes));
        const auto& join = Shape::joins[c];
        if constexpr (of_edges<kind>)
            project_compliant_stretch(rest, k, multiplier, p[join[0]], p[join[1]]);
        else
            project_compliant_volume(rest, k, multiplier, p[join[0]], p[join[1]], p[join[2]], p[join[3]]);
        multiplier.copy_to(of_lanes, std::experimental::vector_aligned);
    }
#pragma GCC unroll 8
    for (int v = 0; v < Shape::vertices; ++v) scatter(p[v], vertices, batch.offset[v] + first);
}

template <typename Scalar, GroupKind kind>
[[gnu::noinline]] void project_all(const Batch<Scalar, kind>* batches, int count, Scalar dt2, Scalar* multipliers, Scalar* vertices)
{
    constexpr int multipliers_of_batch = GroupShape<kind>::constraints * batch_size;
    for (int b = 0; b < count; ++b)
        for (int first = 0; first < batch_size; first += lanes<Scalar>)
            project_part(batches[b], first, Lanes<Scalar>(dt2), multipliers + b * multipliers_of_batch, vertices);
}

}  // namespace

template <typename Scalar>
void project_compliant_batches(GroupKind kind, const void* batches, int count, Scalar dt2, Scalar* multipliers, Scalar* vertices)
{
    with_kind(kind, [&](auto of_kind) {
        project_all<Scalar, of_kind()>(static_cast<const Batch<Scalar, of_kind()>*>(batches), count, dt2, multipliers, vertices);
    });
}

template void project_compliant_batches(GroupKind, const void*, int, float, float*, float*);
template void project_compliant_batches(GroupKind, const void*, int, double, double*, double*);

}  // namespace pbs
