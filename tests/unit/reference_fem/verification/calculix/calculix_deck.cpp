// Reference: CalculiX's manual. A number has 20 characters at most; *BOUNDARY lists node, first and last component, value; *CLOAD node,
// component, value; *EQUATION the number of terms, then node, component and coefficient of each, four on a line; *SPRING the component of
// a SPRING1 and its stiffness; C3D10's middle nodes lie on the edges 12 23 31 14 24 34.

#include "reference_fem/verification/calculix/calculix_deck.hpp"
#include "tests/support/rounding_error.hpp"

#include <cstdlib>
#include <random>

namespace {

using namespace reference_fem;
using test_support::rounding_error;
using Lines = std::vector<std::string>;

// One tet, P1 or P2, held at two nodes and loaded at a third: the smallest problem that uses every card.
NodalProblem one_tet_problem(int element_order)
{
    const pbs::TetMesh mesh{pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}}, pbs::Tets{{0, 1, 2, 3}}};
    NodalProblem problem = nodal_problem(SimplexSpace(mesh, element_order), {.young_pa = 2e5, .poisson = 0.25});
    problem.held[0] = problem.held[2] = true;
    problem.held_at.row(2) << 0.5, 0.0, -0.25;
    problem.forces_n.row(3) << 0.0, -1.5, 0.0;
    return problem;
}

std::string deck_of(const NodalProblem& problem, const DeckOptions& options = {})
{
    std::ostringstream deck;
    write_calculix_deck(deck, problem, options);
    return deck.str();
}

// The lines between a card and the next one.
Lines lines_of(const std::string& deck, const std::string& card)
{
    Lines lines;
    std::istringstream text(deck);
    bool inside = false;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with('*'))
            inside = line == card;
        else if (inside)
            lines.push_back(line);
    }
    return lines;
}

// A number that begins with 1 may be in error by half a unit of its thirteenth digit, and the number that is read is rounded.
const double thirteen_digits = 0.5e-12 + rounding_error(1, 1.0);

// Twenty characters hold a sign, a digit, a point and 17 decimals: of coordinates of a few metres the last is right to half a unit.
TEST(CalculixNumber, FitsIntoTwentyCharactersWithThirteenDigitsOrMore)
{
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0), exponent(-200.0, 200.0), coordinate(-5.0, 5.0);
    for (int i = 0; i < 10000; ++i) {
        const double value = mantissa(random) * std::pow(10.0, exponent(random)), near = coordinate(random);
        const std::string text = calculix_number(value);
        ASSERT_LE(text.size(), 20u) << text;
        ASSERT_NEAR(std::stod(text), value, thirteen_digits * std::abs(value)) << text;
        ASSERT_NEAR(std::stod(calculix_number(near)), near, 0.5e-17 + rounding_error(1, std::abs(near)));
    }
    for (const double exact : {0.0, 1.0, -0.5, 1e5, 0.1, -0.12345678901234567, 1.0 / 3.0})
        EXPECT_EQ(std::stod(calculix_number(exact)), exact);
    for (const double extreme : {-std::numeric_limits<double>::max(), -std::numeric_limits<double>::min(), -1.2345678901234567e-5}) {
        EXPECT_LE(calculix_number(extreme).size(), 20u);
        EXPECT_NEAR(std::strtod(calculix_number(extreme).c_str(), nullptr) / extreme, 1.0, thirteen_digits);
    }
}

// The numbers of a line, separated by commas.
std::vector<double> numbers_of(const std::string& line)
{
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; std::getline(words, word, ',');) numbers.push_back(std::stod(word));
    return numbers;
}

TEST(CalculixDeck, WritesNodesTetsMaterialAndWhatTheProblemHoldsAndLoads)
{
    const std::string deck = deck_of(one_tet_problem(1));
    const std::map<std::string, Lines> cards = {
        {"*NODE, NSET=NODES", {"1, 0, 0, 0", "2, 1, 0, 0", "3, 0, 1, 0", "4, 0, 0, 0.1"}},
        {"*ELEMENT, TYPE=C3D4, ELSET=TETS", {"1, 1, 2, 3, 4"}},
        {"*ELASTIC", {"2e+05, 0.25"}},
        {"*BOUNDARY", {"1, 1, 1, 0", "1, 2, 2, 0", "1, 3, 3, 0", "3, 1, 1, 0.5", "3, 2, 2, 0", "3, 3, 3, -0.25"}},
        {"*CLOAD", {"4, 1, 0", "4, 2, -1.5", "4, 3, 0"}}};
    for (const auto& [card, lines] : cards) EXPECT_EQ(lines_of(deck, card), lines) << card;
    for (const char* card : {"*DLOAD", "*DENSITY"}) EXPECT_EQ(deck.find(card), std::string::npos);
    NodalProblem heavy = one_tet_problem(1);
    heavy.density_kg_m3 = 1000.0;
    heavy.gravity_m_s2 = {0.0, 3.0, -4.0};
    EXPECT_EQ(lines_of(deck_of(heavy), "*DLOAD"), Lines{"TETS, GRAV, 5, 0, 0.6, -0.8"});
    EXPECT_EQ(lines_of(deck_of(heavy), "*DENSITY"), Lines{"1000"});
}

