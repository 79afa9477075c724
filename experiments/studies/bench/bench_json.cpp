#include "experiments/studies/bench/bench.hpp"

#include "analysis/records/provenance.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace experiments {
namespace {

using nlohmann::json;

json json_of(const MachineLimits& limits)
{
    json memory = json::array();
    for (const MemoryBandwidth& point : limits.memory) memory.push_back({{"bytes", point.bytes}, {"gb_s", point.gb_s}});
    return {{"memory", memory}};
}

json number_or_null(const std::optional<double>& value)
{
    return value ? json(*value) : json();
}

json context_of(const BenchRecord& record)
{
    const analysis::Provenance provenance = analysis::collect_provenance(record.options.threads);
    return {{"cpu", provenance.cpu_model},
            {"cores", provenance.logical_cpus},
            {"kernel_instructions", pbs::kernel_instructions()},
            {"kernel_lanes", {{"f32", pbs::kernel_lanes(4)}, {"f64", pbs::kernel_lanes(8)}}},
            {"threads", record.options.threads},
            {"compiler", provenance.compiler},
            {"flags", provenance.flags},
            {"kernel_flags", PBS_KERNEL_FLAGS},
            {"iterations", iterations_per_step},
            {"quick", record.options.quick},
            {"headline_ratio", "ratio_to_plain_spread"},
            {"limits_of_one_core", json_of(record.limits)},
            {"busy_processors", {number_or_null(record.busy_before), number_or_null(record.busy_after)}},
            {"provenance", provenance}};
}

json json_of(const ProjectionKind& kind)
{
    return {{"variant", kind.variant}, {"precision", kind.precision}, {"threads", kind.threads}};
}

json json_of(const ProjectionTiming& timing)
{
    json result = json_of(static_cast<const ProjectionKind&>(timing));
    result.update({{"poses", timing.poses},
                   {"clock", timing.threads == 1 ? "thread_cpu" : "wall"},
                   {"ms_transfer", timing.ms_transfer},
                   {"working_set_bytes", timing.working_set_bytes},
                   {"residuals",
                    {{"stretch_rms", timing.residuals.stretch_rms},
                     {"volume_rms", timing.residuals.volume_rms},
                     {"bind_rms_m", timing.residuals.bind_rms_m}}}});
    for (const auto& [name, of] :
         {std::pair("stretch", &timing.stretch), std::pair("volume", &timing.volume), std::pair("bind", &timing.bind)})
        put_spread(result, std::string("ns_") + name, *of);
    put_spread(result, "ms_step", timing.ms_step);
    put_spread(result, "ratio_to_plain_spread", timing.ratio_to_plain_spread);
    put_spread(result, "ratio_to_plain", timing.ratio_to_plain);
    put_spread(result, "ratio_to_plain_native", timing.ratio_to_plain_native);
    result["residual_to_plain_spread"] = timing.answer_to_plain_spread.residual;
    result["volume_rms_to_plain_spread"] = timing.answer_to_plain_spread.volume_rms;
    result["residual_to_plain"] = timing.answer_to_plain.residual;
    result["volume_rms_to_plain"] = timing.answer_to_plain.volume_rms;
    if (timing.speedup_by_threads) put_spread(result, "speedup_by_threads", *timing.speedup_by_threads);
    if (timing.best_speedup_by_threads) result["best_speedup_by_threads"] = *timing.best_speedup_by_threads;
    if (timing.ms_floor) result["ms_floor"] = *timing.ms_floor;
    if (timing.stretch_fill) result["fill"] = {{"stretch", *timing.stretch_fill}, {"volume", *timing.volume_fill}};
    return result;
}

json json_of(const SkinningTiming& timing)
{
    json result = {{"blend", timing.blend}, {"variant", timing.variant}, {"precision", timing.precision},          {"threads", 1},
                   {"clock", "thread_cpu"}, {"gb_s", timing.gb_s},       {"share_of_limit", timing.share_of_limit}};
    put_spread(result, "ns_vertex", timing.ns_vertex);
    put_spread(result, "ratio_to_plain", timing.ratio_to_plain);
    return result;
}

json json_of(const DeformerTiming& timing)
{
    json result = {{"deformer", timing.deformer}, {"order", timing.order}, {"precision", timing.precision}, {"threads", 1}};
    if (!timing.left_out.empty()) result["left_out"] = timing.left_out;
    if (timing.iterations) result["iterations"] = *timing.iterations;
    for (const auto& [name, spread] :
         {std::pair("ms_frame", &timing.ms_frame), std::pair("ms_iteration", &timing.ms_iteration), std::pair("ns_tet", &timing.ns_tet),
          std::pair("ns_vertex", &timing.ns_vertex), std::pair("ratio_to_plain", &timing.ratio_to_plain)})
        if (*spread) put_spread(result, name, **spread);
    return result;
}

// The reference has no plain implementation, so there is no ratio.
json json_of(const FemTiming& timing, int tets)
{
    json result = {{"variant", "fem"},
                   {"model", "linear"},
                   {"element_order", 1},
                   {"precision", "f64"},
                   {"threads", 1},
                   {"clock", "thread_cpu"},
                   {"further_to_first", timing.further_to_first}};
    put_spread(result, "ms_first_solve", timing.ms_first_solve);
    put_spread(result, "ms_further_frame", timing.ms_further_frame);
    put_spread(result, "ns_element", scaled(timing.ms_further_frame, 1e6 / tets));
    return result;
}

json json_of(const NewtonTiming& timing)
{
    json result = {{"variant", "fem"}, {"model", timing.model}, {"element_order", 1},           {"precision", "f64"},
                   {"threads", 1},     {"clock", "thread_cpu"}, {"newton_steps", timing.steps}, {"reached", timing.is_reached}};
    put_spread(result, "ms_frame", timing.ms_frame);
    put_spread(result, "ms_newton_step", timing.ms_step);
    put_spread(result, "ns_element", timing.ns_element);
    return result;
}

json json_of(const MeshTimings& timings)
{
    json result = {{"mesh", {{"name", timings.name}, {"vertices", timings.vertices}, {"edges", timings.edges}, {"tets", timings.tets}}},
                   {"memory", {{"peak_bytes", timings.memory.peak_bytes}, {"growth_bytes", timings.memory.growth_bytes()}}}};
    for (const char* list : {"results", "yardsticks", "skinning", "fem", "deformers"}) result[list] = json::array();
    for (const ProjectionTiming& timing : timings.projections)
        result[timing.is_baseline() ? "yardsticks" : "results"].push_back(json_of(timing));
    for (const SkinningTiming& timing : timings.skinning) result["skinning"].push_back(json_of(timing));
    if (timings.fem) result["fem"].push_back(json_of(*timings.fem, timings.tets));
    if (timings.newton) result["fem"].push_back(json_of(*timings.newton));
    for (const DeformerTiming& timing : timings.deformers) result["deformers"].push_back(json_of(timing));
    if (!timings.fem_left_out.empty()) result["fem_left_out"] = timings.fem_left_out;
    return result;
}

json bound(double value)
{
    return std::isfinite(value) ? json(value) : json();
}

json json_of(const ScalingFit& fit)
{
    json result = json_of(static_cast<const ProjectionKind&>(fit));
    result.update({{"exponent", fit.exponent.estimate},
                   {"interval", {bound(fit.exponent.low), bound(fit.exponent.high)}},
                   {"level", fit.exponent.level},
                   {"sizes", fit.exponent.n}});
    return result;
}

}  // namespace

nlohmann::json to_json(const BenchOptions& options)
{
    static const auto fields = OptionFields<BenchOptions>("bench")
                                   .record("mesh", &BenchOptions::mesh)
                                   .record("bars", &BenchOptions::bars)
                                   .record("sizes", &BenchOptions::sizes)
                                   .record("threads", &BenchOptions::threads)
                                   .record("quick", &BenchOptions::quick)
                                   .record("seconds", &BenchOptions::seconds)
                                   .complete();
    return fields.json(options);
}

nlohmann::json bench_json(const BenchRecord& record)
{
    json meshes = json::array();
    for (const MeshTimings& mesh : record.meshes) meshes.push_back(json_of(mesh));
    json bench = meshes.front();
    bench["schema"] = 2;
    bench["context"] = context_of(record);
    bench["meshes"] = meshes;
    for (const ScalingFit& fit : record.scaling) bench["scaling"].push_back(json_of(fit));
    return bench;
}

}  // namespace experiments
