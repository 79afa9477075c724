// Reference: the plain implementation of the same sweep.
#include "pbs/flesh/vbd.hpp"

#include "tests/support/four_threads.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/measured_condition.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Positions;
using pbs::Vec3;

struct Body {
    explicit Body(const std::array<int, 3>& cells, const Vec3& joint = Vec3::Zero(), int springs = 60)
        : bent(test_support::two_bone_limb(cells, Vec3::UnitZ(), 70.0, joint)),
          hold(bent.mesh, test_support::springs_at(joint, springs), 2),
          energy(bent.mesh, pbs::flesh_material(0.45), hold)
    {
        hold.centres(bent.pose, centres);
    }
    test_support::TwoBoneLimb bent;
    pbs::BoneHold hold;
    pbs::FleshEnergy energy;
    Positions centres;
};

template <typename Scalar>
Positions swept(pbs::VertexSweep<Scalar>& sweep, const Body& body, Positions x, int sweeps = 1, double omega = 1.85)
{
    pbs::Rows<Scalar> rows = sweep.rows();
    sweep.set_centres(body.centres);
    sweep.load(x, rows);
    for (int k = 0; k < sweeps; ++k) sweep.move(omega, rows);
    sweep.store(rows, x);
    return x;
}

// By how much roundings may change the new position of any one vertex, the others given [m]. A sum of n terms is in error by n roundings of
// the sum of their magnitudes, and a term has a dozen itself: this for the gradient, over the least eigenvalue of the block, and for the
// block, times the step. Positions are rounded relative to the body's own size.
double step_rounding(const Body& body, const Positions& x, double unit)
{
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(body.energy);
    double worst = 0.0;
    for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
        if (stars[i].tets.empty()) continue;
        const double terms = 4.0 * static_cast<double>(stars[i].tets.size()) + 12.0;
        double gradient = stars[i].hold * (x.row(i) - body.centres.row(i)).norm(), hessian = stars[i].diagonal;
        for (const pbs::IncidentTet& tet : stars[i].tets) {
            const Vec3 a = x.row(tet.other[0]) - x.row(i), b = x.row(tet.other[1]) - x.row(i), c = x.row(tet.other[2]) - x.row(i);
            const double face = (b - a).norm() * (c - a).norm();
            gradient += std::abs(tet.w[0]) * a.norm() + std::abs(tet.w[1]) * b.norm() + std::abs(tet.w[2]) * c.norm();
            gradient += tet.kappa * (face * a.norm() + tet.d) * face;
            hessian += tet.kappa * face * face;
        }
        const double step = pbs::block_step(pbs::vertex_block(stars[i], i, x, body.centres)).norm();
        worst = std::max(worst, 2.0 * unit * terms * (gradient + hessian * step) / stars[i].diagonal);
    }
    return worst + unit * (body.bent.mesh.rest.colwise().maxCoeff() - body.bent.mesh.rest.colwise().minCoeff()).maxCoeff();
}

// How a sweep magnifies the roundings is measured: by moving each coordinate by as much.
template <typename Scalar>
void expect_equal_to_plain(const Body& body, const Positions& x, const std::vector<int>& numbers_of_sweeps)
{
    pbs::PlainVertexSweep plain(body.bent.mesh, body.energy);
    pbs::PackedVertexSweep<Scalar> packed(body.bent.mesh, body.energy, 1);
    for (const int sweeps : numbers_of_sweeps) {
        const Positions expected = swept<double>(plain, body, x, sweeps);
        const double tolerance =
            sweeps *
            test_support::value_rounding(x, step_rounding(body, x, double(std::numeric_limits<Scalar>::epsilon()) / 2.0),
                                         [&](const Positions& p) { return (swept<double>(plain, body, p, sweeps) - expected).norm(); });
        const double difference = (swept<Scalar>(packed, body, x, sweeps) - expected).norm();
        EXPECT_LE(difference, tolerance) << sweeps << " sweeps";
        EXPECT_GT((expected - x).norm(), 20.0 * tolerance) << "the sweep moves the body by more than roundings";
    }
}

TEST(PackedVertexSweep, EqualsPlainInDouble)
{
    const Body body({10, 3, 3});
    expect_equal_to_plain<double>(body, body.bent.lbs, {1, 3, 10});
    expect_equal_to_plain<double>(body, test_support::jittered(body.bent.lbs, 0.02), {1, 3, 10});
}

TEST(PackedVertexSweep, EqualsPlainInFloat)
{
    const Body body({10, 3, 3});
    expect_equal_to_plain<float>(body, test_support::jittered(body.bent.lbs, 0.02), {1});
}

TEST(PackedVertexSweep, EqualsPlainInFloatFarFromTheOrigin)
{
    const Body body({10, 3, 3}, {1000.0, -500.0, 200.0});
    expect_equal_to_plain<float>(body, test_support::jittered(body.bent.lbs, 0.02), {1});
}

