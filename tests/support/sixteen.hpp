// Sixteen constraints, or sixteen poses of one body, and the kernels that project them side by side.
//   Sixteen<float> edges; edges.links = {{{0, 1}}};
//   Batched<float, ConstraintKind::edge>::project(edges);
#pragma once

#include "pbs/solver/batched/pbs_kernels.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace test_support {

constexpr int lanes = pbs::batch_size, most_vertices = 6;

// Each lane has the same constraints.
template <typename Scalar>
struct Sixteen {
    using Vector = pbs::Vector3<Scalar>;
    struct Link {
        std::vector<int> vertex;                                     // one: bind, two: stretch, four: volume
        Scalar rest[lanes] = {}, k[lanes] = {}, lambda[lanes] = {};  // rest: [m] or [m^3]; k: 1 / alpha for XPBD
    };

    Vector p[lanes][most_vertices], q[lanes][most_vertices];  // positions and bind points
    Scalar w[lanes][most_vertices] = {};
    std::vector<Link> links;

    Sixteen()
    {
        std::fill_n(p[0], lanes * most_vertices, Vector::Zero());
        std::fill_n(q[0], lanes * most_vertices, Vector::Zero());
    }
};

// One batch, with vertices of its own in each lane. k: as the kernel takes it, from k and the sum of two inverse
// masses.
template <typename Scalar, pbs::ConstraintKind kind>
struct Packed {
    static constexpr int corners = pbs::corners(kind);
    alignas(64) Scalar xyzw[lanes * corners][4] = {};
    alignas(64) Scalar lambda[lanes] = {};
    pbs::Batch<Scalar, kind> batch = {};

    template <typename Stiffness>
    Packed(const Sixteen<Scalar>& from, Stiffness stiffness)
    {
        const auto& link = from.links.front();
        for (int lane = 0; lane < lanes; ++lane) {
            for (int v = 0; v < corners; ++v) {
                batch.offset[v][lane] = 4 * (lane * corners + v);
                for (int axis = 0; axis < 3; ++axis) xyzw[lane * corners + v][axis] = from.p[lane][v](axis);
                xyzw[lane * corners + v][3] = from.w[lane][v];
            }
            batch.rest[lane] = Scalar(corners == 2 ? 1 : 6) * link.rest[lane];
            batch.stiffness[lane] = stiffness(link.k[lane], from.w[lane][0] + from.w[lane][1]);
            lambda[lane] = link.lambda[lane];
        }
    }
    void store(Sixteen<Scalar>& to) const
    {
        for (int lane = 0; lane < lanes; ++lane) {
            for (int v = 0; v < corners; ++v) {
                const Scalar* vertex = xyzw[lane * corners + v];
                to.p[lane][v] = {vertex[0], vertex[1], vertex[2]};
                to.w[lane][v] = vertex[3];
            }
            to.links.front().lambda[lane] = lambda[lane];
        }
    }
};

template <typename S, pbs::ConstraintKind kind>
struct Batched {
    using Scalar = S;
    static constexpr bool one_body = false, compliant = false;
    static constexpr int vertices = pbs::corners(kind);
    static std::vector<std::vector<int>> links()
    {
        if (vertices == 2) return {{0, 1}};
        return {{0, 1, 2, 3}};
    }
    static Packed<S, kind> packed(const Sixteen<S>& from)
    {
        return {from, [](S k, S w) { return vertices == 4 ? k : w > S(0) ? k / w : S(0); }};
    }
    static void project(Sixteen<S>& constraints)
    {
        auto batch = packed(constraints);
        pbs::project_batches<S>(kind, &batch.batch, 1, batch.xyzw[0]);
        batch.store(constraints);
    }
};

// XPBD. Stiffness and multiplier of a tet are those of six times its volume.
template <typename S, pbs::ConstraintKind kind>
struct Compliant : Batched<S, kind> {
    static constexpr bool compliant = true;
    static void project(Sixteen<S>& constraints, S dt2 = S(0.25))
    {
        Packed<S, kind> batch(constraints, [](S k, S) { return k; });
        pbs::project_compliant_batches<S>(kind, &batch.batch, 1, dt2, batch.lambda, batch.xyzw[0]);
        batch.store(constraints);
    }
};

template <typename S>
struct BindBatches {
    using Scalar = S;
    static constexpr bool one_body = false, compliant = false;
    static constexpr int vertices = most_vertices;
    static std::vector<std::vector<int>> links() { return {{0}, {1}, {2}, {3}, {4}, {5}}; }

