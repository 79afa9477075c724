#include "experiments/studies/bench/bench.hpp"

#include "analysis/records/provenance.hpp"
#include "pbs/solver/batched/batch_kernels.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

constexpr double quiet_load = 0.5;

std::string limits_text(const MachineLimits& limits)
{
    std::string copy;
    for (const double bytes : {32e3, 512e3, 8e6, 256e6}) copy += fmt::format("{:8.0f}", bandwidth_at(limits, bytes));
    return fmt::format("one core: multiply-add {:.0f} / {:.0f} GFLOP/s (f32 / f64); copy{} GB/s over 32 KB, 512 KB, 8 MB, 256 MB\n",
                       limits.gflops_f32, limits.gflops_f64, copy);
}

std::string share_text(const ClassTiming& timing)
{
    return timing.roofline ? fmt::format("{:3.0f}%", 100.0 * timing.roofline->share_of_limit) : "    ";
}

std::string floor_text(const ProjectionTiming& timing)
{
    return timing.ms_floor ? fmt::format(" {:>7.1f}", timing.ms_step.median / *timing.ms_floor) : "        ";
}

std::string projection_line(const ProjectionTiming& t)
{
    const std::string name = t.variant + (t.poses > 1 ? fmt::format(" x {}", t.poses) : "");
    std::string line = fmt::format("  {:<13}{:<5}{:>3} ", name, t.precision, t.threads);
    for (const ClassTiming* of : {&t.stretch, &t.volume, &t.bind}) line += fmt::format(" {:>9.3f} {}", of->ns.median, share_text(*of));
    line += fmt::format(" {:>10.4g} {:>9.4g}..{:<8.4g}", t.ms_step.median, t.ms_step.lower, t.ms_step.upper);
    line += floor_text(t);
    for (const Spread& ratio : {t.ratio_to_plain, t.ratio_to_plain_native, t.ratio_to_plain_spread})
        line += fmt::format(" {:>8.2f}", ratio.median);
    if (t.best_speedup_by_threads) line += fmt::format("   x {:.2f} one thread's best", *t.best_speedup_by_threads);
    return line + "\n";
}

std::string projections_text(const std::vector<ProjectionTiming>& timings)
{
    std::string text =
        fmt::format("  {:<13}{:<5}{:>3} {:>14} {:>14} {:>14} {:>10} {:>19} {:>7} {:>8} {:>8} {:>8}\n", "order", "", "thr", "ns stretch lim",
                    "ns volume lim", "ns bind lim", "ms step", "quartiles", "x floor", "x plain", "x native", "x spread");
    for (const ProjectionTiming& timing : timings) text += projection_line(timing);
    return text;
}

std::string skinning_text(const std::vector<SkinningTiming>& timings)
{
    std::string text = fmt::format("  {:<5}{:<8}{:<5} {:>10} {:>9} {:>8}\n", "", "", "", "ns vertex", "GB/s", "x plain");
    for (const SkinningTiming& t : timings)
        text += fmt::format("  {:<5}{:<8}{:<5} {:>10.3f} {:>9.1f} {:>8.2f}\n", t.blend, t.variant, t.precision, t.ns_vertex.median, t.gb_s,
                            t.ratio_to_plain.median);
    return text;
}

std::string fem_text(const MeshTimings& mesh)
{
    if (!mesh.fem_left_out.empty()) return fmt::format("  fem left out: {}\n", mesh.fem_left_out);
    if (!mesh.fem) return "";
    return fmt::format("  fem linear P1: first solve {:.4g} ms, further frame {:.4g} ms (1/{:.0f})\n", mesh.fem->ms_first_solve.median,
                       mesh.fem->ms_further_frame.median, 1.0 / mesh.fem->further_to_first);
}

std::string scaling_text(const std::vector<ScalingFit>& fits)
{
    if (fits.empty()) return "";
    std::string text = "cost of a step ~ constraints^e\n";
    for (const ScalingFit& fit : fits) {
        text += fmt::format("  {:<13}{:<5}{:>2} threads  e = {:.3f}", fit.variant, fit.precision, fit.threads, fit.exponent.estimate);
        if (std::isfinite(fit.exponent.low)) text += fmt::format("  [{:.3f}, {:.3f}] at 95 %", fit.exponent.low, fit.exponent.high);
        text += "\n";
    }
    return text;
}

}  // namespace

std::string bench_table(const BenchRecord& record)
{
    const analysis::Provenance provenance = analysis::collect_provenance(record.options.threads);
    std::string text =
        fmt::format("{}, {} cores, load {:.1f}; kernels: {}, {} / {} lanes; {}\n", provenance.cpu_model, provenance.logical_cpus,
                    record.load_after, pbs::kernel_instructions(), pbs::kernel_lanes(4), pbs::kernel_lanes(8), provenance.compiler);
    if (record.load_before > quiet_load)
        text += fmt::format("other work ran beside this (load {:.1f} before): wall times, and so threads, are worth little\n",
                            record.load_before);
    text += limits_text(record.limits);
    for (const MeshTimings& mesh : record.meshes) {
        text += fmt::format("\n{}: {} vertices, {} edges, {} tets; a step is {} iterations; memory of a solver {:.0f} MB\n", mesh.name,
                            mesh.vertices, mesh.edges, mesh.tets, iterations_a_step, 1e-6 * mesh.memory.growth_bytes());
        text += projections_text(mesh.projections) + skinning_text(mesh.skinning) + fem_text(mesh);
    }
    text +=
        "\nlim: share of min(peak, operations a byte x copy bandwidth at that working set). x floor: times what moving the bytes takes.\n"
        "x plain: times quicker than order `plain`, which is built for the same bits on every machine; x native: than the same loops with\n"
        "all this compiler offers; x spread: than those on constraints whose neighbours in the list share no vertex. Read ratios, not "
        "times.\n";
    return text + scaling_text(record.scaling);
}

}  // namespace experiments
