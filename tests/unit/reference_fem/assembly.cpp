// Reference: the P1 stiffness of one tet in closed form, derived by hand; rigid motions store no energy; the load adds
// up to the weight; the energy is half of u K u. Tolerances: the roundings of an entry and of the sums that follow,
// times the magnitudes of the terms. The magnitudes of all shape functions at a point add up to at most 2, at the
// centroid of a quadratic tet.

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/options.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <random>
#include <set>

namespace assembly_tests {
namespace {

using namespace reference_fem;
using namespace test_support;
using pbs::Vec3;

const Lame material{2.0, 3.0};
constexpr const char* proves_nothing = "a bound that would let a wrong entry pass proves nothing";
const pbs::TetMesh bar = structured_bar({0, 0, 0}, {2, 1, 1}, {3, 2, 2});

double sum_of_weights(const SimplexSpace& space, int points_1d)
{
    return element_tables(space, points_1d).weights.cwiseAbs().sum();
}

TEST(Assembly, StiffnessOfOneLinearTetIsTheClosedForm)
{
    const pbs::TetMesh tet{pbs::Positions{{0.1, 0, 0}, {1.2, 0.1, 0}, {0.2, 0.9, 0.1}, {0, 0.3, 1.1}},
                           pbs::Tets{{0, 1, 2, 3}}};
    Eigen::Matrix3d edges = (tet.rest.bottomRows(3).rowwise() - tet.rest.row(0)).transpose();
    Eigen::Matrix<double, 3, 4> gradient;  // gradients of the four shape functions
    gradient.rightCols(3) = edges.inverse().transpose();
    gradient.col(0) = -gradient.rightCols(3).rowwise().sum();
    Eigen::MatrixXd expected(12, 12);
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
            expected.block<3, 3>(3 * a, 3 * b) =
                edges.determinant() / 6.0 *
                (material.lambda_pa * gradient.col(a) * gradient.col(b).transpose() +
                 material.mu_pa * gradient.col(b) * gradient.col(a).transpose() +
                 material.mu_pa * gradient.col(a).dot(gradient.col(b)) * Eigen::Matrix3d::Identity());
    const SimplexSpace space(tet, 1);
    const SparseMatrix stiffness = stiffness_matrix(space, material);
    EXPECT_LT((stiffness - expected).norm(),
              2.0 * rounding_error(entry_roundings(space, 1, 2), magnitudes(stiffness).norm()));
}

TEST(Assembly, StiffnessIsSymmetricAndKnowsNoRigidMotion)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        const SparseMatrix stiffness = stiffness_matrix(space, material);
        const SparseMatrix terms = magnitudes(stiffness);
        const double roundings = entry_roundings(space, order, 2);
        ASSERT_TRUE(stiffness.isCompressed());  // with each entry once, sorted
        for (Eigen::Index c = 0; c < stiffness.cols(); ++c)
            for (auto k = stiffness.outerIndexPtr()[c] + 1; k < stiffness.outerIndexPtr()[c + 1]; ++k)
                EXPECT_LT(stiffness.innerIndexPtr()[k - 1], stiffness.innerIndexPtr()[k]);
        EXPECT_LT((stiffness - SparseMatrix(stiffness.transpose())).norm(), rounding_error(roundings, terms.norm()));
        EXPECT_LT(rounding_error(roundings, terms.norm()), 1e-11 * stiffness.norm()) << proves_nothing;
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::VectorXd translation = at_nodes(space, [&](const Vec3&) -> Vec3 { return Vec3::Unit(axis); });
            const Eigen::VectorXd rotation =
                at_nodes(space, [&](const Vec3& x) -> Vec3 { return Vec3::Unit(axis).cross(x); });
            for (const Eigen::VectorXd& rigid : {translation, rotation})
                EXPECT_LT((stiffness * rigid).norm(),
                          rounding_error(roundings + most_entries(stiffness), (terms * rigid.cwiseAbs()).norm()));
        }
    }
}

