#include "reference_fem/verification/problems.hpp"

#include "reference_fem/linear_flesh.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cctype>
#include <limits>
#include <map>
#include <random>

namespace reference_fem {

ElasticMaterial solver_material(const Effort& effort, const ElasticMaterial& material)
{
    if (effort.lambda_error == 0.0) return material;
    const Lame lame = lame_parameters(material.young_pa, material.poisson);
    const double lambda = (1.0 + effort.lambda_error) * lame.lambda_pa, mu = lame.mu_pa;
    return {mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), lambda / (2.0 * (lambda + mu))};
}

RowElements elements_of(int order, Formulation formulation)
{
    if (formulation == Formulation::mean_dilatation) return {order, "mean_dilatation"};
    if (formulation == Formulation::taylor_hood) return {order, "taylor_hood"};
    return {order, "displacement"};
}

RowMaterial material_of(const std::string& law, double poisson)
{
    return {law, poisson};
}

std::string identifier_of(const std::string& words)
{
    std::string identifier;
    for (const unsigned char letter : words) {
        const bool kept = std::isalnum(letter) || letter == '.' || letter == '-';
        if (kept || !identifier.ends_with('_')) identifier += kept ? static_cast<char>(std::tolower(letter)) : '_';
    }
    return identifier;
}

RowMaterial linear_material(double poisson)
{
    return material_of("linear", poisson);
}

double order_between(double coarse, double fine)
{
    return std::log2(std::abs(coarse) / std::abs(fine));
}

VerificationRow row_about(const RowSolution& solution, const RowQuantity& quantity, double value, double reference,
                          const std::string& unit, const std::string& source)
{
    const auto& [problem, elements, material, mesh, h_m, dofs] = solution;
    return {problem, quantity, elements, material, mesh, h_m, dofs, value, reference, unit, source};
}

void bound(VerificationRow& row, std::optional<double> low, std::optional<double> high, const std::string& from)
{
    row.low = low;
    row.high = high;
    row.bound_from = from;
}

void unbound(VerificationRow& row)
{
    bound(row, {}, {}, "");
}

void expect_order(VerificationRow& row, double observed, double expected, const std::string& from)
{
    row.observed_order = observed;
    row.expected_order = expected;
    row.bound_from = from;
}

VerificationRows ladder(const std::function<VerificationRow(int n)>& row_of, int coarsest, int levels)
{
    VerificationRows rows;
    const auto difference = [&](int level) { return rows[level].value - rows[level].reference; };
    for (int level = 0; level < levels; ++level) {
        rows.push_back(row_of(coarsest << level));
        if (level > 0) rows[level].observed_order = order_between(difference(level - 1), difference(level));
    }
    return rows;
}

void bound_by_grade_a(VerificationRow& row)
{
    const double tolerance = grade_a * std::abs(row.reference);
    bound(row, row.reference - tolerance, row.reference + tolerance, grade_a_text);
}

namespace {

// The paths from a cell's corner (0,0,0) to (1,1,1) along the axes in each order; the last three are odd permutations.
constexpr int axis_orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};

pbs::Positions grid_points(const pbs::Vec3& lower, const pbs::Vec3& upper, const Divisions& n)
{
    pbs::Positions points((n[0] + 1) * (n[1] + 1) * (n[2] + 1), 3);
    Eigen::Index v = 0;
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i)
                points.row(v++) =
                    lower +
                    (upper - lower).cwiseProduct(pbs::Vec3(double(i) / n[0], double(j) / n[1], double(k) / n[2]));
    return points;
}

double signed_volume_6(const pbs::TetMesh& mesh, Eigen::Index tet)
{
    const auto corner = [&](int c) -> pbs::Vec3 { return mesh.rest.row(mesh.tets(tet, c)); };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0));
}

constexpr int most_steps = 60;

SparseMatrix free_block(const SparseMatrix& matrix, const std::vector<bool>& prescribed)
{
    std::vector<int> place(prescribed.size());
    int unknowns = 0;
    for (std::size_t i = 0; i < prescribed.size(); ++i) place[i] = prescribed[i] ? -1 : unknowns++;
    std::vector<Eigen::Triplet<double, SparseMatrix::StorageIndex>> entries;
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
        for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
            if (place[entry.row()] >= 0 && place[column] >= 0)
                entries.emplace_back(place[entry.row()], place[column], entry.value());
    SparseMatrix block(unknowns, unknowns);
    block.setFromTriplets(entries.begin(), entries.end());
    return block;
}

