#include "pbs/solver/batched/pbs_kernels.hpp"

#include "pbs/solver/batched/pbs_kernels.cpp"

namespace pbs {
namespace {

template <typename Scalar>
[[gnu::always_inline]] inline Vertices<Scalar> vertex(const Scalar* poses, std::size_t i, int first, Scalar w)
{
    const Scalar* xyz = poses + i * 3 * poses_a_block + first;
    return {load(xyz), load(xyz + poses_a_block), load(xyz + 2 * poses_a_block), w};
}

template <typename Scalar>
[[gnu::always_inline]] inline void store(const Vertices<Scalar>& p, Scalar* poses, std::size_t i, int first)
{
    using std::experimental::vector_aligned;
    Scalar* xyz = poses + i * 3 * poses_a_block + first;
    p.x.copy_to(xyz, vector_aligned);
    p.y.copy_to(xyz + poses_a_block, vector_aligned);
    p.z.copy_to(xyz + 2 * poses_a_block, vector_aligned);
}

}  // namespace

template <typename Scalar>
void project_pose_edges(const PoseEdge<Scalar>* edges, std::size_t count, const Scalar* stiffness, Scalar* poses)
{
    for (const PoseEdge<Scalar>* edge = edges; edge < edges + count; ++edge)
        for (int first = 0; first < poses_a_block; first += lanes<Scalar>) {
            const Lanes<Scalar> k = load(stiffness + poses_a_block * static_cast<int>(edge->stiffness) + first);
            const auto [i, j] = edge->vertex;
            Vertices<Scalar> p1 = vertex(poses, i, first, edge->w[0]), p2 = vertex(poses, j, first, edge->w[1]);
            project_stretch<Scalar>(edge->rest_length, k * edge->one_over_w, p1, p2);
            store(p1, poses, i, first);
            store(p2, poses, j, first);
        }
}

template <typename Scalar>
void project_pose_tets(const PoseTet<Scalar>* tets, std::size_t count, const Scalar* stiffness, Scalar* poses)
{
    for (const PoseTet<Scalar>* tet = tets; tet < tets + count; ++tet)
        for (int first = 0; first < poses_a_block; first += lanes<Scalar>) {
            const Lanes<Scalar> k = load(stiffness + poses_a_block * static_cast<int>(tet->stiffness) + first);
            const auto [i, j, l, m] = tet->vertex;
            Vertices<Scalar> p1 = vertex(poses, i, first, tet->w[0]), p2 = vertex(poses, j, first, tet->w[1]),
                             p3 = vertex(poses, l, first, tet->w[2]), p4 = vertex(poses, m, first, tet->w[3]);
            project_volume<Scalar>(tet->six_rest_volume, k, p1, p2, p3, p4);
            store(p1, poses, i, first);
            store(p2, poses, j, first);
            store(p3, poses, l, first);
            store(p4, poses, m, first);
        }
}

template <typename Scalar>
void project_pose_binds(const PoseBind<Scalar>* binds, std::size_t count, const Scalar* k_bind, const Scalar* bind_points, Scalar* poses)
{
    for (std::size_t i = 0; i < count; ++i)
        for (int first = 0; first < poses_a_block; first += lanes<Scalar>) {
            Vertices<Scalar> p = vertex(poses, i, first, binds[i].free);
            project_bind<Scalar>(binds[i].rest_distance, load(k_bind + first) * binds[i].free, vertex(bind_points, i, first, Scalar(0)), p);
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
