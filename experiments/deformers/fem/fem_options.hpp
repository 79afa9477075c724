// Options of the finite element reference as a deformer, their names and keys, and the module that makes it.
#pragma once

#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/options.hpp"

namespace experiments {

template <typename Options>
class OptionFields;  // experiments/settings/option_fields.hpp

// How the bones hold the flesh. smooth: springs, whose density decreases smoothly to zero from the axis of each bone to
// the surface of a capsule around it. embedded: each bone is a rigid capsule inside the flesh, tied to it by stiff
// springs of one density. nodes: whole tets inside the capsule are prescribed. bind: the paper's bind constraint as an
// energy, for nonlinear models. held: as smooth, and each bone holds the flesh that it alone moves, as a skull holds a
// head (pbs::SpringPlacement).
enum class FemAttachment { smooth, embedded, nodes, bind, held };

struct FemOptions {
    reference_fem::Model model = reference_fem::Model::linear;
    int element_order = 2;  // 1, 2
    reference_fem::Formulation formulation = reference_fem::Formulation::displacement;
    double young_pa = 1.0e5;
    double poisson = 0.45;
    double density_kg_m3 = 1000.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero();
    reference_fem::Dynamics dynamics = reference_fem::Dynamics::quasi_static;
    double rayleigh_mass_1_s = 0.0;  // damping C = rayleigh_mass M + rayleigh_stiffness K(rest)
    double rayleigh_stiffness_s = 0.0;
    FemAttachment attachment = FemAttachment::smooth;
    double core_radius = 0.0;  // capsule radius over local limb radius; 0: 0.7 with smooth, otherwise 0.35
    double spring_factor =
        0.0;  // q: springs of density q E / r^2, r the capsule's radius (on its axis, if smooth); 0: 10 with smooth,
              // otherwise 1e4. Doubling that of embedded bones changes no reported value
    pbs::AttachmentKernel attachment_kernel = pbs::AttachmentKernel::biweight;  // of smooth: how the density decreases
    double attachment_ends = 1.0;  // of smooth: over so many capsule radii at each end
    int attachment_samples =
        1;  // of smooth and embedded: multiplies the numbers of sample points along, across and around a bone
    bool contact = true;  // the surface does not pass through itself; see has_contact
    double contact_range =
        0.025;  // distance below which the surface presses on itself, over the mean local limb radius
    double contact_stiffness = 1.0;  // of the barrier, over Young's modulus
    reference_fem::LinearSolver solver = reference_fem::LinearSolver::cholmod;
    int most_newton_steps = 0;  // quasi-static: per stage of the way to a pose, which is then not reached; 0: no limit
    bool nested_start =
        false;  // nonlinear: the way to a far pose begins at the solution with fewer nodes (order 1, unrefined)

    bool has_contact() const
    {
        return contact && model != reference_fem::Model::linear &&
               dynamics != reference_fem::Dynamics::generalized_alpha;
    }
    // Bound vertices have no capsules, prescribed tets have no springs, and both have no sample points.
    bool has_capsules() const { return attachment != FemAttachment::bind; }
    bool has_spring_factor() const { return attachment != FemAttachment::nodes; }
    bool has_sample_points() const { return is_smooth() || attachment == FemAttachment::embedded; }
    bool is_smooth() const { return attachment == FemAttachment::smooth || attachment == FemAttachment::held; }
    // core_radius and spring_factor, or the attachment's own values where these are 0.
    double used_core_radius() const { return core_radius > 0.0 ? core_radius : is_smooth() ? 0.7 : 0.35; }
    double used_spring_factor() const { return spring_factor > 0.0 ? spring_factor : is_smooth() ? 10.0 : 1e4; }
};

// Where and how springs hold the flesh, for attachments with sample points.
inline pbs::SpringPlacement spring_placement(FemAttachment attachment)
{
    return attachment == FemAttachment::embedded ? pbs::SpringPlacement::embedded
           : attachment == FemAttachment::held   ? pbs::SpringPlacement::held
                                                 : pbs::SpringPlacement::smooth;
}

inline pbs::SmoothSpringOptions spring_options(const FemOptions& options)
{
    return {.core_radius = options.used_core_radius(),
            .spring_factor = options.used_spring_factor(),
            .kernel = options.attachment_kernel,
            .ends = options.attachment_ends,
            .samples = options.attachment_samples};
}

// The names of the values of the reference's options in scenes and records.
NAMED_OPTIONS(reference_fem::Model, linear, corotational, stable_neo_hookean, neo_hookean, st_venant_kirchhoff)
NAMED_OPTIONS(reference_fem::Formulation, displacement, mean_dilatation, taylor_hood)
NAMED_OPTIONS(reference_fem::Dynamics, quasi_static, newmark, generalized_alpha)
NAMED_OPTIONS(FemAttachment, smooth, embedded, nodes, bind, held)
NAMED_OPTIONS(pbs::AttachmentKernel, biweight, wendland)
NAMED_OPTIONS(reference_fem::LinearSolver, cholmod, umfpack)

// The options of the finite element reference in scenes and records: their keys, and how they are read.
const OptionFields<FemOptions>& fem_fields();

}  // namespace experiments

// The entry for deformers into the module lib/libpbskin_fem.so, which carries deal.II and is loaded when a scene first
// uses a reference.
extern "C" experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options);  // the caller owns it
