#include "reference_fem/distributed/elastic_problem.hpp"

#include "reference_fem/distributed/distributed_space.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/options.hpp"

#include <Teuchos_ParameterList.hpp>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace reference_fem {
namespace {

namespace mpi = dealii::Utilities::MPI;
using dealii::AffineConstraints;
using dealii::FEFaceValues;
using dealii::FEValues;
using dealii::TrilinosWrappers::MPI::Vector;
using Cell = DistributedSpace::Cell;
using DofIndices = DistributedSpace::DofIndices;

class DistributedSystem {
public:
    DistributedSystem(const pbs::TetMesh& mesh, const ElasticProblem& problem)
        : problem_(problem),
          lame_(lame_parameters(problem.options.young_pa, problem.options.poisson)),
          space_(mesh, problem.options.element_order, problem.held_vertices, problem.pulled_vertices),
          springs_(mesh, problem.attachment, problem.spring_targets),
          prescribed_(mesh, problem.attachment, problem.vertex_targets)
    {
        constrain();
        summary_.mesh = slowest(mesh_clock_);
        const PhaseClock assembly;
        allocate();
        assemble();
        summary_.assembly = slowest(assembly);
    }

    ElasticSolution solve(const IterativeOptions& options);

private:
    static PhaseTime slowest(const PhaseClock& clock)
    {
        const PhaseTime time = clock.elapsed();
        return {mpi::max(time.wall_s, MPI_COMM_WORLD), mpi::max(time.cpu_s, MPI_COMM_WORLD)};
    }

    void constrain();
    void constrain(const Cell& cell, const DofIndices& dofs);
    void allocate();
    void assemble();
    void add_tet(const FEValues<3>& values);
    void add_traction(const FEFaceValues<3>& values);
    void add_springs(Eigen::Index tet);
    void summarise(const Vector& displacement);

    PhaseClock mesh_clock_;
    const ElasticProblem& problem_;
    Lame lame_;
    DistributedSpace space_;
    SpringsInTets springs_;
    PrescribedNodes prescribed_;
    AffineConstraints<double> constraints_;
    dealii::TrilinosWrappers::SparseMatrix matrix_;
    Vector right_hand_side_, load_;  // load_: before the prescribed values are moved to the right-hand side
    dealii::FullMatrix<double> of_tet_;
    dealii::Vector<double> load_of_tet_;
    ElasticSummary summary_;
};

void DistributedSystem::constrain()
{
    constraints_.reinit(space_.relevant);
    DofIndices dofs(space_.element.n_dofs_per_cell());
    for (const auto& cell : space_.dof_handler.active_cell_iterators()) {
        if (cell->is_artificial()) continue;
        cell->get_dof_indices(dofs);
        constrain(cell, dofs);
    }
    constraints_.close();
}

void DistributedSystem::constrain(const Cell& cell, const DofIndices& dofs)
{
    std::vector<unsigned int> held_faces;
    for (const unsigned int face : cell->face_indices())
        if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == held_part) held_faces.push_back(face);
    for (unsigned int node = 0; node < space_.nodes_per_tet(); ++node) {
        const auto on_face = [&](unsigned int face) { return space_.node_on_face(cell, node, face); };
        const bool held = std::ranges::any_of(held_faces, on_face);
        const std::optional<pbs::Vec3> prescribed = prescribed_.displacement(space_.ends(cell, node));
        if (!held && !prescribed) continue;
        for (unsigned int c = 0; c < 3; ++c) {
            const auto dof = dofs[space_.element.component_to_system_index(c, node)];
            constraints_.add_line(dof);
            constraints_.set_inhomogeneity(dof, prescribed ? (*prescribed)(c) : 0.0);
        }
    }
}

void DistributedSystem::allocate()
{
    dealii::DynamicSparsityPattern pattern(space_.relevant);
    dealii::DoFTools::make_sparsity_pattern(space_.dof_handler, pattern, constraints_, false);
    dealii::SparsityTools::distribute_sparsity_pattern(pattern, space_.owned, MPI_COMM_WORLD, space_.relevant);
    matrix_.reinit(space_.owned, space_.owned, pattern, MPI_COMM_WORLD);
    right_hand_side_.reinit(space_.owned, MPI_COMM_WORLD);
    load_.reinit(space_.owned, MPI_COMM_WORLD);
}

void DistributedSystem::assemble()
{
    // On straight tets the stiffness has degree 2 (order - 1), gravity's and the traction's load degree order: n points
    // per direction integrate degree 2 n - 1.
    const int order = problem_.options.element_order;
    FEValues<3> values(space_.mapping, space_.element, dealii::QGaussSimplex<3>(order),
                       dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
    FEFaceValues<3> face_values(space_.mapping, space_.element, dealii::QGaussSimplex<2>(order),
                                dealii::update_values | dealii::update_JxW_values);
    of_tet_.reinit(space_.element.n_dofs_per_cell(), space_.element.n_dofs_per_cell());
    load_of_tet_.reinit(space_.element.n_dofs_per_cell());
    space_.for_each_own_cell([&](const Cell& cell, const DofIndices& dofs) {
        of_tet_ = 0.0;
        load_of_tet_ = 0.0;
        values.reinit(cell);
        add_tet(values);
        for (const unsigned int face : cell->face_indices())
            if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == pulled_part) {
                face_values.reinit(cell, face);
                add_traction(face_values);
            }
        add_springs(space_.tet(cell));
        load_.add(dofs, load_of_tet_);
        constraints_.distribute_local_to_global(of_tet_, load_of_tet_, dofs, matrix_, right_hand_side_);
    });
    matrix_.compress(dealii::VectorOperation::add);
    right_hand_side_.compress(dealii::VectorOperation::add);
    load_.compress(dealii::VectorOperation::add);
}

