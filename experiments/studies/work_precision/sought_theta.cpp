#include "experiments/studies/work_precision/sought_theta.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"

namespace experiments {

std::vector<ThetaRow> sought_thetas(const WorkPrecisionCase& of, const BodyMesh& mesh, const PosePair& poses,
                                    const PosedReference& reference)
{
    std::vector<ThetaRow> rows;
    for (const ComparedDeformer& entry : compared_deformers()) {
        if (!is_available(entry) || entry.stiffness_key.empty()) continue;
        SettingChoice choice{.code = codes_of(entry).front()};
        if (!entry.few_iterations.empty()) choice.iterations = entry.few_iterations.back();
        const auto setting_at = [&](double factor) {
            choice.stiffness_factor = factor;
            return PointSetting{entry.name, spec_with(entry, of.scene, choice), choice.iterations};
        };
        const auto error_pct = [&](double factor) -> std::optional<double> {
            stop_if_interrupted();
            try {
                const Shape shape = PosedDeformer(setting_at(factor), mesh, poses).reach();
                if (shape.finished) return reference.error_of(shape.positions).joint_pct;
            } catch (const pbs::InputError&) {  // a stiffness that the deformer does not accept
            }
            return std::nullopt;
        };
        const double highest = entry.highest_stiffness / stiffness_of(entry, of.scene);
        rows.push_back({of.of, key_of(setting_at(1.0)), nearest_factor(error_pct, highest)});
    }
    return rows;
}

}  // namespace experiments