TEST(CalculixDeck, PutsMiddleNodesOnTheEdgesOfC3D10)
{
    const NodalProblem problem = one_tet_problem(2);
    ASSERT_EQ(problem.nodes.rows(), 10);
    const Lines tets = lines_of(deck_of(problem), "*ELEMENT, TYPE=C3D10, ELSET=TETS");
    ASSERT_EQ(tets.size(), 1u);
    const std::vector<double> tet = numbers_of(tets.front());
    ASSERT_EQ(tet.size(), 11u);
    const int edges_of_c3d10[6][2] = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}};
    const auto position = [&](int place) { return problem.nodes.row(static_cast<int>(tet[place]) - 1).eval(); };
    for (int k = 0; k < 6; ++k)
        EXPECT_EQ(position(5 + k), (position(edges_of_c3d10[k][0]) + position(edges_of_c3d10[k][1])) / 2.0) << "middle node " << 5 + k;
}

// One spring at the middle of the tet: its end is a fifth node that moves by half the sum of the corners' displacements, at a quarter of
// the stiffness.
TEST(CalculixDeck, TiesTheEndOfASpringToItsTet)
{
    NodalProblem problem = one_tet_problem(1);
    problem.held.assign(4, false);
    problem.forces_n.setZero();
    problem.springs = {pbs::Positions(1, 3), pbs::Positions(1, 3), Eigen::VectorXd::Constant(1, 8.0)};
    problem.springs.points << 0.25, 0.25, 0.025;
    problem.springs.targets << 0.75, 0.25, 0.025;
    const std::string deck = deck_of(problem);
    EXPECT_EQ(deck.find("*BOUNDARY"), std::string::npos);
    EXPECT_EQ(lines_of(deck, "*NODE, NSET=ENDS"), Lines{"5, 0, 0, 0"});
    EXPECT_EQ(lines_of(deck, "*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS2"), Lines{"3, 5"});
    const Lines spring = lines_of(deck, "*SPRING, ELSET=SPRINGS3");
    ASSERT_EQ(spring.size(), 2u);
    EXPECT_EQ(spring[0], "3");
    EXPECT_NEAR(std::stod(spring[1]), 2.0, rounding_error(50, 2.0));

    const Lines equations = lines_of(deck, "*EQUATION");
    ASSERT_EQ(equations.size(), 9u);  // three lines in each direction
    EXPECT_EQ(equations[3], "5");
    const std::vector<double> numbers = numbers_of(equations[4] + ", " + equations[5]);
    ASSERT_EQ(numbers.size(), 15u);
    const double sign = -numbers[5] / std::abs(numbers[5]);  // of an eigenvector, which is arbitrary
    for (int term = 0; term < 5; ++term) {
        EXPECT_EQ(numbers[3 * term], term == 0 ? 5 : term);
        EXPECT_EQ(numbers[3 * term + 1], 2);
        EXPECT_NEAR(numbers[3 * term + 2], term == 0 ? 1.0 : -0.5 * sign, rounding_error(50, 1.0));
    }

    const Lines loads = lines_of(deck, "*CLOAD");
    ASSERT_EQ(loads.size(), 12u);  // three at each corner: 8 N/m times 0.5 m along x over four corners
    for (int corner = 0; corner < 4; ++corner) EXPECT_NEAR(numbers_of(loads[3 * corner]).back(), 1.0, rounding_error(50, 1.0));
}

TEST(CalculixDeck, AsksForTheAnalysis)
{
    const NodalProblem problem = one_tet_problem(1);
    EXPECT_NE(deck_of(problem).find("*STEP\n*STATIC\n"), std::string::npos);
    EXPECT_NE(deck_of(problem).find("*RESTART, WRITE\n"), std::string::npos);
    EXPECT_EQ(deck_of(problem, {.analysis = CalculixAnalysis::none}).find("*STEP"), std::string::npos);
    EXPECT_NE(deck_of(problem, {.analysis = CalculixAnalysis::large_strain}).find("*STEP, NLGEOM"), std::string::npos);
    const std::string tight = deck_of(problem, {.analysis = CalculixAnalysis::large_strain, .residual = 1e-12});
    EXPECT_NE(tight.find("*CONTROLS, PARAMETERS=FIELD\n1e-12, 1e-9\n"), std::string::npos);
    EXPECT_EQ(deck_of(problem, {.restart_file = false}).find("*RESTART"), std::string::npos);
}

// Reference: the energy of the springs themselves, sum_s k_s / 2 |X_s + u(X_s) - t_s|^2, for a displacement that the elements represent
// exactly: linear with P1, quadratic with P2.

