// Reference: minima known by hand, and the outcome that each kind of failure must have.

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <algorithm>
#include <limits>

namespace newton_tests {
namespace {

using namespace reference_fem;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
const Lame lame = lame_parameters(1e3, 0.3);

// The end x = 0 is held.
std::vector<bool> held_end(const SimplexSpace& space)
{
    return prescribed_data(space, {.held = [](const pbs::Vec3& x) { return x.x() == 0.0; }}).held;
}

// The bar with its end held.
struct HeldBar {
    explicit HeldBar(Model model, int element_order = 1)
        : space(bar, element_order),
          flesh(space, model, lame, Formulation::displacement),
          newton(space, held_end(space), LinearSolver::cholmod)
    {
    }

    Eigen::VectorXd weight(double force_n_m3) const
    {
        return load_vector(space, [&](const pbs::Vec3&) { return pbs::Vec3(0, 0, -force_n_m3); });
    }
    // Displaced along itself by this strain.
    Eigen::VectorXd strained(double strain) const
    {
        return test_support::at_nodes(space, [&](const pbs::Vec3& x) -> pbs::Vec3 { return {strain * x.x(), 0, 0}; });
    }

    SimplexSpace space;
    ElasticPotential flesh;
    NewtonMinimiser newton;
    Eigen::VectorXd zero = Eigen::VectorXd::Zero(space.dofs());
};

// E = sum of (u_d - 1)^2 / 2, but -u_0^2 / 2 + u_0^4 / 4 of the first degree of freedom, which has no force at u_0 = 0.
// The projected Hessian overestimates the others by factors from 1 to 100.
class Saddle : public Potential {
public:
    double value(const Eigen::VectorXd& u) const override
    {
        const double first = u(0) * u(0);
        return 0.5 * (u.tail(u.size() - 1).array() - 1.0).square().sum() - 0.5 * first + 0.25 * first * first;
    }
    void add_gradient(const Eigen::VectorXd& u, Eigen::VectorXd& gradient) const override
    {
        gradient.tail(u.size() - 1).array() += u.tail(u.size() - 1).array() - 1.0;
        gradient(0) += u(0) * u(0) * u(0) - u(0);
    }
    void add_hessian(const Eigen::VectorXd& u, Definiteness definiteness, NodalMatrix& hessian) const override
    {
        for (int n = 0; n < u.size() / 3; ++n) {
            Eigen::Vector3d diagonal = Eigen::Vector3d::Ones();
            if (definiteness == Definiteness::projected) diagonal *= std::pow(100.0, (n + 1) / (u.size() / 3.0));
            if (n == 0) diagonal(0) = definiteness == Definiteness::projected ? 1.0 : 3.0 * u(0) * u(0) - 1.0;
            hessian.add_block(n, n, diagonal.asDiagonal().toDenseMatrix());
        }
    }
    bool is_quadratic() const override { return false; }
};

TEST(Newton, AQuadraticTakesOneStepAndKeepsItsFactorAndNothingToDoTakesNone)
{
    HeldBar held(Model::linear);
    DeadLoad load(held.weight(10.0));
    Eigen::VectorXd u = held.zero;
    NewtonSummary summary = held.newton.minimise({&held.flesh, &load}, u, u, {});
    EXPECT_TRUE(summary.converged());
    EXPECT_EQ(summary.steps(), 1);
    EXPECT_EQ(summary.factorisations, 1);
    // The gradient at both states and the Hessian at the first one visit the 12 tets.
    EXPECT_EQ(summary.work,
              (pbs::WorkCounters{.gradients = 2, .tet_visits = 3 * 12, .linear_solves = 1, .factorisations = 1}));
    const Eigen::VectorXd once = u;

    load.set(held.weight(20.0));
    summary = held.newton.minimise({&held.flesh, &load}, u, u, {});
    EXPECT_EQ(summary.factorisations, 0);
    EXPECT_EQ(summary.work, (pbs::WorkCounters{.gradients = 2, .tet_visits = 2 * 12, .linear_solves = 1}));
    // Two direct solves with one factor, each in error by rounding.
    const Spectrum of_flesh = spectrum(rest_stiffness(held.space, held.flesh).matrix(), held_end(held.space));
    EXPECT_LT((u - 2.0 * once).norm(), 2.0 * rounding_bound(of_flesh) * u.norm());
    HeldBar other(Model::corotational);
    u = held.zero;
    summary = other.newton.minimise({&other.flesh}, u, u, {});
    EXPECT_TRUE(summary.converged());
    EXPECT_EQ(summary.steps(), 0);
    EXPECT_EQ(u, held.zero);
}

TEST(Newton, ConvergesFasterThanLinearly)
{
    HeldBar held(Model::stable_neo_hookean, 2);
    const DeadLoad load(held.weight(10.0));
    Eigen::VectorXd u = held.zero;
    const NewtonSummary summary = held.newton.minimise({&held.flesh, &load}, u, u, {.relative_tolerance = 1e-11});
    ASSERT_TRUE(summary.converged());
    ASSERT_GE(summary.iterations.size(), 4u);
    const auto& last = summary.iterations;
    const std::size_t n = last.size();
    // Theory: r_{k+1} = O(r_k^2), so each reduction is stronger than the previous one; a wrong tangent reduces by the
    // same factor each time.
    const double before_last = last[n - 3].residual_n / last[n - 4].residual_n,
                 reduction = last[n - 2].residual_n / last[n - 3].residual_n;
    EXPECT_LT(reduction, 0.1 * before_last);
    // Rounding of an energy: a sum over 12 tets of some 50 products each, of terms that may cancel tenfold.
    const double of_sums = 10.0 * 12 * 50 * std::numeric_limits<double>::epsilon();
    for (std::size_t k = 1; k < n; ++k)
        EXPECT_LE(last[k].energy_j, last[k - 1].energy_j + of_sums * std::abs(last[k - 1].energy_j));
}

// The same minimum with fewer factorisations. A kept factor serves only after a whole step that contracted enough.
TEST(Newton, ReusesItsFactorWhileStepsContract)
{
    HeldBar held(Model::stable_neo_hookean, 2);
    const DeadLoad load(held.weight(10.0));
    constexpr double contraction = 0.1, tolerance = 1e-11;
    const auto minimise = [&](double reuse_contraction, Eigen::VectorXd& u) {
        NewtonMinimiser newton(held.space, held_end(held.space), LinearSolver::cholmod);
        u = held.zero;
        return newton.minimise({&held.flesh, &load}, u, u,
                               {.relative_tolerance = tolerance, .reuse_contraction = reuse_contraction});
    };
    Eigen::VectorXd anew, kept;
    const NewtonSummary each_step = minimise(0.0, anew), reusing = minimise(contraction, kept);
    ASSERT_TRUE(each_step.converged() && reusing.converged());
    for (const NewtonSummary* summary : {&each_step, &reusing})
        EXPECT_LE(summary->iterations.back().residual_n, tolerance * summary->iterations.back().force_scale_n);
    EXPECT_LT(reusing.factorisations, each_step.factorisations);

    const auto& states = reusing.iterations;
    EXPECT_FALSE(states.front().reuses_factor);
    for (std::size_t k = 1; k + 1 < states.size(); ++k) {
        EXPECT_EQ(states[k].reuses_factor, states[k].residual_n <= contraction * states[k - 1].residual_n) << k;
        EXPECT_EQ(states[k].step_length, 1.0);
    }
    // Both residuals are at most the tolerance times the scale of the forces, and the Hessian, that at rest to first
    // order, divides them by its smallest eigenvalue.
    const Spectrum of_flesh = spectrum(rest_stiffness(held.space, held.flesh).matrix(), held_end(held.space));
    const double residuals =
        tolerance * (each_step.iterations.back().force_scale_n + reusing.iterations.back().force_scale_n);
    EXPECT_LT((kept - anew).norm(), 2.0 * residuals / of_flesh.smallest);
}

TEST(Newton, TheIncrementOfPrescribedDataGoesIntoTheFirstSolve)
{
    const SimplexSpace space(bar, 1);
    const ElasticPotential flesh(space, Model::linear, lame, Formulation::displacement);
    std::vector<bool> held(space.dofs());
    Eigen::VectorXd stretched = Eigen::VectorXd::Constant(space.dofs(), std::numeric_limits<double>::quiet_NaN());
    for (int d = 0; d < space.dofs(); ++d) {
        const double x = space.node_positions()(d / 3, 0);
        held[d] = x == 0.0 || x == 2.0;
        if (held[d]) stretched(d) = d % 3 == 0 ? 0.1 * x : 0.0;
    }
    NewtonMinimiser newton(space, held, LinearSolver::cholmod);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(space.dofs());
    const NewtonSummary summary = newton.minimise({&flesh}, stretched, u, {});
    ASSERT_TRUE(summary.converged());
    EXPECT_EQ(summary.steps(), 1);
    EXPECT_TRUE(summary.iterations.front().carries_increment);
    for (int d = 0; d < space.dofs(); ++d) {
        if (held[d]) {
            EXPECT_EQ(u(d), stretched(d));
        }
    }
}

TEST(Newton, AnIndefiniteHessianIsProjectedAndSaidSo)
{
    HeldBar held(Model::stable_neo_hookean);
    Eigen::VectorXd u = held.strained(-1.4);  // compressed flat and beyond
    const NewtonSummary summary = held.newton.minimise({&held.flesh}, held.zero, u, {});
    ASSERT_TRUE(summary.converged()) << name_of(summary.outcome);
    EXPECT_TRUE(
        std::any_of(summary.iterations.begin(), summary.iterations.end(), [](const auto& it) { return it.projected; }));
    // The only stress-free state with this end held is rest. All forces vanish there, so Newton's method ends at the
    // residual that the rounding of positions causes, 4 eps D |diag H|, D = sqrt 6 m; the error of u is at most that
    // over the smallest eigenvalue. The factor 2 is for the Hessian of the step before, at which the solver takes this
    // residual.
    const SparseMatrix hessian = rest_stiffness(held.space, held.flesh).matrix();
    const double residual_n = 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(6.0) * hessian.diagonal().norm();
    EXPECT_LT(u.norm(), 2.0 * residual_n / spectrum(hessian, held_end(held.space)).smallest);
}

// Each step reduces the residual, at first sqrt(35) N, to a tenth. A single term converges down to the rounding of
// positions, 4 eps D |diag H| with D = sqrt 6 m and |diag H| < 300 N/m, which is 14 decades. Steps of the projected
// Hessian alone would leave 99 % of the largest component each. The Hessian is 1 N/m for all but the first degree of
// freedom, so that the residual is the error.
const double rounding_n = 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(6.0) * 300.0;

class NewtonAtASaddle : public testing::Test {
protected:
    NewtonSummary minimise(Eigen::VectorXd& u, const NewtonOptions& options = {}) const
    {
        NewtonMinimiser newton(space, std::vector<bool>(space.dofs(), false), LinearSolver::cholmod);
        return newton.minimise({&saddle}, u, u, options);
    }

