#include "reference_fem/distributed/elastic_problem.hpp"

#include <deal.II/base/mpi.h>
#include <sys/resource.h>

#include <algorithm>

namespace reference_fem {
namespace {

struct HeldPoints {
    std::vector<pbs::Vec3> points;
    std::vector<int> tets;
};

void add_held_faces(const pbs::TetMesh& mesh, const std::vector<int>& held_vertices, HeldPoints& held)
{
    std::vector<bool> flags(mesh.rest.rows(), false);
    for (const int v : held_vertices) flags[v] = true;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const auto corners = mesh.tets.row(t);
        if (std::count_if(corners.begin(), corners.end(), [&](int v) { return flags[v]; }) < 3) continue;
        for (const int v : corners) {
            if (!flags[v]) continue;
            held.points.emplace_back(mesh.rest.row(v));
            held.tets.push_back(static_cast<int>(t));
        }
    }
}

void add_attached(const pbs::TetMesh& mesh, const Attachment& attachment, HeldPoints& held)
{
    for (const int tet : attachment.prescribed_tets)
        for (const int v : mesh.tets.row(tet)) {
            held.points.emplace_back(mesh.rest.row(v));
            held.tets.push_back(tet);
        }
    if (attachment.spring_points.rows() == 0) return;
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < attachment.spring_points.rows(); ++s) {
        held.points.emplace_back(attachment.spring_points.row(s));
        held.tets.push_back(where.locate(held.points.back()).tet);
    }
}

void require_vertices(const pbs::TetMesh& mesh, const std::vector<int>& vertices, const char* field)
{
    for (const int v : vertices)
        require(v >= 0 && v < mesh.rest.rows(), field, v, "expected an index below the number of vertices");
}

template <typename Container>
void broadcast_as_bytes(Container& container, long long size)
{
    MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
    container.resize(size);
    // MPI counts in int.
    constexpr long long most_bytes = 1 << 30;
    const long long bytes = size * static_cast<long long>(sizeof(*container.data()));
    for (long long sent = 0; sent < bytes; sent += most_bytes)
        MPI_Bcast(reinterpret_cast<char*>(container.data()) + sent,
                  static_cast<int>(std::min(most_bytes, bytes - sent)), MPI_BYTE, 0, MPI_COMM_WORLD);
}

// Rows of a row-major matrix with a fixed number of columns.
template <typename Matrix>
struct AsFlat {
    Matrix& matrix;
    void resize(long long size) { matrix.resize(size / Matrix::ColsAtCompileTime, Eigen::NoChange); }
    auto* data() { return matrix.data(); }
};

template <typename Matrix>
void broadcast_rows(Matrix& matrix)
{
    AsFlat<Matrix> flat{matrix};
    broadcast_as_bytes(flat, matrix.size());
}

}  // namespace

void check_problem(const pbs::TetMesh& mesh, const ElasticProblem& problem)
{
    const LinearOptions& options = problem.options;
    lame_parameters(options.young_pa, options.poisson);
    require(options.element_order == 1 || options.element_order == 2, "element_order", options.element_order,
            "expected 1 or 2");
    require(options.density_kg_m3 >= 0.0 && std::isfinite(options.density_kg_m3), "density_kg_m3",
            options.density_kg_m3, "expected a finite density >= 0");
    require(options.gravity_m_s2.allFinite(), "gravity_m_s2", options.gravity_m_s2.transpose(),
            "expected finite components");
    require(problem.traction_pa.allFinite(), "traction_pa", problem.traction_pa.transpose(),
            "expected finite components");
    check_mesh(mesh);
    check_attachment(mesh, problem.attachment);
    require(problem.attachment.bind_distance.size() == 0, "bind_distance", problem.attachment.bind_distance.size(),
            "expected none: the bind constraint is not linear");
    require(problem.spring_targets.rows() == problem.attachment.spring_points.rows(), "spring_targets",
            problem.spring_targets.rows(), "expected one per spring point");
    require(problem.attachment.prescribed_tets.empty() || problem.vertex_targets.rows() == mesh.rest.rows(),
            "vertex_targets", problem.vertex_targets.rows(), "expected one per vertex");
    require_vertices(mesh, problem.held_vertices, "held_vertices");
    require_vertices(mesh, problem.pulled_vertices, "pulled_vertices");

    HeldPoints held;
    add_held_faces(mesh, problem.held_vertices, held);
    add_attached(mesh, problem.attachment, held);
    pbs::Positions points(held.points.size(), 3);
    for (std::size_t p = 0; p < held.points.size(); ++p) points.row(p) = held.points[p];
    require_held(mesh, points, held.tets);
}

double peak_memory_mb()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

PrescribedNodes::PrescribedNodes(const pbs::TetMesh& mesh, const Attachment& attachment,
                                 const pbs::Positions& vertex_targets)
    : mesh_(mesh), vertex_targets_(vertex_targets)
{
    for (const int tet : attachment.prescribed_tets)
        for (const int first : mesh.tets.row(tet))
            for (const int second : mesh.tets.row(tet))
                if (first <= second) nodes_.insert({first, second});
}

std::optional<pbs::Vec3> PrescribedNodes::displacement(const std::pair<int, int>& ends) const
{
    if (!nodes_.contains(ends)) return std::nullopt;
    const auto of_vertex = [&](int v) -> pbs::Vec3 { return vertex_targets_.row(v) - mesh_.rest.row(v); };
    return (of_vertex(ends.first) + of_vertex(ends.second)) / 2.0;
}

class MpiSession::Implementation {
public:
    explicit Implementation(char** program) : mpi(program_name_only, program, 1) {}

    int program_name_only = 1;  // PETSc, which deal.II starts, would take the other arguments for its own
    dealii::Utilities::MPI::MPI_InitFinalize mpi;
};

MpiSession::MpiSession(char** argv) : implementation_(std::make_unique<Implementation>(argv))
{
}

MpiSession::~MpiSession() = default;

int MpiSession::rank() const
{
    return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
}

int MpiSession::ranks() const
{
    return static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
}

void MpiSession::abort(int exit_status) const
{
    MPI_Abort(MPI_COMM_WORLD, exit_status);
    std::abort();
}

void MpiSession::broadcast(std::string& text) const
{
    broadcast_as_bytes(text, static_cast<long long>(text.size()));
}

void MpiSession::broadcast(std::vector<int>& values) const
{
    broadcast_as_bytes(values, static_cast<long long>(values.size()));
}

void MpiSession::broadcast(Eigen::VectorXd& values) const
{
    broadcast_as_bytes(values, values.size());
}

void MpiSession::broadcast(pbs::Positions& points) const
{
    broadcast_rows(points);
}

void MpiSession::broadcast(pbs::Tets& tets) const
{
    broadcast_rows(tets);
}

}  // namespace reference_fem
