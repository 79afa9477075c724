// The skeleton's attachment. Reference: exact Dirichlet data, which springs approach with an error of order 1/q; rigid
// translations, which the finite element space contains and the springs therefore reproduce without strain, and the
// linear parts of rotations; equilibrium of forces; another path to the same minimum; the free flesh alone. Tolerances:
// rounding of direct solves. At nu = 0.4999 cond(K) is 7e7 with mean dilatation, since lambda / mu = 5e3 multiplies
// that of the compressible material, and 3e4 with Taylor-Hood.
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>

#include <limits>
#include <numeric>
#include <set>

namespace attachment_tests {
namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_of;
using test_support::SolveRounding;

constexpr double young_pa = 1e5, incompressible = 0.4999;
constexpr const char* proves_nothing = "a bound that would let an error of a percent pass proves nothing";

// 2 x 0.5 x 0.5 m.
pbs::TetMesh jittered_bar(int cells_across)
{
    const double cell_m = 0.5 / cells_across;
    return test_support::jittered(test_support::structured_bar({0, -0.25, -0.25}, {2, 0.25, 0.25},
                                                               {4 * cells_across, cells_across, cells_across}),
                                  Vec3::Constant(cell_m), 0.25);
}

constexpr double cell_m = 0.125, coarse_cell_m = 0.25;
const pbs::TetMesh bar = jittered_bar(4), coarse = jittered_bar(2);

// All tets whose corners satisfy a condition.
template <typename Condition>
std::vector<int> tets_where(const pbs::TetMesh& mesh, const Condition& condition)
{
    std::vector<int> tets;
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        const auto corners = mesh.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return condition(Vec3(mesh.rest.row(v))); }))
            tets.push_back(t);
    }
    return tets;
}

// Whole tets within about one cell of the ends, as the skeleton prescribes them.
const std::vector<int> end_tets =
    tets_where(bar, [](const Vec3& x) { return x(0) < cell_m + 1e-3 || x(0) > 2.0 - cell_m - 1e-3; });

// Those of the coarse bar at one end.
const std::vector<int> held_tets = tets_where(coarse, [](const Vec3& x) { return x(0) < 1.3 * coarse_cell_m; });

Attachment holding(const std::vector<int>& tets)
{
    return {.prescribed_tets = tets};
}

Attachment tied(const Positions& points, double stiffness_n_m)
{
    return {points, Eigen::VectorXd::Constant(points.rows(), stiffness_n_m), {}};
}

// The positions of all nodes of these tets.
Positions nodes_of(const pbs::TetMesh& mesh, const std::vector<int>& tets, int element_order)
{
    const SimplexSpace space(mesh, element_order);
    std::set<int> nodes;
    for (const int t : tets)
        for (const int node : space.tet_nodes().row(t)) nodes.insert(node);
    return space.node_positions()(std::vector<int>(nodes.begin(), nodes.end()), Eigen::all);
}

// The far end turned by 10 degrees about the axis and pulled.
Positions posed(const Positions& points)
{
    const Eigen::AngleAxisd turn(10.0 * std::acos(-1.0) / 180.0, Vec3::UnitX());
    Positions targets = points;
    for (auto point : targets.rowwise())
        if (point(0) > 1.0) point = (turn * Vec3(point.transpose()) + Vec3(0.05, 0, 0)).transpose();
    return targets;
}

class SpringAttachment : public testing::TestWithParam<int> {};

TEST_P(SpringAttachment, ApproachesExactDirichletDataWithOneOverQ)
{
    const int order = GetParam();
    LinearElasticity exact(bar, {.element_order = order, .young_pa = young_pa}, holding(end_tets));
    ASSERT_TRUE(exact.solve(Positions(0, 3), posed(bar.rest)).finite);
    const double size = (exact.positions() - bar.rest).norm();

    const Positions nodes = nodes_of(bar, end_tets, order);
    std::vector<double> errors;
    for (const double q : {1e2, 1e3, 1e4}) {
        LinearElasticity by_springs(bar, {.element_order = order, .young_pa = young_pa},
                                    tied(nodes, q * young_pa * cell_m));
        ASSERT_TRUE(by_springs.solve(posed(nodes), bar.rest).finite);
        errors.push_back((by_springs.positions() - exact.positions()).norm() / size);
        RecordProperty("relative_error_at_q_" + std::to_string(static_cast<int>(q)),
                       std::to_string(errors.back() * 1e6) + "e-6");
    }
    // error = c / q (1 - d / q + ...), where d, of order 10, is the stiffness of the flesh at a tied node over E h. The
    // ratio of two errors whose q differ by a factor of ten is 10 to within d / q of the softer.
    EXPECT_NEAR(errors[0] / errors[1], 10.0, 1.0);
    EXPECT_NEAR(errors[1] / errors[2], 10.0, 0.1);
    EXPECT_LT(errors[2], 1e-4);
}

