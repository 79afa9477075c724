// The contract of the packed systems of elastic flesh: each equals its plain twin, which is the reference, except for
// rounding; and neither threads nor repetition change a bit. What only one of them promises follows below.
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/flesh/vbd.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/four_threads.hpp"
#include "tests/support/held_xpbd.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace packed_systems_tests {
namespace {

using pbs::Positions;
using pbs::Vec3;
using test_support::HeldBar;

template <typename Scalar>
constexpr double epsilon = std::numeric_limits<Scalar>::epsilon();

// Energy, gradient and step of a system of flesh, with the vertices in the order of the mesh.
struct Evaluated {
    double energy;
    pbs::Positions gradient, preconditioned;
};

template <typename Scalar>
Evaluated evaluated_by(pbs::FleshSystem<Scalar>& system, const pbs::Positions& centres, const pbs::Positions& x)
{
    pbs::Rows<Scalar> rows = system.rows(), gradient = system.rows();
    system.set_centres(centres);
    system.load(x, rows);
    Evaluated result;
    result.energy = system.value_and_gradient(rows, gradient);
    pbs::Rows<Scalar> zero = system.rows();
    pbs::Positions offset;  // store() adds the origin of the rows
    system.store(zero, offset);
    system.store(gradient, result.gradient);
    result.gradient -= offset;
    system.precondition(gradient);
    system.store(gradient, result.preconditioned);
    result.preconditioned -= offset;
    return result;
}

std::vector<Positions> listed(const Evaluated& evaluated)
{
    return {evaluated.gradient, evaluated.preconditioned, Positions::Constant(1, 3, evaluated.energy)};
}

// Energy, gradient and preconditioned gradient of the quasi-Newton method.
struct FleshEvaluation {
    explicit FleshEvaluation(const HeldBar& held)
        : bar(held),
          laplacian(pbs::flesh_laplacian(bar.bent.mesh, bar.material, bar.energy, 0.6)),
          factor(pbs::cholesky_factor(laplacian))
    {
    }

    template <typename Scalar>
    Evaluated evaluated(bool packed, int threads, const Positions& x) const
    {
        const auto system = pbs::make_flesh_system<Scalar>(bar.bent.mesh, bar.energy, factor, packed, threads);
        return evaluated_by<Scalar>(*system, bar.centres, x);
    }
    template <typename Scalar>
    std::vector<Positions> results(int threads, const Positions& x) const
    {
        return listed(evaluated<Scalar>(true, threads, x));
    }

    // The two substitutions solve a system that differs from A = L L^T by at most 2 n u |L| |L^T|, n the longest row of
    // L and u = epsilon / 2 (N. Higham, Accuracy and Stability of Numerical Algorithms, SIAM 2002, Theorem 8.5), and
    // the rounding of L adds 2 u |L| |L^T|. The norm of |L| |L^T| is at most that of Frobenius of L squared, which is
    // the trace of A.
    template <typename Scalar>
    void expect_equal_to_plain(const Positions& x) const
    {
        const Evaluated expected = evaluated<double>(false, 1, x), found = evaluated<Scalar>(true, 1, x);
        const double unit = epsilon<Scalar>, rounding = test_support::rounding_of_gradient<Scalar>(bar.energy);
        EXPECT_LE((found.gradient - expected.gradient).cwiseAbs().maxCoeff(), rounding);
        EXPECT_NEAR(found.energy, expected.energy, 30 * 32 * unit * expected.energy);
        EXPECT_GT(expected.gradient.norm(), 100.0 * rounding);
        std::vector<int> entries_of_row(factor.order.size(), 0);
        for (const int row : factor.row) ++entries_of_row[row];
        const int longest_row = *std::max_element(entries_of_row.begin(), entries_of_row.end());
        const Eigen::VectorXd spectrum =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(laplacian), Eigen::EigenvaluesOnly)
                .eigenvalues();
        const double lowest = spectrum.minCoeff(), of_solve = (longest_row + 1.0) * unit * spectrum.sum() / lowest;
        EXPECT_LE(
            (found.preconditioned - expected.preconditioned).norm(),
            rounding * std::sqrt(static_cast<double>(x.size())) / lowest + of_solve * expected.preconditioned.norm());
        EXPECT_LT(of_solve, 0.1);
    }

