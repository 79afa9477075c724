// The projections of pbs/constraints in every lane at once, line by line as in bind.hpp, stretch.hpp and volume.hpp,
// and the loops over batches and poses that call them. A lane whose constraint has no gradient stays, as there.
#include "pbs/solver/batched/pbs_kernels.hpp"

#include "pbs/packed/lanes.hpp"

#include <limits>

namespace pbs {
namespace {

// q: posed bind points; k: stiffness, zero where the vertex is pinned.
template <typename Scalar>
[[gnu::always_inline]] inline void project_bind(const Lanes<Scalar>& rest_distance, const Lanes<Scalar>& k,
                                                const Vertices<Scalar>& q, Vertices<Scalar>& p)
{
    const LaneVector<Scalar> from_q = p - q;
    const Lanes<Scalar> distance = length(from_q);
    const Lanes<Scalar> C = distance - rest_distance;
    add(-quotient(k * C, distance), from_q, p);
}

// k_w: stiffness over w1 + w2, zero where both are pinned.
template <typename Scalar>
[[gnu::always_inline]] inline void project_stretch(const Lanes<Scalar>& rest_length, const Lanes<Scalar>& k_w,
                                                   Vertices<Scalar>& p1, Vertices<Scalar>& p2)
{
    const LaneVector<Scalar> p12 = p1 - p2;
    const Lanes<Scalar> l = length(p12);
    const Lanes<Scalar> C = l - rest_length;         // Eq. 10
    const Lanes<Scalar> k_s = quotient(k_w * C, l);  // s of Eq. 9
    add(-p1.w * k_s, p12, p1);                       // Eq. 8
    add(p2.w * k_s, p12, p2);
}

// With n = 6 g and 6 C the sixths of Eq. 11-14 cancel. six_rest_volume: 6 V0 [m^3].
template <typename Scalar>
[[gnu::always_inline]] inline void project_volume(const Lanes<Scalar>& six_rest_volume, const Lanes<Scalar>& k,
                                                  Vertices<Scalar>& p1, Vertices<Scalar>& p2, Vertices<Scalar>& p3,
                                                  Vertices<Scalar>& p4)
{
    const LaneVector<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const LaneVector<Scalar> n4 = cross(p21, p31);
    const Lanes<Scalar> six_C = dot(n4, p41) - six_rest_volume;  // Eq. 11
    const LaneVector<Scalar> n2 = cross(p31, p41);
    const LaneVector<Scalar> n3 = cross(p41, p21);
    const LaneVector<Scalar> minus_n1 = n2 + n3 + n4;  // Eq. 15
    const Lanes<Scalar> denominator =
        p1.w * dot(minus_n1, minus_n1) + p2.w * dot(n2, n2) + p3.w * dot(n3, n3) + p4.w * dot(n4, n4);
    const Lanes<Scalar> longest2 = max(dot(p21, p21), max(dot(p31, p31), dot(p41, p41)));
    // of n; see volume.hpp
    const Lanes<Scalar> rounding = Scalar(4) * std::numeric_limits<Scalar>::epsilon() * longest2;
    const Lanes<Scalar> k_s =
        // s of Eq. 21
        quotient(k * six_C, denominator, Lanes<Scalar>(rounding * rounding * (p1.w + p2.w + p3.w + p4.w)));
    add(k_s * p1.w, minus_n1, p1);  // Eq. 8
    add(-k_s * p2.w, n2, p2);
    add(-k_s * p3.w, n3, p3);
    add(-k_s * p4.w, n4, p4);
}

// Eq. 18 of Macklin 2016 times k = dt^2 / alpha:  d lambda = (-k C - lambda) / (k sum w |g|^2 + 1).  k: zero where
// there is no constraint. An edge without length has no gradient and stays. With p12 = l g1, both are divided by l at
// once.
template <typename Scalar>
[[gnu::always_inline]] inline void project_compliant_stretch(const Lanes<Scalar>& rest_length, const Lanes<Scalar>& k,
                                                             Lanes<Scalar>& lambda, Vertices<Scalar>& p1,
                                                             Vertices<Scalar>& p2)
{
    const LaneVector<Scalar> p12 = p1 - p2;
    const Lanes<Scalar> l = length(p12);
    const Lanes<Scalar> C = l - rest_length;
    const Lanes<Scalar> step_l =
        quotient(Lanes<Scalar>(-k * C - lambda), Lanes<Scalar>((k * (p1.w + p2.w) + Scalar(1)) * l));
    lambda += step_l * l;
    add(Lanes<Scalar>(p1.w * step_l), p12, p1);
    add(Lanes<Scalar>(-p2.w * step_l), p12, p2);
}

// The same with n = 6 g and 6 C. A tet without a gradient stays, and its multiplier too.
template <typename Scalar>
[[gnu::always_inline]] inline void project_compliant_volume(const Lanes<Scalar>& six_rest_volume,
                                                            const Lanes<Scalar>& k, Lanes<Scalar>& lambda,
                                                            Vertices<Scalar>& p1, Vertices<Scalar>& p2,
                                                            Vertices<Scalar>& p3, Vertices<Scalar>& p4)
{
    const LaneVector<Scalar> p21 = p2 - p1, p31 = p3 - p1, p41 = p4 - p1;
    const LaneVector<Scalar> n4 = cross(p21, p31);
    const Lanes<Scalar> six_C = dot(n4, p41) - six_rest_volume;
    const LaneVector<Scalar> n2 = cross(p31, p41);
    const LaneVector<Scalar> n3 = cross(p41, p21);
    const LaneVector<Scalar> minus_n1 = n2 + n3 + n4;
    const Lanes<Scalar> w_n2 =
        p1.w * dot(minus_n1, minus_n1) + p2.w * dot(n2, n2) + p3.w * dot(n3, n3) + p4.w * dot(n4, n4);
    Lanes<Scalar> step = (-k * six_C - lambda) / (k * w_n2 + Scalar(1));
    where(!(w_n2 > Scalar(0)), step) = Scalar(0);
    lambda += step;
    add(Lanes<Scalar>(-step * p1.w), minus_n1, p1);
    add(Lanes<Scalar>(step * p2.w), n2, p2);
    add(Lanes<Scalar>(step * p3.w), n3, p3);
    add(Lanes<Scalar>(step * p4.w), n4, p4);
}

// Part of a batch: as many constraints as there are lanes.
template <typename Scalar, ConstraintKind kind>
struct Part {
    static constexpr int a_batch = batch_size / lanes<Scalar>;
    static constexpr int vertices = corners(kind);  // a constant, without which the loops below are not unrolled
    const Batch<Scalar, kind>* batch;
    int first;  // lane of the batch

