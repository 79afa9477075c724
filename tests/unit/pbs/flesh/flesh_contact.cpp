// Reference: differences of the penalty, the column of flesh below a skin vertex by hand, and the same minimum by two
// methods.
#include "pbs/flesh/flesh_contact.hpp"

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/quasi_newton.hpp"
#include "pbs/flesh/vbd.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/overlapping_blocks.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace flesh_contact_tests {
namespace {

using namespace test_support;
using pbs::Positions;
using pbs::Vec3;

// Blocks whose bones push one into the other.
struct HeldBlocks {
    OverlappingBlocks blocks = overlapping_blocks(0.15);
    pbs::FleshMaterial material = pbs::flesh_material(0.45);
    pbs::BoneHold hold{blocks.mesh, springs(), 2};
    pbs::FleshEnergy energy{blocks.mesh, material, hold};
    pbs::CholeskyFactor factor = pbs::cholesky_factor(pbs::flesh_laplacian(blocks.mesh, material, energy, 0.6));
    Positions centres;

    HeldBlocks()
    {
        pbs::Pose pose(2, Eigen::Isometry3d::Identity());
        pose[1].translation().z() = -2.15;
        hold.centres(pose, centres);
    }
    static pbs::BoneSprings springs()
    {
        pbs::BoneSprings springs{Positions(40, 3), Eigen::VectorXd::Constant(40, 0.2), {}};
        RandomPoints random(3);
        for (int s = 0; s < 40; ++s) {
            springs.bone.push_back(s % 2);
            springs.points.row(s) = random.point(s % 2 ? 0.1 : 0.3) + Vec3(0, 0, s % 2 ? 2.35 : -0.6);
        }
        return springs;
    }
    double overlap_m(const Positions& x) const
    {
        pbs::SelfContact<double> contact(blocks.mesh, in_order(x.rows()), 3);
        contact.find(x.data());
        double sum = 0.0;
        for (const auto& constraint : contact.constraints()) sum += constraint.depth;
        return sum;
    }
};

const HeldBlocks held;
const pbs::TetMesh& mesh = held.blocks.mesh;

pbs::Rows<double> rows_of(const Positions& x)
{
    pbs::Rows<double> rows(static_cast<int>(x.rows()));
    pbs::load_rows(x, in_order(x.rows()), Vec3::Zero(), rows);
    return rows;
}

struct Found {
    pbs::FleshContact<double> contact{mesh, held.energy, in_order(mesh.rest.rows())};
    Found() { contact.find(rows_of(held.blocks.pushed)); }
    double value(const Positions& x) const
    {
        pbs::Rows<double> ignored(static_cast<int>(x.rows()));
        return contact.add_value_and_gradient(rows_of(x), ignored);
    }
};

Positions random_moves(double size, unsigned seed)
{
    return jittered(Positions::Zero(mesh.rest.rows(), 3), size, seed);
}

// The energy is quadratic as long as no pair opens or closes, so that central differences are exact up to rounding, for
// every eps.
TEST(FleshContact, GradientIsThatOfTheValue)
{
    const Found found;
    const Positions& x = held.blocks.pushed;
    pbs::Rows<double> rows(static_cast<int>(x.rows()));
    EXPECT_GT(found.contact.add_value_and_gradient(rows_of(x), rows), 0.0);
    Positions gradient;
    pbs::store_rows(rows, in_order(x.rows()), Vec3::Zero(), gradient);
    EXPECT_LE(gradient.colwise().sum().norm(), rounding_error(1e3, gradient.cwiseAbs().sum()));
    const Positions direction = random_moves(1.0, 8);
    const double slope = gradient.cwiseProduct(direction).sum();
    for (const double eps : {1e-2, 1e-3, 1e-4, 1e-5})
        EXPECT_NEAR((found.value(x + eps * direction) - found.value(x - eps * direction)) / (2.0 * eps), slope,
                    rounding_error(1e3, found.value(x)) / eps);
}

TEST(FleshContact, PullsBoundTheEnergyFromAboveAndTouchIt)
{
    const Found found;
    const Positions x = held.blocks.pushed + random_moves(0.02, 1);
    const std::vector<pbs::ContactPull> pulls = found.contact.pulls(rows_of(x));
    const auto bound = [&](const Positions& s) {
        double sum = found.value(x);
        for (const pbs::ContactPull& pull : pulls)
            sum += pull.gradient.dot(s.row(pull.vertex)) + pull.stiffness * s.row(pull.vertex).squaredNorm() / 2.0;
        return sum;
    };
    for (unsigned seed = 0; seed < 50; ++seed)
        for (const double size : {1e-3, 0.1, 1.0}) {
            const Positions s = random_moves(size, seed);
            EXPECT_LE(found.value(x + s), bound(s));
        }
    const Positions s = random_moves(1e-6, 77);
    EXPECT_NEAR(found.value(x + s), bound(s), 1e-9 * found.value(x));
}

// In the middle of a face of cubes of the edge h, a third of the triangles is h^2, and a quarter of the tets h^3 / 2.
TEST(FleshContact, StiffnessIsThatOfTheConfinedColumnBelowTheVertex)
{
    const pbs::TetMesh box = structured_bar({0, 0, 0}, {4, 4, 4}, {4, 4, 4});
    const pbs::BoneSprings spring{Positions::Constant(1, 3, 2.1), Eigen::VectorXd::Ones(1), {0}};
    const double nu = 0.3, modulus = (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    const pbs::FleshEnergy energy(box, pbs::flesh_material(nu), pbs::BoneHold(box, spring, 1));
    const pbs::FleshContact<double> contact(box, energy, in_order(box.rest.rows()));
    EXPECT_NEAR(contact.stiffness()(2 + 5 * 2), 2.0 * modulus, rounding_error(100.0, 2.0 * modulus));
    EXPECT_EQ(contact.stiffness()(2 + 5 * (2 + 5 * 2)), 0.0);  // below the skin
}

template <typename Scalar>
Positions by_quasi_newton(bool contact, bool packed, int threads = 1, int iterations = 400)
{
    pbs::QuasiNewtonOptions options;
    options.contact = contact;
    options.packed = packed;
    options.threads = threads;
    options.iterations = iterations;
    Positions x = held.blocks.pushed;
    pbs::QuasiNewton<Scalar>(mesh, held.energy, held.factor, options).minimise(held.centres, x);
    return x;
}

template <typename Scalar>
Positions by_vertex_blocks(bool contact, bool packed,
                           pbs::Acceleration acceleration = pbs::Acceleration::over_relaxation, int threads = 1,
                           int iterations = 600)
{
    pbs::VertexBlockOptions options;
    options.contact = contact;
    options.packed = packed;
    options.acceleration = acceleration;
    options.threads = threads;
    options.iterations = iterations;
    Positions x = held.blocks.pushed;
    EXPECT_TRUE(pbs::VertexBlockDescent<Scalar>(mesh, held.energy, options).minimise(held.centres, x).is_finite);
    return x;
}

TEST(FleshContact, SeparatesBlocksAndBothMethodsReachOneMinimum)
{
    const double without_m = held.overlap_m(by_quasi_newton<double>(false, false));
    const Positions x = by_quasi_newton<double>(true, false);
    EXPECT_GT(without_m, 0.5);
    EXPECT_LE(held.overlap_m(x), 0.15 * without_m);
    constexpr double found_at_other_iterates_m = 5e-3;  // where the second search finds pairs depends on the iterate
    const auto distance_m = [&](const Positions& other) { return (other - x).rowwise().norm().maxCoeff(); };
    EXPECT_LE(distance_m(by_quasi_newton<double>(true, true)), found_at_other_iterates_m);
    EXPECT_LE(distance_m(by_quasi_newton<float>(true, true)), found_at_other_iterates_m);
    EXPECT_LE(distance_m(by_vertex_blocks<double>(true, false)), found_at_other_iterates_m);
    EXPECT_LE(distance_m(by_vertex_blocks<double>(true, true)), found_at_other_iterates_m);
    EXPECT_LE(distance_m(by_vertex_blocks<float>(true, true)), found_at_other_iterates_m);
    EXPECT_LE(distance_m(by_vertex_blocks<float>(true, true, pbs::Acceleration::chebyshev)), found_at_other_iterates_m);
}

TEST(FleshContact, NumberOfThreadsChangesNoBit)
{
    for (const int threads : {2, 4}) {
        EXPECT_EQ(by_quasi_newton<float>(true, true, threads, 20), by_quasi_newton<float>(true, true, 1, 20));
        EXPECT_EQ(by_vertex_blocks<float>(true, true, {}, threads, 20), by_vertex_blocks<float>(true, true, {}, 1, 20));
    }
}

// The second frame has no overlap; what the first one has found does not last.
template <typename Solver, typename... Arguments>
void expect_same_bits_without_overlap(auto options, const Arguments&... arguments)
{
    Positions with = mesh.rest, without = mesh.rest, overlapping = held.blocks.pushed, centres;
    held.hold.centres(pbs::Pose(2, Eigen::Isometry3d::Identity()), centres);
    centres.array() += 0.01;
    options.contact = true;
    Solver of_contact(mesh, held.energy, arguments..., options);
    of_contact.minimise(held.centres, overlapping);
    of_contact.minimise(centres, with);
    options.contact = false;
    Solver(mesh, held.energy, arguments..., options).minimise(centres, without);
    EXPECT_EQ(with, without);
}

TEST(FleshContact, ChangesNoBitWhereNothingOverlaps)
{
    for (const bool packed : {false, true}) {
        pbs::QuasiNewtonOptions of_quasi_newton;
        pbs::VertexBlockOptions of_blocks;
        of_quasi_newton.packed = of_blocks.packed = packed;
        expect_same_bits_without_overlap<pbs::QuasiNewton<double>>(of_quasi_newton, held.factor);
        expect_same_bits_without_overlap<pbs::VertexBlockDescent<double>>(of_blocks);
    }
    expect_same_bits_without_overlap<pbs::QuasiNewton<float>>(pbs::QuasiNewtonOptions{}, held.factor);
    expect_same_bits_without_overlap<pbs::VertexBlockDescent<float>>(pbs::VertexBlockOptions{});
}

TEST(FleshContact, StaysFiniteFromCollapsedMirroredAndTornStates)
{
    const Positions point = Positions::Zero(mesh.rest.rows(), 3);
    Positions torn = held.blocks.pushed;
    for (Eigen::Index v = 0; v < torn.rows(); v += 5) torn.row(v).array() += 50.0;
    for (const Positions& start : {point, mirrored(held.blocks.pushed), torn}) {
        Positions by_newton = start, by_blocks = start;
        pbs::QuasiNewtonOptions newton{.iterations = 100};
        newton.contact = true;
        pbs::VertexBlockOptions blocks;
        blocks.contact = true;
        pbs::QuasiNewton<float>(mesh, held.energy, held.factor, newton).minimise(held.centres, by_newton);
        pbs::VertexBlockDescent<float>(mesh, held.energy, blocks).minimise(held.centres, by_blocks);
        EXPECT_TRUE(by_newton.allFinite() && by_blocks.allFinite());
        EXPECT_LE(by_blocks.rowwise().norm().maxCoeff(), 5.0);
    }
}

}  // namespace
}  // namespace flesh_contact_tests
