#include "reference_fem/verification/calculix/calculix_deck.hpp"

#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <charconv>
#include <limits>
#include <ostream>

namespace reference_fem {

Eigen::Map<const Eigen::VectorXd> as_dofs(const pbs::Positions& at_nodes)
{
    return {at_nodes.data(), at_nodes.size()};
}

pbs::Positions at_nodes(const Eigen::VectorXd& dofs)
{
    return Eigen::Map<const pbs::Positions>(dofs.data(), dofs.size() / 3, 3);
}

NodalProblem nodal_problem(const SimplexSpace& space, const ElasticMaterial& material)
{
    NodalProblem problem;
    problem.nodes = space.node_positions();
    problem.tets = space.tet_nodes();
    problem.material = material;
    problem.held.assign(space.nodes(), false);
    problem.held_at = problem.forces_n = pbs::Positions::Zero(space.nodes(), 3);
    return problem;
}

pbs::Positions linear_displacements(const SimplexSpace& space, const NodalProblem& problem)
{
    const auto lame = lame_parameters(problem.material.young_pa, problem.material.poisson);
    const pbs::Vec3 body_force = problem.density_kg_m3 * problem.gravity_m_s2;
    const Eigen::VectorXd load = load_vector(space, [&](const pbs::Vec3&) { return body_force; }) + as_dofs(problem.forces_n);
    std::vector<bool> prescribed(space.dofs());
    for (int dof = 0; dof < space.dofs(); ++dof) prescribed[dof] = problem.held[dof / 3];
    const EliminatedSystem system(stiffness_matrix(space, lame), prescribed, LinearSolver::cholmod);
    return at_nodes(system.solve(load, as_dofs(problem.held_at)).displacement);
}

namespace {

// Barycentric coordinates of points in each tet, from the inverse of the matrix of its corners.
class Barycentrics {
public:
    explicit Barycentrics(const NodalProblem& problem)
    {
        for (const auto& tet : problem.tets.rowwise()) {
            Eigen::Matrix4d corners;
            for (int i = 0; i < 4; ++i) corners.col(i) << 1.0, problem.nodes.row(tet(i)).transpose();
            of_point_.push_back(corners.inverse());
        }
    }

