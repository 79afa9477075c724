#include "reference_fem/attachment.hpp"

#include "reference_fem/options.hpp"

#include <Eigen/Eigenvalues>

#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace reference_fem {

AttachedPoints::AttachedPoints(const pbs::TetMesh& mesh, const SimplexSpace& space, const pbs::Positions& points,
                               const Eigen::VectorXd& stiffness)
    : points_(points),
      stiffness_(stiffness),
      tet_(points.rows()),
      nodes_(space.tet_nodes().cols(), points.rows()),
      shapes_(space.tet_nodes().cols(), points.rows())
{
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < points.rows(); ++s) {
        const pbs::Location location = where.locate(points.row(s));
        tet_[s] = location.tet;
        if (location.tet < 0) continue;
        nodes_.col(s) = space.tet_nodes().row(location.tet);
        shapes_.col(s) = space.shape_values(location.barycentric);
    }
    sum_tets();
}

void AttachedPoints::sum_tets()
{
    std::map<int, GrippedTet> of_tet;
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        GrippedTet& gripped = of_tet[tet_[s]];
        if (gripped.nodes.size() == 0) gripped = {nodes_.col(s), Eigen::MatrixXd::Zero(nodes_.rows(), nodes_.rows())};
        gripped.stiffness += stiffness_(s) * shapes_.col(s) * shapes_.col(s).transpose();
    }
    for (auto& [tet, gripped] : of_tet) gripped_.push_back(std::move(gripped));
}

void AttachedPoints::add_to(SparseMatrix& matrix) const
{
    for (const GrippedTet& tet : gripped_)
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
            for (Eigen::Index b = 0; b < nodes_.rows(); ++b)
                for (int c = 0; c < 3; ++c)
                    matrix.coeffRef(3 * tet.nodes(a) + c, 3 * tet.nodes(b) + c) += tet.stiffness(a, b);
}

void AttachedPoints::add_load(const pbs::Positions& targets, Eigen::VectorXd& load) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        const pbs::Vec3 force = stiffness_(s) * (targets.row(s) - points_.row(s));
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a) load.segment<3>(3 * nodes_(a, s)) += shapes_(a, s) * force;
    }
}

void AttachedPoints::add_to(NodalMatrix& matrix) const
{
    for (const GrippedTet& tet : gripped_)
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
            for (Eigen::Index b = 0; b < nodes_.rows(); ++b)
                matrix.add_block(tet.nodes(a), tet.nodes(b), tet.stiffness(a, b) * Eigen::Matrix3d::Identity());
}

double AttachedPoints::energy(const pbs::Positions& targets, const Eigen::VectorXd& displacement) const
{
    double energy = 0.0;
    for (Eigen::Index s = 0; s < points_.rows(); ++s)
        if (tet_[s] >= 0)
            energy += stiffness_(s) / 2.0 * (moved(s, displacement) - targets.row(s).transpose()).squaredNorm();
    return energy;
}

void AttachedPoints::add_pull(const pbs::Positions& targets, const Eigen::VectorXd& displacement,
                              Eigen::VectorXd& gradient) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        const pbs::Vec3 pull = stiffness_(s) * (moved(s, displacement) - targets.row(s).transpose());
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a) gradient.segment<3>(3 * nodes_(a, s)) += shapes_(a, s) * pull;
    }
}

pbs::Vec3 AttachedPoints::moved(Eigen::Index spring, const Eigen::VectorXd& displacement) const
{
    pbs::Vec3 point = points_.row(spring);
    for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
        point += shapes_(a, spring) * displacement.segment<3>(3 * nodes_(a, spring));
    return point;
}

pbs::Positions AttachedPoints::moved(const Eigen::VectorXd& displacement) const
{
    pbs::Positions moved_points = points_;
    for (Eigen::Index s = 0; s < points_.rows(); ++s)
        if (tet_[s] < 0)
            moved_points.row(s).setConstant(std::numeric_limits<double>::quiet_NaN());
        else
            moved_points.row(s) = moved(s, displacement).transpose();
    return moved_points;
}

