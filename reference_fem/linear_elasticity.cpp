#include "reference_fem/linear_elasticity.hpp"

#include "reference_fem/assembly.hpp"
#include "reference_fem/eliminated_system.hpp"
#include "reference_fem/held_space.hpp"
#include "reference_fem/input_checks.hpp"
#include "reference_fem/near_null_space.hpp"
#include "pbs/geometry/stopwatch.hpp"

namespace reference_fem {

class LinearElasticity::Implementation {
public:
    Implementation(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
        : options_(options),
          material_(lame_parameters(options.young_pa, options.poisson)),
          held_(mesh, options.element_order, options.density_kg_m3, attachment),
          positions_(mesh.rest),
          displacement_(Eigen::VectorXd::Zero(held_.space().dofs()))
    {
        const pbs::Stopwatch assembly;
        SparseMatrix stiffness = stiffness_matrix(held_.space(), material_);
        held_.springs().add_to(stiffness);
        const double assemble_s = assembly.seconds();
        system_ = std::make_unique<EliminatedSystem>(
            stiffness, held_.prescribed(), options.solver,
            options.solver == LinearSolver::cg_ml ? rigid_body_modes(held_.space().node_positions()) : Eigen::MatrixXd());
        setup_ = held_.summary(&system_->factor(), assemble_s);
    }

    SolveSummary solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets, const pbs::Vec3& gravity_m_s2)
    {
        held_.require_targets(spring_targets, vertex_targets);
        const pbs::Stopwatch stopwatch;
        Eigen::VectorXd load = held_.gravity_load(gravity_m_s2);
        held_.springs().add_load(spring_targets, load);
        const EliminatedSolution solution = system_->solve(load, held_.prescribed_values(vertex_targets));
        displacement_ = solution.displacement;
        positions_ = held_.vertices(displacement_);
        return {stopwatch.seconds(), solution.residual, displacement_.allFinite(), system_->factor().iterations()};
    }

    LinearOptions options_;
    Lame material_;
    HeldSpace held_;
    pbs::Positions positions_;
    Eigen::VectorXd displacement_;  // [m], #dofs
    std::unique_ptr<EliminatedSystem> system_;
    SetupSummary setup_;
};

LinearElasticity::LinearElasticity(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
{
    require(options.gravity_m_s2.allFinite(), "gravity_m_s2", options.gravity_m_s2.transpose(), "expected finite components");
    require(attachment.bind_distance.size() == 0, "bind_distance", attachment.bind_distance.size(),
            "expected none: the bind constraint is not linear");
    implementation_ = std::make_unique<Implementation>(mesh, options, attachment);
}

LinearElasticity::~LinearElasticity() = default;

SolveSummary LinearElasticity::solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets)
{
    return implementation_->solve(spring_targets, vertex_targets, implementation_->options_.gravity_m_s2);
}

SolveSummary LinearElasticity::solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets,
                                     const pbs::Vec3& gravity_m_s2)
{
    return implementation_->solve(spring_targets, vertex_targets, gravity_m_s2);
}

const pbs::Positions& LinearElasticity::positions() const
{
    return implementation_->positions_;
}

const Eigen::VectorXd& LinearElasticity::displacement() const
{
    return implementation_->displacement_;
}

pbs::Positions LinearElasticity::spring_points_deformed() const
{
    return implementation_->held_.springs().moved(implementation_->displacement_);
}

double LinearElasticity::strain_energy_j() const
{
    return strain_energy(implementation_->held_.space(), implementation_->material_, implementation_->displacement_);
}

std::vector<bool> LinearElasticity::prescribed_vertices() const
{
    return implementation_->held_.prescribed_vertices();
}

const SetupSummary& LinearElasticity::setup() const
{
    return implementation_->setup_;
}

}  // namespace reference_fem
