// The formulations for near incompressibility with the skeleton's attachment, nu = 0.4999. Tolerances: rounding of direct solves. With mean
// dilatation cond(K) is 7e7, since lambda / mu = 5e3 multiplies that of the compressible material; with Taylor-Hood it is 3e4.
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include "tests/support/solve_rounding.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <map>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_of;
using test_support::SolveRounding;

constexpr double young_pa = 1e5, poisson = 0.4999, cell_m = 0.25;
const pbs::TetMesh bar =
    test_support::jittered(test_support::structured_bar({0, -0.25, -0.25}, {2, 0.25, 0.25}, {8, 2, 2}), Vec3::Constant(cell_m), 0.25);

// All tets whose corners are at most at x along the bar.
std::vector<int> tets_up_to(double x)
{
    std::vector<int> tets;
    for (int t = 0; t < bar.tets.rows(); ++t) {
        const auto corners = bar.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return bar.rest(v, 0) < x; })) tets.push_back(t);
    }
    return tets;
}

Attachment holding(const std::vector<int>& tets)
{
    return {.spring_points = Positions(0, 3), .spring_stiffness = {}, .prescribed_tets = tets, .bind_distance = {}, .bind_stiffness = {}};
}

LinearOptions options_of(Formulation formulation)
{
    return {.young_pa = young_pa, .poisson = poisson, .formulation = formulation};
}

class Attached : public testing::TestWithParam<Formulation> {};

// Reference: theory. The linear part of a rotation, x + w x x, has no strain and no stress: if it is prescribed at one end, the whole bar
// follows.
TEST_P(Attached, AnInfinitesimalRotationIsFollowedWithoutStrain)
{
    const Attachment attachment = holding(tets_up_to(1.3 * cell_m));
    LinearElasticity fem(bar, options_of(GetParam()), attachment);
    const Vec3 axis(0.3, -0.2, 0.5);
    Positions targets = bar.rest;
    for (auto point : targets.rowwise()) point += axis.cross(Vec3(point.transpose())).transpose();
    ASSERT_TRUE(fem.solve(Positions(0, 3), targets).finite);
    const SolveRounding rounding = rounding_of(fem, bar, options_of(GetParam()), attachment);
    EXPECT_LT((fem.positions() - targets).norm(), rounding.error_m());
    EXPECT_LT(fem.strain_energy_j(), rounding.energy_j());
    EXPECT_LT(rounding.relative(), 1e-5) << "a bound that would let an error of a percent pass proves nothing";
}

