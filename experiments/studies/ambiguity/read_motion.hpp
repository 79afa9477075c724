// Position based skinning by one reading of the paper as a deformer, so that whatever a study measures of a deformer can be measured of a
// reading; and a character that is moved by it through the frames of a scene.
//   ReadDeformer deformer(reading);
//   deformer.reset(character);
//   deformer.advance(pose, dt_s);   // one of the reading's substeps
//   const ReadMotion moved = move(character, scene, reading);
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/ambiguity/reading.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace experiments {

pbs::Weights weights_of(const pbs::Character& character, const Reading& reading);

// Posed q_i [m], #V x 3.
pbs::Positions bind_points_of(const pbs::Character& character, const Reading& reading, const pbs::Pose& pose, const pbs::Positions& lbs);

class ReadDeformer final : public Deformer {
public:
    explicit ReadDeformer(const Reading& reading) : reading_(reading) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return experiments::has_memory(reading_); }

    const pbs::Positions& lbs() const { return lbs_; }  // of the last step [m], #V x 3

private:
    Reading reading_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<pbs::PbsSolver> solver_;
    pbs::Positions lbs_;
};

struct ReadMotion {
    analysis::CaseRecord pbs, lbs;       // volume, from which a verdict is computed
    std::vector<pbs::Positions> shapes;  // of PBS, one per frame [m], #V x 3
    bool finite = true;
};

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading);

}  // namespace experiments