    const SimplexSpace space{bar, 1};
    const Saddle saddle;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(space.dofs());
};

TEST_F(NewtonAtASaddle, StepsAreThoseOfTheHessianItselfWhereItIsIndefinite)
{
    const NewtonSummary summary = minimise(u);
    ASSERT_TRUE(summary.converged());
    EXPECT_LE(summary.steps(), 14);
    for (int d = 1; d < space.dofs(); ++d) EXPECT_NEAR(u(d), 1.0, rounding_n) << d;
    for (std::size_t k = 0; k + 1 < summary.iterations.size(); ++k) EXPECT_TRUE(summary.iterations[k].projected);
}

// Where the force has a component along the direction of negative curvature, the way leads from the saddle to a
// minimum, u_0 = 1.
TEST_F(NewtonAtASaddle, LeavesItAlongNegativeCurvature)
{
    u(0) = 0.01;
    ASSERT_TRUE(minimise(u).converged());
    for (int d = 0; d < space.dofs(); ++d) EXPECT_NEAR(u(d), 1.0, rounding_n) << d;
}

// At u_0 = 0 every Hessian of the saddle is indefinite.
TEST_F(NewtonAtASaddle, EndsAfterSoManyIndefiniteHessiansInARow)
{
    Eigen::VectorXd other = u;
    const NewtonSummary ended = minimise(u, {.indefinite_in_a_row = 3}),
                        allowed = minimise(other, {.indefinite_in_a_row = 15});
    EXPECT_EQ(ended.outcome, NewtonOutcome::iterations_exhausted);
    EXPECT_EQ(ended.steps(), 3);
    EXPECT_TRUE(allowed.converged()) << "fewer than 15 steps lead to the saddle";
}

// Nothing but the largest step: this share in the first two, then a whole one.
class ShortSteps : public Potential {
public:
    explicit ShortSteps(double share) : share_(share) {}
    double value(const Eigen::VectorXd&) const override { return 0.0; }
    void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd&) const override {}
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix&) const override {}
    double largest_step(const Eigen::VectorXd&, const Eigen::VectorXd&) const override
    {
        return asked_++ < 2 ? share_ : 1.0;
    }
    bool is_quadratic() const override { return false; }

private:
    double share_;
    mutable int asked_ = 0;
};

