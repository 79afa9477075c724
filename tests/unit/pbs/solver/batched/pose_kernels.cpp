// Reference: the plain form in pbs/constraints, pose by pose, within the bounds of rounding (projection_rounding.hpp).
#include "pbs/solver/batched/pbs_kernels.hpp"

#include "tests/support/projection_cases.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace {

using namespace test_support;
using pbs::StiffnessOf;
using pbs::Vec3;

constexpr int poses = pbs::poses_a_block;
constexpr int most_vertices = 6;

// Sixteen poses of up to six vertices: the masses belong to the mesh, and every pose has its own stiffness in each class.
template <typename Scalar>
class SixteenPoses {
public:
    using Vector = pbs::Vector3<Scalar>;
    template <int corners>
    using Places = std::array<std::uint32_t, corners>;

    // Positions [m] of vertex v in a pose by `at(pose, v)`, inverse masses by `w(v)`.
    SixteenPoses(const std::function<Vec3(int, int)>& at, const std::function<double(int)>& w)
    {
        for (int v = 0; v < most_vertices; ++v) {
            w_[v] = Scalar(w(v));
            for (int pose = 0; pose < poses; ++pose) set(pose, v, at(pose, v).template cast<Scalar>());
        }
        for (int pose = 0; pose < poses; ++pose)
            for (int which = 0; which < pbs::stiffness_classes; ++which)
                k_[which][pose] = Scalar((5 * pose + 7 * which) % poses) / (poses - 1);  // includes 0 and 1
    }

    // Between the given vertices [m], one edge after the other.
    void expect_as_plain(const std::vector<Places<2>>& edges, double rest_length)
    {
        std::vector<pbs::PoseEdge<Scalar>> of_kernel;
        for (const auto [i, j] : edges) {
            const Scalar w = w_[i] + w_[j];
            const StiffnessOf k = of_kernel.size() % 2 == 0 ? StiffnessOf::stretch : StiffnessOf::jiggling_stretch;
            of_kernel.push_back({{i, j}, k, Scalar(rest_length), {w_[i], w_[j]}, w > 0 ? 1 / w : 0});
        }
        SixteenPoses kernel = *this;
        pbs::project_pose_edges(of_kernel.data(), of_kernel.size(), kernel.k_[0], kernel.xyz_[0][0]);
        for_each_pose(kernel, [&](int pose, double& difference) {
            for (const pbs::PoseEdge<Scalar>& edge : of_kernel) {
                const auto [i, j] = edge.vertex;
                const pbs::StretchConstraint<Scalar> plain{{}, edge.rest_length, k(edge.stiffness, pose)};
                std::array p{position(pose, i), position(pose, j)};
                const RoundingBound bound = rounding_of(plain, w_[i], w_[j], p[0], p[1]);
                project(plain, w_[i], w_[j], p[0], p[1]);
                put_back<2>(pose, {i, j}, p);
                difference = difference * bound.growth + bound.step;
            }
        });
    }

    void expect_as_plain(const std::vector<Places<4>>& tets, double rest_volume)
    {
        std::vector<pbs::PoseTet<Scalar>> of_kernel;
        for (const auto [i, j, l, m] : tets)
            of_kernel.push_back({{i, j, l, m}, StiffnessOf::volume, Scalar(6) * Scalar(rest_volume), {w_[i], w_[j], w_[l], w_[m]}});
        SixteenPoses kernel = *this;
        pbs::project_pose_tets(of_kernel.data(), of_kernel.size(), kernel.k_[0], kernel.xyz_[0][0]);
        for_each_pose(kernel, [&](int pose, double& difference) {
            for (const Places<4>& tet : tets) {
                const pbs::VolumeConstraint<Scalar> plain{{}, Scalar(rest_volume), k(StiffnessOf::volume, pose)};
                std::array<Vector, 4> p;
                std::array<Scalar, 4> w;
                for (int c = 0; c < 4; ++c) p[c] = position(pose, tet[c]), w[c] = w_[tet[c]];
                const RoundingBound bound = rounding_of(plain, w, p);
                project(plain, w[0], w[1], w[2], w[3], p[0], p[1], p[2], p[3]);
                put_back<4>(pose, tet, p);
                difference = difference * bound.growth + bound.step;
            }
        });
    }

