// The project's own claims, and the values that a study's own runs measure for them.
//   const analysis::Records records = test_support::records_of(experiments::audit_study().plan(false));
//   judge(test_support::claim("C13"), records)
//   verdict_from("C09", jiggle_values("limb", measured))
#pragma once

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/studies/study.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace test_support {

inline analysis::Claim claim(const std::string& id)
{
    const auto claims = analysis::parse_claims(analysis::read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE);
    return *std::find_if(claims.begin(), claims.end(), [&](const auto& one) { return one.id == id; });
}

// The verdict on the claim from these values alone.
inline analysis::Verdict verdict_from(const std::string& id, const std::vector<analysis::Measurement>& measured)
{
    return judge(claim(id), {.measurements = measured});
}

// The claim's own cases, whatever its controls are.
inline analysis::Judged own_cases(const std::string& id, const std::vector<analysis::Measurement>& measured)
{
    const analysis::Claim of = claim(id);
    return judged(of, of.own, measured);
}

// Carries out the first `runs` runs of the plan, like `pbskin reproduce`.
inline analysis::Records records_of(experiments::StudyPlan plan, std::size_t runs = 1)
{
    const ScratchFolder folder;
    plan.runs.resize(std::min(runs, plan.runs.size()));
    experiments::write_study_plan(folder / "study", plan);
    for (const experiments::StudyRun& run : plan.runs) experiments::carry_out(run, folder / ("study/" + run.name));
    return experiments::read_study_records(folder / "study", folder.path().string());
}

}  // namespace test_support
