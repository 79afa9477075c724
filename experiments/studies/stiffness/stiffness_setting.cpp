#include "experiments/studies/stiffness/stiffness_setting.hpp"

namespace experiments {

const char* name_of(Method method)
{
    switch (method) {
        case Method::pbs:
            return "pbs";
        case Method::exponent:
            return "exponent";
        case Method::xpbd:
            return "xpbd";
        case Method::xpbd_small_steps:
            return "xpbd_small_steps";
        case Method::xpbd_forgetting:
            return "xpbd_forgetting";
    }
    return "";
}

nlohmann::json to_json(const StiffnessSetting& setting)
{
    return {{"method", name_of(setting.method)}, {"k_stretch", setting.k_stretch},     {"young_pa", setting.young_pa},
            {"iterations", setting.iterations},  {"time_step_s", setting.time_step_s}, {"order_seed", setting.order_seed}};
}

pbs::PbsOptions pbs_options(const LoadedBody& body, const StiffnessSetting& setting)
{
    pbs::PbsOptions options;
    options.iterations = setting.iterations;
    options.k_stretch = setting.k_stretch;
    options.k_bind = body.bind_distance.size() ? 1.0 : 0.0;
    options.precision = pbs::Precision::f64;
    options.order = pbs::Order::plain;
    options.jiggle = pbs::Jiggle{setting.k_stretch};
    if (setting.method == Method::exponent) options.stiffness_form = pbs::StiffnessForm::exponent;
    return options;
}

XpbdOptions xpbd_options(const StiffnessSetting& setting)
{
    XpbdOptions options;
    options.young_pa = setting.young_pa;
    options.density_kg_m3 = flesh_density_kg_m3;
    options.iterations = setting.method == Method::xpbd_small_steps ? 1 : setting.iterations;
    options.substeps = setting.method == Method::xpbd_small_steps ? setting.iterations : 1;
    options.jiggle = true;
    options.keep_multipliers = setting.method != Method::xpbd_forgetting;
    return options;
}

Eigen::VectorXd bind_distance_of(const LoadedBody& body)
{
    return body.bind_distance.size() ? body.bind_distance : Eigen::VectorXd::Zero(body.mesh.rest.rows());
}

}  // namespace experiments
