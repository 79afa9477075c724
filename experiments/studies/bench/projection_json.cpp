#include "experiments/studies/bench/projection_timing.hpp"
#include "experiments/studies/bench/timing_json.hpp"

namespace experiments {
namespace {

nlohmann::json json_of(const RooflinePoint& point)
{
    return {{"flops_per_byte", point.flops_a_byte},
            {"gflops", point.gflops},
            {"attainable_gflops", point.attainable_gflops},
            {"share_of_limit", point.share_of_limit}};
}

void put_class(nlohmann::json& json, const std::string& name, const ClassTiming& timing)
{
    put_spread(json, "ns_" + name, timing.ns);
    if (timing.roofline) json["roofline"][name] = json_of(*timing.roofline);
}

}  // namespace

void to_json(nlohmann::json& json, const ProjectionTiming& timing)
{
    json = {{"variant", timing.variant},
            {"precision", timing.precision},
            {"threads", timing.threads},
            {"poses", timing.poses},
            {"clock", timing.threads == 1 ? "thread_cpu" : "wall"},
            {"ms_transfer", timing.ms_transfer},
            {"working_set_bytes", timing.working_set_bytes}};
    put_class(json, "stretch", timing.stretch);
    put_class(json, "volume", timing.volume);
    put_class(json, "bind", timing.bind);
    put_spread(json, "ms_step", timing.ms_step);
    put_spread(json, "ratio_to_plain", timing.ratio_to_plain);
    put_spread(json, "ratio_to_plain_native", timing.ratio_to_plain_native);
    put_spread(json, "ratio_to_plain_spread", timing.ratio_to_plain_spread);
    if (timing.speedup_by_threads) put_spread(json, "speedup_by_threads", *timing.speedup_by_threads);
    if (timing.ms_floor) json["ms_floor"] = *timing.ms_floor;
    if (timing.best_speedup_by_threads) json["best_speedup_by_threads"] = *timing.best_speedup_by_threads;
    json["residuals"] = {{"stretch_rms", timing.residuals.stretch_rms},
                         {"volume_rms", timing.residuals.volume_rms},
                         {"bind_rms_m", timing.residuals.bind_rms_m}};
    if (timing.stretch_fill) json["fill"] = {{"stretch", *timing.stretch_fill}, {"volume", *timing.volume_fill}};
}

}  // namespace experiments