    HeldBar bar;
    Eigen::SparseMatrix<double> laplacian;  // its lower triangle
    pbs::CholeskyFactor factor;
};

// The same for projective dynamics, whose plain local step uses eigenvectors and no formula.
struct ProjectiveEvaluation {
    explicit ProjectiveEvaluation(const HeldBar& held, bool keeps_volume = true)
        : bar(held),
          flesh(bar.bent.mesh, bar.springs, 2,
                {.poisson = 0.45, .volume_share = pbs::volume_share_of_projective(0.45, keeps_volume)}),
          energy(bar.bent.mesh, pbs::projective_weights(0.45, keeps_volume), flesh.hold())
    {
    }

    template <typename Scalar>
    auto system(bool packed, int threads) const
    {
        return pbs::make_flesh_system<Scalar>(bar.bent.mesh, energy, flesh.factor(), packed, threads);
    }
    template <typename Scalar>
    std::vector<Positions> results(int threads, const Positions& x) const
    {
        return listed(evaluated_by<Scalar>(*system<Scalar>(true, threads), bar.centres, x));
    }

    // A rounding of the entries of F changes the nearest rotation by 1 / (s_2 + s_3) and less, the nearest matrix of
    // determinant one by (P_23 / (P_23 - kappa)) and less, which the formulae keep below ten. F itself has rounding of
    // x over the edge's length. Each entry of the gradient sums some 25 tets with some 60 roundings of terms as large
    // as the weights, V0 and the gradients are.
    template <typename Scalar>
    double tolerance(const Positions& x) const
    {
        constexpr double amplification = 10.0;
        double part = 0.0;
        for (const pbs::ProjectiveTet& tet : energy.tets()) {
            const double of_f =
                (x.rowwise() - x.colwise().mean()).rowwise().norm().maxCoeff() * tet.inverse_edges.norm();
            // the size of the terms of F, R and D
            part = std::max(part, tet.volume * tet.inverse_edges.norm() * std::max(1.0, of_f));
        }
        return 25 * 60 * amplification * epsilon<Scalar> * (energy.weights().strain + energy.weights().volume) * part;
    }

    // Returns how many tets were refused by the formulae. The energy changes with x by its gradient, and its terms are
    // rounded as those of the gradient are, times a displacement.
    template <typename Scalar>
    int expect_equal_to_plain(const Positions& x) const
    {
        const auto by_sixteen = system<Scalar>(true, 1);
        const Evaluated expected = evaluated_by<double>(*system<double>(false, 1), bar.centres, x);
        const Evaluated found = evaluated_by<Scalar>(*by_sixteen, bar.centres, x);
        const double bound = tolerance<Scalar>(x);
        EXPECT_LE((found.gradient - expected.gradient).cwiseAbs().maxCoeff(), bound);
        EXPECT_NEAR(
            found.energy, expected.energy,
            bound * std::max(x.cwiseAbs().maxCoeff(), bar.centres.cwiseAbs().maxCoeff()) * std::sqrt(double(x.size())));
        EXPECT_GT(expected.gradient.cwiseAbs().maxCoeff(), 4.0 * bound);
        return by_sixteen->refused();
    }

    HeldBar bar;
    pbs::HeldFlesh flesh;
    pbs::ProjectiveEnergy energy;
};

