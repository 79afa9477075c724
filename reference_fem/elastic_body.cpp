#include "reference_fem/elastic_body.hpp"

#include "reference_fem/dynamics/time_stepper.hpp"

#include <limits>

namespace reference_fem {
namespace {

TimeStepperOptions stepper_options(const ElasticOptions& options)
{
    return {.scheme = options.dynamics == Dynamics::newmark ? newmark() : generalized_alpha(options.spectral_radius),
            .density_kg_m3 = options.density_kg_m3,
            .rayleigh_mass_1_s = options.rayleigh_mass_1_s,
            .rayleigh_stiffness_s = options.rayleigh_stiffness_s};
}

Targets between(const Targets& from, const Targets& to, double share)
{
    const auto part = [&](const pbs::Positions& a, const pbs::Positions& b) -> pbs::Positions {
        return a + share * (b - a);
    };
    return {part(from.springs, to.springs), part(from.vertices, to.vertices), part(from.bind_points, to.bind_points)};
}

}  // namespace

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
          last_iterate_(displacement_),
          positions_(mesh.rest),
          terms_{&flesh_, &gravity_},
          setup_(held_.summary(nullptr, 0.0))
    {
        if (flesh_.is_quadratic()) {
            linear_flesh_ = std::make_unique<StiffnessPotential>(rest_stiffness(held_.space(), flesh_));
            terms_.front() = linear_flesh_.get();
        }
        if (attachment.spring_points.rows() > 0) terms_.push_back(&springs_);
        if (attachment.bind_distance.size() > 0) {
            bind_ = std::make_unique<BindPotential>(mesh.rest, attachment.bind_distance, attachment.bind_stiffness);
            terms_.push_back(bind_.get());
        }
        if (options.contact.range_m > 0.0) {
            require(options.dynamics != Dynamics::generalized_alpha, "contact.range_m", options.contact.range_m,
                    "expected 0 with generalized_alpha, whose state at the end of a step is extrapolated");
            contact_ = std::make_unique<ContactPotential>(held_.space(), options.contact);
            terms_.push_back(contact_.get());
        }
        if (options.dynamics == Dynamics::quasi_static) return;
        stepper_ =
            std::make_unique<TimeStepper>(held_.space(), held_.prescribed(), flesh_, stepper_options(options), newton_);
    }

    LoadPathSummary solve(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2, const LoadPathOptions& options)
    {
        const Eigen::VectorXd weight_before = gravity_.force(), weight = held_.gravity_load(gravity_m_s2);
        if (stepper_) newton_.forget_factor();
        pbs::Positions guide = targets_at(0.0).guide;
        const LoadPathSummary path = follow_load_path(
            [&](double fraction) {
                gravity_.set(weight_before + fraction * (weight - weight_before));
                const Targets targets = targets_at(fraction);
                if (guide.rows() > 0) follow_guide(held_.prescribed_values(held_.rest() + targets.guide - guide));
                const NewtonSummary summary =
                    newton_.minimise(terms_, move_to(targets), displacement_, options_.newton);
                last_iterate_ = displacement_;
                if (summary.converged()) guide = targets.guide;
                return summary;
            },
            displacement_, options);
        gravity_.set(weight_before + path.reached * (weight - weight_before));
        if (stepper_) {
            stepper_->forget_factor();
            stepper_->start(displacement_);
            weighs_ = true;
        }
        show();
        return path;
    }

    NewtonSummary solve_at_once(const Targets& targets, const pbs::Vec3& gravity_m_s2)
    {
        gravity_.set(held_.gravity_load(gravity_m_s2));
        NewtonOptions options = options_.newton;
        options.reuse_contraction = 0.0;  // far from a minimum a kept factor can lead elsewhere
        const std::optional<NewtonSummary> refused = refused_guess();
        const NewtonSummary summary =
            refused ? *refused : newton_.minimise(terms_, move_to(targets), displacement_, options);
        last_iterate_ = displacement_;
        show();
        return summary;
    }