    // The tet in which the point lies deepest, and its coordinates there; tet -1: outside all.
    std::pair<int, Eigen::Vector4d> locate(const Eigen::RowVector3d& point) const
    {
        const Eigen::Vector4d homogeneous(1.0, point(0), point(1), point(2));
        double deepest = -1e-10;  // a point this far outside is on the face except for rounding
        std::pair<int, Eigen::Vector4d> containing{-1, Eigen::Vector4d::Zero()};
        for (std::size_t t = 0; t < of_point_.size(); ++t) {
            const Eigen::Vector4d barycentric = of_point_[t] * homogeneous;
            if (barycentric.minCoeff() < deepest) continue;
            deepest = barycentric.minCoeff();
            containing = {static_cast<int>(t), barycentric};
        }
        return containing;
    }

private:
    std::vector<Eigen::Matrix4d> of_point_;
};

constexpr std::size_t number_width = 20;  // of CalculiX's Fortran format f20.0

template <typename... Format>
std::string text_of(double value, Format... format)
{
    char text[400];
    return {text, std::to_chars(text, text + sizeof text, value, format...).ptr};
}

double value_of(const std::string& text)
{
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

void write_mesh(std::ostream& deck, const NodalProblem& problem)
{
    deck << "*NODE, NSET=NODES\n";
    for (Eigen::Index n = 0; n < problem.nodes.rows(); ++n) {
        deck << n + 1;
        for (const double coordinate : problem.nodes.row(n)) deck << ", " << calculix_number(coordinate);
        deck << "\n";
    }
    deck << "*ELEMENT, TYPE=" << (problem.tets.cols() == 4 ? "C3D4" : "C3D10") << ", ELSET=TETS\n";
    for (Eigen::Index t = 0; t < problem.tets.rows(); ++t) {
        deck << t + 1;
        for (const int node : problem.tets.row(t)) deck << ", " << node + 1;
        deck << "\n";
    }
}

void write_material(std::ostream& deck, const NodalProblem& problem)
{
    deck << "*MATERIAL, NAME=FLESH\n*ELASTIC\n"
         << calculix_number(problem.material.young_pa) << ", " << calculix_number(problem.material.poisson) << "\n";
    if (problem.density_kg_m3 > 0.0) deck << "*DENSITY\n" << calculix_number(problem.density_kg_m3) << "\n";
    deck << "*SOLID SECTION, ELSET=TETS, MATERIAL=FLESH\n";
}

void write_equation(std::ostream& deck, const NodalProblem& problem, const EquivalentSpring& spring, Eigen::Index end, int component)
{
    constexpr int terms_per_line = 4;
    const Eigen::Index nodes = problem.tets.cols();
    deck << "*EQUATION\n" << nodes + 1 << "\n" << end << ", " << component << ", 1";
    for (Eigen::Index i = 0; i < nodes; ++i)
        deck << ((i + 1) % terms_per_line == 0 ? "\n" : ", ") << problem.tets(spring.tet, i) + 1 << ", " << component << ", "
             << calculix_number(-spring.coefficients(i));
    deck << "\n";
}

void write_springs(std::ostream& deck, const NodalProblem& problem, const EquivalentSprings& few)
{
    if (few.springs.empty()) return;
    const Eigen::Index first_end = problem.nodes.rows() + 1, springs = static_cast<Eigen::Index>(few.springs.size());
    deck << "*NODE, NSET=ENDS\n";
    for (Eigen::Index m = 0; m < springs; ++m) deck << first_end + m << ", 0, 0, 0\n";
    for (int component = 1; component <= 3; ++component) {
        const std::string set = "SPRINGS" + std::to_string(component);
        deck << "*ELEMENT, TYPE=SPRING1, ELSET=" << set << "\n";
        for (Eigen::Index m = 0; m < springs; ++m)
            deck << problem.tets.rows() + (component - 1) * springs + m + 1 << ", " << first_end + m << "\n";
        deck << "*SPRING, ELSET=" << set << "\n" << component << "\n" << calculix_number(few.stiffness_n_m) << "\n";
    }
    for (Eigen::Index m = 0; m < springs; ++m)
        for (int component = 1; component <= 3; ++component) write_equation(deck, problem, few.springs[m], first_end + m, component);
}

void write_analysis(std::ostream& deck, const DeckOptions& options)
{
    const bool large_strain = options.analysis == CalculixAnalysis::large_strain;
    deck << (large_strain ? "*STEP, NLGEOM, INC=10000\n" : "*STEP\n");
    deck << "*STATIC\n";
    // Newton's residual over the mean force, and the last correction over the largest increment: CalculiX asks for 5e-3 and 1e-2.
    if (large_strain)
        deck << calculix_number(options.first_increment) << ", 1.\n*CONTROLS, PARAMETERS=FIELD\n"
             << calculix_number(options.residual) << ", 1e-9\n";
}

void write_components(std::ostream& deck, Eigen::Index node, const Eigen::RowVector3d& values, bool with_range)
{
    for (int c = 0; c < 3; ++c) {
        deck << node + 1 << ", " << c + 1;
        if (with_range) deck << ", " << c + 1;
        deck << ", " << calculix_number(values(c)) << "\n";
    }
}

void write_held_nodes(std::ostream& deck, const NodalProblem& problem)
{
    if (std::ranges::find(problem.held, true) == problem.held.end()) return;
    deck << "*BOUNDARY\n";
    for (Eigen::Index n = 0; n < problem.nodes.rows(); ++n)
        if (problem.held[n]) write_components(deck, n, problem.held_at.row(n), true);
}

void write_loads(std::ostream& deck, const NodalProblem& problem, const pbs::Positions& forces_n)
{
    const double gravity = problem.gravity_m_s2.norm();
    if (gravity > 0.0 && problem.density_kg_m3 > 0.0) {
        deck << "*DLOAD\nTETS, GRAV, " << calculix_number(gravity);
        for (const double component : problem.gravity_m_s2) deck << ", " << calculix_number(component / gravity);
        deck << "\n";
    }
    if (forces_n.isZero(0.0)) return;
    deck << "*CLOAD\n";
    for (Eigen::Index n = 0; n < problem.nodes.rows(); ++n)
        if (!forces_n.row(n).isZero(0.0)) write_components(deck, n, forces_n.row(n), false);
}

}  // namespace

Eigen::VectorXd tet_shape_functions(const Eigen::Vector4d& barycentric, int nodes_per_tet)
{
    if (nodes_per_tet == 4) return barycentric;
    Eigen::VectorXd shapes(10);
    shapes.head<4>() = barycentric.array() * (2.0 * barycentric.array() - 1.0);
    constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (int k = 0; k < 6; ++k) shapes(4 + k) = 4.0 * barycentric(edges[k][0]) * barycentric(edges[k][1]);
    return shapes;
}

EquivalentSprings equivalent_springs(const NodalProblem& problem)
{
    const GroundSprings& many = problem.springs;
    EquivalentSprings few;
    few.forces_n = pbs::Positions::Zero(problem.nodes.rows(), 3);
    const int width = static_cast<int>(problem.tets.cols());
    const Barycentrics barycentrics(problem);
    std::vector<Eigen::MatrixXd> of_tet(problem.tets.rows());
    for (Eigen::Index s = 0; s < many.points.rows(); ++s) {
        const auto [tet, barycentric] = barycentrics.locate(many.points.row(s));
        if (tet < 0) continue;
        const Eigen::VectorXd shapes = tet_shape_functions(barycentric, width);
        if (of_tet[tet].size() == 0) of_tet[tet] = Eigen::MatrixXd::Zero(width, width);
        of_tet[tet] += many.stiffness_n_m(s) * shapes * shapes.transpose();
        for (int i = 0; i < width; ++i)
            few.forces_n.row(problem.tets(tet, i)) += many.stiffness_n_m(s) * shapes(i) * (many.targets.row(s) - many.points.row(s));
    }

    for (std::size_t t = 0; t < of_tet.size(); ++t) {
        if (of_tet[t].size() == 0) continue;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(of_tet[t]);
        for (int m = 0; m < width; ++m)
            if (eigen.eigenvalues()(m) > 0.0)
                few.springs.push_back({static_cast<int>(t), std::sqrt(eigen.eigenvalues()(m)) * eigen.eigenvectors().col(m)});
        few.stiffness_n_m = std::max(few.stiffness_n_m, eigen.eigenvalues().maxCoeff());
    }
    for (EquivalentSpring& spring : few.springs) spring.coefficients /= std::sqrt(few.stiffness_n_m);
    std::erase_if(few.springs, [](const EquivalentSpring& spring) {
        return spring.coefficients.squaredNorm() <= std::numeric_limits<double>::epsilon();
    });
    return few;
}

std::string calculix_number(double value)
{
    const std::string shortest = text_of(value);  // that reads back as `value`
    if (shortest.size() <= number_width) return shortest;
    std::string nearest;
    for (const auto format : {std::chars_format::scientific, std::chars_format::fixed})
        for (int digits = 17; digits >= 12; --digits) {
            const std::string text = text_of(value, format, digits);
            if (text.size() > number_width) continue;
            if (nearest.empty() || std::abs(value_of(text) - value) < std::abs(value_of(nearest) - value)) nearest = text;
            break;
        }
    return nearest;
}

void write_calculix_deck(std::ostream& deck, const NodalProblem& problem, const DeckOptions& options)
{
    write_mesh(deck, problem);
    write_material(deck, problem);
    if (options.analysis == CalculixAnalysis::none) return;
    const EquivalentSprings springs = equivalent_springs(problem);
    write_springs(deck, problem, springs);
    write_analysis(deck, options);
    write_held_nodes(deck, problem);
    write_loads(deck, problem, problem.forces_n + springs.forces_n);
    if (options.restart_file) deck << "*RESTART, WRITE\n";
    deck << "*NODE PRINT, NSET=NODES, FREQUENCY=100000\nU\n*END STEP\n";
}

}  // namespace reference_fem
