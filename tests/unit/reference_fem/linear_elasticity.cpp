// The input that the reference refuses, and what it reports about its set-up. The verification tests show that it
// solves correctly.

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/structured_bar.hpp"

namespace linear_elasticity_tests {
namespace {

using namespace reference_fem;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});

Attachment springs_at(const pbs::Positions& points)
{
    return {points, Eigen::VectorXd::Constant(points.rows(), 10.0), {}};
}

const pbs::Positions three_points{{0.1, 0.1, 0.1}, {0.1, 0.9, 0.1}, {1.9, 0.5, 0.5}};

void expect_refused(const std::string& field, const Attachment& attachment, const LinearOptions& options = {},
                    const pbs::TetMesh& mesh = bar)
{
    test_support::expect_refused(field, [&] { LinearElasticity(mesh, options, attachment); });
}

TEST(LinearElasticity, RefusesOptionsOutOfBounds)
{
    const Attachment held = springs_at(three_points);
    expect_refused("element_order", held, {.element_order = 3});
    for (const double young_pa : {0.0, std::nan("")}) expect_refused("young_pa", held, {.young_pa = young_pa});
    for (const double poisson : {0.5, -1.0}) expect_refused("poisson", held, {.poisson = poisson});
    expect_refused("density_kg_m3", held, {.density_kg_m3 = -1.0});
    expect_refused("gravity_m_s2", held, {.gravity_m_s2 = {0.0, INFINITY, 0.0}});
}

TEST(LinearElasticity, RefusesBadAttachmentsAndABodyThatCanMoveFreely)
{
    const auto refused = [](const std::string& field, const std::function<void(Attachment&)>& spoil) {
        Attachment attachment = springs_at(three_points);
        spoil(attachment);
        expect_refused(field, attachment);
    };
    refused("spring_stiffness", [](auto& a) { a.spring_stiffness.conservativeResize(2); });
    refused("spring_stiffness", [](auto& a) { a.spring_stiffness(1) = 0.0; });
    refused("spring_points", [](auto& a) { a.spring_points(1, 1) = std::nan(""); });
    refused("prescribed_tets", [](auto& a) { a.prescribed_tets = {static_cast<int>(bar.tets.rows())}; });
    refused("prescribed_tets", [](auto& a) { a.prescribed_tets = {-1}; });
    const pbs::Positions two = three_points.topRows(2), on_one_line{{0.1, 0.5, 0.5}, {0.7, 0.5, 0.5}, {1.9, 0.5, 0.5}},
                         outside = three_points.array() + 10.0;
    expect_refused("attachment", {});
    for (const pbs::Positions& points : {two, on_one_line, outside}) expect_refused("attachment", springs_at(points));
}

TEST(LinearElasticity, RefusesAPartOfTheMeshThatNothingHolds)
{
    const pbs::TetMesh two = joined({bar, test_support::structured_bar({5, 5, 5}, {7, 6, 6}, {2, 1, 1})});
    expect_refused("attachment", springs_at(three_points), {}, two);
    Attachment both = springs_at(three_points);
    both.prescribed_tets = {static_cast<int>(bar.tets.rows())};
    EXPECT_NO_THROW(LinearElasticity(two, {}, both));
}

TEST(LinearElasticity, RefusesTargetsOfTheWrongSizeAndReportsThoseThatAreNotNumbers)
{
    LinearElasticity fem(bar, {}, springs_at(three_points));
    EXPECT_THROW(fem.solve(three_points.topRows(2), bar.rest), pbs::InputError);
    EXPECT_THROW(fem.solve(three_points, bar.rest.topRows(2)), pbs::InputError);
    EXPECT_FALSE(fem.solve(three_points.array() * std::nan(""), bar.rest).finite);
    EXPECT_TRUE(fem.solve(three_points, bar.rest).finite) << "the next frame is whole again";
    EXPECT_EQ(fem.positions(), bar.rest);
}

TEST(LinearElasticity, SpringsOutsideEveryTetAreLeftOutAndReported)
{
    pbs::Positions points(4, 3);
    points << three_points, 5.0, 0.5, 0.5;
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

TEST(LinearElasticity, SetupSaysWhatWasDone)
{
    const LinearElasticity fem(bar, {.element_order = 1}, springs_at(three_points)),
        held(bar, {}, {.prescribed_tets = {3}});
    EXPECT_EQ(fem.setup().dofs, 3 * bar.rest.rows());
    EXPECT_TRUE(fem.setup().factored);
    EXPECT_NE(fem.setup().solver.find("CHOLMOD"), std::string::npos);
    EXPECT_NE(fem.setup().blas.find("blas"), std::string::npos);
    EXPECT_GT(fem.setup().reciprocal_condition, 0.0);
    const std::vector<bool> prescribed = held.prescribed_vertices();  // those of the tet and no others
    EXPECT_EQ(std::count(prescribed.begin(), prescribed.end(), true), 4);
    for (const int vertex : bar.tets.row(3)) EXPECT_TRUE(prescribed[vertex]);
}

// Reference: theory. The normal integrates to zero over a closed surface, and x . n to three times the volume.
// Tolerances: rounding of sums over nodes of entries, into which the normal brings the Jacobian once more. The
// magnitudes of all shape functions at a point add up to at most 2.

using pbs::Vec3;

double sum_error(const SimplexSpace& space, double area)
{
    const double of_entry =
        test_support::entry_roundings(space, space.element_order() + 1, 1) + test_support::jacobian_roundings(space);
    return test_support::rounding_error(of_entry + space.nodes(), 2.0 * area);
}

TEST(TractionLoad, OfAUniformPressureAddsUpToNothingAndOnlyTheFacesThatAreAskedForAreLoaded)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(test_support::jittered_cube(3), order);
        const auto forces_of = [&](const Traction& traction) -> pbs::Positions {
            const Eigen::VectorXd load = traction_load(space, traction);
            return Eigen::Map<const pbs::Positions>(load.data(), space.nodes(), 3);
        };
        const pbs::Positions pressed =
            forces_of({[](const Vec3&) { return true; }, [](const Vec3&, const Vec3& normal) { return normal; }});
        const double rounding = sum_error(space, 6.0), farthest = std::sqrt(3.0);
        EXPECT_LT(pressed.colwise().sum().norm(), rounding);
        // the work of the volume
        EXPECT_NEAR((pressed.array() * space.node_positions().array()).sum(), 3.0, farthest * rounding);
        EXPECT_LT(rounding, 1e-11) << "a bound that would let a wrong face pass proves nothing";

        const auto on_top = [](const Vec3& centre) { return centre.z() > 1.0 - 1e-9; };
        const pbs::Positions forces = forces_of({on_top, [](const Vec3& x, const Vec3&) -> Vec3 {
                                                     return {0, 0, x.x()};
                                                 }});
        EXPECT_LT((forces.colwise().sum() - Eigen::RowVector3d(0, 0, 0.5)).norm(), sum_error(space, 1.0));
        // Away from a face a shape function is zero to the rounding of its terms, of at most 3. The faces of six tets
        // about a node have a third of the area.
        for (int node = 0; node < space.nodes(); ++node)
            if (space.node_positions()(node, 2) < 1.0 - 1e-9) {
                EXPECT_LT(forces.row(node).norm(), test_support::rounding_error(8, 3.0 / 3.0));
            }
    }
}

}  // namespace
}  // namespace linear_elasticity_tests
