// Reference: the weak forms in the header, evaluated by hand. The verification tests show that the formulations solve
// correctly. Tolerances: the gradient G of a displacement is a sum over ten nodes of at most s = largest_gradient_sum,
// times the inverse of the Jacobian. An error dG changes the energy density, of at most (mu + 3/2 lambda) |G|^2, by 2
// (mu + 3/2 lambda) |G| dG, and the pressure by sqrt 3 lambda dG.
#include "reference_fem/linear_flesh.hpp"

#include "pbs/geometry/input_error.hpp"
#include "reference_fem/assembly.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <numeric>

namespace {

using namespace reference_fem;
using test_support::rounding_error;

const pbs::TetMesh cube = test_support::jittered_cube(2);
const Lame lame{300.0, 100.0};

// u = (2 x + y, -y + 3 z, 4 z - x) [m]: div u = 5, |eps|^2 = 2^2 + 1^2 + 4^2 + 2 ((1/2)^2 + (1/2)^2 + (3/2)^2) = 26.5.
Eigen::VectorXd affine(const SimplexSpace& space)
{
    return test_support::at_nodes(space, [](const pbs::Vec3& x) -> pbs::Vec3 {
        return {2 * x(0) + x(1), 3 * x(2) - x(1), 4 * x(2) - x(0)};
    });
}
// |G|
const double affine_energy_j = lame.lambda_pa / 2.0 * 25.0 + lame.mu_pa * 26.5, affine_gradient = std::sqrt(32.0);

// dG [1]: a shape function goes through eight roundings, the sum through eleven, since I + G counts as another node,
// then the inverse.
double gradient_error(const SimplexSpace& space, const Eigen::VectorXd& displacement, double gradient)
{
    return rounding_error(8 + 11, 1.0 + test_support::largest_gradient_sum(space, displacement)) +
           rounding_error(test_support::jacobian_roundings(space), gradient);
}

// [J] of a body of this volume [m^3]; the energy goes through the volumes, a dozen products and the sum over four
// points of all tets.
double energy_error(const SimplexSpace& space, const Eigen::VectorXd& displacement, double gradient, double volume)
{
    const double modulus_pa = lame.mu_pa + 1.5 * lame.lambda_pa;
    const double roundings =
        test_support::jacobian_roundings(space) + 12.0 + 4.0 * static_cast<double>(space.tet_nodes().rows());
    return (2.0 * modulus_pa * gradient * gradient_error(space, displacement, gradient) +
            rounding_error(roundings, modulus_pa * gradient * gradient)) *
           volume;
}

std::vector<int> all_tets_but_the_last()
{
    std::vector<int> tets(cube.tets.rows() - 1);
    std::iota(tets.begin(), tets.end(), 0);
    return tets;
}

class EveryFormulation : public testing::TestWithParam<Formulation> {};

TEST_P(EveryFormulation, AffineDisplacementsHaveTheEnergyByHand)
{
    const SimplexSpace space(cube, 2);
    for (const auto& held : {std::vector<int>{}, all_tets_but_the_last()}) {
        const LinearFlesh flesh(space, lame, GetParam(), held);
        const Eigen::VectorXd pressure = Eigen::VectorXd::Constant(flesh.pressures(), 5.0 * lame.lambda_pa);
        const double rounding = energy_error(space, affine(space), affine_gradient, 1.0);
        EXPECT_NEAR(flesh.strain_energy_j(affine(space), pressure), affine_energy_j, rounding);
        EXPECT_LT(rounding, 1e-10 * affine_energy_j) << "a bound that would let a wrong term pass proves nothing";
    }
}

// u K u / 2 is the energy if the pressure is lambda div u, since then the row of every q holds. Tolerances: the
// roundings of an entry, of its row and of the sum over the unknowns. An entry of B, the integral of q div v, is at
// most sqrt(q q) sqrt(grad v : grad v), and those are entries of -K over 1 / lambda and of K over mu: the bound by
// diagonal entries holds with a factor sqrt(lambda / mu).
TEST_P(EveryFormulation, TheMatrixHasTheEnergyOfAffineDisplacements)
{
    const SimplexSpace space(cube, 2);
    const LinearFlesh flesh(space, lame, GetParam());
    Eigen::VectorXd unknowns = flesh.on_unknowns(affine(space));
    unknowns.tail(flesh.pressures()).setConstant(5.0 * lame.lambda_pa / flesh.pressure_unit_pa());
    const SparseMatrix stiffness = flesh.stiffness();
    ASSERT_EQ(stiffness.rows(), flesh.unknowns());
    const SparseMatrix terms = std::sqrt(lame.lambda_pa / lame.mu_pa) * test_support::magnitudes(stiffness);
    const Eigen::VectorXd forces = terms * unknowns.cwiseAbs();
    const double of_entry = test_support::entry_roundings(space, 2, 2),
                 of_row = of_entry + test_support::most_entries(stiffness);
    const double rounding =
        rounding_error(of_row + static_cast<double>(unknowns.size()), unknowns.cwiseAbs().dot(forces) / 2.0);
    EXPECT_NEAR(unknowns.dot(stiffness * unknowns) / 2.0, affine_energy_j, rounding);
    EXPECT_LT(rounding, 1e-9 * affine_energy_j) << "a bound that would let a wrong entry pass proves nothing";
    EXPECT_LE((stiffness * unknowns).tail(flesh.pressures()).norm(),
              rounding_error(of_row, forces.tail(flesh.pressures()).norm()));
    const SparseMatrix transposed = stiffness.transpose();
    EXPECT_LT((stiffness - transposed).norm(), rounding_error(of_entry, terms.norm()));
}

TEST_P(EveryFormulation, PressureAtAVertexIsLambdaTimesTheDilatation)
{
    const SimplexSpace space(cube, 2);
    const LinearFlesh flesh(space, lame, GetParam());
    const Eigen::VectorXd pressure = Eigen::VectorXd::Constant(flesh.pressures(), 5.0 * lame.lambda_pa);
    // A pressure is the mean over at most 24 tets about a vertex of the mean over four corners.
    const double rounding = std::sqrt(3.0) * lame.lambda_pa * gradient_error(space, affine(space), affine_gradient) +
                            rounding_error(24 + 4 + 3, 1500.0);
    for (const int vertex : {0, 13, 26})
        EXPECT_NEAR(flesh.pressure_at_vertex_pa(affine(space), pressure, vertex), 1500.0, rounding);
}

INSTANTIATE_TEST_SUITE_P(Formulations, EveryFormulation,
                         testing::Values(Formulation::displacement, Formulation::mean_dilatation,
                                         Formulation::taylor_hood));

// u = (x^2, 0, 0) on the unit tet: div u = 2 x has the mean 1/2, and x^2 has the mean 1/10.
TEST(LinearFlesh, MeanDilatationTakesEachTetsMean)
{
    const SimplexSpace space(test_support::unit_tet(), 2);
    const Eigen::VectorXd displacement = test_support::at_nodes(space, [](const pbs::Vec3& x) -> pbs::Vec3 {
        return {x.x() * x.x(), 0, 0};
    });
    const LinearFlesh mean(space, lame, Formulation::mean_dilatation),
        pointwise(space, lame, Formulation::displacement);
    const double of_pressure = std::sqrt(3.0) * lame.lambda_pa * gradient_error(space, displacement, 2.0);  // |G| = 2 x
    EXPECT_NEAR(mean.pressure_at_vertex_pa(displacement, {}, 1), lame.lambda_pa * 0.5, of_pressure);
    EXPECT_NEAR(pointwise.pressure_at_vertex_pa(displacement, {}, 1), lame.lambda_pa * 2.0, of_pressure);
    // 2 mu eps:eps / 2 integrates to mu * 4 * V / 10; the volume terms to lambda / 2 * V (1/2)^2 and lambda / 2 * 4 * V
    // / 10.
    const double volume = 1.0 / 6.0, shear = lame.mu_pa * 0.4 * volume;
    const double of_energy = energy_error(space, displacement, 2.0, volume);
    EXPECT_NEAR(mean.strain_energy_j(displacement, {}), shear + lame.lambda_pa / 2.0 * 0.25 * volume, of_energy);
    EXPECT_NEAR(pointwise.strain_energy_j(displacement, {}), shear + lame.lambda_pa / 2.0 * 0.4 * volume, of_energy);
}

TEST(LinearFlesh, PressuresAreInPascalsAndThoseThatOnlyHeldTetsHaveAreNotSolvedFor)
{
    const SimplexSpace space(cube, 2);
    const LinearFlesh flesh(space, lame, Formulation::taylor_hood, all_tets_but_the_last());
    const std::vector<bool> prescribed = flesh.prescribed(std::vector<bool>(space.dofs(), false));
    const auto last = cube.tets.bottomRows<1>();
    for (int v = 0; v < cube.rest.rows(); ++v) EXPECT_EQ(!prescribed[space.dofs() + v], (last.array() == v).any());
    Eigen::VectorXd unknowns = flesh.on_unknowns(affine(space));
    EXPECT_EQ(flesh.displacement(unknowns), affine(space));
    EXPECT_EQ(flesh.pressure_pa(unknowns), Eigen::VectorXd::Zero(cube.rest.rows()));
    unknowns(space.dofs() + 4) = 2.0;
    EXPECT_EQ(flesh.pressure_pa(unknowns)(4), 2.0 * flesh.pressure_unit_pa());
}

TEST(LinearFlesh, TaylorHoodRefusesWhatItCannot)
{
    const SimplexSpace linear(cube, 1), quadratic(cube, 2);
    EXPECT_THROW(LinearFlesh(linear, lame, Formulation::taylor_hood), pbs::InputError);
    EXPECT_THROW(LinearFlesh(quadratic, {0.0, 100.0}, Formulation::taylor_hood), pbs::InputError);
    const LinearFlesh flesh(quadratic, lame, Formulation::taylor_hood);
    EXPECT_EQ(flesh.solver(LinearSolver::cholmod), LinearSolver::umfpack);
    EXPECT_EQ(LinearFlesh(linear, lame, Formulation::mean_dilatation).solver(LinearSolver::cholmod),
              LinearSolver::cholmod);
}

}  // namespace