class EquivalentSpringsOfOrder : public testing::TestWithParam<int> {
protected:
    EquivalentSpringsOfOrder()
    {
        constexpr int springs = 50;
        const Eigen::MatrixXd weights = Eigen::MatrixXd::NullaryExpr(springs, 4, [&] { return number(0.1, 1.0); });
        problem_.springs.points = weights.rowwise().sum().cwiseInverse().asDiagonal() * weights * problem_.nodes.topRows(4);
        problem_.springs.targets = pbs::Positions::NullaryExpr(springs, 3, [&] { return number(-1.0, 1.0); });
        problem_.springs.stiffness_n_m = Eigen::VectorXd::NullaryExpr(springs, [&] { return number(1.0, 1000.0); });
    }

    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

    // Linear with P1, quadratic with P2.
    Eigen::RowVector3d displacement(const Eigen::RowVector3d& x, double size) const
    {
        const double quadratic = GetParam() == 2 ? 1.0 : 0.0;
        return size * Eigen::RowVector3d(0.3 - x(1) + quadratic * x(0) * x(2), 2.0 * x(0) + x(2) - quadratic * x(1) * x(1),
                                         0.1 + quadratic * x(2) * x(0));
    }

    double energy_of_all(double size) const
    {
        const GroundSprings& springs = problem_.springs;
        double energy = 0.0;
        for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
            const Eigen::RowVector3d point = springs.points.row(s);
            energy += springs.stiffness_n_m(s) / 2.0 * (point + displacement(point, size) - springs.targets.row(s)).squaredNorm();
        }
        return energy;
    }

    double energy_of(const EquivalentSprings& few, double size) const
    {
        pbs::Positions at_nodes = problem_.nodes;
        for (auto row : at_nodes.rowwise()) row = displacement(row, size);
        double energy = -few.forces_n.cwiseProduct(at_nodes).sum();
        for (const EquivalentSpring& spring : few.springs) {
            Eigen::RowVector3d end = Eigen::RowVector3d::Zero();
            for (Eigen::Index i = 0; i < problem_.tets.cols(); ++i)
                end += spring.coefficients(i) * at_nodes.row(problem_.tets(spring.tet, i));
            energy += few.stiffness_n_m / 2.0 * end.squaredNorm();
        }
        return energy;
    }

    std::mt19937_64 random_{3};
    NodalProblem problem_ = one_tet_problem(GetParam());
};

// Each side is a sum of less than 1000 products, whose magnitudes have a sum of at most some 1e5 J. Eigenvalues that are left out change it
// by eps times that.
TEST_P(EquivalentSpringsOfOrder, HaveTheEnergyOfAllButForAConstant)
{
    const EquivalentSprings few = equivalent_springs(problem_);
    EXPECT_LE(few.springs.size(), static_cast<std::size_t>(problem_.tets.cols()));
    for (const double size : {0.5, -2.0})
        EXPECT_NEAR(energy_of(few, size), energy_of_all(size) - energy_of_all(0.0), rounding_error(1000, 1e5));
    double largest = 0.0;  // so that coefficients fit into a deck
    for (const EquivalentSpring& spring : few.springs) largest = std::max(largest, spring.coefficients.squaredNorm());
    EXPECT_NEAR(largest, 1.0, rounding_error(20, 1.0));
}

TEST_P(EquivalentSpringsOfOrder, LeaveOutPointsOutsideTheFlesh)
{
    const double inside = energy_of(equivalent_springs(problem_), 1.0);
    problem_.springs.points.conservativeResize(51, 3);
    problem_.springs.targets.conservativeResize(51, 3);
    problem_.springs.stiffness_n_m.conservativeResize(51);
    problem_.springs.points.row(50) << 0.5, 0.5, 0.5;
    problem_.springs.targets.row(50).setOnes();
    problem_.springs.stiffness_n_m(50) = 1000.0;
    EXPECT_EQ(energy_of(equivalent_springs(problem_), 1.0), inside);
    problem_.springs = {};
    const EquivalentSprings none = equivalent_springs(problem_);
    EXPECT_TRUE(none.springs.empty());
    EXPECT_TRUE(none.forces_n.isZero(0.0));
}

INSTANTIATE_TEST_SUITE_P(ElementOrders, EquivalentSpringsOfOrder, testing::Values(1, 2));

// Each is 1 at its own node and 0 at the others; node 4 + k is in the middle of edge k.
TEST(TetShapeFunctions, AreOneAtTheirNode)
{
    for (const int nodes : {4, 10}) {
        const NodalProblem problem = one_tet_problem(nodes == 4 ? 1 : 2);
        Eigen::Matrix4d corners;
        for (int i = 0; i < 4; ++i) corners.col(i) << 1.0, problem.nodes.row(problem.tets(0, i)).transpose();
        for (int i = 0; i < nodes; ++i) {
            Eigen::Vector4d point;
            point << 1.0, problem.nodes.row(problem.tets(0, i)).transpose();
            const Eigen::VectorXd shapes = tet_shape_functions(corners.inverse() * point, nodes);
            EXPECT_LE((shapes - Eigen::VectorXd::Unit(nodes, i)).cwiseAbs().maxCoeff(), rounding_error(40, 1.0));
        }
    }
}

}  // namespace