    [[gnu::always_inline]] void gather_from(const Scalar* xyzw, Vertices<Scalar> (&p)[vertices]) const
    {
#pragma GCC unroll 8
        for (int v = 0; v < vertices; ++v) p[v] = gather(xyzw, batch->offset[v] + first);
    }

    [[gnu::always_inline]] void scatter_to(Scalar* xyzw, const Vertices<Scalar> (&p)[vertices]) const
    {
#pragma GCC unroll 8
        for (int v = 0; v < vertices; ++v) scatter(p[v], xyzw, batch->offset[v] + first);
    }

    [[gnu::always_inline]] void project(Vertices<Scalar> (&p)[vertices]) const
    {
        const Lanes<Scalar> rest = load(batch->rest + first), k = load(batch->stiffness + first);
        if constexpr (kind == ConstraintKind::edge)
            project_stretch(rest, k, p[0], p[1]);
        else
            project_volume(rest, k, p[0], p[1], p[2], p[3]);
    }

    // The same for XPBD. lambda: of the batch.
    [[gnu::always_inline]] void project_compliant(const Lanes<Scalar>& dt2, Scalar* lambda,
                                                  Vertices<Scalar> (&p)[vertices]) const
    {
        const Lanes<Scalar> rest = load(batch->rest + first), k = dt2 * load(batch->stiffness + first);
        Lanes<Scalar> multiplier = load(static_cast<const Scalar*>(lambda + first));
        if constexpr (kind == ConstraintKind::edge)
            project_compliant_stretch(rest, k, multiplier, p[0], p[1]);
        else
            project_compliant_volume(rest, k, multiplier, p[0], p[1], p[2], p[3]);
        store(multiplier, lambda + first);
    }
};

template <typename Scalar, ConstraintKind kind>
Part<Scalar, kind> part(const Batch<Scalar, kind>* batches, int i)
{
    constexpr int a_batch = Part<Scalar, kind>::a_batch;
    return {batches + i / a_batch, i % a_batch * lanes<Scalar>};
}

// C over its value at rest; zero where there is no constraint.
template <typename Scalar, ConstraintKind kind>
[[gnu::always_inline]] inline Lanes<Scalar> relative_error(const Part<Scalar, kind>& part, const Vertices<Scalar>* p)
{
    const Lanes<Scalar> rest = load(part.batch->rest + part.first);
    if constexpr (kind == ConstraintKind::edge)
        return quotient(length(p[0] - p[1]) - rest, rest);
    else
        return quotient(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) - rest, rest);
}

// A part does not wait for the stores of the one before: they share no vertex (../../packed/constraint_sequence.hpp).
template <typename Scalar, ConstraintKind kind>
[[gnu::noinline]] void project_all(const Batch<Scalar, kind>* batches, int count, Scalar* vertices)
{
    for (int i = 0; i < count * Part<Scalar, kind>::a_batch; ++i) {
        Vertices<Scalar> p[corners(kind)];
        part(batches, i).gather_from(vertices, p);
        part(batches, i).project(p);
        part(batches, i).scatter_to(vertices, p);
    }
}

template <typename Scalar, ConstraintKind kind>
[[gnu::noinline]] void project_all(const Batch<Scalar, kind>* batches, int count, Scalar dt2, Scalar* multipliers,
                                   Scalar* vertices)
{
    for (int i = 0; i < count * Part<Scalar, kind>::a_batch; ++i) {
        Vertices<Scalar> p[corners(kind)];
        const auto constraint = part(batches, i);
        constraint.gather_from(vertices, p);
        constraint.project_compliant(Lanes<Scalar>(dt2), multipliers + i / constraint.a_batch * batch_size, p);
        constraint.scatter_to(vertices, p);
    }
}

template <typename Scalar>
[[gnu::always_inline]] inline Vertices<Scalar> vertex(const Scalar* poses, std::size_t i, int first, Scalar w)
{
    const Scalar* xyz = poses + i * 3 * poses_a_block + first;
    return {load(xyz), load(xyz + poses_a_block), load(xyz + 2 * poses_a_block), w};
}

template <typename Scalar>
[[gnu::always_inline]] inline void store(const Vertices<Scalar>& p, Scalar* poses, std::size_t i, int first)
{
    Scalar* xyz = poses + i * 3 * poses_a_block + first;
    pbs::store(p.x, xyz);
    pbs::store(p.y, xyz + poses_a_block);
    pbs::store(p.z, xyz + 2 * poses_a_block);
}

// project(constraint, k, p) for each constraint in all poses; p: its vertices.
template <typename Scalar, typename Constraint, typename Project>
[[gnu::always_inline]] inline void project_in_poses(const Constraint* constraints, std::size_t count,
                                                    const Scalar* stiffness, Scalar* poses, const Project& project)
{
    constexpr int n = sizeof(Constraint::vertex) / sizeof(std::uint32_t);
    for (const Constraint* constraint = constraints; constraint < constraints + count; ++constraint)
        for (int first = 0; first < poses_a_block; first += lanes<Scalar>) {
            Vertices<Scalar> p[n];
            for (int i = 0; i < n; ++i)
                p[i] = vertex(static_cast<const Scalar*>(poses), constraint->vertex[i], first, constraint->w[i]);
            project(*constraint, load(stiffness + poses_a_block * static_cast<int>(constraint->stiffness) + first), p);
            for (int i = 0; i < n; ++i) store(p[i], poses, constraint->vertex[i], first);
        }
}

}  // namespace

