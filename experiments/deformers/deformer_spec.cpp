#include "experiments/deformers/deformer_spec.hpp"

#include "experiments/deformers/option_names.hpp"

namespace experiments {
namespace {

nlohmann::json to_json(const pbs::PbsOptions& options)
{
    nlohmann::json json = {{"iterations", options.iterations},
                           {"k_stretch", options.k_stretch},
                           {"k_volume", options.k_volume},
                           {"k_bind", options.k_bind},
                           {"gravity_m_s2", {options.gravity_m_s2.x(), options.gravity_m_s2.y(), options.gravity_m_s2.z()}},
                           {"order", name_of(options.order)},
                           {"precision", name_of(options.precision)},
                           {"masses", name_of(options.masses)},
                           {"volume_form", name_of(options.volume_form)},
                           {"stiffness", name_of(options.stiffness_form)},
                           {"stop_residual", options.stop_residual}};
    if (options.sleep) json["sleep_tolerance"] = options.sleep_tolerance;
    if (options.jiggle) json["jiggle"] = {{"k_stretch", options.jiggle->k_stretch}};
    if (options.jiggle && options.jiggle->k_bind) json["jiggle"]["k_bind"] = *options.jiggle->k_bind;
    if (options.class_order != pbs::ClassOrder::bind_stretch_volume) json["class_order"] = name_of(options.class_order);
    if (options.lbs_entry != pbs::LbsEntry::start) json["lbs_entry"] = name_of(options.lbs_entry);
    if (options.bind_on_bone != pbs::BindOnBone::pinned) json["bind_on_bone"] = name_of(options.bind_on_bone);
    return json;
}

nlohmann::json to_json(const FemOptions& options)
{
    return {{"model", name_of(options.model)},
            {"element_order", options.element_order},
            {"formulation", name_of(options.formulation)},
            {"young_pa", options.young_pa},
            {"poisson", options.poisson},
            {"density_kg_m3", options.density_kg_m3},
            {"gravity_m_s2", {options.gravity_m_s2.x(), options.gravity_m_s2.y(), options.gravity_m_s2.z()}},
            {"dynamics", name_of(options.dynamics)},
            {"nested_start", options.nested_start},
            {"most_newton_steps", options.most_newton_steps},
            {"rayleigh", {options.rayleigh_mass_1_s, options.rayleigh_stiffness_s}},
            {"attachment", name_of(options.attachment)},
            {"core_radius", options.core_radius},
            {"spring_factor", options.spring_factor},
            {"solver", name_of(options.solver)}};
}

nlohmann::json to_json(const XpbdOptions& options)
{
    return {{"young_pa", options.young_pa},
            {"poisson", options.poisson},
            {"density_kg_m3", options.density_kg_m3},
            {"iterations", options.iterations},
            {"substeps", options.substeps},
            {"gravity_m_s2", {options.gravity_m_s2.x(), options.gravity_m_s2.y(), options.gravity_m_s2.z()}},
            {"jiggle", options.jiggle}};
}

}  // namespace

nlohmann::json to_json(const DeformerSpec& spec)
{
    nlohmann::json json = {{"name", spec.name}, {"label", spec.label}, {"kind", spec.kind}, {"variant", spec.variant}};
    if (spec.kind == "pbs") json["options"] = to_json(spec.pbs);
    if (spec.kind == "fem") json["options"] = to_json(spec.fem);
    if (spec.kind.starts_with("xpbd")) json["options"] = to_json(spec.xpbd);
    if (spec.kind == "delta_mush") json["options"] = {{"iterations", spec.delta_mush.iterations}, {"step", spec.delta_mush.step}};
    return json;
}

}  // namespace experiments
