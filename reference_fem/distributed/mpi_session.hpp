// MPI from start to end of a program, and what the ranks tell each other before there is a distributed mesh. The header is plain.
//   MpiSession session(argc, argv);
//   if (session.rank() == 0) mesh = read_tet_mesh(file).mesh;
//   session.broadcast(mesh.rest);
#pragma once

#include "pbs/geometry/types.hpp"

#include <memory>
#include <string>
#include <vector>

namespace reference_fem {

class MpiSession {
public:
    MpiSession(int& argc, char**& argv);  // one thread a rank
    ~MpiSession();

    int rank() const;
    int ranks() const;
    [[noreturn]] void abort(int exit_status) const;  // ends all ranks: for an error that one of them met alone

    // From rank 0 to all.
    void broadcast(std::string& text) const;
    void broadcast(std::vector<int>& values) const;
    void broadcast(Eigen::VectorXd& values) const;
    void broadcast(pbs::Positions& points) const;
    void broadcast(pbs::Tets& tets) const;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace reference_fem