namespace {

// Root of each vertex's connected part (union-find).
std::vector<int> part_of_vertices(const pbs::TetMesh& mesh)
{
    std::vector<int> parent(mesh.rest.rows());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int vertex) {
        while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
    };
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 1; corner < 4; ++corner) parent[root(mesh.tets(t, corner))] = root(mesh.tets(t, 0));
    for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<int>(v));
    return parent;
}

// The second largest spread of the points, relative to the largest, is not lost in rounding.
bool span_a_plane(const std::vector<pbs::Vec3>& points)
{
    if (points.size() < 3) return false;
    pbs::Vec3 mean = pbs::Vec3::Zero();
    for (const pbs::Vec3& point : points) mean += point / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const pbs::Vec3& point : points) scatter += (point - mean) * (point - mean).transpose();
    const pbs::Vec3 spread =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
    return spread(1) > 1e-12 * spread(2);
}

// Every point that the attachment holds: the springs' points, the corners of prescribed tets, bound vertices.
void check_held(const pbs::TetMesh& mesh, const Attachment& attachment, const std::vector<int>& spring_tets)
{
    std::vector<int> tets = spring_tets;
    std::vector<pbs::Vec3> corners;
    for (const int tet : attachment.prescribed_tets)
        for (const int vertex : mesh.tets.row(tet)) {
            corners.emplace_back(mesh.rest.row(vertex));
            tets.push_back(tet);
        }
    for (Eigen::Index t = 0; attachment.bind_stiffness.size() > 0 && t < mesh.tets.rows(); ++t)
        for (const int vertex : mesh.tets.row(t)) {
            if (attachment.bind_stiffness(vertex) == 0.0) continue;
            corners.emplace_back(mesh.rest.row(vertex));
            tets.push_back(static_cast<int>(t));
        }
    const Eigen::Index springs = attachment.spring_points.rows();
    pbs::Positions points(springs + corners.size(), 3);
    points.topRows(springs) = attachment.spring_points;
    for (std::size_t k = 0; k < corners.size(); ++k) points.row(springs + k) = corners[k].transpose();
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

Eigen::MatrixXd unit_gravity_loads(const SimplexSpace& space, double density_kg_m3)
{
    Eigen::MatrixXd loads(space.dofs(), 3);
    for (int axis = 0; axis < 3; ++axis)
        loads.col(axis) =
            load_vector(space, [&](const pbs::Vec3&) -> pbs::Vec3 { return density_kg_m3 * pbs::Vec3::Unit(axis); });
    return loads;
}

const pbs::TetMesh& checked(const pbs::TetMesh& mesh, double density_kg_m3, const Attachment& attachment)
{
    require(density_kg_m3 >= 0.0 && std::isfinite(density_kg_m3), "density_kg_m3", density_kg_m3,
            "expected a finite density >= 0");
    check_mesh(mesh);
    check_attachment(mesh, attachment);
    return mesh;
}

}  // namespace

void require_held(const pbs::TetMesh& mesh, const pbs::Positions& points, const std::vector<int>& tets)
{
    const std::vector<int> part = part_of_vertices(mesh);
    std::map<int, std::vector<pbs::Vec3>> held;
    for (Eigen::Index p = 0; p < points.rows(); ++p)
        if (tets[p] >= 0) held[part[mesh.tets(tets[p], 0)]].push_back(points.row(p));
    std::set<int> checked;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const int of_tet = part[mesh.tets(t, 0)];
        if (!checked.insert(of_tet).second) continue;
        require(span_a_plane(held[of_tet]), "attachment of the part with tet", t,
                "expected three held points inside that are not on one line");
    }
}