// lambda div(phi_i) div(phi_j) + 2 mu eps(phi_i) : eps(phi_j), and gravity.
void DistributedSystem::add_tet(const FEValues<3>& values)
{
    const pbs::Vec3 force = problem_.options.density_kg_m3 * problem_.options.gravity_m_s2;
    for (const unsigned int q : values.quadrature_point_indices())
        for (const unsigned int i : values.dof_indices()) {
            const unsigned int a = space_.element.system_to_component_index(i).first;
            const auto& gradient_i = values.shape_grad(i, q);
            load_of_tet_(i) += force(a) * values.shape_value(i, q) * values.JxW(q);
            for (const unsigned int j : values.dof_indices()) {
                const unsigned int b = space_.element.system_to_component_index(j).first;
                const auto& gradient_j = values.shape_grad(j, q);
                const double shear = gradient_i[b] * gradient_j[a] + (a == b ? gradient_i * gradient_j : 0.0);
                of_tet_(i, j) +=
                    (lame_.lambda_pa * gradient_i[a] * gradient_j[b] + lame_.mu_pa * shear) * values.JxW(q);
            }
        }
}

void DistributedSystem::add_traction(const FEFaceValues<3>& values)
{
    for (const unsigned int q : values.quadrature_point_indices())
        for (const unsigned int i : values.dof_indices())
            load_of_tet_(i) += problem_.traction_pa(space_.element.system_to_component_index(i).first) *
                               values.shape_value(i, q) * values.JxW(q);
}

// A spring couples nodes of one tet, so the rank that owns the tet adds it: k N^T N, and k N^T (target - point).
void DistributedSystem::add_springs(Eigen::Index tet)
{
    const auto& scalar = space_.element.base_element(0);
    for (const SpringInTet& spring : springs_.in(tet)) {
        const dealii::Point<3> point(spring.barycentric.x(), spring.barycentric.y(), spring.barycentric.z());
        for (unsigned int a = 0; a < space_.nodes_per_tet(); ++a)
            for (unsigned int c = 0; c < 3; ++c) {
                const unsigned int i = space_.element.component_to_system_index(c, a);
                const double pull = spring.stiffness * scalar.shape_value(a, point);
                load_of_tet_(i) += pull * spring.stretch(c);
                for (unsigned int b = 0; b < space_.nodes_per_tet(); ++b)
                    of_tet_(i, space_.element.component_to_system_index(c, b)) += pull * scalar.shape_value(b, point);
            }
    }
}

ElasticSolution DistributedSystem::solve(const IterativeOptions& options)
{
    const PhaseClock setup;
    std::vector<double> modes = space_.rigid_body_modes();
    dealii::TrilinosWrappers::PreconditionAMG preconditioner;
    preconditioner.initialize(matrix_, smoothed_aggregation(modes.data(), 6, 3));
    summary_.setup = slowest(setup);

    const PhaseClock solving;
    Vector displacement(space_.owned, MPI_COMM_WORLD);
    dealii::SolverControl control(options.most_iterations, options.tolerance * right_hand_side_.l2_norm());
    summary_.converged = true;
    try {
        dealii::SolverCG<Vector>(control).solve(matrix_, displacement, right_hand_side_, preconditioner);
    } catch (const dealii::SolverControl::NoConvergence&) {
        summary_.converged = false;
    }
    summary_.solve = slowest(solving);
    summary_.iterations = static_cast<int>(control.last_step());
    summarise(displacement);

    ElasticSolution solution;
    constraints_.distribute(displacement);
    summary_.compliance_j = load_ * displacement;
    summary_.peak_mb = mpi::max(peak_memory_mb(), MPI_COMM_WORLD);
    std::tie(solution.nodes, solution.displacement) = space_.on_rank_0([&](auto dof) { return displacement(dof); });
    solution.summary = summary_;
    return solution;
}

void DistributedSystem::summarise(const Vector& displacement)
{
    Vector defect(space_.owned, MPI_COMM_WORLD);
    const double norm = matrix_.residual(defect, displacement, right_hand_side_);
    summary_.relative_residual = norm == 0.0 ? 0.0 : norm / right_hand_side_.l2_norm();
    summary_.converged = summary_.converged && std::isfinite(summary_.relative_residual);
    summary_.solver = "conjugate gradients, Trilinos ML smoothed aggregation";
    summary_.ranks = static_cast<int>(mpi::n_mpi_processes(MPI_COMM_WORLD));
    summary_.tets = space_.mesh.tets.rows();
    summary_.dofs = space_.dof_handler.n_dofs();
    const auto own_tets = static_cast<double>(space_.triangulation.n_locally_owned_active_cells());
    summary_.tets_of_rank_min = static_cast<long long>(mpi::min(own_tets, MPI_COMM_WORLD));
    summary_.tets_of_rank_max = static_cast<long long>(mpi::max(own_tets, MPI_COMM_WORLD));
}

}  // namespace

ElasticSolution solve_distributed(const pbs::TetMesh& mesh, const ElasticProblem& problem,
                                  const IterativeOptions& options)
{
    check_problem(mesh, problem);
    return DistributedSystem(mesh, problem).solve(options);
}

}  // namespace reference_fem
