#include "reference_fem/linear_elasticity.hpp"

#include "reference_fem/assembly.hpp"
#include "reference_fem/attached_points.hpp"
#include "reference_fem/blas.hpp"
#include "reference_fem/eliminated_system.hpp"
#include "reference_fem/held_parts.hpp"
#include "reference_fem/input_checks.hpp"
#include "pbs/geometry/stopwatch.hpp"

namespace reference_fem {
namespace {

void check_options(const LinearOptions& options)
{
    require(options.density_kg_m3 >= 0.0 && std::isfinite(options.density_kg_m3), "density_kg_m3", options.density_kg_m3,
            "expected a finite density >= 0");
    require(options.gravity_m_s2.allFinite(), "gravity_m_s2", options.gravity_m_s2.transpose(), "expected finite components");
}

void check_attachment(const pbs::TetMesh& mesh, const Attachment& attachment)
{
    require(attachment.spring_stiffness.size() == attachment.spring_points.rows(), "spring_stiffness", attachment.spring_stiffness.size(),
            "expected one a spring point");
    require(attachment.spring_points.allFinite(), "spring_points", "not a number or infinite", "expected finite coordinates");
    for (const double stiffness : attachment.spring_stiffness)
        require(stiffness > 0.0 && std::isfinite(stiffness), "spring_stiffness", stiffness, "expected a finite stiffness > 0");
    for (const int tet : attachment.prescribed_tets)
        require(tet >= 0 && tet < mesh.tets.rows(), "prescribed_tets", tet, "expected an index below the number of tets");
}

// Every point that the attachment holds: the springs' points, and the corners of prescribed tets.
void check_held(const pbs::TetMesh& mesh, const Attachment& attachment, const std::vector<int>& spring_tets)
{
    const Eigen::Index springs = attachment.spring_points.rows();
    pbs::Positions points(springs + 4 * attachment.prescribed_tets.size(), 3);
    points.topRows(springs) = attachment.spring_points;
    std::vector<int> tets = spring_tets;
    for (const int tet : attachment.prescribed_tets)
        for (const int vertex : mesh.tets.row(tet)) {
            points.row(tets.size()) = mesh.rest.row(vertex);
            tets.push_back(tet);
        }
    require_held(mesh, points, tets);
}

std::vector<bool> dofs_in_tets(const SimplexSpace& space, const std::vector<int>& tets)
{
    std::vector<bool> inside(space.dofs(), false);
    for (const int tet : tets)
        for (const int node : space.tet_nodes().row(tet))
            for (int c = 0; c < 3; ++c) inside[3 * node + c] = true;
    return inside;
}

// Gravity is linear: three loads [kg] for unit acceleration along each axis, #dofs x 3.
Eigen::MatrixXd unit_gravity_loads(const SimplexSpace& space, double density_kg_m3)
{
    Eigen::MatrixXd loads(space.dofs(), 3);
    for (int axis = 0; axis < 3; ++axis)
        loads.col(axis) = load_vector(space, [&](const pbs::Vec3&) -> pbs::Vec3 { return density_kg_m3 * pbs::Vec3::Unit(axis); });
    return loads;
}

}  // namespace

class LinearElasticity::Implementation {
public:
    Implementation(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
        : options_(options),
          material_(lame_parameters(options.young_pa, options.poisson)),
          rest_(mesh.rest),
          positions_(mesh.rest),
          space_(mesh, options.element_order),
          springs_(mesh, space_, attachment.spring_points, attachment.spring_stiffness),
          prescribed_(dofs_in_tets(space_, attachment.prescribed_tets)),
          displacement_(Eigen::VectorXd::Zero(space_.dofs()))
    {
        check_held(mesh, attachment, springs_.tets());
        const pbs::Stopwatch assembly;
        SparseMatrix stiffness = stiffness_matrix(space_, material_);
        springs_.add_to(stiffness);
        gravity_loads_ = unit_gravity_loads(space_, options.density_kg_m3);
        setup_.assemble_s = assembly.seconds();
        system_ = std::make_unique<EliminatedSystem>(stiffness, prescribed_, options.solver);
        summarise_setup();
    }

    SolveSummary solve(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets, const pbs::Vec3& gravity_m_s2)
    {
        require(spring_targets.rows() == static_cast<Eigen::Index>(springs_.tets().size()), "spring_targets", spring_targets.rows(),
                "expected one a spring point");
        require(vertex_targets.rows() == rest_.rows(), "vertex_targets", vertex_targets.rows(), "expected one a vertex");
        const pbs::Stopwatch stopwatch;
        Eigen::VectorXd load = gravity_loads_ * gravity_m_s2;
        springs_.add_load(spring_targets, load);
        const pbs::Positions prescribed = space_.from_vertices(vertex_targets - rest_);
        const EliminatedSolution solution = system_->solve(load, Eigen::Map<const Eigen::VectorXd>(prescribed.data(), prescribed.size()));
        displacement_ = solution.displacement;
        // Degree of freedom 3 n + c and row-major positions have the same layout.
        positions_ = rest_ + Eigen::Map<const pbs::Positions>(displacement_.data(), rest_.rows(), 3);
        return {stopwatch.seconds(), solution.residual, displacement_.allFinite()};
    }

    LinearOptions options_;
    Lame material_;
    pbs::Positions rest_, positions_;
    SimplexSpace space_;
    AttachedPoints springs_;
    std::vector<bool> prescribed_;  // #dofs
    Eigen::VectorXd displacement_;  // [m], #dofs
    Eigen::MatrixXd gravity_loads_;
    std::unique_ptr<EliminatedSystem> system_;
    SetupSummary setup_;

private:
    void summarise_setup()
    {
        const DirectFactor& factor = system_->factor();
        setup_.dofs = space_.dofs();
        setup_.analyse_s = factor.analyse_s();
        setup_.factor_s = factor.factor_s();
        setup_.elements = "deal.II " REFERENCE_FEM_DEAL_II_VERSION;
        setup_.solver = factor.name();
        setup_.blas = resolved_blas();
        setup_.factored = factor.usable();
        setup_.reciprocal_condition = factor.reciprocal_condition();
        setup_.spring_tet = springs_.tets();
    }
};

LinearElasticity::LinearElasticity(const pbs::TetMesh& mesh, const LinearOptions& options, const Attachment& attachment)
{
    check_options(options);
    check_mesh(mesh);
    check_attachment(mesh, attachment);
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

pbs::Positions LinearElasticity::spring_points_deformed() const
{
    return implementation_->springs_.moved(implementation_->displacement_);
}

double LinearElasticity::strain_energy_j() const
{
    return strain_energy(implementation_->space_, implementation_->material_, implementation_->displacement_);
}

std::vector<bool> LinearElasticity::prescribed_vertices() const
{
    std::vector<bool> prescribed(implementation_->rest_.rows());
    for (std::size_t v = 0; v < prescribed.size(); ++v) prescribed[v] = implementation_->prescribed_[3 * v];
    return prescribed;
}

const SetupSummary& LinearElasticity::setup() const
{
    return implementation_->setup_;
}

}  // namespace reference_fem