TEST_P(SpringAttachment, RepeatsARigidTranslation)
{
    const Positions nodes = nodes_of(bar, end_tets, 1);
    const Attachment attachment = tied(nodes, 1e4 * young_pa * cell_m);
    const LinearOptions options{.element_order = GetParam(), .young_pa = young_pa};
    LinearElasticity fem(bar, options, attachment);
    const Eigen::RowVector3d shift(3.0, -2.0, 1.0);
    ASSERT_TRUE(fem.solve(nodes.rowwise() + shift, bar.rest).finite);
    const SolveRounding rounding = rounding_of(fem, bar, options, attachment);
    EXPECT_LT((fem.positions() - (bar.rest.rowwise() + shift)).norm(), rounding.error_m());
    EXPECT_LT(rounding.relative(), 1e-5) << proves_nothing;
    EXPECT_LT(fem.strain_energy_j(), rounding.energy_j());
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, SpringAttachment, testing::Values(1, 2));

LinearOptions options_of(Formulation formulation)
{
    return {.young_pa = young_pa, .poisson = incompressible, .formulation = formulation};
}

class Attached : public testing::TestWithParam<LinearOptions> {};

// Reference: theory. The linear part of a rotation, x + w x x, has no strain and no stress: if it is prescribed at one
// end, the whole bar follows.
TEST_P(Attached, AnInfinitesimalRotationIsFollowedWithoutStrain)
{
    const Attachment attachment = holding(held_tets);
    LinearElasticity fem(coarse, GetParam(), attachment);
    const Vec3 axis(0.3, -0.2, 0.5);
    Positions targets = coarse.rest;
    for (auto point : targets.rowwise()) point += axis.cross(Vec3(point.transpose())).transpose();
    ASSERT_TRUE(fem.solve(Positions(0, 3), targets).finite);
    const SolveRounding rounding = rounding_of(fem, coarse, GetParam(), attachment);
    EXPECT_LT((fem.positions() - targets).norm(), rounding.error_m());
    EXPECT_LT(fem.strain_energy_j(), rounding.energy_j());
    EXPECT_LT(rounding.relative(), 1e-5) << proves_nothing;
}

// Reference: equilibrium of forces, which is exact since translations are in the space: the springs carry the weight.
TEST_P(Attached, SpringsCarryTheWeight)
{
    const Positions points{{0.1, 0, 0}, {0.3, 0.1, 0}, {0.2, 0, -0.1}, {1.9, 0, 0}, {1.7, 0.1, 0}, {1.8, 0, -0.1}};
    const double k = 1e2 * young_pa * coarse_cell_m;
    const Attachment attachment = tied(points, k);
    LinearOptions options = GetParam();
    options.gravity_m_s2 = {1.0, -2.0, -9.81};
    LinearElasticity fem(coarse, options, attachment);
    ASSERT_TRUE(fem.solve(points, coarse.rest).finite);
    const Vec3 reaction = k * (points - fem.spring_points_deformed()).colwise().sum().transpose();
    const Vec3 weight = options.density_kg_m3 * 0.5 * options.gravity_m_s2;  // 2 x 0.5 x 0.5 m^3
    // The force due to the residual, and the rounding of stretches, which are differences of positions of 2 m.
    const SolveRounding rounding = rounding_of(fem, coarse, options, attachment);
    const int nodes = static_cast<int>(fem.displacement().size()) / 3;
    const double of_stretches = k * 2.0 * std::numeric_limits<double>::epsilon() * std::sqrt(3.0 * points.rows());
    EXPECT_LT((reaction + weight).norm(), rounding.force_n(nodes) + of_stretches);
    EXPECT_LT(rounding.force_n(nodes), 1e-4 * weight.norm()) << proves_nothing;
}

INSTANTIATE_TEST_SUITE_P(Elements, Attached,
                         testing::Values(LinearOptions{.element_order = 1, .young_pa = young_pa},
                                         LinearOptions{.young_pa = young_pa}, options_of(Formulation::mean_dilatation),
                                         options_of(Formulation::taylor_hood)));

