// The settings at which the values of C09 are measured.
//   for (const JiggleSetting& setting : jiggle_settings()) responses.push_back(jolt_response(character, jiggling(pbs, setting), ...));
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/solver/options.hpp"

#include <string>
#include <vector>

namespace experiments {

struct JiggleSetting {
    double k_stretch = 0.1;  // in the zone; 1 elsewhere
    double time_step_s = 0.01;
    int iterations = 24;
    double k_bind = 1.0;  // in the zone; 1 elsewhere
    pbs::Masses masses = pbs::Masses::unit;
    bool operator==(const JiggleSetting&) const = default;
};

// The default, then one change at a time: k_stretch 0.05 to 1, steps of 2.5 to 40 ms, 6 to 96 iterations, lumped masses, an unbound zone.
std::vector<JiggleSetting> jiggle_settings();

// The zone is bound and all masses are 1, as in the paper. Other settings are other readings of the paper.
bool is_of_the_paper(const JiggleSetting& setting);

nlohmann::json to_json(const JiggleSetting& setting);

DeformerSpec jiggling(DeformerSpec pbs, const JiggleSetting& setting);  // with the gravity of `pbs`
analysis::CaseKey key_of(const std::string& body, const JiggleSetting& setting);
std::string text_of(const JiggleSetting& setting);  // "k_stretch 0.1, 10 ms, 24 iterations, unit masses"; a k_bind below 1 is appended

}  // namespace experiments