void check_attachment(const pbs::TetMesh& mesh, const Attachment& attachment)
{
    require(attachment.spring_stiffness.size() == attachment.spring_points.rows(), "spring_stiffness",
            attachment.spring_stiffness.size(), "expected one per spring point");
    require(attachment.spring_points.allFinite(), "spring_points", "not a number or infinite",
            "expected finite coordinates");
    for (const double stiffness : attachment.spring_stiffness)
        require(stiffness > 0.0 && std::isfinite(stiffness), "spring_stiffness", stiffness,
                "expected a finite stiffness > 0");
    for (const int tet : attachment.prescribed_tets)
        require(tet >= 0 && tet < mesh.tets.rows(), "prescribed_tets", tet,
                "expected an index below the number of tets");
    require(attachment.bind_distance.size() == 0 || attachment.bind_distance.size() == mesh.rest.rows(),
            "bind_distance", attachment.bind_distance.size(), "expected one per vertex");
    require(attachment.bind_stiffness.size() == attachment.bind_distance.size(), "bind_stiffness",
            attachment.bind_stiffness.size(), "expected one a bound vertex");
    for (Eigen::Index v = 0; v < attachment.bind_distance.size(); ++v) {
        const double distance = attachment.bind_distance(v), stiffness = attachment.bind_stiffness(v);
        require(distance >= 0.0 && std::isfinite(distance), "bind_distance", distance,
                "expected a finite distance >= 0");
        require(stiffness >= 0.0 && std::isfinite(stiffness), "bind_stiffness", stiffness,
                "expected a finite stiffness >= 0");
    }
}

HeldSpace::HeldSpace(const pbs::TetMesh& mesh, int element_order, double density_kg_m3, const Attachment& attachment)
    : rest_(checked(mesh, density_kg_m3, attachment).rest),
      space_(mesh, element_order),
      springs_(mesh, space_, attachment.spring_points, attachment.spring_stiffness),
      prescribed_(dofs_in_tets(space_, attachment.prescribed_tets)),
      gravity_loads_(unit_gravity_loads(space_, density_kg_m3))
{
    check_held(mesh, attachment, springs_.tets());
}

// Degree of freedom 3 n + c and row-major positions have the same layout.
Eigen::VectorXd HeldSpace::prescribed_values(const pbs::Positions& vertex_targets) const
{
    const pbs::Positions on_nodes = space_.from_vertices(vertex_targets - rest_);
    return Eigen::Map<const Eigen::VectorXd>(on_nodes.data(), on_nodes.size());
}

pbs::Positions HeldSpace::vertices(const Eigen::VectorXd& displacement) const
{
    return rest_ + Eigen::Map<const pbs::Positions>(displacement.data(), rest_.rows(), 3);
}

std::vector<bool> HeldSpace::prescribed_vertices() const
{
    std::vector<bool> vertices(rest_.rows());
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = prescribed_[3 * v];
    return vertices;
}

void HeldSpace::require_targets(const pbs::Positions& spring_targets, const pbs::Positions& vertex_targets) const
{
    require(spring_targets.rows() == static_cast<Eigen::Index>(springs_.tets().size()), "spring_targets",
            spring_targets.rows(), "expected one per spring point");
    require(vertex_targets.rows() == rest_.rows(), "vertex_targets", vertex_targets.rows(), "expected one per vertex");
}

SetupSummary HeldSpace::summary(const PreparedSolver* factor, double assemble_s) const
{
    SetupSummary summary;
    summary.dofs = space_.dofs();
    summary.assemble_s = assemble_s;
    summary.elements = "deal.II " REFERENCE_FEM_DEAL_II_VERSION;
    summary.blas = resolved_blas();
    summary.spring_tet = springs_.tets();
    if (!factor) return summary;
    summary.analyse_s = factor->analyse_s();
    summary.factor_s = factor->factor_s();
    summary.solver = factor->name();
    summary.factored = factor->usable();
    summary.reciprocal_condition = factor->reciprocal_condition();
    return summary;
}

}  // namespace reference_fem