    // For every vertex v, with rest distances [m] by `rest_distance(v)`, to the positions of `bind_points`.
    void expect_as_plain(const SixteenPoses& bind_points, const std::function<double(int)>& rest_distance)
    {
        std::vector<pbs::PoseBind<Scalar>> binds;
        for (int v = 0; v < most_vertices; ++v) binds.push_back({Scalar(rest_distance(v)), Scalar(w_[v] > 0)});
        SixteenPoses kernel = *this;
        pbs::project_pose_binds(binds.data(), binds.size(), kernel.k_[1], bind_points.xyz_[0][0], kernel.xyz_[0][0]);
        for_each_pose(kernel, [&](int pose, double& difference) {
            for (int v = 0; v < most_vertices; ++v) {
                const pbs::BindConstraint<Scalar> plain{v, binds[v].rest_distance, k_[1][pose]};
                Vector p = position(pose, v);
                difference = std::max(difference, rounding_of(plain, bind_points.position(pose, v), p).step);
                project(plain, w_[v], bind_points.position(pose, v), p);
                set(pose, v, p);
            }
        });
    }

private:
    Vector position(int pose, int v) const { return {xyz_[v][0][pose], xyz_[v][1][pose], xyz_[v][2][pose]}; }
    void set(int pose, int v, const Vector& p)
    {
        for (int axis = 0; axis < 3; ++axis) xyz_[v][axis][pose] = p(axis);
    }
    template <int corners>
    void put_back(int pose, const Places<corners>& places, const std::array<Vector, corners>& p)
    {
        for (int c = 0; c < corners; ++c) set(pose, places[c], p[c]);
    }
    Scalar k(StiffnessOf which, int pose) const { return k_[static_cast<int>(which)][pose]; }

    // project_plain moves a pose of this one and returns how far the kernel's result may differ [m]; pinned vertices are equal to the bit.
    void for_each_pose(const SixteenPoses& kernel, const std::function<void(int, double&)>& project_plain)
    {
        for (int pose = 0; pose < poses; ++pose) {
            double bound = 0.0;
            project_plain(pose, bound);
            for (int v = 0; v < most_vertices; ++v)
                EXPECT_LE((kernel.position(pose, v) - position(pose, v)).cwiseAbs().maxCoeff(), w_[v] > 0 ? bound : 0.0)
                    << "pose " << pose << " vertex " << v;
        }
    }

    alignas(64) Scalar xyz_[most_vertices][3][poses];
    alignas(64) Scalar k_[pbs::stiffness_classes][poses];
    Scalar w_[most_vertices];
};

const std::vector<std::array<std::uint32_t, 2>> one_edge{{0, 1}};
const std::vector<std::array<std::uint32_t, 4>> one_tet{{0, 1, 2, 3}};
const std::vector<std::array<std::uint32_t, 2>> edges_of_tet{{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0, 3}, {1, 2}};
const std::vector<std::array<std::uint32_t, 4>> tets_of_fan{{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 5}};

template <typename Scalar>
class PoseKernels : public testing::Test {
protected:
    // The ring at a different place in every pose, with noise; bit v of `pinned` marks vertex v as pinned.
    SixteenPoses<Scalar> noisy_ring(double size_m, double noise, int pinned = 0, double mirror = 1.0)
    {
        return {[&](int, int v) -> Vec3 { return size_m * (ring[v] + random_.point(noise)).cwiseProduct(Vec3(1, 1, mirror)); },
                [&](int v) { return pinned >> v & 1 ? 0.0 : random_.number(0.2, 5.0); }};
    }

    RandomPoints random_{51};
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PoseKernels, Scalars);

double volume_m3(double size_m)
{
    return std::pow(size_m, 3) / 6;
}

TYPED_TEST(PoseKernels, OneAfterTheOther)
{
    for (const double size_m : sizes_m)
        for (const double noise : {0.0, 0.01, 0.2}) {
            SCOPED_TRACE(testing::Message() << "size " << size_m << " noise " << noise);
            this->noisy_ring(size_m, noise).expect_as_plain(edges_of_tet, size_m);
            this->noisy_ring(size_m, noise).expect_as_plain(tets_of_fan, volume_m3(size_m));
        }
}

TYPED_TEST(PoseKernels, EveryCombinationOfPinnedVertices)
{
    for (int pinned = 0; pinned < 1 << most_vertices; ++pinned) {
        SCOPED_TRACE(testing::Message() << "pinned " << pinned);
        this->noisy_ring(1.0, 0.2, pinned).expect_as_plain(edges_of_tet, 1.0);
        this->noisy_ring(1.0, 0.2, pinned).expect_as_plain(tets_of_fan, volume_m3(1.0));
    }
}