    LoadPathSummary advance(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2, double time_step_s)
    {
        const Eigen::VectorXd weight = held_.gravity_load(gravity_m_s2),
                              weight_before = weighs_ ? gravity_.force() : weight;
        const MovingData data{
            [&](double fraction) { return held_.prescribed_values(checked(targets_at(fraction)).vertices); },
            [&](double from, double to, double share) {
                move_to(share == 1.0 ? targets_at(to)
                                     : between(checked(targets_at(from)), checked(targets_at(to)), share));
                gravity_.set(weight_before + (from + share * (to - from)) * (weight - weight_before));
            }};
        const LoadPathSummary path =
            stepper_->advance(terms_, data, time_step_s, displacement_, options_.newton, options_.path);
        last_iterate_ = path.converged() ? displacement_ : stepper_->last_iterate();
        weighs_ |= path.converged();
        gravity_.set(path.converged() ? weight : weight_before);
        show();
        return path;
    }

    // The guide may lead the flesh into itself, and the initial guess then stops before.
    void follow_guide(const Eigen::VectorXd& change)
    {
        displacement_ += (contact_ ? contact_->largest_step(displacement_, change) : 1.0) * change;
    }

    // An outcome of Newton's method that was not begun; nothing: the initial guess may be used.
    std::optional<NewtonSummary> refused_guess() const
    {
        if (!contact_ || !contact_->intersects(displacement_)) return {};
        NewtonSummary summary;
        summary.outcome = NewtonOutcome::intersects_itself;
        summary.iterations.emplace_back();
        return summary;
    }

    void start_at(const Eigen::VectorXd& displacement)
    {
        displacement_ = displacement;
        positions_ = held_.vertices(displacement_);
    }

    std::vector<pbs::Location> places_of(const pbs::Positions& points_at_rest) const
    {
        const pbs::TetMesh mesh{held_.rest(), held_.space().tet_nodes().leftCols(4)};
        const pbs::PointLocation where(mesh);
        std::vector<pbs::Location> places;
        for (const auto& point : points_at_rest.rowwise()) places.push_back(where.locate(point));
        return places;
    }

    pbs::Positions moved(const std::vector<pbs::Location>& places, const Eigen::VectorXd& displacement) const
    {
        const SimplexSpace& space = held_.space();
        const pbs::Positions nodes =
            space.node_positions() + Eigen::Map<const pbs::Positions>(displacement.data(), space.nodes(), 3);
        pbs::Positions moved(static_cast<Eigen::Index>(places.size()), 3);
        for (std::size_t p = 0; p < places.size(); ++p) {
            const auto& [tet, barycentric] = places[p];
            if (tet < 0)
                moved.row(p).setConstant(std::numeric_limits<double>::quiet_NaN());
            else
                moved.row(p) =
                    space.shape_values(barycentric).transpose() * nodes(space.tet_nodes().row(tet), Eigen::all);
        }
        return moved;
    }

    void show()
    {
        positions_ = held_.vertices(displacement_);
        setup_ = held_.summary(newton_.factor(), 0.0);
    }

    Targets checked(const Targets& targets) const
    {
        held_.require_targets(targets.springs, targets.vertices);
        require(!bind_ || targets.bind_points.rows() == held_.rest().rows(), "bind_points", targets.bind_points.rows(),
                "expected one per vertex");
        return targets;
    }

    // Springs and bind points go to their targets; what the prescribed degrees of freedom shall be [m], #dofs.
    Eigen::VectorXd move_to(const Targets& targets)
    {
        checked(targets);
        springs_.move_to(targets.springs);
        if (bind_) bind_->move_to(targets.bind_points);
        return held_.prescribed_values(targets.vertices);
    }

    ElasticOptions options_;
    HeldSpace held_;
    ElasticPotential flesh_;
    std::unique_ptr<StiffnessPotential> linear_flesh_;  // the same by its matrix; null where the law is not linear
    SpringPotential springs_;
    std::unique_ptr<BindPotential> bind_;
    std::unique_ptr<ContactPotential> contact_;  // null: none
    DeadLoad gravity_;
    bool weighs_ = false;  // a gravity was given before
    NewtonMinimiser newton_;
    std::unique_ptr<TimeStepper> stepper_;  // null: quasi-static
    Eigen::VectorXd displacement_;          // [m], #dofs
    Eigen::VectorXd last_iterate_;          // displacement [m], #dofs, at which Newton's method ended
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
    return implementation_->solve(targets_at, gravity_m_s2, implementation_->options_.path);
}