// Reference: another path to the same minimum, Newton's method on the potential of the same energy.
TEST(NearIncompressibleAttachment, MeanDilatationIsThatOfTheElasticBody)
{
    const Attachment attachment = holding(held_tets);
    const Vec3 gravity(0, 0, -9.81);
    LinearOptions options = options_of(Formulation::mean_dilatation);
    options.gravity_m_s2 = gravity;
    LinearElasticity kept(coarse, options, attachment);
    kept.solve(Positions(0, 3), coarse.rest);
    ElasticBody newton(coarse,
                       {.model = Model::linear,
                        .formulation = Formulation::mean_dilatation,
                        .young_pa = young_pa,
                        .poisson = incompressible,
                        .newton = {},
                        .path = {}},
                       attachment);
    ASSERT_TRUE(newton.solve([&](double) { return Targets{Positions(0, 3), coarse.rest, {}}; }, gravity).converged());
    // One linear solve meets Newton's tolerance of 1e-8 on the forces, so there are two solves with rounding errors.
    const SolveRounding rounding = rounding_of(kept, coarse, options, attachment);
    EXPECT_LT((kept.positions() - newton.positions()).norm(), 2.0 * rounding.error_m());
    EXPECT_NEAR(kept.strain_energy_j(), newton.strain_energy_j(), 2.0 * rounding.energy_j(newton.strain_energy_j()));
}

// Reference: the boundary value problem of the free flesh alone, with the nodes at the held tets prescribed. The
// prescribed state of the tets, here an expansion by 3 s, shares no pressure with the adjacent flesh. It contributes to
// the energy, V (lambda / 2 (3 s)^2 + 3 mu s^2).
TEST(NearIncompressibleAttachment, HeldTetsActByTheirNodesAlone)
{
    pbs::TetMesh free = box_mesh({coarse_cell_m, -0.25, -0.25}, {2, 0.25, 0.25}, {7, 2, 2});
    const pbs::TetMesh whole =
        test_support::jittered(joined({free, box_mesh({0, -0.25, -0.25}, {coarse_cell_m, 0.25, 0.25}, {1, 2, 2})}),
                               // in which the free flesh comes first
                               Vec3::Constant(coarse_cell_m), 0.25);
    free.rest = whole.rest.topRows(free.rest.rows());
    Attachment held = holding(std::vector<int>(whole.tets.rows() - free.tets.rows()));
    std::iota(held.prescribed_tets.begin(), held.prescribed_tets.end(), static_cast<int>(free.tets.rows()));

    const double swelling = 0.01;
    const auto swollen = [&](const Vec3& x) -> Vec3 { return swelling * x; };
    const LinearOptions options = options_of(Formulation::taylor_hood);
    LinearElasticity fem(whole, options, held);
    ASSERT_TRUE(fem.solve(Positions(0, 3), (1.0 + swelling) * whole.rest).finite);

    const double held_volume = pbs::tet_volumes(whole.rest, whole.tets)(held.prescribed_tets).sum();
    const Positions held_nodes = nodes_of(whole, held.prescribed_tets, 2);
    const auto is_held_node = [&](const Vec3& x) {
        return (held_nodes.rowwise() - x.transpose()).rowwise().norm().minCoeff() < 1e-9;
    };
    const ElasticMaterial material{young_pa, incompressible};
    const BoundaryValueSolution alone =
        solve(free, material, {.displacement = swollen, .held = is_held_node, .formulation = Formulation::taylor_hood});

    const SolveRounding of_bar = rounding_of(fem, whole, options, held), of_part = rounding_of(alone, material);
    const double error_m = of_bar.error_m() + of_part.error_m();
    const Lame lame = lame_parameters(young_pa, incompressible);
    const double pressure_unit_pa = LinearFlesh(*alone.space, lame, Formulation::taylor_hood).pressure_unit_pa();
    double squares = 0.0;
    for (Eigen::Index v = 0; v < free.rest.rows(); ++v) {
        const Vec3 moved = fem.positions().row(v) - whole.rest.row(v);
        squares += (moved - alone.displacement.segment<3>(3 * v)).squaredNorm();
        EXPECT_NEAR(fem.pressure_pa()(v), alone.pressure_pa(v), error_m * pressure_unit_pa);
    }
    EXPECT_LT(std::sqrt(squares), error_m);
    EXPECT_LT(error_m, 1e-6 * swelling) << proves_nothing;
    const double of_held = held_volume * swelling * swelling * (4.5 * lame.lambda_pa + 3.0 * lame.mu_pa);
    const double energy = alone.strain_energy_j(material) + of_held;
    EXPECT_NEAR(fem.strain_energy_j(), energy, of_bar.energy_j(energy) + of_part.energy_j(energy));
}

