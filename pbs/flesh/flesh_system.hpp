// The energy of the flesh (flesh_energy.hpp, or projective_dynamics.hpp) as a minimiser needs it: values, gradients and steps of a
// quasi-Newton method, on rows of numbers. One implementation is plain, the other one packed; both have the same constants.
//   auto system = make_flesh_system<float>(mesh, energy, factor, Arithmetic::packed_f32, threads);
//   system->set_centres(centres);
//   system->load(positions, x);
//   double e = system->value_and_gradient(x, g);
//   system->precondition(g);   // g <- H^-1 g
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/flesh/projective_dynamics.hpp"
#include "pbs/packed/rows.hpp"

#include <memory>

namespace pbs {

template <typename Scalar>
class FleshSystem {
public:
    virtual ~FleshSystem() = default;

    virtual Rows<Scalar> rows() const = 0;                   // of a vector, zeros
    virtual void set_centres(const Positions& centres) = 0;  // c_i [m], #V x 3; packed: their mean becomes the origin of the rows
    virtual void load(const Positions& x, Rows<Scalar>& rows) const = 0;
    virtual void store(const Rows<Scalar>& rows, Positions& x) const = 0;
    virtual double value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) = 0;  // over Young's modulus [m^3], [m^2]
    virtual void precondition(Rows<Scalar>& residual) = 0;                                 // [m^2] -> [m]
    virtual double dot(const Rows<Scalar>& a, const Rows<Scalar>& b) const = 0;
    virtual void add(double factor, const Rows<Scalar>& a, Rows<Scalar>& to) const = 0;  // to += factor * a
    // The norm of a step that ends an iteration [m]: this share of the first one, or a few roundings of the positions, as at rest.
    double smallest_step(const Rows<Scalar>& x, double share, double first) const;
    virtual std::size_t bytes() const = 0;  // that an evaluation and a preconditioning read from memory
};

// Energy: FleshEnergy or ProjectiveEnergy. factor: of flesh_laplacian. Scalar is that of `arithmetic` (unchecked).
template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor,
                                                       Arithmetic arithmetic, int threads);

}  // namespace pbs