LoadPathSummary ElasticBody::solve_here(const Targets& targets, const pbs::Vec3& gravity_m_s2)
{
    require(gravity_m_s2.allFinite(), "gravity_m_s2", gravity_m_s2.transpose(), "expected finite components");
    if (const std::optional<NewtonSummary> refused = implementation_->refused_guess())
        return {.steps = {{1.0, *refused}}};
    return implementation_->solve([&](double) { return targets; }, gravity_m_s2, {.smallest_step = 1.0});
}

LoadPathSummary ElasticBody::advance(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2, double time_step_s)
{
    require(gravity_m_s2.allFinite(), "gravity_m_s2", gravity_m_s2.transpose(), "expected finite components");
    require(implementation_->stepper_ != nullptr, "dynamics", "quasi_static",
            "expected newmark or generalized_alpha for a step in time");
    return implementation_->advance(targets_at, gravity_m_s2, time_step_s);
}

void ElasticBody::start_from(const pbs::Positions& vertices)
{
    implementation_->start_at(implementation_->held_.prescribed_values(vertices));
}

void ElasticBody::start_from_nodes(const pbs::Positions& nodes)
{
    const pbs::Positions& rest = nodes_at_rest();
    require(nodes.rows() == rest.rows(), "nodes", nodes.rows(), "expected one position per node");
    const pbs::Positions displacement = nodes - rest;
    implementation_->start_at(Eigen::VectorXd::Map(displacement.data(), displacement.size()));
}

void ElasticBody::give_up_when(std::function<bool()> is_over)
{
    implementation_->options_.newton.is_over = std::move(is_over);
}

NewtonSummary ElasticBody::solve_at_once(const Targets& targets, const pbs::Vec3& gravity_m_s2)
{
    require(gravity_m_s2.allFinite(), "gravity_m_s2", gravity_m_s2.transpose(), "expected finite components");
    require(implementation_->stepper_ == nullptr, "dynamics", "in time", "expected quasi_static for a solve at once");
    return implementation_->solve_at_once(targets, gravity_m_s2);
}

const pbs::Positions& ElasticBody::positions() const
{
    return implementation_->positions_;
}

const pbs::Positions& ElasticBody::nodes_at_rest() const
{
    return implementation_->held_.space().node_positions();
}

std::vector<pbs::Location> ElasticBody::places_of(const pbs::Positions& points_at_rest) const
{
    return implementation_->places_of(points_at_rest);
}

pbs::Positions ElasticBody::moved(const std::vector<pbs::Location>& places) const
{
    return implementation_->moved(places, implementation_->displacement_);
}

pbs::Positions ElasticBody::moved_in_last_iterate(const std::vector<pbs::Location>& places) const
{
    return implementation_->moved(places, implementation_->last_iterate_);
}

Jacobians ElasticBody::jacobians_of_last_iterate() const
{
    return implementation_->flesh_.jacobians(implementation_->last_iterate_);
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

double ElasticBody::potential_energy_j() const
{
    double energy_j = 0.0;
    for (const Potential* term : implementation_->terms_) energy_j += term->value(implementation_->displacement_);
    return energy_j;
}

double ElasticBody::kinetic_energy_j() const
{
    return implementation_->stepper_ ? implementation_->stepper_->kinetic_energy_j() : 0.0;
}

Jacobians ElasticBody::jacobians() const
{
    return implementation_->flesh_.jacobians(implementation_->displacement_);
}

std::vector<bool> ElasticBody::prescribed_vertices() const
{
    return implementation_->held_.prescribed_vertices();
}

std::vector<PressedPair> ElasticBody::pressed() const
{
    return implementation_->contact_ ? implementation_->contact_->pressed(implementation_->displacement_)
                                     : std::vector<PressedPair>();
}

ContactState ElasticBody::contact() const
{
    return implementation_->contact_ ? implementation_->contact_->state(implementation_->displacement_)
                                     : ContactState();
}

const SetupSummary& ElasticBody::setup() const
{
    return implementation_->setup_;
}

}  // namespace reference_fem
