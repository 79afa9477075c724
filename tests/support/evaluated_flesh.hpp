// Energy, gradient and step of a system of flesh, with the vertices in the order of the mesh.
//   const Evaluated found = evaluated<float>(system, centres, x);
#pragma once

#include "pbs/flesh/flesh_system.hpp"

namespace test_support {

struct Evaluated {
    double energy;
    pbs::Positions gradient, preconditioned;
};

template <typename Scalar>
Evaluated evaluated(pbs::FleshSystem<Scalar>& system, const pbs::Positions& centres, const pbs::Positions& x)
{
    pbs::Rows<Scalar> rows = system.rows(), gradient = system.rows();
    system.set_centres(centres);
    system.load(x, rows);
    Evaluated result;
    result.energy = system.value_and_gradient(rows, gradient);
    pbs::Rows<Scalar> zero = system.rows();
    pbs::Positions offset;  // store() adds the origin of the rows
    system.store(zero, offset);
    system.store(gradient, result.gradient);
    result.gradient -= offset;
    system.precondition(gradient);
    system.store(gradient, result.preconditioned);
    result.preconditioned -= offset;
    return result;
}

}  // namespace test_support
