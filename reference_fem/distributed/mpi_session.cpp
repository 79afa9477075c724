#include "reference_fem/distributed/mpi_session.hpp"

#include <deal.II/base/mpi.h>

namespace reference_fem {
namespace {

template <typename Container>
void broadcast_as_bytes(Container& container, long long size)
{
    MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
    container.resize(size);
    // MPI counts in int.
    constexpr long long most_bytes = 1 << 30;
    const long long bytes = size * static_cast<long long>(sizeof(*container.data()));
    for (long long sent = 0; sent < bytes; sent += most_bytes)
        MPI_Bcast(reinterpret_cast<char*>(container.data()) + sent, static_cast<int>(std::min(most_bytes, bytes - sent)), MPI_BYTE, 0,
                  MPI_COMM_WORLD);
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

class MpiSession::Implementation {
public:
    Implementation(int& argc, char**& argv) : mpi(argc, argv, 1) {}

    dealii::Utilities::MPI::MPI_InitFinalize mpi;
};

MpiSession::MpiSession(int& argc, char**& argv) : implementation_(std::make_unique<Implementation>(argc, argv))
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
