// The input that the reference refuses, and what it reports about its set-up. The verification tests show that it solves correctly.

#include "pbs/geometry/input_error.hpp"
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "tests/support/element_rounding.hpp"
#include "tests/support/solve_rounding.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});

Attachment springs_at(const pbs::Positions& points)
{
    return {points, Eigen::VectorXd::Constant(points.rows(), 10.0), {}};
}

pbs::Positions three_points()
{
    pbs::Positions points(3, 3);
    points << 0.1, 0.1, 0.1, 0.1, 0.9, 0.1, 1.9, 0.5, 0.5;
    return points;
}

void expect_refused(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment, const std::string& field)
{
    try {
        LinearElasticity fem(mesh, options, attachment);
        FAIL() << field << " was accepted";
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
}

TEST(LinearElasticity, RefusesOptionsOutOfBounds)
{
    const auto refused = [](const std::string& field, const std::function<void(LinearOptions&)>& spoil) {
        LinearOptions options;
        spoil(options);
        expect_refused(bar, options, springs_at(three_points()), field);
    };
    refused("element_order", [](auto& o) { o.element_order = 3; });
    refused("young_pa", [](auto& o) { o.young_pa = 0.0; });
    refused("young_pa", [](auto& o) { o.young_pa = std::nan(""); });
    refused("poisson", [](auto& o) { o.poisson = 0.5; });
    refused("poisson", [](auto& o) { o.poisson = -1.0; });
    refused("density_kg_m3", [](auto& o) { o.density_kg_m3 = -1.0; });
    refused("gravity_m_s2", [](auto& o) { o.gravity_m_s2(1) = INFINITY; });
}

TEST(LinearElasticity, RefusesBadAttachments)
{
    const auto refused = [](const std::string& field, const std::function<void(Attachment&)>& spoil) {
        Attachment attachment = springs_at(three_points());
        spoil(attachment);
        expect_refused(bar, {}, attachment, field);
    };
    refused("spring_stiffness", [](auto& a) { a.spring_stiffness.conservativeResize(2); });
    refused("spring_stiffness", [](auto& a) { a.spring_stiffness(1) = 0.0; });
    refused("spring_points", [](auto& a) { a.spring_points(1, 1) = std::nan(""); });
    refused("prescribed_tets", [](auto& a) { a.prescribed_tets = {static_cast<int>(bar.tets.rows())}; });
    refused("prescribed_tets", [](auto& a) { a.prescribed_tets = {-1}; });
}

TEST(LinearElasticity, RefusesABodyThatCanMoveFreely)
{
    expect_refused(bar, {}, {}, "attachment");
    expect_refused(bar, {}, springs_at(three_points().topRows(2)), "attachment");
    pbs::Positions on_one_line(3, 3);
    on_one_line << 0.1, 0.5, 0.5, 0.7, 0.5, 0.5, 1.9, 0.5, 0.5;
    expect_refused(bar, {}, springs_at(on_one_line), "attachment");
    expect_refused(bar, {}, springs_at(three_points().array() + 10.0), "attachment");  // all points are outside
}

TEST(LinearElasticity, RefusesAPartOfTheMeshThatNothingHolds)
{
    pbs::TetMesh two = bar;
    const int vertices = static_cast<int>(bar.rest.rows());
    two.rest.conservativeResize(2 * vertices, 3);
    two.rest.bottomRows(vertices) = bar.rest.array() + 5.0;
    two.tets.conservativeResize(2 * bar.tets.rows(), 4);
    two.tets.bottomRows(bar.tets.rows()) = bar.tets.array() + vertices;
    expect_refused(two, {}, springs_at(three_points()), "attachment");
    Attachment both = springs_at(three_points());
    both.prescribed_tets = {static_cast<int>(bar.tets.rows())};
    EXPECT_NO_THROW(LinearElasticity(two, {}, both));
}

TEST(LinearElasticity, RefusesTargetsOfTheWrongSize)
{
    LinearElasticity fem(bar, {}, springs_at(three_points()));
    EXPECT_THROW(fem.solve(three_points().topRows(2), bar.rest), pbs::InputError);
    EXPECT_THROW(fem.solve(three_points(), bar.rest.topRows(2)), pbs::InputError);
}

TEST(LinearElasticity, TargetsThatAreNotNumbersAreAReportedOutcome)
{
    LinearElasticity fem(bar, {}, springs_at(three_points()));
    EXPECT_FALSE(fem.solve(three_points().array() * std::nan(""), bar.rest).finite);
    EXPECT_TRUE(fem.solve(three_points(), bar.rest).finite) << "the next frame is whole again";
    EXPECT_EQ(fem.positions(), bar.rest);
}

TEST(LinearElasticity, SpringsOutsideEveryTetAreLeftOutAndReported)
{
    pbs::Positions points(4, 3);
    points << three_points(), 5.0, 0.5, 0.5;
    LinearElasticity fem(bar, {}, springs_at(points));
    EXPECT_GE(fem.setup().spring_tet[0], 0);
    EXPECT_EQ(fem.setup().spring_tet[3], -1);
    pbs::Positions targets = points;
    targets.row(3).array() += 100.0;  // a target that nothing is tied to
    ASSERT_TRUE(fem.solve(targets, bar.rest).finite);
    EXPECT_EQ(fem.positions(), bar.rest);
    EXPECT_EQ(fem.spring_points_deformed().topRows(3), points.topRows(3));
    EXPECT_FALSE(fem.spring_points_deformed().row(3).allFinite());
}

TEST(LinearElasticity, PrescribedTetsHoldTheirVerticesAndNoOthers)
{
    Attachment attachment;
    attachment.prescribed_tets = {3};
    const LinearElasticity fem(bar, {}, attachment);
    const std::vector<bool> prescribed = fem.prescribed_vertices();
    EXPECT_EQ(std::count(prescribed.begin(), prescribed.end(), true), 4);
    for (const int vertex : bar.tets.row(3)) EXPECT_TRUE(prescribed[vertex]);
}

TEST(LinearElasticity, SetupSaysWhatWasDone)
{
    const LinearElasticity fem(bar, {.element_order = 1}, springs_at(three_points()));
    EXPECT_EQ(fem.setup().dofs, 3 * bar.rest.rows());
    EXPECT_TRUE(fem.setup().factored);
    EXPECT_NE(fem.setup().solver.find("CHOLMOD"), std::string::npos);
    EXPECT_NE(fem.setup().blas.find("blas"), std::string::npos);
    EXPECT_GT(fem.setup().reciprocal_condition, 0.0);
}

// Reference: theory. The normal integrates to zero over a closed surface, and x . n to three times the volume. A bar on rollers under
// uniform tension has an affine displacement and a uniform stress. Tolerances: rounding of a direct solve, by cond(K), and of sums over
// nodes of entries, into which the normal brings the Jacobian once more. The magnitudes of all shape functions at a point add up to at
// most 2.

using pbs::Vec3;

class BoundaryData : public testing::TestWithParam<int> {
protected:
    static double sum_error(const SimplexSpace& space, double area)
    {
        const double of_entry = test_support::entry_roundings(space, GetParam() + 1, 1) + test_support::jacobian_roundings(space);
        return test_support::rounding_error(of_entry + space.nodes(), 2.0 * area);
    }

    const pbs::TetMesh cube = test_support::jittered_cube(3);
};

TEST_P(BoundaryData, AUniformPressureAddsUpToNothingAndDoesTheWorkOfTheVolume)
{
    const SimplexSpace space(cube, GetParam());
    const Eigen::VectorXd load =
        traction_load(space, {[](const Vec3&) { return true; }, [](const Vec3&, const Vec3& normal) { return normal; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    const double rounding = sum_error(space, 6.0), farthest = std::sqrt(3.0);
    EXPECT_LT(forces.colwise().sum().norm(), rounding);
    EXPECT_NEAR((forces.array() * space.node_positions().array()).sum(), 3.0, farthest * rounding);
    EXPECT_LT(rounding, 1e-11) << "a bound that would let a wrong face pass proves nothing";
}

TEST_P(BoundaryData, OnlyTheFacesThatAreAskedForAreLoaded)
{
    const SimplexSpace space(cube, GetParam());
    const auto on_top = [](const Vec3& centre) { return centre.z() > 1.0 - 1e-9; };
    const Eigen::VectorXd load = traction_load(space, {on_top, [](const Vec3& x, const Vec3&) -> Vec3 { return {0, 0, x.x()}; }});
    const Eigen::Map<const pbs::Positions> forces(load.data(), space.nodes(), 3);
    EXPECT_LT((forces.colwise().sum() - Eigen::RowVector3d(0, 0, 0.5)).norm(), sum_error(space, 1.0));
    // Away from a face a shape function is zero to the rounding of its terms, of at most 3. The faces of six tets about a node have a third
    // of the area.
    for (int node = 0; node < space.nodes(); ++node)
        if (space.node_positions()(node, 2) < 1.0 - 1e-9) {
            EXPECT_LT(forces.row(node).norm(), test_support::rounding_error(8, 3.0 / 3.0));
        }
}

TEST_P(BoundaryData, ABarOnRollersIsStretchedUniformly)
{
    const ElasticMaterial material{2.0e5, 0.3};
    const double tension_pa = 1.0e3, strain = tension_pa / material.young_pa;
    const auto exact = [&](const Vec3& x) -> Vec3 { return strain * Vec3(x.x(), -material.poisson * x.y(), -material.poisson * x.z()); };
    const BoundaryValueSolution solution =
        solve(cube, material,
              {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
               .element_order = GetParam(),
               .tractions = {{[](const Vec3& centre) { return centre.x() > 1.0 - 1e-9; },
                              [&](const Vec3&, const Vec3& normal) -> Vec3 { return tension_pa * normal; }}}});
    const test_support::SolveRounding rounding = test_support::rounding_of(solution, material);
    EXPECT_LT(rounding.relative(), 1e-9) << "a bound that would let an error of a percent pass proves nothing";
    EXPECT_LT(test_support::relative_error(solution, exact), rounding.relative());
    EXPECT_LT((solution.displacement_at({1, 1, 1}) - exact({1, 1, 1})).norm(), rounding.error_m());
    const Eigen::Matrix3d stress = Vec3(tension_pa, 0, 0).asDiagonal();
    for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0.33, 0.33, 0.66)})
        EXPECT_LT((solution.stress_at(point, material) - stress).norm(),
                  rounding.stress_pa(lame_parameters(material.young_pa, material.poisson), cube));
    EXPECT_NEAR(solution.work_of_load_j(), tension_pa * strain, rounding.error_m() * solution.load.norm());
    const double energy_j = tension_pa * strain / 2.0;
    EXPECT_NEAR(solution.strain_energy_j(material), energy_j, rounding.energy_j(energy_j));
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, BoundaryData, testing::Values(1, 2));

}  // namespace
