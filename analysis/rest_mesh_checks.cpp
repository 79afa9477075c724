#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <fmt/format.h>

namespace analysis {

Eigen::VectorXd checked_rest_volumes(const pbs::Positions& rest, const pbs::Tets& tets)
{
    if (tets.rows() == 0) throw pbs::InputError("", 0, "tets", "0", "expected at least one tet");
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner)
            if (tets(t, corner) < 0 || tets(t, corner) >= rest.rows())
                throw pbs::InputError("", 0, fmt::format("tet {}", t), fmt::format("vertex {}", tets(t, corner)),
                                      fmt::format("expected 0 <= vertex < {}", rest.rows()));
    Eigen::VectorXd volumes = pbs::tet_volumes(rest, tets);
    for (Eigen::Index t = 0; t < volumes.size(); ++t)
        if (!(volumes(t) > 0.0))
            throw pbs::InputError("", 0, fmt::format("rest volume of tet {}", t), fmt::format("{} m^3", volumes(t)), "expected > 0");
    return volumes;
}

void require_points(const pbs::Positions& positions, Eigen::Index vertices, const char* name)
{
    if (positions.rows() != vertices)
        throw pbs::InputError("", 0, fmt::format("points of {}", name), std::to_string(positions.rows()),
                              fmt::format("expected {} as in the rest mesh", vertices));
}

}  // namespace analysis