template <typename Scalar>
void project_batches(ConstraintKind kind, const void* batches, int count, Scalar* vertices)
{
    with_kind(kind, [&](auto of_kind) {
        project_all<Scalar, of_kind()>(static_cast<const Batch<Scalar, of_kind()>*>(batches), count, vertices);
    });
}

template <typename Scalar>
void project_bind_batches(const BindBatch<Scalar>* batches, int count, Scalar* vertices)
{
    alignas(64) std::uint32_t offset[batch_size];
    for (int lane = 0; lane < batch_size; ++lane) offset[lane] = 4 * lane;
    for (int i = 0; i < count; ++i) {
        const BindBatch<Scalar>& batch = batches[i];
        Scalar* first_vertex = vertices + static_cast<std::size_t>(i) * 4 * batch_size;
        for (int first = 0; first < batch_size; first += lanes<Scalar>) {
            Vertices<Scalar> p = gather(first_vertex, offset + first);
            const Vertices<Scalar> q{load(batch.x + first), load(batch.y + first), load(batch.z + first), Scalar(0)};
            project_bind(load(batch.rest_distance + first), load(batch.stiffness + first), q, p);
            scatter(p, first_vertex, offset + first);
        }
    }
}

template <typename Scalar>
double sum_squared_errors(ConstraintKind kind, const void* batches, int count, const Scalar* vertices)
{
    return with_kind(kind, [&](auto of_kind) {
        constexpr int parts_in_scalar = 32;  // then on in double
        const int parts = count * Part<Scalar, of_kind()>::a_batch;
        Lanes<Scalar> sum = Scalar(0);
        double total = 0.0;
        for (int i = 0; i < parts; ++i) {
            const auto constraint = part(static_cast<const Batch<Scalar, of_kind()>*>(batches), i);
            Vertices<Scalar> p[corners(of_kind())];
            constraint.gather_from(vertices, p);
            const Lanes<Scalar> error = relative_error(constraint, p);
            sum += error * error;
            if (i % parts_in_scalar != parts_in_scalar - 1 && i + 1 != parts) continue;
            for (int lane = 0; lane < lanes<Scalar>; ++lane) total += sum[lane];
            sum = Scalar(0);
        }
        return total;
    });
}

