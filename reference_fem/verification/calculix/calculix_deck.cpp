#include "reference_fem/verification/calculix/calculix_deck.hpp"

#include "reference_fem/verification/calculix/equivalent_springs.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

namespace reference_fem {
namespace {

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