TEST(Assembly, LoadAddsUpToTheTotalForceAndItsMoment)
{
    const Vec3 force(1.0, -2.0, 0.5);
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        const Eigen::VectorXd load = load_vector(space, [&](const Vec3&) { return force; });
        Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
        for (int n = 0; n < space.nodes(); ++n) {
            total += load.segment<3>(3 * n);
            moment += Vec3(space.node_positions().row(n)).cross(load.segment<3>(3 * n));
        }
        const double volume = 2.0, terms = 2.0 * sum_of_weights(space, order + 1) * force.norm(),
                     farthest = std::sqrt(6.0);
        const double roundings = entry_roundings(space, order + 1, 1) + space.nodes();
        EXPECT_LT((total - volume * force).norm(), rounding_error(roundings, terms));
        EXPECT_LT((moment - volume * Vec3(1.0, 0.5, 0.5).cross(force)).norm(),  // of the weight at the bar's centre
                  rounding_error(roundings + 2, terms * farthest));
        EXPECT_LT(rounding_error(roundings, terms), 1e-11) << proves_nothing;
    }
}

TEST(Assembly, LoadOfACubicForceIsExactOnQuadraticTets)
{
    // The virtual work of f = x^3 e_x with v = x^2 e_x over [0, 2] x [0, 1]^2 is 2^6 / 6. Its degree is 5, the highest
    // that three points per direction integrate.
    const SimplexSpace space(bar, 2);
    const Eigen::VectorXd load = load_vector(space, [](const Vec3& x) -> Vec3 { return {x(0) * x(0) * x(0), 0, 0}; });
    const Eigen::VectorXd square = at_nodes(space, [](const Vec3& x) -> Vec3 { return {x(0) * x(0), 0, 0}; });
    // The cube of a coordinate triples its eight roundings; x^3 x^2 is at most 2^5.
    const double roundings = entry_roundings(space, 3, 1) + 3 * 8 + space.nodes();
    EXPECT_NEAR(load.dot(square), 64.0 / 6.0, rounding_error(roundings, 2.0 * sum_of_weights(space, 3) * 32.0));
}

TEST(Assembly, EnergyIsHalfTheWorkOfTheStiffness)
{
    std::mt19937 random(3);
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        Eigen::VectorXd displacement(space.dofs());
        for (double& u : displacement) u = random() / 4294967296.0 - 0.5;
        const SparseMatrix stiffness = stiffness_matrix(space, material);
        const double work = displacement.dot(stiffness * displacement) / 2.0;
        // The work goes through the entries, their rows and the degrees of freedom, the energy through the gradients of
        // a tet and the points.
        const ElementTables tables = element_tables(space, order);
        const double roundings = 2.0 * entry_roundings(space, order, 2) + most_entries(stiffness) + space.dofs() +
                                 2 * tables.nodes_per_tet + static_cast<double>(tables.weights.size());
        const double rounding = rounding_error(
            roundings, displacement.cwiseAbs().dot(magnitudes(stiffness) * displacement.cwiseAbs()) / 2.0);
        EXPECT_NEAR(strain_energy(space, material, displacement), work, rounding);
        EXPECT_LT(rounding, 1e-10 * work) << proves_nothing;
    }
}