template <typename Scalar>
void largest_errors(ConstraintKind kind, const void* batches, int count, const Scalar* vertices, Scalar* errors)
{
    with_kind(kind, [&](auto of_kind) {
        for (int i = 0; i < count * Part<Scalar, of_kind()>::a_batch; ++i) {
            const auto constraint = part(static_cast<const Batch<Scalar, of_kind()>*>(batches), i);
            Vertices<Scalar> p[corners(of_kind())];
            constraint.gather_from(vertices, p);
            const Lanes<Scalar> error = abs(relative_error(constraint, p));
            error.copy_to(errors + i * lanes<Scalar>, std::experimental::element_aligned);
        }
    });
}

template <typename Scalar>
double sum_squared_bind_errors(const BindBatch<Scalar>* batches, int count, const Scalar* vertices)
{
    double sum = 0.0;
    for (int i = 0; i < count * batch_size; ++i) {
        const BindBatch<Scalar>& batch = batches[i / batch_size];
        const int lane = i % batch_size;
        const Scalar* vertex = vertices + 4 * static_cast<std::size_t>(i);
        const Scalar x = vertex[0] - batch.x[lane], y = vertex[1] - batch.y[lane], z = vertex[2] - batch.z[lane];
        const double error = __builtin_sqrt(double(x * x + y * y + z * z)) - double(batch.rest_distance[lane]);
        sum += error * error;
    }
    return sum;
}