TEST(PackedVertexSweep, EqualsPlainOnInvertedTets)
{
    const Body body({10, 3, 3});
    Positions mirrored = body.bent.lbs;
    mirrored.col(2) *= -1.0;
    expect_equal_to_plain<double>(body, mirrored, {1, 3, 10});
}

TEST(PackedVertexSweep, EqualsPlainOnOneTet)
{
    Body body({10, 3, 3});
    body.bent.mesh.tets = pbs::Tets(body.bent.mesh.tets.topRows(1));  // and 175 vertices without tets
    pbs::BoneSprings spring{Positions(1, 3), Eigen::VectorXd::Constant(1, 1.0), {1}};
    spring.points.row(0).setZero();
    for (const int v : body.bent.mesh.tets.row(0)) spring.points.row(0) += body.bent.mesh.rest.row(v) / 4.0;
    body.hold = pbs::BoneHold(body.bent.mesh, spring, 2);
    body.energy = pbs::FleshEnergy(body.bent.mesh, pbs::flesh_material(0.45), body.hold);
    body.hold.centres(body.bent.pose, body.centres);
    expect_equal_to_plain<double>(body, body.bent.mesh.rest, {1, 3, 10});
}

TEST(PackedVertexSweep, AVertexWithoutTetsStays)
{
    Body body({10, 3, 3});
    const Eigen::Index last = body.bent.mesh.rest.rows();
    body.bent.mesh.rest.conservativeResize(last + 1, 3);
    body.bent.mesh.rest.row(last) << 0.5, 2.0, -1.0;  // exact in float
    body.hold = pbs::BoneHold(body.bent.mesh, test_support::random_springs(60, 0.3), 2);
    body.energy = pbs::FleshEnergy(body.bent.mesh, pbs::flesh_material(0.45), body.hold);
    body.hold.centres(body.bent.pose, body.centres);
    pbs::PackedVertexSweep<double> packed(body.bent.mesh, body.energy, 1);
    pbs::PlainVertexSweep plain(body.bent.mesh, body.energy);
    const Positions& rest = body.bent.mesh.rest;
    EXPECT_EQ(swept<double>(plain, body, rest).row(last), rest.row(last));
    const double of_origin = test_support::coordinate_rounding_m(rest, 2.0);  // which is subtracted and added
    EXPECT_LE((swept<double>(packed, body, rest).row(last) - rest.row(last)).cwiseAbs().maxCoeff(), of_origin);
    EXPECT_GT((swept<double>(packed, body, rest) - rest).norm(), 0.01);
}

TEST(PackedVertexSweep, CollapsedToAPointStaysFiniteInFloat)
{
    const Body body({10, 3, 3});
    const Positions point = Positions::Zero(body.bent.mesh.rest.rows(), 3);
    pbs::PackedVertexSweep<float> packed(body.bent.mesh, body.energy, 1);
    EXPECT_TRUE(swept<float>(packed, body, point, 10).allFinite());
    pbs::PlainVertexSweep plain(body.bent.mesh, body.energy);
    EXPECT_TRUE(swept<double>(plain, body, point, 10).allFinite());
}

TEST(PackedVertexSweep, ExtrapolatesAsPlainDoes)
{
    const Body body({4, 2, 2});
    pbs::PlainVertexSweep plain(body.bent.mesh, body.energy);
    pbs::PackedVertexSweep<double> packed(body.bent.mesh, body.energy, 1);
    const Positions &before = body.bent.mesh.rest, &x = body.bent.lbs, expected = before + 1.5 * (x - before);
    for (pbs::VertexSweep<double>* sweep :
         {static_cast<pbs::VertexSweep<double>*>(&plain), static_cast<pbs::VertexSweep<double>*>(&packed)}) {
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

template <typename Scalar>
void expect_threads_to_sweep_alike(const Body& body)
{
    const Positions x = test_support::jittered(body.bent.lbs, 0.002);
    pbs::PackedVertexSweep<Scalar> alone(body.bent.mesh, body.energy, 1);
    const Positions expected = swept<Scalar>(alone, body, x, 2);
    for (const int threads : {2, 4}) {
        pbs::PackedVertexSweep<Scalar> shared(body.bent.mesh, body.energy, threads);
        EXPECT_EQ(swept<Scalar>(shared, body, x, 2), expected) << threads;
    }
}

// 17,629 vertices, some 9 colours: chunks for several threads.
TEST(PackedVertexSweep, ThreadsChangeNoBit)
{
    const Body body({60, 16, 16});
    ASSERT_GE(body.bent.mesh.rest.rows(), 16384);
    expect_threads_to_sweep_alike<float>(body);
    expect_threads_to_sweep_alike<double>(body);
}

}  // namespace
