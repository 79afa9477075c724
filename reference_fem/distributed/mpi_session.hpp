// MPI for the whole life of a program, and the data that ranks exchange before there is a distributed mesh. This header includes no MPI.
//   MpiSession session(argc, argv);
//   if (session.rank() == 0) mesh = read_tet_mesh(file).mesh;
//   session.broadcast(mesh.rest);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <memory>
#include <string>
#include <vector>

namespace reference_fem {

// One a program, over MPI_COMM_WORLD; its end ends MPI.
class MpiSession {
public:
    MpiSession(int& argc, char**& argv);  // one thread a rank
    ~MpiSession();

    int rank() const;                                // from 0
    int ranks() const;                               // all of MPI_COMM_WORLD
    [[noreturn]] void abort(int exit_status) const;  // ends all ranks: for an error that one of them met alone

    // Sends from rank 0 to all; called by all ranks. The arrays of the others take the size of rank 0's.
    void broadcast(std::string& text) const;
    void broadcast(std::vector<int>& values) const;  // of any length
    void broadcast(Eigen::VectorXd& values) const;   // to the bit
    void broadcast(pbs::Positions& points) const;    // #P x 3
    void broadcast(pbs::Tets& tets) const;           // #T x 4

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace reference_fem
