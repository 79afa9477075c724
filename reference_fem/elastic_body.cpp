#include "reference_fem/elastic_body.hpp"

#include "reference_fem/held_space.hpp"
#include "reference_fem/input_checks.hpp"
#include "reference_fem/potentials/bind_potential.hpp"
#include "reference_fem/potentials/dead_load.hpp"
#include "reference_fem/potentials/spring_potential.hpp"
#include "pbs/geometry/stopwatch.hpp"

namespace reference_fem {

class ElasticBody::Implementation {
public:
    Implementation(const pbs::TetMesh& mesh, const ElasticOptions& options, const Attachment& attachment)
        : options_(options),
          held_(mesh, options.element_order, options.density_kg_m3, attachment),
          flesh_(held_.space(), options.model, lame_parameters(options.young_pa, options.poisson), options.formulation),
          springs_(held_.springs()),
          gravity_(Eigen::VectorXd::Zero(held_.space().dofs())),
          newton_(held_.space(), held_.prescribed(), options.solver),
          displacement_(Eigen::VectorXd::Zero(held_.space().dofs())),
          positions_(mesh.rest),
          terms_{&flesh_, &gravity_},
          setup_(held_.summary(nullptr, 0.0))
    {
        if (attachment.spring_points.rows() > 0) terms_.push_back(&springs_);
        if (attachment.bind_distance.size() == 0) return;
        bind_ = std::make_unique<BindPotential>(mesh.rest, attachment.bind_distance, attachment.bind_stiffness);
        terms_.push_back(bind_.get());
    }

    LoadPathSummary solve(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2)
    {
        const Eigen::VectorXd weight_before = gravity_.force(), weight = held_.gravity_load(gravity_m_s2);
        const LoadPathSummary path = follow_load_path(
            [&](double fraction) {
                gravity_.set(weight_before + fraction * (weight - weight_before));
                return newton_.minimise(terms_, move_to(targets_at(fraction)), displacement_, options_.newton);
            },
            displacement_, options_.path);
        gravity_.set(weight_before + path.reached * (weight - weight_before));
        positions_ = held_.vertices(displacement_);
        setup_ = held_.summary(newton_.factor(), 0.0);
        return path;
    }

    // Springs and bind points go to their targets; what the prescribed degrees of freedom shall be [m], #dofs.
    Eigen::VectorXd move_to(const Targets& targets)
    {
        held_.require_targets(targets.springs, targets.vertices);
        springs_.move_to(targets.springs);
        if (bind_) {
            require(targets.bind_points.rows() == held_.rest().rows(), "bind_points", targets.bind_points.rows(), "expected one a vertex");
            bind_->move_to(targets.bind_points);
        }
        return held_.prescribed_values(targets.vertices);
    }

    ElasticOptions options_;
    HeldSpace held_;
    ElasticPotential flesh_;
    SpringPotential springs_;
    std::unique_ptr<BindPotential> bind_;
    DeadLoad gravity_;
    NewtonMinimiser newton_;
    Eigen::VectorXd displacement_;  // [m], #dofs
    pbs::Positions positions_;
    Terms terms_;
    SetupSummary setup_;
};

ElasticBody::ElasticBody(const pbs::TetMesh& mesh, const ElasticOptions& options, const Attachment& attachment)
    : implementation_(std::make_unique<Implementation>(mesh, options, attachment))
{
}

ElasticBody::~ElasticBody() = default;

LoadPathSummary ElasticBody::solve(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2)
{
    require(gravity_m_s2.allFinite(), "gravity_m_s2", gravity_m_s2.transpose(), "expected finite components");
    return implementation_->solve(targets_at, gravity_m_s2);
}

void ElasticBody::start_from(const pbs::Positions& vertices)
{
    implementation_->displacement_ = implementation_->held_.prescribed_values(vertices);
}

const pbs::Positions& ElasticBody::positions() const
{
    return implementation_->positions_;
}

const Eigen::VectorXd& ElasticBody::displacement() const
{
    return implementation_->displacement_;
}

pbs::Positions ElasticBody::spring_points_deformed() const
{
    return implementation_->held_.springs().moved(implementation_->displacement_);
}

double ElasticBody::strain_energy_j() const
{
    return implementation_->flesh_.value(implementation_->displacement_);
}

Jacobians ElasticBody::jacobians() const
{
    return implementation_->flesh_.jacobians(implementation_->displacement_);
}

std::vector<bool> ElasticBody::prescribed_vertices() const
{
    return implementation_->held_.prescribed_vertices();
}

const SetupSummary& ElasticBody::setup() const
{
    return implementation_->setup_;
}

}  // namespace reference_fem