TEST(Newton, DataThatMoveFartherThanContactAllowsArriveLaterOrTheStepFails)
{
    HeldBar bar(Model::linear);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(bar.space.dofs());
    Eigen::VectorXd u = bar.zero, unmoved = bar.zero;
    const ShortSteps shortened(0.4), none(0.0);
    const NewtonSummary moved = bar.newton.minimise({&bar.flesh, &shortened}, ones, u, {});
    EXPECT_TRUE(moved.converged());
    EXPECT_EQ(std::ranges::count(moved.iterations, true, &NewtonIteration::carries_increment), 3);
    // A rigid translation strains nothing. Its last step is one solve, and the two before have moved it in the same
    // direction.
    const Spectrum of_flesh = spectrum(rest_stiffness(bar.space, bar.flesh).matrix(), held_end(bar.space));
    EXPECT_LT((u - ones).norm(), 3.0 * rounding_bound(of_flesh) * ones.norm());
    EXPECT_EQ(bar.newton.minimise({&bar.flesh, &none}, ones, unmoved, {}).outcome, NewtonOutcome::no_descent);
    EXPECT_EQ(unmoved, bar.zero);
}

TEST(Newton, OutcomesOfFailure)
{
    HeldBar infinite(Model::neo_hookean), held(Model::stable_neo_hookean), other(Model::linear);
    Eigen::VectorXd inverted = held.strained(-2.0), u = held.zero, ones = Eigen::VectorXd::Ones(held.space.dofs());
    EXPECT_EQ(infinite.newton.minimise({&infinite.flesh}, held.zero, inverted, {}).outcome, NewtonOutcome::not_finite);
    const DeadLoad load(held.weight(10.0));
    EXPECT_EQ(held.newton.minimise({&held.flesh, &load}, held.zero, u, {.iterations = 1}).outcome,
              NewtonOutcome::iterations_exhausted);
    u = held.zero;
    EXPECT_EQ(held.newton.minimise({&held.flesh, &load}, held.zero, u, {.is_over = [] { return true; }}).outcome,
              NewtonOutcome::given_up);
    EXPECT_EQ(u, held.zero) << "no step is taken";
    const NodalMatrix stiffness = rest_stiffness(other.space, other.flesh);
    StiffnessPotential concave(stiffness);
    concave.set(-1.0, other.zero);
    EXPECT_EQ(other.newton.minimise({&concave}, ones, ones, {}).outcome, NewtonOutcome::not_positive_definite);
}

