// One batch of groups with their own vertices: the kernel projects them, and so does the plain form, one constraint after the other.
//   SixteenGroups<float, GroupKind::tet> groups;
//   groups.set_vertex(lane, v, point, w); groups.set_constraint(lane, c, rest, k); groups.expect_as_plain();
#pragma once

#include "pbs/solver/batched/pbs_kernels.hpp"
#include "tests/support/projection_rounding.hpp"

#include <gtest/gtest.h>

namespace test_support {

template <typename Scalar, pbs::GroupKind kind>
class SixteenGroups {
public:
    using Shape = pbs::GroupShape<kind>;
    using Vector = pbs::Vector3<Scalar>;
    static constexpr int lanes = pbs::batch_size, vertices = Shape::vertices, constraints = Shape::constraints;
    static constexpr std::size_t corners = pbs::of_edges<kind> ? 2 : 4;  // vertices per constraint

    void set_vertex(int lane, int v, const pbs::Vec3& point, double w)
    {
        Scalar* to = vertex(lane, v);
        for (int axis = 0; axis < 3; ++axis) to[axis] = Scalar(point(axis));
        to[3] = Scalar(w);
    }
    // rest: length [m] or volume [m^3]. To be called after the vertices are set.
    void set_constraint(int lane, int c, double rest, double k)
    {
        rest_[lane][c] = Scalar(rest);
        stiffness_[lane][c] = Scalar(k);
    }

    Scalar* vertex(int lane, int v) { return xyzw_[lane * vertices + v]; }
    Vector position(int lane, int v) { return {vertex(lane, v)[0], vertex(lane, v)[1], vertex(lane, v)[2]}; }
    Scalar rest(int lane, int c) const { return rest_[lane][c]; }

    const pbs::Batch<Scalar, kind>& batch()
    {
        for (int lane = 0; lane < lanes; ++lane) {
            for (int v = 0; v < vertices; ++v) batch_.offset[v][lane] = 4 * (lane * vertices + v);
            for (int c = 0; c < constraints; ++c) {
                const auto& join = Shape::joins[c];
                const Scalar w = vertex(lane, join[0])[3] + vertex(lane, join[1])[3], k = stiffness_[lane][c];
                batch_.rest[c][lane] = pbs::of_edges<kind> ? rest_[lane][c] : Scalar(6) * rest_[lane][c];
                batch_.stiffness[c][lane] = !pbs::of_edges<kind> ? k : w > Scalar(0) ? k / w : Scalar(0);
            }
        }
        return batch_;
    }
    Scalar* memory() { return xyzw_[0]; }
    void project() { pbs::project_batches<Scalar>(kind, &batch(), 1, memory()); }

    // Compares the kernel's positions with those of pbs/constraints; masses and pinned vertices must agree to the bit.
    void expect_as_plain()
    {
        SixteenGroups kernel = *this;
        kernel.project();
        for (int lane = 0; lane < lanes; ++lane) {
            const double bound = project_plain(lane);
            for (int v = 0; v < vertices; ++v) {
                SCOPED_TRACE(testing::Message() << "lane " << lane << " vertex " << v);
                const double difference = (kernel.position(lane, v) - position(lane, v)).cwiseAbs().maxCoeff();
                EXPECT_LE(difference, vertex(lane, v)[3] > Scalar(0) ? bound : 0.0);
                EXPECT_EQ(kernel.vertex(lane, v)[3], vertex(lane, v)[3]);
            }
        }
    }

private:
    // Returns how far the kernel's result may differ [m].
    double project_plain(int lane)
    {
        double difference = 0.0;
        for (int c = 0; c < constraints; ++c) {
            const RoundingBound bound = project_plain(lane, c);
            difference = difference * bound.growth + bound.step;
        }
        return difference;
    }

    RoundingBound project_plain(int lane, int c)
    {
        const auto& join = Shape::joins[c];
        std::array<Vector, corners> p;
        std::array<Scalar, corners> w;
        for (std::size_t i = 0; i < corners; ++i) {
            p[i] = position(lane, join[i]);
            w[i] = vertex(lane, join[i])[3];
        }
        RoundingBound bound;
        if constexpr (pbs::of_edges<kind>) {
            const pbs::StretchConstraint<Scalar> edge{{join[0], join[1]}, rest_[lane][c], stiffness_[lane][c]};
            bound = rounding_of(edge, w[0], w[1], p[0], p[1]);
            pbs::project(edge, w[0], w[1], p[0], p[1]);
        } else {
            const pbs::VolumeConstraint<Scalar> tet{{0, 1, 2, 3}, rest_[lane][c], stiffness_[lane][c]};
            bound = rounding_of(tet, w, p);
            pbs::project(tet, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]);
        }
        for (std::size_t i = 0; i < corners; ++i)
            for (int axis = 0; axis < 3; ++axis) vertex(lane, join[i])[axis] = p[i](axis);
        return bound;
    }

    alignas(64) Scalar xyzw_[lanes * vertices][4] = {};
    pbs::Batch<Scalar, kind> batch_{};
    Scalar rest_[lanes][constraints] = {}, stiffness_[lanes][constraints] = {};
};

}  // namespace test_support