TEST(Assembly, ErrorNormsOfZeroAreTheNormsOfTheField)
{
    // |x|^2 and |grad|^2 = 1 for u = (x, 0, 0) over [0, 2] x [0, 1]^2: 8/3 and 2.
    const SimplexSpace space(bar, 1);
    const auto field = [](const Vec3& x) -> Vec3 { return {x(0), 0, 0}; };
    const auto gradient = [](const Vec3&) -> Eigen::Matrix3d { return Vec3(1, 0, 0).asDiagonal(); };
    const ErrorNorms norms = error_norms(space, Eigen::VectorXd::Zero(space.dofs()), field, gradient);
    // Squares go through the roundings of the volume and of a coordinate, twice, and the sum over all points of all
    // tets. The root of s has the error of s over 2 sqrt s.
    const ElementTables tables = element_tables(space, 4);
    const double roundings = jacobian_roundings(space) + 2 * 8 + 4 + static_cast<double>(tables.weights.size()),
                 volume = tables.weights.cwiseAbs().sum();
    EXPECT_NEAR(norms.l2, std::sqrt(8.0 / 3.0), rounding_error(roundings, 4.0 * volume) / (2.0 * std::sqrt(8.0 / 3.0)));
    EXPECT_NEAR(norms.h1_seminorm, std::sqrt(2.0), rounding_error(roundings, volume) / (2.0 * std::sqrt(2.0)));
    // A coordinate of at most 2 is compared with its interpolation, a sum of four products with shape functions, over a
    // volume of 2.
    EXPECT_LT(error_norms(space, at_nodes(space, field), field, gradient).l2,
              rounding_error(8 + 8 + 4, 2.0) * std::sqrt(2.0));
}

// Reference: the same sums in a dense matrix.

TEST(NodalMatrix, AddsWhatADenseMatrixAdds)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1}), order);
        NodalMatrix matrix(space);
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(space.dofs(), space.dofs());
        const auto nodes = space.tet_nodes().cols();
        for (Eigen::Index t = 0; t < space.tet_nodes().rows(); ++t) {
            const Eigen::MatrixXd values = Eigen::MatrixXd::Random(3 * nodes, 3 * nodes);
            matrix.add_tet(t, values);
            for (Eigen::Index a = 0; a < nodes; ++a)
                for (Eigen::Index b = 0; b < nodes; ++b)
                    dense.block<3, 3>(3 * space.tet_nodes()(t, a), 3 * space.tet_nodes()(t, b)) +=
                        values.block<3, 3>(3 * a, 3 * b);
        }
        matrix.add_block(0, 1, Eigen::Matrix3d::Constant(2.0));
        dense.block<3, 3>(0, 3).array() += 2.0;
        EXPECT_EQ(Eigen::MatrixXd(matrix.matrix()), dense);
        matrix.set_zero();
        EXPECT_EQ(matrix.matrix().norm(), 0.0);
    }
}

// Reference: the definition of nodal elements. Vertex v is node v, shape functions are 1 at their own node and 0 at the
// others. At nodes they are polynomials of 0, 1/2 and 1, which are not rounded.

TEST(SimplexSpace, KeepsVerticesAndTetsInTheirOrderAndAddsANodePerEdgeToQuadraticTets)
{
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        EXPECT_EQ(space.node_positions().topRows(bar.rest.rows()), bar.rest);
        EXPECT_EQ(space.tet_nodes().leftCols(4), bar.tets);
        EXPECT_EQ(space.nodes(), bar.rest.rows() + (order == 2 ? pbs::edges_of(bar.tets).rows() : 0));
    }
}

TEST(SimplexSpace, MidEdgeNodesLieInTheMiddleOfTheirEdges)
{
    const SimplexSpace space(bar, 2);
    std::set<int> seen;
    for (const auto& tet : space.tet_nodes().rowwise())
        for (int k = 0; k < 6; ++k) {
            const auto& [first, second] = SimplexSpace::edge_corners[k];
            const Eigen::RowVector3d middle = (bar.rest.row(tet(first)) + bar.rest.row(tet(second))) / 2.0;
            EXPECT_EQ(space.node_positions().row(tet(4 + k)), middle);
            seen.insert(tet(4 + k));
        }
    EXPECT_EQ(static_cast<int>(seen.size()), space.nodes() - bar.rest.rows());
}

