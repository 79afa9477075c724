#include "reference_fem/linear_elasticity.hpp"

#include "pbs/geometry/cost.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"

namespace reference_fem {

class LinearElasticity::Implementation {
public:
    Implementation(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
        : options_(options),
          held_(mesh, options.element_order, options.density_kg_m3, attachment),
          flesh_(held_.space(), lame_parameters(options.young_pa, options.poisson), options.formulation,
                 attachment.prescribed_tets),
          positions_(mesh.rest),
          displacement_(Eigen::VectorXd::Zero(held_.space().dofs())),
          pressure_pa_(Eigen::VectorXd::Zero(flesh_.pressures()))
    {
        const pbs::Stopwatch assembly;
        SparseMatrix stiffness = flesh_.stiffness();
        held_.springs().add_to(stiffness);
        const double assemble_s = assembly.seconds();
        system_ = std::make_unique<EliminatedSystem>(
            stiffness, flesh_.prescribed(held_.prescribed()), flesh_.solver(options.solver));
        setup_ = held_.summary(&system_->factor(), assemble_s);
        setup_.dofs = flesh_.unknowns();
    }

    SolveSummary solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets,
                       const pbs::Vec3& gravity_m_s2)
    {
        held_.require_targets(spring_targets, vertex_targets);
        const pbs::Stopwatch stopwatch;
        Eigen::VectorXd load = held_.gravity_load(gravity_m_s2);
        held_.springs().add_load(spring_targets, load);
        const EliminatedSolution solution =
            system_->solve(flesh_.on_unknowns(load), flesh_.on_unknowns(held_.prescribed_values(vertex_targets)));
        displacement_ = flesh_.displacement(solution.displacement);
        pressure_pa_ = flesh_.pressure_pa(solution.displacement);
        positions_ = held_.vertices(displacement_);
        return {stopwatch.seconds(), solution.residual, displacement_.allFinite()};
    }

    LinearOptions options_;
    HeldSpace held_;
    LinearFlesh flesh_;
    pbs::Positions positions_;
    Eigen::VectorXd displacement_;  // [m], #dofs
    Eigen::VectorXd pressure_pa_;   // #V, with taylor_hood
    std::unique_ptr<EliminatedSystem> system_;
    SetupSummary setup_;
};

LinearElasticity::LinearElasticity(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
{
    require(options.gravity_m_s2.allFinite(), "gravity_m_s2", options.gravity_m_s2.transpose(),
            "expected finite components");
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

const Eigen::VectorXd& LinearElasticity::pressure_pa() const
{
    return implementation_->pressure_pa_;
}

pbs::Positions LinearElasticity::spring_points_deformed() const
{
    return implementation_->held_.springs().moved(implementation_->displacement_);
}

double LinearElasticity::strain_energy_j() const
{
    return implementation_->flesh_.strain_energy_j(implementation_->displacement_, implementation_->pressure_pa_);
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
