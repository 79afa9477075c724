// Reference: calculus and theory. Each potential's gradient is the derivative of its value and its Hessian that of its
// gradient (eps sweeps on a distorted mesh, away from rest); the Hessian of the linear law is the stiffness that
// deal.II assembles separately; rotations store no energy.
#include "pbs/geometry/input_error.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include "tests/support/eps_sweep.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

namespace {

using namespace reference_fem;
using pbs::Vec3;
using test_support::at_nodes;

const pbs::TetMesh cube =
    test_support::jittered(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 1, 1}), {0.5, 1.0, 1.0}, 0.2);
const Lame lame = lame_parameters(1e3, 0.4);

// Rounding of a sum relative to the sum of its terms' magnitudes: every term goes through at most `roundings` of eps
// / 2. Of these, a law has a hundred (tests/verification/reference_fem/laws.cpp); an entry of a matrix is a sum of nine
// products over up to 6 points of up to 24 tets about an edge or vertex, the magnitudes of which are those of the
// entry, since the terms on the diagonal have one sign.
double rounding(int roundings)
{
    return test_support::rounding_error(roundings, 1.0);
}
const int of_law = 100, of_entry = of_law + 9 + 6 + 24, of_energy = of_law + 6 * 12;  // 6 points of 12 tets

Eigen::VectorXd random_dofs(int size, double magnitude, unsigned seed)
{
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> entry(-magnitude, magnitude);
    return Eigen::VectorXd::NullaryExpr(size, [&] { return entry(generator); });
}

void expect_consistent(const Potential& potential, const SimplexSpace& space, double size)
{
    const Eigen::VectorXd at = random_dofs(space.dofs(), 0.1 * size, 1), along = random_dofs(space.dofs(), 1.0, 2),
                          across = random_dofs(space.dofs(), 1.0, 3);
    const auto gradient = [&](const Eigen::VectorXd& u) {
        Eigen::VectorXd g = Eigen::VectorXd::Zero(u.size());
        potential.add_gradient(u, g);
        return g;
    };
    const auto value = [&](const Eigen::VectorXd& u) { return potential.value(u); };
    NodalMatrix hessian(space);
    potential.add_hessian(at, Definiteness::as_it_is, hessian);
    EXPECT_LE((hessian.matrix() - SparseMatrix(hessian.matrix().transpose())).norm(),
              rounding(2 * of_entry) * hessian.matrix().norm());
    // central differences of a quadratic are exact, so no decrease of the error is visible
    if (potential.is_quadratic()) {
        const Eigen::VectorXd ahead = at + along, behind = at - along, slopes_ahead = gradient(ahead),
                              slopes_behind = gradient(behind);
        const double slope = (value(ahead) - value(behind)) / 2.0;
        // of terms without their signs
        const double work = slopes_ahead.norm() * ahead.norm() + slopes_behind.norm() * behind.norm();
        EXPECT_NEAR(slope, gradient(at).dot(along), rounding(of_energy + space.dofs()) * work);
        const Eigen::VectorXd turn = (slopes_ahead - slopes_behind) / 2.0;
        EXPECT_LT((turn - hessian.matrix() * along).norm(),
                  rounding(of_entry + space.dofs()) *
                      (slopes_ahead.norm() + slopes_behind.norm() + hessian.matrix().norm() * along.norm()));
        return;
    }
    test_support::expect_slope_by_eps_sweep(value, at, along, gradient(at).dot(along), 0.1 * size);
    test_support::expect_slope_by_eps_sweep([&](const Eigen::VectorXd& u) { return gradient(u).dot(across); }, at,
                                            along, across.dot(hessian.matrix() * along), 0.1 * size);
}

struct Case {
    Model model;
    int element_order;
    Formulation formulation;
};

class Flesh : public testing::TestWithParam<Case> {
protected:
    const SimplexSpace space{cube, GetParam().element_order};
    const ElasticPotential flesh{space, GetParam().model, lame, GetParam().formulation};
};

TEST_P(Flesh, GradientIsTheSlopeOfTheEnergyAndHessianThatOfTheGradient)
{
    expect_consistent(flesh, space, 0.3);
}

TEST_P(Flesh, ARotationStoresNothingUnlessTheLawIsLinear)
{
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const double energy = flesh.value(at_nodes(space, [&](const Vec3& x) -> Vec3 { return turn * x - x; }));
    if (GetParam().model == Model::linear)
        EXPECT_GT(energy, lame.mu_pa);  // |u| is of order one, and so is the fictitious strain
    else
        // The terms of a law, which a rotation R makes cancel, are of the size of the moduli times |R - I|^2; the
        // volume is 1 m^3.
        EXPECT_LT(std::abs(energy), rounding(of_energy) * (lame.lambda_pa + lame.mu_pa) *
                                        (turn - Eigen::Matrix3d::Identity()).squaredNorm());
}

