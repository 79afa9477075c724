#include "reference_fem/distributed/elastic_problem.hpp"

#include "pbs/geometry/topology.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numeric>

namespace reference_fem {
namespace {

using Ends = std::pair<int, int>;

// The two vertices each node lies halfway between.
std::vector<Ends> ends_of_nodes(const SimplexSpace& space)
{
    std::vector<Ends> ends(space.nodes());
    for (const auto& tet : space.tet_nodes().rowwise())
        for (int node = 0; node < tet.size(); ++node) {
            const int first = node < 4 ? node : SimplexSpace::edge_corners[node - 4][0];
            const int second = node < 4 ? node : SimplexSpace::edge_corners[node - 4][1];
            ends[tet(node)] = std::minmax(int(tet(first)), int(tet(second)));
        }
    return ends;
}

class SerialSystem {
public:
    SerialSystem(const pbs::TetMesh& mesh, const ElasticProblem& problem)
        : mesh_(mesh), problem_(problem), space_(mesh, problem.options.element_order), ends_(ends_of_nodes(space_))
    {
        for (int node = 0; node < space_.nodes(); ++node) node_of_ends_[ends_[node]] = node;
        split_boundary();
    }

    ElasticSolution solve() const;

private:
    void split_boundary();
    // The nodes of a boundary triangle: corners, then on P2 the middles of its edges.
    std::vector<int> nodes_of(const Eigen::RowVector3i& triangle) const;
    Eigen::VectorXd traction_load() const;
    Eigen::VectorXd external_load(const AttachedPoints& springs) const;
    ElasticSolution sorted(const Eigen::VectorXd& displacement) const;

    const pbs::TetMesh& mesh_;
    const ElasticProblem& problem_;
    SimplexSpace space_;
    std::vector<Ends> ends_;
    std::map<Ends, int> node_of_ends_;
    std::vector<Eigen::RowVector3i> held_, pulled_;  // boundary triangles
};

void SerialSystem::split_boundary()
{
    std::vector<bool> held(mesh_.rest.rows(), false), pulled = held;
    for (const int v : problem_.held_vertices) held[v] = true;
    for (const int v : problem_.pulled_vertices) pulled[v] = true;
    const pbs::Triangles boundary = pbs::boundary_of(mesh_.tets);
    for (const auto& triangle : boundary.rowwise()) {
        const auto all_in = [&](const std::vector<bool>& part) {
            return part[triangle(0)] && part[triangle(1)] && part[triangle(2)];
        };
        if (all_in(held))
            held_.emplace_back(triangle);
        else if (all_in(pulled))
            pulled_.emplace_back(triangle);
    }
}

std::vector<int> SerialSystem::nodes_of(const Eigen::RowVector3i& triangle) const
{
    std::vector<int> nodes(triangle.begin(), triangle.end());
    for (int k = 0; k < 3 && space_.element_order() == 2; ++k)
        nodes.push_back(node_of_ends_.at(std::minmax(int(triangle(k)), int(triangle((k + 1) % 3)))));
    return nodes;
}

// A constant traction on a flat triangle of area A: A / 3 at each corner on P1; nothing there and A / 3 at each
// mid-edge on P2.
Eigen::VectorXd SerialSystem::traction_load() const
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space_.dofs());
    for (const Eigen::RowVector3i& triangle : pulled_) {
        const auto corner = [&](int k) -> pbs::Vec3 { return mesh_.rest.row(triangle(k)); };
        const double area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2.0;
        const std::vector<int> nodes = nodes_of(triangle);
        for (std::size_t k = nodes.size() - 3; k < nodes.size(); ++k)
            load.segment<3>(3 * nodes[k]) += area / 3.0 * problem_.traction_pa;
    }
    return load;
}

Eigen::VectorXd SerialSystem::external_load(const AttachedPoints& springs) const
{
    const pbs::Vec3 force = problem_.options.density_kg_m3 * problem_.options.gravity_m_s2;
    Eigen::VectorXd load = load_vector(space_, [&](const pbs::Vec3&) { return force; }) + traction_load();
    springs.add_load(problem_.spring_targets, load);
    return load;
}

ElasticSolution SerialSystem::sorted(const Eigen::VectorXd& displacement) const
{
    std::vector<int> order(space_.nodes());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](int node) { return ends_[node]; });
    ElasticSolution solution;
    solution.nodes.resize(space_.nodes(), 2);
    solution.displacement.resize(space_.nodes(), 3);
    for (std::size_t n = 0; n < order.size(); ++n) {
        solution.nodes.row(n) << ends_[order[n]].first, ends_[order[n]].second;
        solution.displacement.row(n) = displacement.segment<3>(3 * order[n]);
    }
    return solution;
}

ElasticSolution SerialSystem::solve() const
{
    const PhaseClock assembly;
    const Attachment& attachment = problem_.attachment;
    const AttachedPoints springs(mesh_, space_, attachment.spring_points, attachment.spring_stiffness);
    SparseMatrix stiffness =
        stiffness_matrix(space_, lame_parameters(problem_.options.young_pa, problem_.options.poisson));
    springs.add_to(stiffness);
    const Eigen::VectorXd load = external_load(springs);

    std::vector<bool> fixed(space_.dofs(), false);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(space_.dofs());
    const auto fix = [&](int node, const pbs::Vec3& value) {
        values.segment<3>(3 * node) = value;
        for (int c = 0; c < 3; ++c) fixed[3 * node + c] = true;
    };
    for (const Eigen::RowVector3i& triangle : held_)
        for (const int node : nodes_of(triangle)) fix(node, pbs::Vec3::Zero());
    const PrescribedNodes prescribed(mesh_, attachment, problem_.vertex_targets);
    for (int node = 0; node < space_.nodes(); ++node)
        if (const auto value = prescribed.displacement(ends_[node])) fix(node, *value);
    const PhaseTime assembly_time = assembly.elapsed();

    const PhaseClock setup;
    const bool iterative = problem_.options.solver == LinearSolver::cg_ml;
    const EliminatedSystem system(stiffness, fixed, problem_.options.solver,
                                  iterative ? rigid_body_modes(space_.node_positions()) : Eigen::MatrixXd());
    const PhaseTime setup_time = setup.elapsed();
    const PhaseClock solving;
    const EliminatedSolution eliminated = system.solve(load, values);
    ElasticSolution solution = sorted(eliminated.displacement);
    ElasticSummary& summary = solution.summary;
    summary.solve = solving.elapsed();
    summary.assembly = assembly_time;
    summary.setup = setup_time;
    summary.solver = system.factor().name();
    summary.iterations = system.factor().iterations();
    summary.tets = summary.tets_of_rank_min = summary.tets_of_rank_max = mesh_.tets.rows();
    summary.dofs = space_.dofs();
    summary.relative_residual = eliminated.residual;
    summary.converged = eliminated.displacement.allFinite();
    summary.compliance_j = load.dot(eliminated.displacement);
    return solution;
}

}  // namespace

ElasticSolution solve_serially(const pbs::TetMesh& mesh, const ElasticProblem& problem)
{
    check_problem(mesh, problem);
    const PhaseClock preparation;
    const SerialSystem system(mesh, problem);
    const PhaseTime mesh_time = preparation.elapsed();
    ElasticSolution solution = system.solve();
    solution.summary.mesh = mesh_time;
    solution.summary.peak_mb = peak_memory_mb();
    return solution;
}

}  // namespace reference_fem
