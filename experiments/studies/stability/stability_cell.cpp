#include "experiments/studies/stability/stability_cell.hpp"

#include "experiments/deformers/registry.hpp"

namespace experiments {

std::string precision_of(const StabilityCell& cell)
{
    return traits_of(cell.spec).precision;
}

nlohmann::json to_json(const StabilityCell& cell)
{
    const Disturbance& disturbance = cell.disturbance;
    const pbs::Vec3& axis = disturbance.axis;
    return {{"body", cell.body},
            {"model", cell.model},
            {"factor", cell.factor},
            {"value", cell.value},
            {"unit", cell.unit},
            {"second_factor", cell.second_factor},
            {"second_value", cell.second_value},
            {"second_unit", cell.second_unit},
            {"named", cell.named},
            {"deformer", to_json(cell.spec)},
            {"axis", {axis.x(), axis.y(), axis.z()}},
            {"angle_deg", disturbance.angle_deg},
            {"turning_steps", disturbance.turning_steps},
            {"teleport_m", disturbance.teleport_m},
            {"stays", disturbance.stays},
            {"time_step_s", cell.time_step_s},
            {"still_steps", cell.still_steps},
            {"start", static_cast<int>(disturbance.start)},
            {"defect", static_cast<int>(cell.defect)},
            {"thinness", cell.thinness},
            {"mass_ratio", cell.mass_ratio},
            {"held_end", cell.held_end},
            {"as_published", cell.as_published}};
}

std::string setting_of(const StabilityCell& cell)
{
    nlohmann::json setting = to_json(cell);
    for (const char* of_the_way : {"model", "factor", "value", "unit", "second_factor", "second_value", "second_unit", "named",
                                   "turning_steps", "start", "stays", "as_published"})
        setting.erase(of_the_way);
    return setting.dump();
}

}  // namespace experiments
