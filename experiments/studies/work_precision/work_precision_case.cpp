#include "experiments/studies/work_precision/work_precision_case.hpp"

#include "experiments/settings/option_fields.hpp"

namespace experiments {

nlohmann::json to_json(const WorkPrecisionCase& of)
{
    static const auto fields =
        OptionFields<WorkPrecisionCase>("work_precision")
            .record("of", &WorkPrecisionCase::of)
            .record("scene", &WorkPrecisionCase::scene)
            .record("frame", &WorkPrecisionCase::frame)
            .record("half", &WorkPrecisionCase::half)
            .record("range", &WorkPrecisionCase::range)
            .record("rounds", &WorkPrecisionCase::rounds)
            .record("newton_rounds", &WorkPrecisionCase::newton_rounds)
            .record("reference_is_refined", &WorkPrecisionCase::reference_is_refined)
            .record("members", &WorkPrecisionCase::members)
            .record("converged_iterations", &WorkPrecisionCase::converged_iterations)
            .record("longest_frame_ms", &WorkPrecisionCase::longest_frame_ms)
            .record("external", &WorkPrecisionCase::external)
            .derived("points",
                     [](const WorkPrecisionCase& one) -> nlohmann::json { return digest_of(point_settings(one.scene, one.range)); })
            .derived("reference", [](const WorkPrecisionCase& one) { return to_json(reference_flesh(one.scene)); })
            .complete();
    nlohmann::json json = fields.json(of);
    if (of.external.empty()) json.erase("external");  // as in records of the fixed list of deformers
    return json;
}

}  // namespace experiments
