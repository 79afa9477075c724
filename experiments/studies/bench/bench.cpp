#include "experiments/studies/bench/bench.hpp"

#include "experiments/process/machine.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>

namespace experiments {
namespace {

constexpr int usual_bars[] = {2200, 19'500}, quick_bar = 300;  // vertices
constexpr int smallest_tets = 300, largest_tets = 20'000'000;

using BodyMaker = std::function<BenchBody()>;

std::vector<BodyMaker> bodies_of(const BenchOptions& options)
{
    if (!options.mesh.empty())
        return {[path = options.mesh] {
            return make_bench_body(std::filesystem::path(path).filename().string(), pbs::read_tet_mesh(path).mesh);
        }};
    if (options.quick && options.sizes.empty()) return {[] { return bench_bar(quick_bar); }};
    std::vector<BodyMaker> bodies;
    if (options.sizes.empty() || options.bars)
        for (const int vertices : usual_bars) bodies.push_back([vertices] { return bench_bar(vertices); });
    for (const int tets : options.sizes) bodies.push_back([tets] { return bench_bar_of_tets(tets); });
    return bodies;
}

MeshTimingOptions timing_options(const BenchOptions& options)
{
    MeshTimingOptions timing;
    if (options.threads > 1) timing.threads.push_back(options.threads);
    timing.rounds.seconds = options.seconds;
    if (options.quick) timing.rounds = {.seconds = 0.0, .fewest = 2, .most = 2};
    timing.fem = options.sizes.empty() || options.bars;
    return timing;
}

}  // namespace

std::vector<ScalingFit> fit_scaling(const std::vector<MeshTimings>& meshes)
{
    std::vector<ScalingFit> fits;
    if (meshes.size() < 2) return fits;
    for (const ProjectionKind& kind : meshes.front().projections) {
        std::vector<double> constraints, ms_step;
        for (const MeshTimings& mesh : meshes)
            for (const ProjectionTiming& timing : mesh.projections)
                if (kind == timing) constraints.push_back(mesh.constraints()), ms_step.push_back(timing.ms_step.median);
        if (constraints.size() == meshes.size()) fits.push_back({kind, analysis::observed_order(constraints, ms_step).slope});
    }
    return fits;
}

BenchRecord run_bench(const BenchOptions& options)
{
    BenchRecord record;
    record.options = options;
    const double sleep_s = options.quick ? 0.05 : 0.5;
    record.busy_before = busy_processors(sleep_s);
    spdlog::info("measuring the machine's limits");
    record.limits = options.quick ? measure_limits(1e-4, 1e6) : measure_limits(0.05);
    for (const BodyMaker& make : bodies_of(options)) {
        const BenchBody body = make();
        spdlog::info("{}: {} vertices, {} tets", body.character.name, body.mesh().rest.rows(), body.mesh().tets.rows());
        record.meshes.push_back(time_mesh(body, record.limits, timing_options(options)));
    }
    record.busy_after = busy_processors(sleep_s);
    if (!options.sizes.empty()) record.scaling = fit_scaling(record.meshes);
    return record;
}

int parse_size(const std::string& text)
{
    char* end = nullptr;
    double number = std::strtod(text.c_str(), &end);
    static const std::map<std::string, double> units = {{"", 1.0}, {"k", 1e3}, {"K", 1e3}, {"m", 1e6}, {"M", 1e6}};
    const auto unit = units.find(end);
    const bool known = unit != units.end();
    if (known) number *= unit->second;
    if (!known || end == text.c_str() || !(number >= smallest_tets && number <= largest_tets))
        throw pbs::InputError("", 0, "--sizes", text, "expected numbers of tets from 300 to 20M, e.g. 1K,10K,100K,1M");
    return static_cast<int>(number);
}

}  // namespace experiments
