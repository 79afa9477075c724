// A second program's answer to the same nodes, tets and data: CalculiX. Its cantilevers are in reference_fem/verification/calculix; here it
// solves the limb, whose bones (####) hold whole tets or, by the smooth attachment, springs, with the forearm bent or twisted, linear and
// at large strain.
//
//   (---####---.---####---)
//
// If ccx is not on the PATH, one row states that the comparison was not made.

#include "experiments/studies/verification/problem.hpp"
#include "pbs/character/character.hpp"
#include "reference_fem/verification/calculix/calculix_rows.hpp"

namespace experiments {

using namespace reference_fem;

namespace {

struct LimbPose {
    std::string name;
    pbs::Vec3 axis;
    double angle_deg;
    BodyModel model;
    int element_order;
    FemAttachment attachment = FemAttachment::nodes;
};

VerificationRow limb_row(const CalculixComparison& comparison, const pbs::Character& limb, const LimbPose& pose)
{
    const HeldBody body = held_body(
        limb, {solver_material(comparison.effort, calculix_flesh), pose.attachment, pose.model, pose.element_order, [&](double fraction) {
                   return pbs::joint_sweep(limb.skeleton, 1, pose.axis, fraction * pose.angle_deg, 2, 0.01).steps.back();
               }});
    const bool linear = pose.model == BodyModel::linear, smooth = pose.attachment == FemAttachment::smooth;
    const AnsweredProblem answer = answered_body(limb.mesh, body);
    VerificationRow row = calculix_row(comparison, (smooth ? "limb, smooth attachment, " : "limb, ") + pose.name,
                                       linear ? "linear" : "st_venant_kirchhoff", answer, deck_options(body));
    row.mesh = std::to_string(limb.mesh.rest.rows()) + " vertices";
    if (smooth) bound(row, {}, difference_bound(limb.mesh, body, answer.displacements), difference_bound_text(pose.model));
    if (pose.model == BodyModel::st_venant_kirchhoff_at_four_points) row.note += "P2 integrated by C3D10's four points";
    if (pose.model == BodyModel::st_venant_kirchhoff && pose.element_order == 2) {
        row.quantity.setting += "_six_points";
        unbound(row);
        row.note += "six quadrature points against C3D10's four";
    }
    return row;
}

VerificationRows limb_rows(const CalculixComparison& comparison, const Effort& effort)
{
    const pbs::Vec3 twist = pbs::Vec3::UnitX(), bend = pbs::Vec3::UnitZ();
    const pbs::Character limb = effort.limb(0), coarse_limb = effort.limb(600);
    const pbs::Character& second_order_limb = effort.full ? limb : coarse_limb;
    VerificationRows rows;
    const auto add = [&](const pbs::Character& character, const LimbPose& pose) { rows.push_back(limb_row(comparison, character, pose)); };
    for (const int element_order : {1, 2})
        for (const LimbPose& pose : {LimbPose{"bent by 10 deg", bend, 10.0, BodyModel::linear, element_order},
                                     LimbPose{"bent by 90 deg", bend, 90.0, BodyModel::linear, element_order},
                                     LimbPose{"twisted by 90 deg", twist, 90.0, BodyModel::linear, element_order}})
            add(limb, pose);
    add(limb, {"bent by 30 deg", bend, 30.0, BodyModel::st_venant_kirchhoff, 1});
    add(limb, {"twisted by 30 deg", twist, 30.0, BodyModel::st_venant_kirchhoff, 1});
    for (const BodyModel model : {BodyModel::st_venant_kirchhoff_at_four_points, BodyModel::st_venant_kirchhoff})
        add(second_order_limb, {"bent by 30 deg", bend, 30.0, model, 2});

    constexpr FemAttachment smooth = FemAttachment::smooth;
    const pbs::Character small_limb = effort.limb(400);  // each tet in a capsule adds up to 30 equations to CalculiX's deck
    for (const int element_order : {1, 2}) {
        const BodyModel large = element_order == 1 ? BodyModel::st_venant_kirchhoff : BodyModel::st_venant_kirchhoff_at_four_points;
        add(small_limb, {"bent by 10 deg", bend, 10.0, BodyModel::linear, element_order, smooth});
        add(small_limb, {"bent by 30 deg", bend, 30.0, large, element_order, smooth});
        add(small_limb, {"twisted by 30 deg", twist, 30.0, large, element_order, smooth});
    }
    return rows;
}

}  // namespace

VerificationRows calculix_rows(const Effort& effort)
{
    const auto program = calculix_on_path();
    if (!program)
        return {{.problem = "calculix",
                 .quantity = {"second_opinion", "second opinion"},
                 .unit = "1",
                 .note = "not installed: no ccx on the PATH (Debian: calculix-ccx)"}};
    const CalculixComparison comparison{effort, *program, calculix_version(*program)};
    VerificationRows rows = calculix_cantilever_rows(comparison);
    const auto append = [&](const VerificationRows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
    if (effort.limb) append(limb_rows(comparison, effort));
    append(calculix_timing_rows(comparison));
    return rows;
}

reference_fem::HeldBody held_body(const pbs::Character& character, const HeldFrame& frame)
{
    constexpr double whole_tets_fit = 0.6;  // radius of a capsule over that of the limb
    FemOptions options{.young_pa = frame.material.young_pa, .attachment = frame.attachment};
    if (frame.attachment == FemAttachment::nodes) options.core_radius = whole_tets_fit;
    const BoneAttachment bones = bone_attachment(character, options);
    const auto targets_at = [bones, rest = character.mesh.rest, pose_at = frame.pose_at](double fraction) {
        return targets(bones, rest, pose_at(fraction));
    };
    return {frame.material, frame.model, frame.element_order, bones.attachment, targets_at};
}

}  // namespace experiments
