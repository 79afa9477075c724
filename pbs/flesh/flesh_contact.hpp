// Self-contact of flesh as an energy: a penalty on the skin that lies in flesh of another part, by the depth
// constraints C of SelfContact,
//   E_c = sum over the pairs of k_v / 2 min(C, 0)^2.
// beta, m and delta are kept from one detection to the next, so that C is linear and E_c convex.
//
// k_v = M a_v^2 / V_v is the stiffness of the column of flesh below the vertex, whose section a_v is a third of the
// areas of the skin's triangles around it, and whose height is V_v / a_v, with the lumped volume V_v. The flesh around
// it lets no column expand sideways, so that M = E (1 - nu) / ((1 + nu) (1 - 2 nu)) = lambda + mu in the constants of
// FleshMaterial. The form K A^2 / V is that of J. Hallquist, LS-DYNA Theory Manual, 2006, there with the bulk modulus
// and a factor that the user chooses.
//   FleshContact<float> contact(mesh, energy, place);
//   contact.forget();
//   contact.find(x);
//   double e = contact.add_value_and_gradient(x, gradient);
#pragma once

#include "pbs/contact/self_contact.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/packed/rows.hpp"

#include <vector>

namespace pbs {

// An upper bound of E_c as springs of single vertices, which equals E_c and its gradient where it was made: moving the
// vertices by s_i adds at most the sum of gradient . s_i + stiffness |s_i|^2 / 2.
struct ContactPull {
    int vertex;
    double stiffness = 0.0;        // over Young's modulus [m]
    Vec3 gradient = Vec3::Zero();  // over Young's modulus [m^2]
};

template <typename Scalar>
class FleshContact {
public:
    // place: the row of each vertex, #V.
    FleshContact(const TetMesh& mesh, const FleshEnergy& energy, const std::vector<int>& place);

    void forget() { contact_.forget(); }  // as SelfContact has it
    bool find(const Rows<Scalar>& x);     // likewise; false: there is no pair
    // Returns E_c over Young's modulus [m^3], and adds its gradient [m^2].
    double add_value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) const;
    // Since the weights c_i of a pair, 1 and -beta_i, have absolute values that add up to 2, |sum c_i s_i|^2 <= 2 sum
    // |c_i| |s_i|^2. Hence the stiffness of a vertex is the sum of 2 k_v |c_i| |m|^2. By vertex.
    std::vector<ContactPull> pulls(const Rows<Scalar>& x) const;

    // k_v over Young's modulus [m], #V; 0 below the skin
    const Eigen::VectorXd& stiffness() const { return stiffness_; }

private:
    SelfContact<Scalar> contact_;
    std::vector<int> place_;
    Eigen::VectorXd stiffness_;
};

}  // namespace pbs