// By how much roundings may change the new position of any one vertex, the others given [m]. A sum of n terms is in
// error by n roundings of the sum of their magnitudes, and a term has a dozen itself: this for the gradient, over the
// least eigenvalue of the block, and for the block, times the step. Positions are rounded relative to the body's own
// size.
double step_rounding(const HeldBar& body, const Positions& x, double unit)
{
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(body.energy);
    double worst = 0.0;
    for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
        if (stars[i].tets.empty()) continue;
        const double terms = 4.0 * static_cast<double>(stars[i].tets.size()) + 12.0;
        double gradient = stars[i].hold * (x.row(i) - body.centres.row(i)).norm(), hessian = stars[i].diagonal;
        for (const pbs::IncidentTet& tet : stars[i].tets) {
            const Vec3 a = x.row(tet.other[0]) - x.row(i), b = x.row(tet.other[1]) - x.row(i),
                       c = x.row(tet.other[2]) - x.row(i);
            const double face = (b - a).norm() * (c - a).norm();
            gradient += std::abs(tet.w[0]) * a.norm() + std::abs(tet.w[1]) * b.norm() + std::abs(tet.w[2]) * c.norm();
            gradient += tet.kappa * (face * a.norm() + tet.d) * face;
            hessian += tet.kappa * face * face;
        }
        const double step = pbs::block_step(pbs::vertex_block(stars[i], i, x, body.centres)).norm();
        worst = std::max(worst, 2.0 * unit * terms * (gradient + hessian * step) / stars[i].diagonal);
    }
    return worst +
           unit * (body.bent.mesh.rest.colwise().maxCoeff() - body.bent.mesh.rest.colwise().minCoeff()).maxCoeff();
}

template <typename Scalar>
Positions positions_after(pbs::VertexSweep<Scalar>& sweep, const HeldBar& body, Positions x, int sweeps)
{
    pbs::Rows<Scalar> rows = sweep.rows();
    sweep.set_centres(body.centres);
    sweep.load(x, rows);
    for (int k = 0; k < sweeps; ++k) sweep.move(1.85, rows);
    sweep.store(rows, x);
    return x;
}

// Sweeps of vertex block descent.
struct VertexSweeps {
    explicit VertexSweeps(const HeldBar& held) : bar(held) {}

    template <typename Scalar>
    Positions swept(bool packed, int threads, const Positions& x, int sweeps) const
    {
        return positions_after<Scalar>(*pbs::make_vertex_sweep<Scalar>(bar.bent.mesh, bar.energy, packed, threads), bar,
                                       x, sweeps);
    }
    template <typename Scalar>
    std::vector<Positions> results(int threads, const Positions& x) const
    {
        return {swept<Scalar>(true, threads, x, 2)};
    }

    // How a sweep magnifies the roundings is measured: by moving each coordinate by as much.
    template <typename Scalar>
    void expect_equal_to_plain(const Positions& x) const
    {
        for (const int sweeps : sizeof(Scalar) == 4 ? std::vector{1} : std::vector{1, 3, 10}) {
            const auto plain = [&](const Positions& p) { return swept<double>(false, 1, p, sweeps); };
            const Positions expected = plain(x);
            const double tolerance =
                sweeps * test_support::value_rounding(x, step_rounding(bar, x, epsilon<Scalar> / 2.0),
                                                      [&](const Positions& p) { return (plain(p) - expected).norm(); });
            EXPECT_LE((swept<Scalar>(true, 1, x, sweeps) - expected).norm(), tolerance) << sweeps << " sweeps";
            EXPECT_GT((expected - x).norm(), 20.0 * tolerance) << "the sweep moves the body by more than roundings";
        }
    }

    HeldBar bar;
};

// Passes of XPBD with neo-Hookean constraints.
struct XpbdPasses {
    explicit XpbdPasses(const HeldBar& held) : bar(held) {}

    template <typename Scalar>
    auto system(int threads) const
    {
        return pbs::make_xpbd_system<Scalar>(bar.bent.mesh, bar.flesh, true, threads);
    }
    template <typename Scalar>
    Positions iterated(pbs::XpbdSystem<Scalar>& system, const Positions& from, int times, bool with_residual) const
    {
        pbs::Rows<Scalar> rows = system.rows();
        system.set_targets(bar.targets);
        system.load(from, rows);
        for (int k = 0; k < times; ++k) system.iterate(rows, with_residual);
        Positions x;
        system.store(rows, x);
        return x;
    }
    template <typename Scalar>
    std::vector<Positions> results(int threads, const Positions& x) const
    {
        return {iterated<Scalar>(*system<Scalar>(threads), x, 3, true)};
    }

