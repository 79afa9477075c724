// Sweeps of vertex block descent on rows of numbers. One implementation is plain, the other one packed; both move the vertices by the same
// colours (../packed/vertex_order.hpp), one colour after the other.
//   auto sweep = make_vertex_sweep<float>(mesh, energy, Arithmetic::packed_f32, threads);
//   sweep->set_centres(centres);
//   sweep->load(positions, x);
//   sweep->move(1.88, x);   // x_i -= omega H_i^-1 g_i for each vertex, each with the latest positions of the others
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/packed/rows.hpp"

#include <memory>

namespace pbs {

template <typename Scalar>
class VertexSweep {
public:
    virtual ~VertexSweep() = default;

    virtual Rows<Scalar> rows() const = 0;                   // of positions, zeros
    virtual void set_centres(const Positions& centres) = 0;  // c_i [m], #V x 3; packed: their mean becomes the origin of the rows
    virtual void load(const Positions& x, Rows<Scalar>& rows) const = 0;
    virtual void store(const Rows<Scalar>& rows, Positions& x) const = 0;
    virtual void move(double omega, Rows<Scalar>& x) = 0;
    virtual void extrapolate(double omega, const Rows<Scalar>& before, Rows<Scalar>& x) const = 0;  // x = before + omega (x - before)
    virtual std::size_t bytes() const = 0;                                                          // that a sweep reads from memory
};

// Scalar is that of `arithmetic` (unchecked).
template <typename Scalar>
std::unique_ptr<VertexSweep<Scalar>> make_vertex_sweep(const TetMesh& mesh, const FleshEnergy& energy, Arithmetic arithmetic, int threads);

}  // namespace pbs
