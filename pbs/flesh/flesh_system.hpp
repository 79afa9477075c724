// The energy of the flesh (flesh_energy.hpp, or projective_dynamics.hpp) as a minimiser needs it: values, gradients and steps of a
// quasi-Newton method, on rows of numbers. One implementation is plain, the other one packed; both have the same constants.
//   auto system = make_flesh_system<float>(mesh, energy, factor, Arithmetic::packed_f32, threads);
//   system->set_centres(centres);
//   system->load(positions, x);
//   double e = system->value_and_gradient(x, g);
//   system->precondition(g);   // g <- H^-1 g
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/packed/rows.hpp"

#include <memory>

namespace pbs {

class ProjectiveEnergy;

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
};

// Energy: FleshEnergy or ProjectiveEnergy. factor: of flesh_laplacian. Scalar is that of `arithmetic` (unchecked).
template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor,
                                                       Arithmetic arithmetic, int threads);

// Solves L L^T x = b with a kept factor, for x, y and z side by side.
//   const TriangularSolve<float> solve(factor, place);
//   solve.apply(rows);   // b in, x out
// Columns of L with the same rows below (supernodes) are processed together, so that each row is read and written once for all of them.
template <typename Scalar>
class TriangularSolve {
public:
    // place: where row i of the matrix lies among the rows that are passed to apply, #rows.
    TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place);

    void apply(Scalar* rows);  // four numbers per row

private:
    std::vector<Supernode> supernodes_;
    std::vector<std::uint32_t> below_;  // rows below the supernodes' triangles
    std::vector<Scalar> values_;
    std::vector<std::uint32_t> place_;  // of row k of L
    Rows<Scalar> work_;
};

// The same with a loop per entry of L: the plain implementation, in double.
void solve_plainly(const CholeskyFactor& factor, const std::vector<int>& place, double* rows, std::vector<double>& work);

// The plain implementation of FleshSystem: the energy in file order and a loop per entry of the factor, in double.

// Energy: FleshEnergy or ProjectiveEnergy.
template <typename Energy>
class PlainSystem : public FleshSystem<double> {
public:
    PlainSystem(const Energy& energy, const CholeskyFactor& factor);

    Rows<double> rows() const override { return Rows<double>(static_cast<int>(place_.size())); }
    void set_centres(const Positions& centres) override { centres_ = centres; }
    void load(const Positions& x, Rows<double>& rows) const override;
    void store(const Rows<double>& rows, Positions& x) const override;
    double value_and_gradient(const Rows<double>& x, Rows<double>& gradient) override;
    void precondition(Rows<double>& residual) override;
    double dot(const Rows<double>& a, const Rows<double>& b) const override;
    void add(double factor, const Rows<double>& a, Rows<double>& to) const override;

private:
    Energy energy_;
    CholeskyFactor factor_;
    std::vector<int> place_;  // the identity, #V
    Positions centres_, x_, gradient_;
    std::vector<double> work_;
};

using PlainFlesh = PlainSystem<FleshEnergy>;
using PlainProjective = PlainSystem<ProjectiveEnergy>;

}  // namespace pbs