TEST(SimplexSpace, ShapeFunctionsAreOneAtTheirOwnNodeAndZeroAtTheOthers)
{
    const Vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const int order : {1, 2}) {
        const SimplexSpace space(bar, order);
        for (int node = 0; node < space.tet_nodes().cols(); ++node) {
            const auto* ends = SimplexSpace::edge_corners[std::max(node - 4, 0)];
            const Vec3 point = node < 4 ? corners[node] : Vec3((corners[ends[0]] + corners[ends[1]]) / 2.0);
            const Eigen::VectorXd expected = Eigen::VectorXd::Unit(space.tet_nodes().cols(), node);
            EXPECT_EQ(space.shape_values(point), expected) << "order " << order << ", node " << node;
        }
        // A function goes through eight roundings and the sum of ten. The terms of L_i (2 L_i - 1) and 4 L_i L_j add up
        // to 3 in magnitude.
        EXPECT_NEAR(space.shape_values({0.1, 0.2, 0.3}).sum(), 1.0, rounding_error(8 + 10, 3.0));
    }
}

TEST(SimplexSpace, AffineValuesAtVerticesAreAffineOnAllNodes)
{
    const SimplexSpace space(bar, 2);
    const Eigen::Matrix3d gradient{{1, 2, 3}, {-4, 5, 6}, {7, -8, 9}};
    const pbs::Positions expected = space.node_positions() * gradient.transpose();
    // There are three products and sums on both sides, and the mean of two.
    const pbs::Positions terms = space.node_positions().cwiseAbs() * gradient.cwiseAbs().transpose();
    EXPECT_LT((space.from_vertices(bar.rest * gradient.transpose()) - expected).norm(),
              rounding_error(3 + 3 + 1, terms.norm()));
}

TEST(SimplexSpace, RefusesDegenerateMeshesAndOrdersThatItDoesNotHave)
{
    for (const int order : {0, 3}) EXPECT_THROW(SimplexSpace(bar, order), pbs::InputError) << order;
    pbs::TetMesh inverted = bar, flat = bar, unused = bar, out_of_range = bar, not_finite = bar;
    std::swap(inverted.tets(4, 0), inverted.tets(4, 1));
    flat.rest.row(flat.tets(0, 3)) = flat.rest.row(flat.tets(0, 2));
    unused.rest.conservativeResize(bar.rest.rows() + 1, 3);
    unused.rest.bottomRows(1).setZero();
    out_of_range.tets(2, 1) = static_cast<int>(bar.rest.rows());
    not_finite.rest(3, 1) = std::nan("");
    for (const auto& mesh : {inverted, flat, unused, out_of_range, not_finite, pbs::TetMesh{}})
        EXPECT_THROW(SimplexSpace(mesh, 1), pbs::InputError);
}

// Reference: relations between elastic constants, by hand: E = mu (3 lambda + 2 mu) / (lambda + mu), nu = lambda / (2
// (lambda + mu)).

// Each relation goes through some fifteen roundings. 1 - 2 nu cancels in lambda, but E and nu depend on lambda by a
// factor below 1 - 2 nu where nu is close to 1/2. At nu = -0.4 the sums lambda + mu and 3 lambda + 2 mu cancel, by
// factors of 2.6 and 5.
TEST(Material, LameParametersReturnYoungsModulusAndPoissonsRatioOfAStableMaterial)
{
    for (const double poisson : {-0.4, 0.0, 0.3, 0.45, 0.4999}) {
        const auto [lambda, mu] = lame_parameters(7e4, poisson);
        EXPECT_NEAR(mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), 7e4, rounding_error(15, 5.0 * 7e4));
        EXPECT_NEAR(lambda / (2.0 * (lambda + mu)), poisson, rounding_error(15, 2.6 * 0.5));
    }
    for (const double young : {0.0, -1.0, double(INFINITY), std::nan("")})
        EXPECT_THROW(lame_parameters(young, 0.3), pbs::InputError);
    for (const double poisson : {-1.0, 0.5, 0.6, std::nan("")})
        EXPECT_THROW(lame_parameters(1.0, poisson), pbs::InputError);
}

}  // namespace
}  // namespace assembly_tests
