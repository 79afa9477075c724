#include "experiments/studies/stability/stability_cell.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"

namespace experiments {

std::string precision_of(const StabilityCell& cell)
{
    return traits_of(cell.spec).precision;
}

nlohmann::json to_json(const Disturbance& disturbance)
{
    static const auto fields = OptionFields<Disturbance>("disturbance")
                                   .record("axis", &Disturbance::axis)
                                   .record("angle_deg", &Disturbance::angle_deg)
                                   .record("turning_steps", &Disturbance::turning_steps)
                                   .record("teleport_m", &Disturbance::teleport_m)
                                   .record("start", &Disturbance::start)
                                   .record("stays", &Disturbance::stays)
                                   .complete();
    return fields.json(disturbance);
}

nlohmann::json to_json(const StabilityCell& cell)
{
    static const auto fields = OptionFields<StabilityCell>("cell")
                                   .record("body", &StabilityCell::body)
                                   .record("model", &StabilityCell::model)
                                   .record("factor", &StabilityCell::factor)
                                   .record("value", &StabilityCell::value)
                                   .record("unit", &StabilityCell::unit)
                                   .record("second_factor", &StabilityCell::second_factor)
                                   .record("second_value", &StabilityCell::second_value)
                                   .record("second_unit", &StabilityCell::second_unit)
                                   .record("named", &StabilityCell::named)
                                   .record("deformer", &StabilityCell::spec)
                                   .record("disturbance", &StabilityCell::disturbance)
                                   .record("time_step_s", &StabilityCell::time_step_s)
                                   .record("still_steps", &StabilityCell::still_steps)
                                   .record("defect", &StabilityCell::defect)
                                   .record("thinness", &StabilityCell::thinness)
                                   .record("mass_ratio", &StabilityCell::mass_ratio)
                                   .record("held_end", &StabilityCell::held_end)
                                   .record("nudge_m", &StabilityCell::nudge_m)
                                   .record("as_published", &StabilityCell::as_published)
                                   .complete();
    return fields.json(cell);
}

std::string setting_of(const StabilityCell& cell)
{
    nlohmann::json setting = to_json(cell);
    for (const char* of_the_way :
         {"model", "factor", "value", "unit", "second_factor", "second_value", "second_unit", "named", "as_published"})
        setting.erase(of_the_way);
    for (const char* of_the_way : {"turning_steps", "start", "stays"}) setting["disturbance"].erase(of_the_way);
    return setting.dump();
}

}  // namespace experiments
