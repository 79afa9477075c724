// The frames that figures and the report's viewer show. No claim is judged by them. README.md describes the runs and
// records.
#include "experiments/studies/study.hpp"

namespace experiments {
namespace {

StudyPlan plan(bool full)
{
    return plan_of_cases("frames", full, [](const StudyCase& study_case, StudyPlan& plan) {
        StudyRun run = study_case.scene_run(study_case.name,
                                            {"output.frames=[]", "output.frame_names=[]", "output.frames_every=1"});
        // the sweeps go beyond the last pose that flesh reaches
        run.bad_frames_are_results = !run.scene.reference.empty();
        for (const nlohmann::json& table : study_case.value<nlohmann::json>("pbs", nlohmann::json::array()))
            run.scene.deformers.push_back(study_case.further_pbs(table));
        plan.runs.push_back(run);
    });
}

}  // namespace

Study frames_study()
{
    return {"frames", plan};
}

}  // namespace experiments