// Reference: theory. Linear strain interprets the rotation x -> R x by theta as the strain (R + R^T) / 2 - I, which is
// cos(theta) - 1 across the axis: a fictitious stress. This is why the linear reference is only a negative control
// beyond some 10 degrees, and how large its error is.

const LinearOptions linear_tets{.element_order = 1, .young_pa = young_pa, .poisson = 0.3};

pbs::TetMesh long_bar(int cells_across)
{
    return test_support::structured_bar({-2, -0.25, -0.25}, {2, 0.25, 0.25},
                                        {8 * cells_across, cells_across, cells_across});
}

Positions rotated(const Positions& points, double angle)
{
    return points * Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix().transpose();
}

class RigidRotation : public testing::TestWithParam<double> {};

// All tets are prescribed: the map is x -> R x, its volume is correct, its stress is fictitious: V (2 lambda + 2 mu) (1
// - cos theta)^2.
TEST_P(RigidRotation, StoresFictitiousEnergy)
{
    const double angle = GetParam() * std::acos(-1.0) / 180.0;
    const pbs::TetMesh mesh = long_bar(2);
    const std::vector<int> all = tets_where(mesh, [](const Vec3&) { return true; });
    for (const int order : {1, 2}) {
        LinearElasticity fem(mesh, {.element_order = order, .young_pa = young_pa, .poisson = linear_tets.poisson},
                             holding(all));
        ASSERT_TRUE(fem.solve(Positions(0, 3), rotated(mesh.rest, angle)).finite);
        // Positions are the sum of the rest and a difference from it: two roundings each.
        constexpr double eps = std::numeric_limits<double>::epsilon();
        EXPECT_LT((fem.positions() - rotated(mesh.rest, angle)).norm(), 2.0 * eps * mesh.rest.norm());
        const double lambda_plus_mu =
            linear_tets.young_pa / (2.0 * (1.0 + linear_tets.poisson) * (1.0 - 2.0 * linear_tets.poisson));
        const double strain = 1.0 - std::cos(angle), volume = pbs::tet_volumes(mesh.rest, mesh.tets).sum();
        const double energy = volume * 2.0 * lambda_plus_mu * strain * strain;
        EXPECT_GT(energy, 0.0);
        // Each component of the gradient sums ten nodes' displacements, in error by eps times their 2 m, over at least
        // a quarter of a cell of 0.25 m. The energy is quadratic in the strain, which that error is relative to.
        const double of_gradient = std::sqrt(10.0) * eps * 2.0 / (0.25 / 4.0);
        EXPECT_NEAR(fem.strain_energy_j(), energy, 2.0 * of_gradient / strain * energy);
    }
}

// Both ends are turned equally, and the rest is free. Far from the ends the flesh loses the fictitious strain and keeps
// only the skew part of R, so F = I + sin(theta) J and the volume ratio is 1 + sin^2(theta) instead of 1. The effect of
// the compressed ends on the middle: they are compressed by 1 - cos(theta) over about a width w and tend to lengthen by
// at most that strain, which the length L shares between two fixed ends: below (1 - cos(theta)) w / L. (The rest of
// their influence decays like exp(-4 s / w) with the distance s.)
TEST_P(RigidRotation, SwellsFreeFleshBySineSquared)
{
    const double angle = GetParam() * std::acos(-1.0) / 180.0;
    const pbs::TetMesh mesh = long_bar(4);
    const Attachment ends = holding(tets_where(mesh, [](const Vec3& x) { return std::abs(x(0)) > 1.85; }));
    const std::vector<int> middle = tets_where(mesh, [](const Vec3& x) { return std::abs(x(0)) < 0.15; });
    LinearElasticity fem(mesh, linear_tets, ends);
    ASSERT_TRUE(fem.solve(Positions(0, 3), rotated(mesh.rest, angle)).finite);
    const Eigen::VectorXd ratio =
        pbs::tet_volumes(fem.positions(), mesh.tets).cwiseQuotient(pbs::tet_volumes(mesh.rest, mesh.tets));
    const double sine = std::sin(angle), strain = 1.0 - std::cos(angle);
    ASSERT_FALSE(middle.empty());
    for (const int t : middle) EXPECT_NEAR(ratio(t), 1.0 + sine * sine, strain * 0.5 / 4.0) << "tet " << t;
}

INSTANTIATE_TEST_SUITE_P(Degrees, RigidRotation, testing::Values(1.0, 10.0, 45.0));

}  // namespace
}  // namespace attachment_tests