// Volumes have the wrong sign, and the projections pass through flat states.
TYPED_TEST(PoseKernels, Mirrored)
{
    for (const double size_m : sizes_m) {
        SCOPED_TRACE(testing::Message() << "size " << size_m);
        this->noisy_ring(size_m, 0.02, 0, -1.0).expect_as_plain(edges_of_tet, size_m);
        this->noisy_ring(size_m, 0.02, 0, -1.0).expect_as_plain(one_tet, volume_m3(size_m));
    }
}

TYPED_TEST(PoseKernels, DegenerateTets)
{
    for (const TetShape& shape : degenerate_tets)
        for (const double size_m : sizes_m)
            for (int pinned = 0; pinned < 16; ++pinned) {
                SCOPED_TRACE(testing::Message() << shape.name << " size " << size_m << " pinned " << pinned);
                const auto at = [&](int, int v) -> Vec3 { return size_m * shape.corners[v % 4]; };
                const auto w = [&](int v) { return pinned >> v & 1 ? 0.0 : this->random_.number(0.2, 5.0); };
                SixteenPoses<TypeParam>(at, w).expect_as_plain(one_tet, volume_m3(size_m));
            }
}

TYPED_TEST(PoseKernels, DegenerateEdges)
{
    for (const double length : {0.0, 1e-3, 1.0, 100.0})
        for (const double size_m : sizes_m)
            for (int pinned = 0; pinned < 4; ++pinned) {
                SCOPED_TRACE(testing::Message() << "length " << length << " size " << size_m << " pinned " << pinned);
                Vec3 first = Vec3::Zero();
                const auto at = [&](int, int v) -> Vec3 {
                    if (v == 0) return first = this->random_.point(size_m);
                    return first + length * size_m * this->random_.point(1.0).normalized();
                };
                const auto w = [&](int v) { return pinned >> v & 1 ? 0.0 : this->random_.number(0.2, 5.0); };
                SixteenPoses<TypeParam>(at, w).expect_as_plain(one_edge, size_m);
            }
}

TYPED_TEST(PoseKernels, Bind)
{
    for (const double size_m : sizes_m)
        for (const int pinned : {0, 0b101010, 0b111111}) {
            SCOPED_TRACE(testing::Message() << "size " << size_m << " pinned " << pinned);
            const auto bind_points = this->noisy_ring(size_m, 0.5);
            this->noisy_ring(size_m, 0.5, pinned).expect_as_plain(bind_points, [&](int v) { return 0.1 * v * size_m; });
        }
}

TYPED_TEST(PoseKernels, BindOnTheBoneAndOnTheBindPoint)
{
    const auto bind_points = this->noisy_ring(1.0, 0.0);
    this->noisy_ring(1.0, 0.0).expect_as_plain(bind_points, [](int v) { return v % 2 ? 0.3 : 0.0; });
    this->noisy_ring(1.0, 0.5).expect_as_plain(bind_points, [](int) { return 0.0; });
}

// A NaN remains NaN and stays in its pose.
TYPED_TEST(PoseKernels, NotANumberStaysInItsPose)
{
    alignas(64) TypeParam clean[4][3][poses], sick[4][3][poses], k[pbs::stiffness_classes][poses];
    std::fill_n(k[0], pbs::stiffness_classes * poses, TypeParam(0.5));
    for (int v = 0; v < 4; ++v)
        for (int axis = 0; axis < 3; ++axis)
            for (int pose = 0; pose < poses; ++pose) clean[v][axis][pose] = TypeParam(1.1 * ring[v](axis));
    std::copy_n(clean[0][0], 4 * 3 * poses, sick[0][0]);
    sick[1][0][5] = std::numeric_limits<TypeParam>::quiet_NaN();
    const pbs::PoseEdge<TypeParam> edge{{0, 1}, StiffnessOf::stretch, 1, {1, 1}, TypeParam(0.5)};
    const pbs::PoseTet<TypeParam> tet{{0, 1, 2, 3}, StiffnessOf::volume, 1, {1, 1, 1, 1}};
    for (TypeParam* block : {clean[0][0], sick[0][0]}) {
        pbs::project_pose_edges(&edge, 1, k[0], block);
        pbs::project_pose_tets(&tet, 1, k[0], block);
    }
    EXPECT_TRUE(std::isnan(sick[1][0][5]));
    for (int v = 0; v < 4; ++v)
        for (int axis = 0; axis < 3; ++axis)
            for (int pose = 0; pose < poses; ++pose)
                if (pose != 5) {
                    EXPECT_EQ(sick[v][axis][pose], clean[v][axis][pose]) << "pose " << pose;
                }
}

}  // namespace