// Reference: an attempt that fails in a known way.

// Converges only in steps of at most `longest`, and never beyond `wall`; u(0) equals the fraction.
struct Attempt {
    Eigen::VectorXd& u;
    double longest, wall = 2.0;

    NewtonSummary operator()(double fraction) const
    {
        const bool converges = fraction - u(0) <= longest && fraction <= wall;
        u(0) = converges ? fraction : -99.0;  // the state that a failed solve leaves
        NewtonSummary summary;
        summary.outcome = converges ? NewtonOutcome::converged : NewtonOutcome::no_descent;
        return summary;
    }
};

// Two Newton steps per attempt.
TEST(LoadPath, EndsWhereItHasTakenTheStepsItMay)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const auto attempt = [&](double fraction) {
        NewtonSummary summary = Attempt{u, 0.25}(fraction);
        summary.iterations.assign(3, NewtonIteration{.step_length = 1.0});
        summary.iterations.back().step_length = 0.0;
        return summary;
    };
    const int needed = follow_load_path(attempt, u, {}).newton_steps();
    u.setZero();
    EXPECT_TRUE(follow_load_path(attempt, u, {.most_newton_steps = needed}).converged());
    u.setZero();
    // the last attempt is not started
    const LoadPathSummary path = follow_load_path(attempt, u, {.most_newton_steps = needed - 2});
    EXPECT_FALSE(path.converged());
    EXPECT_EQ(path.reached, u(0));
    EXPECT_GT(path.reached, 0.0);
}

