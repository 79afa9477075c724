// The warped stiffness matrix of M. Mueller, J. Dorsey, L. McMillan, R. Jagnow, B. Cutler (Stable real-time
// deformations, SCA 2002), as the inverse that a minimiser applies: R K R^T, where K is the second derivative of the
// flesh's energy at rest and R turns each vertex as the bones around it turn. K is factored once for all poses; a pose
// costs the rotations alone. Near the minimum R K R^T is close to the second derivative of the energy, since flesh that
// a bone carries along is as stiff as at rest in the frame of this bone. Unlike the Laplacian (flesh_laplacian) it
// resists changes of volume as the flesh does and lets it rotate.
//   WarpedSolve<float> solve(mesh, energy, factor.order, system->place(), true);
//   solve.set_rotations(rotations);
//   solve.apply(rows);   // b in, (R K R^T)^-1 b out
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/packed/rows.hpp"

#include <cstdint>
#include <vector>

namespace pbs {

template <typename Scalar>
class WarpedSolve {
public:
    // order: of the vertices in the factor; that of a factor of the same mesh has few entries. place: the row of each
    // vertex, #V. packed: false solves with a loop per entry, in double. InputError: K is not positive definite, or the
    // module of CHOLMOD is missing.
    WarpedSolve(const TetMesh& mesh, const FleshEnergy& energy, const std::vector<int>& order,
                const std::vector<int>& place, bool packed);

    void set_rotations(const std::vector<Eigen::Matrix3d>& rotations);  // #V
    void apply(Rows<Scalar>& rows);                                     // [m^2] -> [m]
    std::size_t entries() const { return entries_; }                    // of the factor

private:
    void make_panels(const CholeskyFactor& factor);

    std::vector<int> order_;            // vertices in the order of the factor
    std::vector<std::uint32_t> place_;  // 4 * row of each of them
    std::size_t entries_ = 0;
    CholeskyFactor plain_;  // empty where the panels are used
    std::vector<Panel> panels_;
    std::vector<std::uint32_t> blocks_;  // of rows of the panels, 4 * block
    Rows<PanelValue<Scalar>> values_;
    Rows<Scalar> rotations_, turned_, scratch_;
};

}  // namespace pbs