TEST_P(Flesh, ProjectedHessianHasNoNegativeEigenvalues)
{
    // Compressed to half along x: compressed laws soften, so that the Hessian of most of them has negative eigenvalues.
    const Eigen::VectorXd squeezed = random_dofs(space.dofs(), 0.02, 4) + at_nodes(space, [](const Vec3& x) -> Vec3 {
                                         return {-0.5 * x.x(), 0, 0};
                                     });
    NodalMatrix hessian(space);
    flesh.add_hessian(squeezed, Definiteness::projected, hessian);
    const Eigen::MatrixXd dense = hessian.matrix();
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense, Eigen::EigenvaluesOnly).eigenvalues()(0),
              // of the sums, and n eps of the eigenvalue solver
              -(rounding(of_entry) + dense.rows() * rounding(2)) * dense.norm());
}

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    for (const Model model : {Model::linear, Model::corotational, Model::stable_neo_hookean, Model::neo_hookean,
                              Model::st_venant_kirchhoff})
        for (const int order : {1, 2})
            for (const Formulation formulation : {Formulation::displacement, Formulation::mean_dilatation})
                cases.push_back({model, order, formulation});
    for (const int order : {1, 2}) cases.push_back({Model::isochoric_neo_hookean, order, Formulation::displacement});
    return cases;
}
INSTANTIATE_TEST_SUITE_P(EveryLaw, Flesh, testing::ValuesIn(all_cases()));

TEST(ElasticPotential, TheLinearLawIsTheStiffnessThatDealIiAssembles)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(cube, order);
        const NodalMatrix hessian =
            rest_stiffness(space, ElasticPotential(space, Model::linear, lame, Formulation::displacement));
        const SparseMatrix stiffness = stiffness_matrix(space, lame);
        EXPECT_LT((hessian.matrix() - stiffness).norm(), rounding(2 * (of_entry - of_law)) * stiffness.norm())
            << "P" << order;
    }
}

TEST(ElasticPotential, EveryLawHasTheLinearStiffnessAtRest)
{
    const SimplexSpace space(cube, 2);
    for (const Formulation formulation : {Formulation::displacement, Formulation::mean_dilatation}) {
        const SparseMatrix linear =
            rest_stiffness(space, ElasticPotential(space, Model::linear, lame, formulation)).matrix();
        for (const Model model :
             {Model::corotational, Model::stable_neo_hookean, Model::neo_hookean, Model::st_venant_kirchhoff}) {
            const SparseMatrix at_rest =
                rest_stiffness(space, ElasticPotential(space, model, lame, formulation)).matrix();
            EXPECT_LT((at_rest - linear).norm(), rounding(of_entry) * linear.norm());
        }
    }
}

TEST(ElasticPotential, MeanDilatationOnLinearTetsIsDisplacement)
{
    const SimplexSpace space(cube, 1);
    const Eigen::VectorXd u = random_dofs(space.dofs(), 0.05, 5);
    for (const Model model : {Model::linear, Model::stable_neo_hookean}) {
        const double displacement = ElasticPotential(space, model, lame, Formulation::displacement).value(u);
        EXPECT_NEAR(ElasticPotential(space, model, lame, Formulation::mean_dilatation).value(u), displacement,
                    rounding(2 * of_energy) * displacement);
    }
}

TEST(ElasticPotential, JacobiansOfAnAffineMotion)
{
    const SimplexSpace space(cube, 2);
    const ElasticPotential flesh(space, Model::stable_neo_hookean, lame, Formulation::displacement);
    // F = diag(-2, 1, 1)
    const Eigen::VectorXd mirrored = at_nodes(space, [](const Vec3& x) -> Vec3 { return {-3.0 * x.x(), 0, 0}; });
    const Jacobians jacobians = flesh.jacobians(mirrored);
    // An entry of F sums ten products of |u| <= 3 m and |grad N| <= 10 / m; the volume sums 72 points more.
    EXPECT_NEAR(jacobians.lowest, -2.0, rounding(20) * 300.0);
    EXPECT_EQ(jacobians.inverted, 6 * cube.tets.rows());  // every quadrature point
    EXPECT_NEAR(jacobians.volume, -2.0, rounding(20 + 80) * 300.0);
    EXPECT_TRUE(std::isfinite(flesh.value(mirrored)));
    EXPECT_TRUE(
        std::isinf(ElasticPotential(space, Model::neo_hookean, lame, Formulation::displacement).value(mirrored)));
    EXPECT_THROW(ElasticPotential(space, Model::linear, lame, Formulation::taylor_hood), pbs::InputError);
    EXPECT_THROW(ElasticPotential(space, Model::isochoric_neo_hookean, lame, Formulation::mean_dilatation),
                 pbs::InputError);
}