    // The plain system visits the constraints in the same order. A visit rounds each of its quantities some 100 times,
    // and moves vertices of at most 2 m by sums of them. Each of the some 25 tets and springs at a vertex passes errors
    // on, enlarged by at most the condition number of its 2 x 2 system, which is below 10 here.
    template <typename Scalar>
    void expect_equal_to_plain(const Positions& x) const
    {
        for (const bool with_residual : {false, true}) {
            const auto by_sixteen = system<Scalar>(1);
            pbs::PlainXpbd plain(bar.flesh, by_sixteen->visits());
            const Positions expected = iterated<double>(plain, x, 2, with_residual);
            const double tolerance = 100 * 25 * 2 * epsilon<Scalar>;
            EXPECT_LE((iterated<Scalar>(*by_sixteen, x, 2, with_residual) - expected).cwiseAbs().maxCoeff(), tolerance)
                << with_residual;
            EXPECT_GT((expected - x).cwiseAbs().maxCoeff(), 10.0 * tolerance);
        }
    }

    test_support::HeldXpbd bar;
};

template <typename System>
class PackedSystem : public testing::Test {
protected:
    static const System& bent()
    {
        static const System system(HeldBar({10, 3, 3}));
        return system;
    }
    static const Positions& lbs() { return bent().bar.bent.lbs; }

    template <typename Scalar>
    static void expect_same_bits(const System& system)
    {
        const Positions x = test_support::jittered(system.bar.bent.lbs, 0.002);
        const std::vector<Positions> expected = system.template results<Scalar>(1, x);
        for (const int threads : {1, 2, 4})
            EXPECT_EQ(system.template results<Scalar>(threads, x), expected) << threads << " threads";
    }
};
using Systems = testing::Types<FleshEvaluation, ProjectiveEvaluation, VertexSweeps, XpbdPasses>;
TYPED_TEST_SUITE(PackedSystem, Systems);

TYPED_TEST(PackedSystem, EqualsPlainInDouble)
{
    this->bent().template expect_equal_to_plain<double>(test_support::jittered(this->lbs(), 0.01));
}

TYPED_TEST(PackedSystem, EqualsPlainInFloat)
{
    this->bent().template expect_equal_to_plain<float>(test_support::jittered(this->lbs(), 0.01));
}

TYPED_TEST(PackedSystem, EqualsPlainInFloatFarFromTheOrigin)
{
    const TypeParam system(HeldBar({10, 3, 3}, {1000.0, -500.0, 200.0}));
    system.template expect_equal_to_plain<float>(test_support::jittered(system.bar.bent.lbs, 0.01));
}

// In fifteen lanes there is no tet, and most vertices have none.
TYPED_TEST(PackedSystem, EqualsPlainOnOneTet)
{
    const TypeParam system(HeldBar::one_tet({10, 3, 3}));
    system.template expect_equal_to_plain<double>(test_support::jittered(system.bar.bent.lbs, 0.01));
}

TYPED_TEST(PackedSystem, ACollapsedBodyStaysFinite)
{
    const Positions point = Positions::Zero(this->lbs().rows(), 3);
    for (const Positions& result : this->bent().template results<float>(1, point)) EXPECT_TRUE(result.allFinite());
}

// 17,629 vertices: enough slabs, and chunks of a colour, for several threads.
TYPED_TEST(PackedSystem, NeitherThreadsNorRepetitionChangeABit)
{
    const TypeParam system(HeldBar({60, 16, 16}));
    const int vertices = system.bar.vertices();
    ASSERT_GE(vertices, 16384);
    ASSERT_GE(pbs::order_vertices(system.bar.bent.mesh.tets, vertices, pbs::vertices_a_slab(vertices)).slabs(), 4);
    this->template expect_same_bits<float>(system);
    this->template expect_same_bits<double>(system);
}

const HeldBar bent_bar({10, 3, 3});

