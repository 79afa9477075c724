// A body that an attachment holds, by prescribed tets or by springs, as a problem that CalculiX can solve too, with the reference's answer.
#pragma once

#include "reference_fem/elastic_body.hpp"
#include "reference_fem/verification/calculix/calculix_deck.hpp"

namespace reference_fem {

enum class BodyModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by C3D10's rule; the reference's own rule has six points
};
struct HeldBody {
    ElasticMaterial material;
    BodyModel model = BodyModel::linear;
    int element_order = 1;
    Attachment attachment;  // no vertex is bound
    TargetsAt targets_at;   // of the problem at 1, and of rest, where a large rotation begins, at 0
};
AnsweredProblem answered_body(const pbs::TetMesh& mesh, const HeldBody& body);

// The analysis that the model needs. With springs CalculiX's Newton stops at a residual of 1e-12 of the mean force, otherwise at 1e-9.
DeckOptions deck_options(const HeldBody& body);

// How far the two programs' answers may differ at a node, relative to the largest displacement: an error of forces relative to |K| |u|,
// times cond(K), which turns it into one of displacements, times |u| over the largest displacement. Norms are 2-norms, and a node's
// difference is at most that of all. K is the stiffness at rest with the springs (rounding_bound.hpp). The errors of forces are
//   rounding: sqrt(n) eps, n unknowns;
//   at large strain the reference's last residual, 1e-11 of the gradients of flesh and springs, each at most |K| |u|;
//   and CalculiX's: in each unknown at most its bound times the mean force of elements on their nodes, which is at most |K| |u|.
double difference_bound(const pbs::TetMesh& mesh, const HeldBody& body, const pbs::Positions& displacements);
std::string difference_bound_text(BodyModel model);

}  // namespace reference_fem