TEST(SpringPotential, IsConsistent)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(cube, order);
        // the last point lies outside and has no effect
        const pbs::Positions points{{0.2, 0.3, 0.4}, {0.7, 0.6, 0.2}, {9.0, 9.0, 9.0}};
        const AttachedPoints springs(cube, space, points, Eigen::Vector3d(3.0, 5.0, 7.0));
        SpringPotential potential(springs);
        potential.move_to(pbs::Positions(points.array() + 0.25));
        expect_consistent(potential, space, 1.0);
        EXPECT_NEAR(potential.value(Eigen::VectorXd::Zero(space.dofs())), (3.0 + 5.0) / 2.0 * 3.0 * 0.25 * 0.25,
                    rounding(40));  // of values below 1
    }
}

TEST(BindPotential, IsConsistent)
{
    const SimplexSpace space(cube, 2);
    const Eigen::VectorXd distance = cube.rest.rowwise().norm(),
                          stiffness = Eigen::VectorXd::LinSpaced(cube.rest.rows(), 0.0, 5.0);
    BindPotential potential(cube.rest, distance, stiffness);
    potential.move_to(pbs::Positions::Zero(cube.rest.rows(), 3));
    EXPECT_EQ(potential.value(Eigen::VectorXd::Zero(space.dofs())), 0.0);
    potential.move_to(pbs::Positions::Constant(cube.rest.rows(), 3, -0.3));
    expect_consistent(potential, space, 1.0);
}

TEST(BindPotential, AVertexOnItsBonePointHasAFiniteHessianAndADeadLoadIsConsistent)
{
    const SimplexSpace space(cube, 1);
    const Eigen::Index vertices = cube.rest.rows();
    const BindPotential potential(cube.rest, Eigen::VectorXd::Zero(vertices), Eigen::VectorXd::Constant(vertices, 2.0));
    NodalMatrix hessian(space);
    potential.add_hessian(Eigen::VectorXd::Zero(space.dofs()), Definiteness::as_it_is, hessian);
    EXPECT_EQ((Eigen::MatrixXd(hessian.matrix()) - 2.0 * Eigen::MatrixXd::Identity(3 * vertices, 3 * vertices)).norm(),
              0.0);
    expect_consistent(DeadLoad(random_dofs(space.dofs(), 1.0, 6)), space, 1.0);
}

// c / 2 (u - u0)^T A (u - u0), separately and together. A value goes through the product and sum of a row, of the dofs'
// products and the factor c. The gradient is added to ones, and these are taken away again: two more roundings of at
// most the gradient and one.
TEST(QuadraticForm, OfAStiffnessAndOfTheMass)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(cube, order);
        const Eigen::VectorXd u = random_dofs(space.dofs(), 1.0, 7), u0 = random_dofs(space.dofs(), 1.0, 8);
        const auto expect_form = [&](const Potential& potential, const SparseMatrix& A, double c,
                                     const Eigen::VectorXd& offset) {
            const Eigen::VectorXd gradient = c * (A * offset), ones = Eigen::VectorXd::Ones(u.size());
            const Eigen::VectorXd magnitudes = c * (SparseMatrix(A.cwiseAbs()) * offset.cwiseAbs());
            const int row = test_support::most_entries(A), dofs = space.dofs();
            const double value = c / 2.0 * offset.dot(A * offset);
            const double value_error = rounding(2 * (row + dofs + 3)) * magnitudes.dot(offset.cwiseAbs()) / 2.0;
            Eigen::VectorXd alone = ones, together = ones;
            potential.add_gradient(u, alone);
            EXPECT_NEAR(potential.value_and_add_gradient(u, together), value, value_error);
            EXPECT_NEAR(potential.value(u), value, value_error);
            EXPECT_LT((alone - ones - gradient).norm(),
                      rounding(2 * (row + 3)) * magnitudes.norm() + rounding(2) * std::sqrt(u.size()));
            EXPECT_LT(value_error, 1e-10 * value) << "a bound that would let a wrong entry pass proves nothing";
            EXPECT_EQ(alone, together);
            NodalMatrix hessian(space);
            potential.add_hessian(u, Definiteness::projected, hessian);
            EXPECT_EQ((hessian.matrix() - c * A).norm(), 0.0);  // the same products, each rounded once
            EXPECT_TRUE(potential.is_quadratic());
        };
        const NodalMatrix stiffness =
            rest_stiffness(space, ElasticPotential(space, Model::linear, lame, Formulation::displacement));
        StiffnessPotential spring(stiffness);
        expect_form(spring, stiffness.matrix(), 1.0, u);  // as it is, the linear law
        spring.set(2.5, u0);
        expect_form(spring, stiffness.matrix(), 2.5, u - u0);
        const ConsistentMass mass(space, 7.0);
        InertiaPotential inertia(mass);
        inertia.set(40.0, u0);
        expect_form(inertia, mass.matrix(), 40.0, u - u0);
    }
}

