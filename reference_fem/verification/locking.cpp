// The share of bending and torsion that remains as Poisson's ratio approaches 1/2, by element: linear tets have about as many volumes to
// keep as displacements to keep them with, and lock.
//   bending: the cantilever of cantilever.cpp, against Timoshenko's beam
//   torsion: the bar of torsion.cpp; Saint-Venant's solution changes no volume, so its torque does not depend on Poisson's ratio
// Only formulations for nearly incompressible materials (reference_fem/formulation.hpp) have bounds.
#include "reference_fem/verification/beam_problems.hpp"

namespace reference_fem {
namespace {

const std::vector<double> quick_ladder = {0.3, 0.49, 0.499, 0.49999};
const std::vector<double> full_ladder = {0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999};

struct Element {
    int order;
    Formulation formulation;
};

VerificationRow as_locking(VerificationRow row, const Element& element)
{
    row.problem = "locking";
    row.note.clear();
    if (element.formulation == Formulation::displacement) {
        row.low = row.high = std::nullopt;
        row.bound_from.clear();
    }
    return row;
}

}  // namespace

VerificationRows locking_rows(const Effort& effort)
{
    VerificationRows rows;
    const int cube = effort.full ? 8 : 4;
    for (const Element& element : {Element{1, Formulation::displacement}, Element{2, Formulation::displacement},
                                   Element{2, Formulation::mean_dilatation}, Element{2, Formulation::taylor_hood}})
        for (const double nu : effort.full ? full_ladder : quick_ladder) {
            rows.push_back(as_locking(cantilever_row(effort, nu, element.order, element.formulation, {48, 6, 6}), element));
            VerificationRow torsion = torsion_row(effort, nu, element.order, element.formulation, cube);
            bound_by_grade_a(torsion);
            rows.push_back(as_locking(torsion, element));
        }
    return rows;
}

}  // namespace reference_fem
