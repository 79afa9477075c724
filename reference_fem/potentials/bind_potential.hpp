// The paper's bind constraint (Sec. 3.6) as an energy on vertices: sum_i k_i / 2 (|x_i - q_i| - d_i)^2, q_i the vertex's rest projection
// on its bone, carried by the bone. It keeps a distance and nothing else: around the bone and, past its ends, around the end point a vertex
// is free. A vertex on the bone (d_i = 0) is tied to q_i.
#pragma once

#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// Until move_to() the bind points q_i are the rest positions.
class BindPotential : public Potential {
public:
    // rest [m], #V x 3; distance d_i [m] and stiffness k_i [N/m], #V; k_i = 0: not bound. Vertex v is node v.
    BindPotential(const pbs::Positions& rest, const Eigen::VectorXd& distance, const Eigen::VectorXd& stiffness)
        : rest_(rest), distance_(distance), stiffness_(stiffness), bind_points_(rest)
    {
    }

    void move_to(const pbs::Positions& bind_points) { bind_points_ = bind_points; }  // q_i [m], #V x 3

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return false; }

private:
    pbs::Vec3 offset(const Eigen::VectorXd& displacement, Eigen::Index vertex) const;  // x_i - q_i [m]

    pbs::Positions rest_;
    Eigen::VectorXd distance_, stiffness_;
    pbs::Positions bind_points_;
};

}  // namespace reference_fem