// Reference: equilibrium of forces, which is exact since translations are in the space: the springs carry the weight.
TEST_P(Attached, SpringsCarryTheWeight)
{
    Positions points(6, 3);
    points << 0.1, 0, 0, 0.3, 0.1, 0, 0.2, 0, -0.1, 1.9, 0, 0, 1.7, 0.1, 0, 1.8, 0, -0.1;
    const double k = 1e2 * young_pa * cell_m;
    Attachment attachment = holding({});
    attachment.spring_points = points;
    attachment.spring_stiffness.setConstant(points.rows(), k);
    LinearOptions options = options_of(GetParam());
    options.gravity_m_s2 = {1.0, -2.0, -9.81};
    LinearElasticity fem(bar, options, attachment);
    ASSERT_TRUE(fem.solve(points, bar.rest).finite);
    const Vec3 reaction = k * (points - fem.spring_points_deformed()).colwise().sum().transpose();
    const Vec3 weight = options.density_kg_m3 * 0.5 * options.gravity_m_s2;  // 2 x 0.5 x 0.5 m^3
    // The force due to the residual, and the rounding of stretches, which are differences of positions of 2 m.
    const SolveRounding rounding = rounding_of(fem, bar, options, attachment);
    const int nodes = static_cast<int>(fem.displacement().size()) / 3;
    const double of_stretches = k * 2.0 * std::numeric_limits<double>::epsilon() * std::sqrt(3.0 * points.rows());
    EXPECT_LT((reaction + weight).norm(), rounding.force_n(nodes) + of_stretches);
    EXPECT_LT(rounding.force_n(nodes), 1e-4 * weight.norm()) << "a bound that would let an error of a percent pass proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Formulations, Attached, testing::Values(Formulation::mean_dilatation, Formulation::taylor_hood));

// Reference: another path to the same minimum, Newton's method on the potential of the same energy.
TEST(NearIncompressibleAttachment, MeanDilatationIsThatOfTheElasticBody)
{
    const Attachment attachment = holding(tets_up_to(1.3 * cell_m));
    const Vec3 gravity(0, 0, -9.81);
    LinearOptions options = options_of(Formulation::mean_dilatation);
    options.gravity_m_s2 = gravity;
    LinearElasticity kept(bar, options, attachment);
    kept.solve(Positions(0, 3), bar.rest);
    ElasticBody newton(bar,
                       {.model = Model::linear,
                        .formulation = Formulation::mean_dilatation,
                        .young_pa = young_pa,
                        .poisson = poisson,
                        .newton = {},
                        .path = {}},
                       attachment);
    ASSERT_TRUE(newton.solve([&](double) { return Targets{Positions(0, 3), bar.rest, {}}; }, gravity).converged());
    // One linear solve meets Newton's tolerance of 1e-8 on the forces, so there are two solves with rounding errors.
    const SolveRounding rounding = rounding_of(kept, bar, options, attachment);
    EXPECT_LT((kept.positions() - newton.positions()).norm(), 2.0 * rounding.error_m());
    EXPECT_NEAR(kept.strain_energy_j(), newton.strain_energy_j(), 2.0 * rounding.energy_j(newton.strain_energy_j()));
}

// The flesh that is not held, as a separate mesh, and the indices of its vertices in the bar.
struct FreePart {
    pbs::TetMesh mesh;
    std::vector<int> vertex_of_bar;
};

FreePart without(const std::vector<int>& held_tets)
{
    FreePart part;
    std::map<int, int> vertex;
    std::vector<Eigen::RowVector4i> tets;
    for (int t = 0; t < bar.tets.rows(); ++t) {
        if (std::binary_search(held_tets.begin(), held_tets.end(), t)) continue;
        Eigen::RowVector4i corners;
        for (int c = 0; c < 4; ++c) {
            const auto [entry, is_new] = vertex.emplace(bar.tets(t, c), static_cast<int>(vertex.size()));
            if (is_new) part.vertex_of_bar.push_back(bar.tets(t, c));
            corners(c) = entry->second;
        }
        tets.push_back(corners);
    }
    part.mesh.rest = bar.rest(part.vertex_of_bar, Eigen::all);
    part.mesh.tets.resize(tets.size(), 4);
    for (std::size_t t = 0; t < tets.size(); ++t) part.mesh.tets.row(t) = tets[t];
    return part;
}

// Reference: the boundary value problem of the free flesh alone, with the nodes at the held tets prescribed. The prescribed state of the
// tets, here an expansion by 3 s, shares no pressure with the adjacent flesh. It contributes to the energy, V (lambda / 2 (3 s)^2 + 3 mu
// s^2).
TEST(NearIncompressibleAttachment, HeldTetsActByTheirNodesAlone)
{
    const std::vector<int> held = tets_up_to(1.3 * cell_m);
    const double swelling = 0.01;
    const auto swollen = [&](const Vec3& x) -> Vec3 { return swelling * x; };
    const LinearOptions options = options_of(Formulation::taylor_hood);
    LinearElasticity fem(bar, options, holding(held));
    ASSERT_TRUE(fem.solve(Positions(0, 3), (1.0 + swelling) * bar.rest).finite);

    const FreePart part = without(held);
    std::vector<Vec3> corners;
    double held_volume = 0.0;
    for (const int t : held) {
        for (const int v : bar.tets.row(t)) corners.emplace_back(bar.rest.row(v));
        const Vec3 a = bar.rest.row(bar.tets(t, 0)), b = bar.rest.row(bar.tets(t, 1)), c = bar.rest.row(bar.tets(t, 2)),
                   d = bar.rest.row(bar.tets(t, 3));
        held_volume += (b - a).cross(c - a).dot(d - a) / 6.0;
    }
    const auto is_held_node = [&](const Vec3& x) {  // a corner of a held tet, or the midpoint of two
        for (std::size_t k = 0; k < corners.size(); ++k)
            for (std::size_t l = k - k % 4; l <= k; ++l)
                if ((x - (corners[k] + corners[l]) / 2.0).norm() < 1e-9) return true;
        return false;
    };
    const ElasticMaterial material{young_pa, poisson};
    const BoundaryValueSolution alone =
        solve(part.mesh, material, {.displacement = swollen, .held = is_held_node, .formulation = Formulation::taylor_hood});

    const SolveRounding of_bar = rounding_of(fem, bar, options, holding(held)), of_part = rounding_of(alone, material);
    const double error_m = of_bar.error_m() + of_part.error_m();
    const Lame lame = lame_parameters(young_pa, poisson);
    const double pressure_unit_pa = LinearFlesh(*alone.space, lame, Formulation::taylor_hood).pressure_unit_pa();
    double squares = 0.0;
    for (std::size_t v = 0; v < part.vertex_of_bar.size(); ++v) {
        const Vec3 moved = fem.positions().row(part.vertex_of_bar[v]) - bar.rest.row(part.vertex_of_bar[v]);
        squares += (moved - alone.displacement.segment<3>(3 * v)).squaredNorm();
        EXPECT_NEAR(fem.pressure_pa()(part.vertex_of_bar[v]), alone.pressure_pa(v), error_m * pressure_unit_pa);
    }
    EXPECT_LT(std::sqrt(squares), error_m);
    EXPECT_LT(error_m, 1e-6 * swelling) << "a bound that would let an error of a percent pass proves nothing";
    const double of_held = held_volume * swelling * swelling * (4.5 * lame.lambda_pa + 3.0 * lame.mu_pa);
    const double energy = alone.strain_energy_j(material) + of_held;
    EXPECT_NEAR(fem.strain_energy_j(), energy, of_bar.energy_j(energy) + of_part.energy_j(energy));
}

}  // namespace
