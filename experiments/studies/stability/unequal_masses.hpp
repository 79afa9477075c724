// Algorithm 1 with particles of very different masses, which the paper's m_i = 1 leaves out: masses from 1 to `ratio`, evenly spread in
// their logarithm over the vertices, seeded.
#pragma once

#include "pbs/solver/particles.hpp"
#include "pbs/solver/projection.hpp"

namespace experiments {

class UnequalMasses {
public:
    UnequalMasses(const pbs::TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                  const pbs::PbsOptions& options, double ratio);

    pbs::StepSummary advance(const pbs::Positions& lbs_positions, const pbs::Positions& bind_points, double dt_s);
    const pbs::Positions& positions() const { return particles_.positions(); }  // [m], #V x 3

private:
    template <typename Scalar>
    void project(pbs::Projection<Scalar>& projection, const pbs::Positions& bind_points);

    pbs::PbsOptions options_;
    pbs::Particles particles_;
    std::unique_ptr<pbs::Projection<float>> single_;  // one of the two, by options.precision
    std::unique_ptr<pbs::Projection<double>> double_;
};

}  // namespace experiments