    explicit BindBatches(const Sixteen<S>& from)
    {
        for (int v = 0; v < vertices; ++v)
            for (int lane = 0; lane < lanes; ++lane) {
                S* to = xyzw[v * lanes + lane];
                for (int axis = 0; axis < 3; ++axis) to[axis] = from.p[lane][v](axis);
                to[3] = from.w[lane][v];
                batches[v].x[lane] = from.q[lane][v](0), batches[v].y[lane] = from.q[lane][v](1),
                batches[v].z[lane] = from.q[lane][v](2);
                batches[v].rest_distance[lane] = from.links[v].rest[lane];
                batches[v].stiffness[lane] = from.w[lane][v] > S(0) ? from.links[v].k[lane] : S(0);
            }
    }
    static void project(Sixteen<S>& binds)
    {
        BindBatches packed(binds);
        pbs::project_bind_batches<S>(packed.batches, vertices, packed.xyzw[0]);
        for (int v = 0; v < vertices; ++v)
            for (int lane = 0; lane < lanes; ++lane)
                binds.p[lane][v] = Eigen::Map<const pbs::Vector3<S>>(packed.xyzw[v * lanes + lane]);
    }

    alignas(64) S xyzw[vertices * lanes][4];
    pbs::BindBatch<S> batches[vertices] = {};
};

// Sixteen poses of up to six vertices: masses and rest values belong to the mesh, and every pose has its own stiffness
// in each class.
template <typename S, int corners>
struct Poses {
    using Scalar = S;
    static constexpr bool one_body = true, compliant = false;
    static constexpr int vertices = most_vertices;
    static std::vector<std::vector<int>> links()
    {
        if (corners == 1) return {{0}, {1}, {2}, {3}, {4}, {5}};
        if (corners == 2) return {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0, 3}, {1, 2}};
        return {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 5}};
    }

    static void project(Sixteen<S>& poses)
    {
        alignas(64) S p[vertices][3][lanes], q[vertices][3][lanes], k[pbs::stiffness_classes][lanes] = {};
        const auto& links = poses.links;
        const S* w = poses.w[0];
        for (int v = 0; v < vertices; ++v)
            for (int axis = 0; axis < 3; ++axis)
                for (int pose = 0; pose < lanes; ++pose)
                    p[v][axis][pose] = poses.p[pose][v](axis), q[v][axis][pose] = poses.q[pose][v](axis);
        const auto of_class = [&](std::size_t c, pbs::StiffnessOf which) {
            std::copy_n(links[c].k, lanes, k[static_cast<int>(which)]);
            return which;
        };
        if constexpr (corners == 1) {
            std::vector<pbs::PoseBind<S>> binds;
            for (std::size_t c = 0; c < links.size(); ++c) binds.push_back({links[c].rest[0], S(w[c] > 0)});
            pbs::project_pose_binds(binds.data(), binds.size(), links[0].k, q[0][0], p[0][0]);
        } else {
            using enum pbs::StiffnessOf;
            std::vector<std::conditional_t<corners == 2, pbs::PoseEdge<S>, pbs::PoseTet<S>>> constraints(links.size());
            for (std::size_t c = 0; c < links.size(); ++c) {
                constraints[c].stiffness = of_class(c, corners == 4 ? volume : c % 2 == 0 ? stretch : jiggling_stretch);
                constraints[c].rest = (corners == 4 ? S(6) : S(1)) * links[c].rest[0];
                S sum = 0;
                for (int i = 0; i < corners; ++i) {
                    constraints[c].vertex[i] = static_cast<std::uint32_t>(links[c].vertex[i]);
                    sum += constraints[c].w[i] = w[links[c].vertex[i]];
                }
                if constexpr (corners == 2) constraints[c].one_over_w = sum > 0 ? 1 / sum : 0;
            }
            if constexpr (corners == 2)
                pbs::project_pose_edges(constraints.data(), constraints.size(), k[0], p[0][0]);
            else
                pbs::project_pose_tets(constraints.data(), constraints.size(), k[0], p[0][0]);
        }
        for (int v = 0; v < vertices; ++v)
            for (int pose = 0; pose < lanes; ++pose) poses.p[pose][v] = {p[v][0][pose], p[v][1][pose], p[v][2][pose]};
    }
};

}  // namespace test_support