// Inverted and crushed tets, and tets of many times their volume: what the formulae refuse goes to the plain code.
TEST(PackedProjective, EqualsPlainInAnyState)
{
    const Positions &lbs = bent_bar.bent.lbs, &rest = bent_bar.bent.mesh.rest;
    Positions flat = lbs;
    flat.col(2) *= 1e-3;
    const int tets = static_cast<int>(bent_bar.bent.mesh.tets.rows());
    struct Case {
        const char* name;
        Positions x;
        int fewest_refused, most_refused;
    };
    for (const bool keeps_volume : {true, false}) {
        const ProjectiveEvaluation flesh(bent_bar, keeps_volume);
        for (const auto& [name, x, fewest, most] :
             {Case{"lbs", lbs, 0, 0}, Case{"jittered", test_support::jittered(lbs, 0.01), 0, 0},
              Case{"rest", rest, 0, 0}, Case{"torn", test_support::jittered(lbs, 0.2), 1, tets},
              Case{"flat", flat, 0, tets}, Case{"collapsed", Positions::Zero(lbs.rows(), 3), tets, tets}}) {
            SCOPED_TRACE(name);
            for (const int refused : {flesh.expect_equal_to_plain<double>(x), flesh.expect_equal_to_plain<float>(x)}) {
                EXPECT_GE(refused, fewest);
                EXPECT_LE(refused, most);
            }
        }
    }
}

TEST(PackedVertexSweep, EqualsPlainFromLbsAndOnInvertedTets)
{
    const VertexSweeps sweeps(bent_bar);
    for (const Positions& x : {bent_bar.bent.lbs, test_support::mirrored(bent_bar.bent.lbs)})
        sweeps.expect_equal_to_plain<double>(x);
}

// The position of the vertex is exact in float; packed code subtracts its origin and adds it.
TEST(PackedVertexSweep, AVertexWithoutTetsStays)
{
    test_support::TwoBoneLimb limb = bent_bar.bent;
    const Eigen::Index last = limb.mesh.rest.rows();
    limb.mesh.rest.conservativeResize(last + 1, 3);
    limb.mesh.rest.row(last) << 0.5, 2.0, -1.0;
    const VertexSweeps sweeps(HeldBar(limb, test_support::springs_at(Vec3::Zero())));
    const Positions& rest = limb.mesh.rest;
    EXPECT_EQ(sweeps.swept<double>(false, 1, rest, 1).row(last), rest.row(last));
    const Positions found = sweeps.swept<double>(true, 1, rest, 1);
    EXPECT_LE((found.row(last) - rest.row(last)).cwiseAbs().maxCoeff(), test_support::coordinate_rounding_m(rest, 2.0));
    EXPECT_GT((found - rest).norm(), 0.01);
}

TEST(PackedVertexSweep, ExtrapolatesAsPlainDoes)
{
    const HeldBar body({4, 2, 2});
    const Positions &before = body.bent.mesh.rest, &x = body.bent.lbs, expected = before + 1.5 * (x - before);
    for (const bool packed : {false, true}) {
        const auto sweep = pbs::make_vertex_sweep<double>(body.bent.mesh, body.energy, packed, 1);
        sweep->set_centres(body.centres);
        pbs::Rows<double> of_before = sweep->rows(), of_x = sweep->rows();
        sweep->load(before, of_before);
        sweep->load(x, of_x);
        sweep->extrapolate(1.5, of_before, of_x);
        Positions found;
        sweep->store(of_x, found);
        EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), test_support::coordinate_rounding_m(x, 12.0));
    }
}

TEST(PackedXpbd, VisitsEveryConstraintOnce)
{
    const XpbdPasses passes(HeldBar({44, 8, 8}));
    std::set<std::pair<bool, int>> expected, found;
    for (const pbs::XpbdVisit& visit : pbs::PlainXpbd(passes.bar.flesh).visits())
        expected.insert({visit.is_hold, visit.tet});
    const std::vector<pbs::XpbdVisit> visits = passes.system<float>(1)->visits();
    for (const pbs::XpbdVisit& visit : visits) found.insert({visit.is_hold, visit.tet});
    EXPECT_EQ(found, expected);
    EXPECT_EQ(visits.size(), expected.size());
}

}  // namespace
}  // namespace packed_systems_tests
