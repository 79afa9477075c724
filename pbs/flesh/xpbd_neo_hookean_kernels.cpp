#include "pbs/flesh/flesh_kernels.hpp"

#include "pbs/packed/lanes.hpp"

namespace pbs {
namespace {

// As many tets as there are lanes: PlainXpbd::visit_tet, line by line.
template <typename Scalar, bool with_residual>
[[gnu::always_inline]] inline void visit_part(NeoHookeanBatch<Scalar>& batch, int first, const Lanes<Scalar>& alpha,
                                              Scalar* x)
{
    using L = Lanes<Scalar>;
    const L one = Scalar(1);
    Vertices<Scalar> p[4];
    for (int i = 0; i < 4; ++i) p[i] = gather(static_cast<const Scalar*>(x), batch.offset[i] + first);
    L g[9], S[6];
    for (int k = 0; k < 9; ++k) g[k] = load(batch.rest_inverse[k] + first);
    for (int k = 0; k < 6; ++k) S[k] = load(batch.weighted[k] + first);
    const LaneMatrix<Scalar> edges{{p[1] - p[0], p[2] - p[0], p[3] - p[0]}};
    LaneMatrix<Scalar> F;
    for (int j = 0; j < 3; ++j) F.column[j] = combined(edges, g[j], g[3 + j], g[6 + j]);
    const LaneMatrix<Scalar> H{
        {cross(F.column[1], F.column[2]), cross(F.column[2], F.column[0]), cross(F.column[0], F.column[1])}};
    const L size = sqrt(inner(F, F)), over_size = quotient(one, size);
    LaneMatrix<Scalar> D;
    for (int j = 0; j < 3; ++j) D.column[j] = times(over_size, F.column[j]);
    const LaneMatrix<Scalar> HS = times_symmetric(H, S), DS = times_symmetric(D, S);
    const L k_H = load(batch.hydrostatic + first), k_D = load(batch.deviatoric + first);

    L multiplier_H = load(batch.multiplier[0] + first), multiplier_D = load(batch.multiplier[1] + first);
    L right_H = -k_H * (dot(F.column[0], H.column[0]) - alpha) - multiplier_H, right_D = -k_D * size - multiplier_D;
    LaneMatrix<Scalar> applied, residual;
    if constexpr (with_residual) {
        applied = load_matrix(batch.applied, first);
        residual = sum(one, applied, L(-one), sum(multiplier_H, H, multiplier_D, D));
        right_H += k_H * inner(HS, residual);
        right_D += k_D * inner(DS, residual);
    }
    const L mixed = inner(HS, D);
    const L HH = k_H * inner(HS, H) + one, HD = k_H * mixed, DH = k_D * mixed, DD = k_D * inner(DS, D) + one;
    const L over_determinant = one / (HH * DD - HD * DH);
    const L change_H = (right_H * DD - HD * right_D) * over_determinant,
            change_D = (HH * right_D - DH * right_H) * over_determinant;
    multiplier_H += change_H;
    multiplier_D += change_D;
    store(multiplier_H, batch.multiplier[0] + first);
    store(multiplier_D, batch.multiplier[1] + first);

    LaneMatrix<Scalar> more = sum(change_H, H, change_D, D);
    if constexpr (with_residual) {
        more = sum(one, more, L(-one), residual);
        store_matrix(sum(one, applied, one, more), batch.applied, first);
    }
    LaneVector<Scalar> on_first{Scalar(0), Scalar(0), Scalar(0)};
    for (int i = 1; i < 4; ++i) {
        const LaneVector<Scalar> force = combined(more, g[3 * i - 3], g[3 * i - 2], g[3 * i - 1]);
        on_first = on_first + force;
        add(p[i].w, force, p[i]);
    }
    add(L(-p[0].w), on_first, p[0]);
    for (int i = 0; i < 4; ++i) scatter(p[i], x, batch.offset[i] + first);
}

// PlainXpbd::visit_hold, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline void visit_part(HoldBatch<Scalar>& batch, int first, Scalar* x)
{
    using L = Lanes<Scalar>;
    Vertices<Scalar> p[4];
    for (int i = 0; i < 4; ++i) p[i] = gather(static_cast<const Scalar*>(x), batch.offset[i] + first);
    for (int r = 0; r < 4; ++r) {
        L v[4];
        for (int i = 0; i < 4; ++i) v[i] = load(batch.v[r][i] + first);
        const L k = load(batch.stiffness[r] + first), share = load(batch.share[r] + first);
        L multiplier[3];
        for (int axis = 0; axis < 3; ++axis) multiplier[axis] = load(batch.multiplier[r][axis] + first);
        const L C_x = v[0] * p[0].x + v[1] * p[1].x + v[2] * p[2].x + v[3] * p[3].x - load(batch.target[r][0] + first);
        const L C_y = v[0] * p[0].y + v[1] * p[1].y + v[2] * p[2].y + v[3] * p[3].y - load(batch.target[r][1] + first);
        const L C_z = v[0] * p[0].z + v[1] * p[1].z + v[2] * p[2].z + v[3] * p[3].z - load(batch.target[r][2] + first);
        const LaneVector<Scalar> change{(-k * C_x - multiplier[0]) * share, (-k * C_y - multiplier[1]) * share,
                                        (-k * C_z - multiplier[2]) * share};
        store(L(multiplier[0] + change.x), batch.multiplier[r][0] + first);
        store(L(multiplier[1] + change.y), batch.multiplier[r][1] + first);
        store(L(multiplier[2] + change.z), batch.multiplier[r][2] + first);
        for (int i = 0; i < 4; ++i) add(L(p[i].w * v[i]), change, p[i]);
    }
    for (int i = 0; i < 4; ++i) scatter(p[i], x, batch.offset[i] + first);
}

}  // namespace

template <typename Scalar>
void visit_holds(HoldBatch<Scalar>* batches, int count, Scalar* x)
{
    for (int b = 0; b < count; ++b)
        for (int first = 0; first < batch_size; first += lanes<Scalar>) visit_part(batches[b], first, x);
}

template <typename Scalar>
void visit_tets(NeoHookeanBatch<Scalar>* batches, int count, Scalar alpha, bool with_residual, Scalar* x)
{
    for (int b = 0; b < count; ++b)
        for (int first = 0; first < batch_size; first += lanes<Scalar>) {
            if (with_residual)
                visit_part<Scalar, true>(batches[b], first, alpha, x);
            else
                visit_part<Scalar, false>(batches[b], first, alpha, x);
        }
}

template <typename Scalar>
void begin_step(Scalar momentum, int rows, Scalar* x, Scalar* before, Scalar* predicted, const Scalar* applied)
{
    for (int i = 0; i < 4 * rows; ++i) {
        predicted[i] = x[i] + momentum * (x[i] - before[i]);
        before[i] = x[i];
        x[i] = predicted[i] + applied[i];
    }
}

template <typename Scalar>
double end_step(int rows, const Scalar* x, const Scalar* before, const Scalar* predicted, Scalar* applied)
{
    double work = 0.0;
    for (int i = 0; i < rows; ++i, x += 4, before += 4, predicted += 4, applied += 4) {
        Scalar of_row = Scalar(0);
        for (int axis = 0; axis < 3; ++axis) {
            applied[axis] = x[axis] - predicted[axis];
            of_row += applied[axis] * (x[axis] - before[axis]);
        }
        work += double(of_row / x[3]);
    }
    return work;
}

template void visit_holds(HoldBatch<float>*, int, float*);
template void visit_holds(HoldBatch<double>*, int, double*);
template void visit_tets(NeoHookeanBatch<float>*, int, float, bool, float*);
template void visit_tets(NeoHookeanBatch<double>*, int, double, bool, double*);
template void begin_step(float, int, float*, float*, float*, const float*);
template void begin_step(double, int, double*, double*, double*, const double*);
template double end_step(int, const float*, const float*, const float*, float*);
template double end_step(int, const double*, const double*, const double*, double*);

}  // namespace pbs