int kernel_lanes(int bytes_of_scalar)
{
    return bytes_of_scalar == sizeof(float) ? lanes<float> : lanes<double>;
}

const char* kernel_instructions()
{
#if defined(__AVX512DQ__)
    return "AVX-512";
#elif defined(__AVX2__)
    return "AVX2";
#elif defined(__AVX__)
    return "AVX";
#elif defined(__SSE2__)
    return "SSE2";
#else
    return "baseline";
#endif
}

template void project_batches(ConstraintKind, const void*, int, float*);
template void project_batches(ConstraintKind, const void*, int, double*);
template double sum_squared_errors(ConstraintKind, const void*, int, const float*);
template double sum_squared_errors(ConstraintKind, const void*, int, const double*);
template double sum_squared_bind_errors(const BindBatch<float>*, int, const float*);
template double sum_squared_bind_errors(const BindBatch<double>*, int, const double*);
template void largest_errors(ConstraintKind, const void*, int, const float*, float*);
template void largest_errors(ConstraintKind, const void*, int, const double*, double*);
template void project_bind_batches(const BindBatch<float>*, int, float*);
template void project_bind_batches(const BindBatch<double>*, int, double*);

template <typename Scalar>
void project_compliant_batches(ConstraintKind kind, const void* batches, int count, Scalar dt2, Scalar* multipliers,
                               Scalar* vertices)
{
    with_kind(kind, [&](auto of_kind) {
        project_all<Scalar, of_kind()>(static_cast<const Batch<Scalar, of_kind()>*>(batches), count, dt2, multipliers,
                                       vertices);
    });
}

template void project_compliant_batches(ConstraintKind, const void*, int, float, float*, float*);
template void project_compliant_batches(ConstraintKind, const void*, int, double, double*, double*);

template <typename Scalar>
void project_pose_edges(const PoseEdge<Scalar>* edges, std::size_t count, const Scalar* stiffness, Scalar* poses)
{
    project_in_poses(edges, count, stiffness, poses, [](const PoseEdge<Scalar>& edge, const Lanes<Scalar>& k, auto& p) {
        project_stretch<Scalar>(edge.rest, k * edge.one_over_w, p[0], p[1]);
    });
}

template <typename Scalar>
void project_pose_tets(const PoseTet<Scalar>* tets, std::size_t count, const Scalar* stiffness, Scalar* poses)
{
    project_in_poses(tets, count, stiffness, poses, [](const PoseTet<Scalar>& tet, const Lanes<Scalar>& k, auto& p) {
        project_volume<Scalar>(tet.rest, k, p[0], p[1], p[2], p[3]);
    });
}

template <typename Scalar>
void project_pose_binds(const PoseBind<Scalar>* binds, std::size_t count, const Scalar* k_bind,
                        const Scalar* bind_points, Scalar* poses)
{
    for (std::size_t i = 0; i < count; ++i)
        for (int first = 0; first < poses_a_block; first += lanes<Scalar>) {
            Vertices<Scalar> p = vertex(poses, i, first, binds[i].free);
            project_bind<Scalar>(binds[i].rest_distance, load(k_bind + first) * binds[i].free,
                                 vertex(bind_points, i, first, Scalar(0)), p);
            store(p, poses, i, first);
        }
}

template void project_pose_edges(const PoseEdge<float>*, std::size_t, const float*, float*);
template void project_pose_edges(const PoseEdge<double>*, std::size_t, const double*, double*);
template void project_pose_tets(const PoseTet<float>*, std::size_t, const float*, float*);
template void project_pose_tets(const PoseTet<double>*, std::size_t, const double*, double*);
template void project_pose_binds(const PoseBind<float>*, std::size_t, const float*, const float*, float*);
template void project_pose_binds(const PoseBind<double>*, std::size_t, const double*, const double*, double*);

}  // namespace pbs