// A square of 1 m in plane strain, compressed along x between smooth walls on a smooth floor, with a free surface
// above: the state is homogeneous. Returns whether it is a minimum of the energy among all displacements of the
// quadratic elements.
bool surface_is_stable(double strain, int cells)
{
    const Lame soft = lame_parameters(1.0, 0.499);
    const SimplexSpace space(test_support::structured_bar({0, 0, 0}, {1, 1.0 / cells, 1}, {cells, 1, cells}), 2);
    double low = 1.0, high = 4.0;  // the stretch along z, by bisection: P_zz = 0
    while (high - low > 1e-14) {
        const double z = (low + high) / 2.0;
        (soft.mu_pa * (z * z - 1.0) + soft.lambda_pa * std::log((1.0 - strain) * z) > 0.0 ? high : low) = z;
    }
    const pbs::Positions X = space.node_positions();
    Eigen::VectorXd u = Eigen::VectorXd::Zero(space.dofs());
    std::vector<int> row(space.dofs(), -1);  // of a free degree of freedom
    int rows = 0;
    for (int n = 0; n < X.rows(); ++n) {
        u(3 * n) = -strain * X(n, 0), u(3 * n + 2) = (low - 1.0) * X(n, 2);
        if (X(n, 0) > 1e-9 && X(n, 0) < 1.0 - 1e-9) row[3 * n] = rows++;
        if (X(n, 2) > 1e-9) row[3 * n + 2] = rows++;
    }
    NodalMatrix hessian(space);
    const ElasticPotential flesh(space, Model::neo_hookean, soft, Formulation::displacement);
    flesh.add_hessian(u, Definiteness::as_it_is, hessian);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(space.dofs());
    flesh.add_gradient(u, gradient);
    for (int dof = 0; dof < space.dofs(); ++dof)
        // of cells of 1 m at most
        EXPECT_NEAR(row[dof] >= 0 ? gradient(dof) : 0.0, 0.0, 1e-12 * soft.lambda_pa) << "no equilibrium";
    std::vector<Eigen::Triplet<double>> entries;
    for (int column = 0; column < space.dofs(); ++column)
        for (SparseMatrix::InnerIterator entry(hessian.matrix(), column); entry; ++entry)
            if (row[entry.row()] >= 0 && row[column] >= 0)
                entries.emplace_back(row[entry.row()], row[column], entry.value());
    Eigen::SparseMatrix<double> free(rows, rows);
    free.setFromTriplets(entries.begin(), entries.end());
    return Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(free).info() == Eigen::Success;
}

// The surface of incompressible neo-Hookean flesh wrinkles where r = stretch^2 fulfils r^3 + r^2 + 3 r = 1 (M. Biot,
// Mechanics of Incremental Deformations, 1965), whatever the wavelength: at a strain of 0.456. Conforming elements and
// a floor can only delay it, the less, the smaller the cells are.
TEST(NeoHookeanSurface, WrinklesAtBiotsStrain)
{
    double r = 0.0;
    for (int i = 0; i < 100; ++i) r = (1.0 - r * r * r - r * r) / 3.0;
    const double strain = 1.0 - std::sqrt(r);
    EXPECT_NEAR(strain, 0.456, 5e-4);
    EXPECT_TRUE(surface_is_stable(strain, 16));
    EXPECT_FALSE(surface_is_stable(1.015 * strain, 16));
    EXPECT_TRUE(surface_is_stable(1.015 * strain, 8));
}

}  // namespace
