#include "experiments/studies/bench/bench.hpp"

#include "analysis/records/provenance.hpp"
#include "pbs/solver/batched/batch_kernels.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace experiments {
namespace {

nlohmann::json json_of(const MachineLimits& limits)
{
    nlohmann::json copy = nlohmann::json::array();
    for (const CopyBandwidth& point : limits.copy) copy.push_back({{"bytes", point.bytes}, {"gb_s", point.gb_s}});
    return {{"fma_gflops_f32", limits.gflops_f32}, {"fma_gflops_f64", limits.gflops_f64}, {"copy", copy}};
}

nlohmann::json context_of(const BenchRecord& record)
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
            {"iterations", iterations_a_step},
            {"quick", record.options.quick},
            {"limits_of_one_core", json_of(record.limits)},
            {"load", {record.load_before, record.load_after}},
            {"provenance", provenance}};
}

nlohmann::json bound(double value)
{
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace

void to_json(nlohmann::json& json, const ScalingFit& fit)
{
    json = {{"variant", fit.variant},
            {"precision", fit.precision},
            {"threads", fit.threads},
            {"exponent", fit.exponent.estimate},
            {"interval", {bound(fit.exponent.low), bound(fit.exponent.high)}},
            {"level", fit.exponent.level},
            {"sizes", fit.exponent.n}};
}

nlohmann::json bench_json(const BenchRecord& record)
{
    nlohmann::json meshes = nlohmann::json::array();
    for (const MeshTimings& mesh : record.meshes) meshes.push_back(json_of(mesh));
    nlohmann::json json = meshes.front();
    json["schema"] = 1;
    json["context"] = context_of(record);
    json["meshes"] = meshes;
    if (!record.scaling.empty()) json["scaling"] = record.scaling;
    return json;
}

}  // namespace experiments
