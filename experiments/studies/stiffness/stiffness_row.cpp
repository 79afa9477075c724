#include "experiments/studies/stiffness/stiffness_row.hpp"

namespace experiments {

using analysis::Columns;
using Row = StiffnessRow;
using Setting = StiffnessSetting;

const Columns<Row> stiffness_columns =
    Columns<Row>{{"body", &Row::body, "", "name of the body"},
                 {"load", &Row::load, "", "zone, zone on held or cantilever: what hangs on what"},
                 {"vertices", &Row::vertices, "", "number of vertices"},
                 {"edges", &Row::edges, "", "number of edges"},
                 {"tets", &Row::tets, "", "number of tets"},
                 {"mesh", &Row::mesh, "", "size that was asked for: wanted, or wanted, a tenth finer"}} +
    within(&Row::setting, Columns<Setting>{{"method", &Setting::method, "", "solver"},
                                           {"k_stretch", &Setting::k_stretch, "", "stiffness of PBS; of no meaning for XPBD"},
                                           {"young_pa", &Setting::young_pa, "Pa", "stiffness of XPBD; of no meaning for PBS"},
                                           {"iterations", &Setting::iterations, "", "iterations per step"},
                                           {"time_step_ms", &Setting::time_step_ms, "ms", "time step"},
                                           {"order_seed", &Setting::order_seed, "", "seed of the order of constraints; 0: file order"}}) +
    Columns<Row>{{"by", &Row::by, "", "linear: the map of a step near rest; stepped: the solver in time"},
                 {"force_n", &Row::force_n, "N", "weight of what hangs"},
                 {"stiffness_n_m", &Row::stiffness_n_m, "N/m", "that weight over the mean displacement"},
                 {"converged", &Row::converged, "", "the body came to rest"},
                 {"steps", &Row::steps, "", "applications of the linear map, or time steps"}};

namespace {

// still: RestingState or SteppedBody.
template <typename Still>
StiffnessRow row_of(const LoadedBody& body, const StiffnessSetting& setting, const std::string& by, const Still& still, double gravity_m_s2)
{
    return {.body = body.name,
            .load = body.load,
            .vertices = static_cast<int>(body.mesh.rest.rows()),
            .edges = body.edges,
            .tets = static_cast<int>(body.mesh.tets.rows()),
            .setting = setting,
            .by = by,
            .force_n = weight_n(body, gravity_m_s2),
            .stiffness_n_m = effective_stiffness_n_m(body, still.displacement, gravity_m_s2),
            .converged = still.converged,
            .steps = still.steps};
}

}  // namespace

StiffnessRow linear_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    return row_of(body, setting, "linear", rest_near_rest(body, setting), 1.0);
}

StiffnessRow stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting)
{
    return row_of(body, setting, "stepped", step_until_still(body, setting, still_gravity_m_s2), still_gravity_m_s2);
}

}  // namespace experiments
