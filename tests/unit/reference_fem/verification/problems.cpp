// Reference: volumes in closed form, and the topology of a ball. Tolerances: the roundings of tets' volumes and of
// their sum. Where coordinates are multiples of 1/2 a volume is rounded once, by its division by 6.
#include "reference_fem/verification/problems.hpp"

#include "analysis/records/tables.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "reference_fem/verification/verification_record.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cmath>

namespace {

using namespace reference_fem;
using pbs::Vec3;
using test_support::rounding_error;

double lowest_volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff();
}

double volume(const pbs::TetMesh& mesh)
{
    return pbs::tet_volumes(mesh.rest, mesh.tets).sum();
}

void expect_ball(const pbs::TetMesh& mesh)
{
    const pbs::Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_components, 1);
    EXPECT_EQ(topology.boundary_euler, 2);
    EXPECT_EQ(topology.unused_vertices, 0);
}

TEST(StructuredMesh, ABoxIsFilledByEqualTetsAndJoinedBoxesShareTheirVertices)
{
    const pbs::TetMesh box = box_mesh({0, -1, 2}, {3, 1, 3}, {3, 2, 2});
    EXPECT_EQ(box.tets.rows(), 6 * 12);
    EXPECT_NEAR(volume(box), 6.0, rounding_error(1 + 6 * 12, 6.0));
    EXPECT_EQ(lowest_volume(box), 0.5 / 6.0);
    expect_ball(box);
    EXPECT_EQ(text_of({3, 2, 2}), "3 x 2 x 2");
    const pbs::TetMesh mirrored = mapped(box, [](const Vec3& p) -> Vec3 { return {-p.x(), p.y(), p.z()}; });
    EXPECT_GT(lowest_volume(mirrored), 0.0) << "a mirrored mesh is turned right side out";
    const pbs::TetMesh whole =
        joined({box_mesh({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), box_mesh({1, 0, 0}, {2, 1, 1}, {2, 2, 2})});
    EXPECT_EQ(whole.rest.rows(), 5 * 3 * 3);
    EXPECT_NEAR(volume(whole), 2.0, rounding_error(1 + 2 * 6 * 8, 2.0));
    expect_ball(whole);
}

TEST(StructuredMesh, JitterMovesInnerVerticesOnly)
{
    const pbs::TetMesh even = jittered_cube(4, 0.0), moved = jittered_cube(4, 0.45);
    EXPECT_GT(lowest_volume(moved), 0.0);
    EXPECT_NEAR(volume(moved), 1.0, test_support::volume_error(moved.rest, moved.tets));
    const std::vector<bool> on_boundary = pbs::boundary_vertices(even.tets, even.rest.rows());
    for (Eigen::Index v = 0; v < even.rest.rows(); ++v)
        EXPECT_EQ(even.rest.row(v) == moved.rest.row(v), on_boundary[v]);
}

// Reference: beam theory. A slender beam follows Bernoulli and Euler, and the reduction by shear and rotary inertia is
// proportional to (h / L)^2.

// Rayleigh's quotient over the Bernoulli-Euler mode lowers omega^2 by a factor of 1 + 2 s with s = 4.647 (r / L)^2 (1 +
// E / (k G)) / 2.
double first_order_share(double length_m)
{
    const double nu = 0.3, r_over_l = std::sqrt(1.0 / 12.0) * 0.1 / length_m;
    return 4.647 * r_over_l * r_over_l * (1.0 + (12.0 + 11.0 * nu) / 5.0) / 2.0;
}

// At 20 to 100 times the height. The mode itself changes by s, which changes the quotient by s^2; 4.647 has half a unit
// of its last digit.
TEST(BeamFrequency, IsLoweredByRotaryInertiaAndShear)
{
    for (const double length_m : {2.0, 4.0, 10.0}) {
        const double s = first_order_share(length_m);
        const Beam beam{length_m, 0.1, 1e5, 0.3, 1000.0};
        EXPECT_NEAR(1.0 - timoshenko_rad_s(beam) / bernoulli_euler_rad_s(beam), 1.0 - 1.0 / std::sqrt(1.0 + 2.0 * s),
                    s * s + 0.0005 / 4.647 * s);
    }
}

// Factors of powers of two change no digit. Blevins, Formulas for natural frequency and mode shape, 1979, table 8-1:
// f = 1.87510407^2 / (2 pi L^2) sqrt(E I / m). The printed root is rounded by half a unit of its last digit, which
// changes its square by twice the root times as much.
TEST(BeamFrequency, OfBernoulliAndEulerIsAsPrintedAndScalesAsTheRootOfYoungsModulusOverDensity)
{
    const Beam beam{1.0, 0.1, 1e5, 0.3, 1000.0}, stiff{1.0, 0.1, 4e5, 0.3, 1000.0}, heavy{1.0, 0.1, 1e5, 0.3, 4000.0};
    EXPECT_EQ(timoshenko_rad_s(stiff), 2.0 * timoshenko_rad_s(beam));
    EXPECT_EQ(timoshenko_rad_s(heavy), 0.5 * timoshenko_rad_s(beam));
    const double root = 1.87510407, half_a_unit = 0.5e-8, scale = std::sqrt(1e5 * 1e-4 / 12.0 / (1000.0 * 1e-2));
    EXPECT_NEAR(bernoulli_euler_rad_s({1.0, 0.1, 1e5, 0.0, 1000.0}), root * root * scale,
                2.0 * root * half_a_unit * scale);
}

// Reference: the rules in the header, by hand.

VerificationRow row()
{
    return {.problem = "beam",
            .quantity = {"mean_deflection", "deflection, \"mean\"", "newmark"},
            .elements = {2, "taylor_hood"},
            .material = {"linear", 0.3},
            .mesh = "4 x 1 x 1",
            .h_m = 0.25,
            .dofs = 90,
            .value = 1.96,
            .reference = -2.0,
            .unit = "m",
            .source = "closed form: a beam",
            .low = 1.95,
            .high = 2.05,
            .bound_from = "theory"};
}

TEST(VerificationRowTest, TheDifferenceIsSignedAndOfTheReferencesSize)
{
    VerificationRow without = row();
    EXPECT_DOUBLE_EQ(*difference_pct(without), 198.0);
    without.reference = 0.0;
    EXPECT_FALSE(difference_pct(without));
}

TEST(VerificationRowTest, HoldsBetweenItsBoundsWithItsOrder)
{
    struct Case {
        const char* name;
        std::function<void(VerificationRow&)> change;
        std::optional<bool> holds;
    };
    const auto ordered = [](std::optional<double> observed, double value = 1.96) {
        return [=](VerificationRow& r) { r.expected_order = 2.0, r.observed_order = observed, r.value = value; };
    };
    const std::vector<Case> all = {
        {"between the bounds", [](auto&) {}, true},
        {"below", [](auto& r) { r.value = 1.94; }, false},
        {"above", [](auto& r) { r.value = 2.06; }, false},
        {"not a number", [](auto& r) { r.value = std::nan(""); }, false},
        {"without an upper bound", [](auto& r) { r.high = std::nullopt, r.value = 1e300; }, true},
        {"no order was observed", ordered({}), false},
        {"its order", ordered(1.91), true},
        {"another order", ordered(2.11), false},
        {"its order outside of the bounds", ordered(2.0, 0.0), false},
        {"without bounds there is nothing to hold",
         [](auto& r) { r.low = r.high = std::nullopt, r.observed_order = 1.2; },
         {}}};
    for (const Case& of : all) {
        VerificationRow changed = row();
        of.change(changed);
        EXPECT_EQ(holds(changed), of.holds) << of.name;
    }
}

TEST(VerificationRecordTest, ComesBackFromItsTable)
{
    const test_support::ScratchFolder folder;
    VerificationRow seen = row();
    seen.low = seen.high = std::nullopt;
    seen.material = {"none"};
    seen.elements = {.formulation = "pbs"};
    seen.observed_order = 1.9;
    seen.value = std::nan("");
    const std::string file = folder / "verification.csv";
    table_of(verification_columns(), {row(), seen}).write(file);
    const analysis::CsvTable table = analysis::read_csv(file);
    EXPECT_EQ(table.rows(), 2);
    const std::vector<std::tuple<int, const char*, const char*>> cells = {{0, "quantity", "mean_deflection"},
                                                                          {0, "description", "deflection, \"mean\""},
                                                                          {0, "element_order", "2"},
                                                                          {0, "formulation", "taylor_hood"},
                                                                          {0, "setting", "newmark"},
                                                                          {0, "material", "linear"},
                                                                          {0, "holds", "yes"},
                                                                          {1, "poisson", ""},
                                                                          {1, "element_order", ""},
                                                                          {1, "formulation", "pbs"},
                                                                          {1, "holds", ""}};
    for (const auto& [number, column, text] : cells) EXPECT_EQ(table.text_at(number, column), text) << column;
    EXPECT_EQ(table.number(0, "value"), 1.96);
    EXPECT_EQ(table.number(0, "poisson"), 0.3);
    const VerificationRows read = rows_of(verification_columns(), table);
    EXPECT_EQ(table_of(verification_columns(), read).text(), table.text());
    EXPECT_TRUE(std::isnan(read.at(1).value));
    EXPECT_EQ(read.at(1).observed_order, 1.9);
}

}  // namespace