TEST(LoadPath, TakesOneStepWhereItConvergesHalvesUntilItDoesAndDoublesAfterTwo)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1), halved = u;
    const LoadPathSummary one = follow_load_path(Attempt{u, 1.0}, u, {}),
                          path = follow_load_path(Attempt{halved, 0.3}, halved, {});
    EXPECT_TRUE(one.converged() && path.converged());
    EXPECT_EQ(one.steps.size(), 1u);
    EXPECT_EQ(one.halvings(), 0);
    EXPECT_EQ(halved(0), 1.0);
    EXPECT_GE(path.halvings(), 2);  // 1 and 1/2 fail at first
    u.setZero();
    std::vector<double> fractions;
    const auto attempt = [&](double fraction) {
        fractions.push_back(fraction);
        return Attempt{u, 1.0}(fraction);
    };
    follow_load_path(attempt, u, {.first_step = 0.125});
    EXPECT_EQ(fractions, (std::vector<double>{0.125, 0.25, 0.5, 0.75, 1.0}));
}

TEST(LoadPath, EndsInTheLastConvergedStateWhereAnAttemptIsGivenUp)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const auto attempt = [&](double fraction) {
        NewtonSummary summary = Attempt{u, 0.25}(fraction);
        if (fraction > 0.6) summary.outcome = NewtonOutcome::given_up;
        return summary;
    };
    const LoadPathSummary path = follow_load_path(attempt, u, {});
    EXPECT_EQ(path.steps.size(), 1u) << "no step is halved";
    EXPECT_EQ(u(0), 0.0);
    const LoadPathSummary later = follow_load_path(attempt, u, {.first_step = 0.25});
    EXPECT_FALSE(later.converged());
    EXPECT_EQ(later.reached, 0.5);
    EXPECT_EQ(u(0), 0.5);
}

TEST(LoadPath, StopsAtAWallInTheLastConvergedState)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const LoadPathSummary path =
        follow_load_path(Attempt{u, 1.0, 0.6}, u, {.first_step = 1.0, .smallest_step = 1.0 / 16.0});
    EXPECT_FALSE(path.converged());
    EXPECT_LE(path.reached, 0.6);
    EXPECT_GT(path.reached, 0.6 - 2.0 / 16.0);
    EXPECT_EQ(u(0), path.reached);
    EXPECT_EQ(path.steps.back().newton.outcome, NewtonOutcome::no_descent);
}

}  // namespace
}  // namespace newton_tests