// The largest magnitude of an eigenvalue of a symmetric operator on R^n: C. Lanczos, J. Res. Nat. Bur. Stand. 45, 1950,
// with every vector made orthogonal to all before it, twice.
double largest_eigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply, Eigen::Index n)
{
    const Eigen::Index steps = std::min<Eigen::Index>(most_steps, n);
    Eigen::MatrixXd basis(n, steps);
    Eigen::VectorXd diagonal(steps), beside(steps);
    std::mt19937 random(1);
    Eigen::VectorXd next = Eigen::VectorXd::NullaryExpr(n, [&] { return random() / 4294967295.0 - 0.5; });
    Eigen::Index taken = 0;
    for (bool exhausted = false; taken < steps && !exhausted; ++taken) {
        basis.col(taken) = next / next.norm();
        next = apply(basis.col(taken));
        const double image = next.norm();
        diagonal(taken) = basis.col(taken).dot(next);
        const auto known = basis.leftCols(taken + 1);
        for (int pass = 0; pass < 2; ++pass) next -= known * (known.transpose() * next).eval();
        beside(taken) = next.norm();
        exhausted = beside(taken) <= n * std::numeric_limits<double>::epsilon() * image;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
    tridiagonal.computeFromTridiagonal(diagonal.head(taken), beside.head(taken - 1), Eigen::EigenvaluesOnly);
    return tridiagonal.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

std::string text_of(const Divisions& divisions)
{
    return std::to_string(divisions[0]) + " x " + std::to_string(divisions[1]) + " x " + std::to_string(divisions[2]);
}

pbs::TetMesh box_mesh(const pbs::Vec3& lower, const pbs::Vec3& upper, const Divisions& divisions)
{
    const auto [nx, ny, nz] = divisions;
    pbs::TetMesh mesh;
    mesh.rest = grid_points(lower, upper, divisions);
    mesh.tets.resize(6 * nx * ny * nz, 4);
    const auto vertex = [nx = nx, ny = ny](const Divisions& corner) {
        return corner[0] + (nx + 1) * (corner[1] + (ny + 1) * corner[2]);
    };
    Eigen::Index tet = 0;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                for (int order = 0; order < 6; ++order, ++tet) {
                    Divisions corner = {i, j, k};
                    mesh.tets(tet, 0) = vertex(corner);
                    for (int step = 0; step < 3; ++step) {
                        ++corner[axis_orders[order][step]];
                        mesh.tets(tet, step + 1) = vertex(corner);
                    }
                    if (order >= 3) std::swap(mesh.tets(tet, 2), mesh.tets(tet, 3));
                }
    return mesh;
}

pbs::TetMesh jittered_cube(int n, double share)
{
    pbs::TetMesh mesh = box_mesh(pbs::Vec3::Zero(), pbs::Vec3::Ones(), {n, n, n});
    std::mt19937 random(20140101);
    for (auto vertex : mesh.rest.rowwise()) {
        const bool inner = (vertex.array() > 1e-9).all() && (vertex.array() < 1.0 - 1e-9).all();
        for (int c = 0; c < 3 && inner; ++c) vertex(c) += share / n * (random() / 4294967296.0 - 0.5);
    }
    return mesh;
}

pbs::TetMesh mapped(pbs::TetMesh mesh, const std::function<pbs::Vec3(const pbs::Vec3&)>& map)
{
    for (auto vertex : mesh.rest.rowwise()) vertex = map(vertex.transpose()).transpose();
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet)
        if (signed_volume_6(mesh, tet) < 0.0) std::swap(mesh.tets(tet, 2), mesh.tets(tet, 3));
    return mesh;
}

pbs::TetMesh joined(const std::vector<pbs::TetMesh>& meshes)
{
    std::map<std::array<long, 3>, int> numbers;
    std::vector<pbs::Vec3> points;
    std::vector<std::array<int, 4>> tets;
    for (const pbs::TetMesh& mesh : meshes) {
        std::vector<int> number(mesh.rest.rows());
        for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
            const pbs::Vec3 point = mesh.rest.row(v);
            const std::array<long, 3> place = {std::lround(1e7 * point.x()), std::lround(1e7 * point.y()),
                                               std::lround(1e7 * point.z())};
            const auto [found, is_new] = numbers.try_emplace(place, static_cast<int>(points.size()));
            if (is_new) points.push_back(point);
            number[v] = found->second;
        }
        for (const auto& tet : mesh.tets.rowwise())
            tets.push_back({number[tet(0)], number[tet(1)], number[tet(2)], number[tet(3)]});
    }
    pbs::TetMesh whole;
    whole.rest.resize(points.size(), 3);
    for (std::size_t v = 0; v < points.size(); ++v) whole.rest.row(v) = points[v];
    whole.tets.resize(tets.size(), 4);
    for (std::size_t t = 0; t < tets.size(); ++t) whole.tets.row(t) << tets[t][0], tets[t][1], tets[t][2], tets[t][3];
    return whole;
}

Spectrum spectrum(const SparseMatrix& symmetric, const std::vector<bool>& prescribed)
{
    const SparseMatrix block = free_block(symmetric, prescribed);
    auto inverse = prepare(block, LinearSolver::cholmod);
    if (!inverse->usable()) inverse = prepare(block, LinearSolver::umfpack);  // indefinite
    const double largest =
        largest_eigenvalue([&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return block * x; }, block.rows());
    const double of_inverse =
        largest_eigenvalue([&](const Eigen::VectorXd& x) { return inverse->solve(x); }, block.rows());
    return {static_cast<int>(block.rows()), largest, 1.0 / of_inverse};
}

Spectrum spectrum(const BoundaryValueSolution& solution, const ElasticMaterial& material)
{
    const LinearFlesh flesh(*solution.space, lame_parameters(material.young_pa, material.poisson),
                            solution.formulation);
    return spectrum(flesh.stiffness(), flesh.prescribed(solution.held));
}

double rounding_bound(const Spectrum& spectrum)
{
    return std::sqrt(static_cast<double>(spectrum.unknowns)) * std::numeric_limits<double>::epsilon() *
           spectrum.condition();
}

}  // namespace reference_fem
