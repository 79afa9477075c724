#include "pbs/solver/batched/pbs_kernels.hpp"

#include "pbs/solver/batched/pbs_kernels.cpp"

namespace pbs {
namespace {

// Part of a batch: as many groups as there are lanes.
template <typename Scalar, GroupKind kind>
struct Part {
    static constexpr int a_batch = batch_size / lanes<Scalar>;
    using Shape = GroupShape<kind>;
    const Batch<Scalar, kind>* batch;
    int first;  // lane of the batch

    [[gnu::always_inline]] void gather_from(const Scalar* vertices, Vertices<Scalar> (&p)[Shape::vertices]) const
    {
#pragma GCC unroll 8
        for (int v = 0; v < Shape::vertices; ++v) p[v] = gather(vertices, batch->offset[v] + first);
    }

    [[gnu::always_inline]] void scatter_to(Scalar* vertices, const Vertices<Scalar> (&p)[Shape::vertices]) const
    {
#pragma GCC unroll 8
        for (int v = 0; v < Shape::vertices; ++v) scatter(p[v], vertices, batch->offset[v] + first);
    }

    [[gnu::always_inline]] void project(Vertices<Scalar> (&p)[Shape::vertices]) const
    {
#pragma GCC unroll 8
        for (int c = 0; c < Shape::constraints; ++c) {
            const Lanes<Scalar> rest = load(batch->rest[c] + first), k = load(batch->stiffness[c] + first);
            const auto& join = Shape::joins[c];
            if constexpr (of_edges<kind>)
                project_stretch(rest, k, p[join[0]], p[join[1]]);
            else
                project_volume(rest, k, p[join[0]], p[join[1]], p[join[2]], p[join[3]]);
        }
    }
};

template <typename Scalar, GroupKind kind>
Part<Scalar, kind> part(const Batch<Scalar, kind>* batches, int i)
{
    constexpr int a_batch = Part<Scalar, kind>::a_batch;
    return {batches + i / a_batch, i % a_batch * lanes<Scalar>};
}

// C over its value at rest, of constraint c of every group; zero where there is none.
template <typename Scalar, GroupKind kind>
[[gnu::always_inline]] inline Lanes<Scalar> relative_error(const Part<Scalar, kind>& part, const Vertices<Scalar>* p, int c)
{
    const Lanes<Scalar> rest = load(part.batch->rest[c] + part.first);
    const auto& join = GroupShape<kind>::joins[c];
    if constexpr (of_edges<kind>)
        return quotient(length(p[join[0]] - p[join[1]]) - rest, rest);
    else
        return quotient(dot(cross(p[join[1]] - p[join[0]], p[join[2]] - p[join[0]]), p[join[3]] - p[join[0]]) - rest, rest);
}

// A part does not wait for the stores of the one before: they share no vertex (../../packed/groups.hpp).
template <typename Scalar, GroupKind kind>
[[gnu::noinline]] void project_all(const Batch<Scalar, kind>* batches, int count, Scalar* vertices)
{
    for (int i = 0; i < count * Part<Scalar, kind>::a_batch; ++i) {
        Vertices<Scalar> p[GroupShape<kind>::vertices];
        part(batches, i).gather_from(vertices, p);
        part(batches, i).project(p);
        part(batches, i).scatter_to(vertices, p);
    }
}

}  // namespace

template <typename Scalar>
void project_batches(GroupKind kind, const void* batches, int count, Scalar* vertices)
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
double sum_squared_errors(GroupKind kind, const void* batches, int count, const Scalar* vertices)
{
    return with_kind(kind, [&](auto of_kind) {
        using Shape = GroupShape<of_kind()>;
        constexpr int parts_in_scalar = 32;  // then on in double
        const int parts = count * Part<Scalar, of_kind()>::a_batch;
        Lanes<Scalar> sum = Scalar(0);
        double total = 0.0;
        for (int i = 0; i < parts; ++i) {
            const auto of = part(static_cast<const Batch<Scalar, of_kind()>*>(batches), i);
            Vertices<Scalar> p[Shape::vertices];
            of.gather_from(vertices, p);
            for (int c = 0; c < Shape::constraints; ++c) {
                const Lanes<Scalar> error = relative_error(of, p, c);
                sum += error * error;
            }
            if (i % parts_in_scalar != parts_in_scalar - 1 && i + 1 != parts) continue;
            for (int lane = 0; lane < lanes<Scalar>; ++lane) total += sum[lane];
            sum = Scalar(0);
        }
        return total;
    });
}

template <typename Scalar>
void largest_errors(GroupKind kind, const void* batches, int count, const Scalar* vertices, Scalar* errors)
{
    with_kind(kind, [&](auto of_kind) {
        using Shape = GroupShape<of_kind()>;
        for (int i = 0; i < count * Part<Scalar, of_kind()>::a_batch; ++i) {
            const auto of = part(static_cast<const Batch<Scalar, of_kind()>*>(batches), i);
            Vertices<Scalar> p[Shape::vertices];
            of.gather_from(vertices, p);
            Lanes<Scalar> largest = Scalar(0);
            for (int c = 0; c < Shape::constraints; ++c) {
                const Lanes<Scalar> error = abs(relative_error(of, p, c));
                where(largest == largest && !(error <= largest), largest) = error;  // not a number stays
            }
            largest.copy_to(errors + i * lanes<Scalar>, std::experimental::element_aligned);
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

template void project_batches(GroupKind, const void*, int, float*);
template void project_batches(GroupKind, const void*, int, double*);
template double sum_squared_errors(GroupKind, const void*, int, const float*);
template double sum_squared_errors(GroupKind, const void*, int, const double*);
template double sum_squared_bind_errors(const BindBatch<float>*, int, const float*);
template double sum_squared_bind_errors(const BindBatch<double>*, int, const double*);
template void largest_errors(GroupKind, const void*, int, const float*, float*);
template void largest_errors(GroupKind, const void*, int, const double*, double*);
template void project_bind_batches(const BindBatch<float>*, int, float*);
template void project_bind_batches(const BindBatch<double>*, int, double*);

}  // namespace pbs
