// The bench as a whole: the machine's bandwidth, every body in turn, and the growth of the cost; its record and its
// table for reading.
#include "analysis/records/provenance.hpp"
#include "analysis/statistics/fits.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/batched/pbs_kernels.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

namespace experiments {
namespace {

using nlohmann::json;

constexpr int turns = 3;
constexpr double smallest_bytes = 16 * 1024.0;
constexpr int usual_bars[] = {2200, 19'500}, quick_bar = 300;  // vertices
constexpr int smallest_tets = 300, largest_tets = 20'000'000;
constexpr double quiet_processors = 0.5;  // of other work

// The largest amount of work per second over the turns. work(repeats) does the work and returns its amount; the number
// of repeats is chosen so that they take about `seconds`.
template <typename Work>
double best_rate(double seconds, const Work& work)
{
    double best = 0.0;
    std::size_t repeats = 1;
    for (int turn = 0; turn < turns;) {
        const double start = thread_cpu_s();
        const double done = work(repeats);
        const double took = thread_cpu_s() - start;
        if (took < 0.7 * seconds && turn == 0) {
            repeats = std::max(repeats + 1, static_cast<std::size_t>(double(repeats) *
                                                                     std::min(10.0, seconds / std::max(took, 1e-7))));
            continue;
        }
        best = std::max(best, done / std::max(took, 1e-9));
        ++turn;
    }
    return best;
}

// Bytes that a core reads and writes: from one half of the working set to the other, or in place, whichever is faster.
double gb_s(std::vector<float>& numbers, double seconds)
{
    volatile float one = 1.0f;  // unknown to the compiler
    const std::size_t half = numbers.size() / 2;
    const auto rate = [&](std::size_t count, const auto& once) {
        return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
                   for (std::size_t repeat = 0; repeat < repeats; ++repeat) once();
                   return 2.0 * double(repeats) * double(count) * sizeof(float);
               });
    };
    const double copied = rate(half, [&] {
        std::memcpy(&numbers[0], &numbers[half], half * sizeof(float));
        asm volatile("" ::: "memory");  // so that no repetition is left out
    });
    const double updated = rate(numbers.size(), [&] {
        const float factor = one;
        for (float& number : numbers) number *= factor;
    });
    return std::max(copied, updated);
}

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

json time_mesh(const BenchBody& body, const std::vector<MemoryBandwidth>& memory, const BenchOptions& options)
{
    const PeakMemory peak = peak_memory_of([&] {
        pbs::PbsSolver solver(body.mesh(), body.character.binding.distance, {}, {}, body.held);
        solver.advance(body.twisted, body.bind_points, 0.01);
    });
    json timed = {{"mesh",
                   {{"name", body.character.name},
                    {"vertices", body.mesh().rest.rows()},
                    {"edges", body.edges},
                    {"tets", body.mesh().tets.rows()}}},
                  {"memory", {{"peak_bytes", peak.peak_bytes}, {"growth_bytes", peak.growth_bytes()}}},
                  {"results", json::array()},
                  {"yardsticks", json::array()},
                  {"deformers", json::array()}};
    Rounds rounds = options.quick ? Rounds{.seconds = 0.0, .fewest = 2, .most = 2} : Rounds{.seconds = options.seconds};
    std::vector<int> threads = {1};
    if (options.threads > 1) threads.push_back(options.threads);
    for (const json& entry : time_projections(body, threads, memory, rounds)) {
        const std::string variant = entry.at("variant");
        const bool is_baseline = variant == "plain_native" || variant == "plain_spread";  // which no scene can ask for
        timed[is_baseline ? "yardsticks" : "results"].push_back(entry);
    }
    rounds.seconds /= 16.0;  // for each kind of deformer
    if (options.sizes.empty() || options.bars) timed["deformers"] = time_deformers(body, rounds);
    return timed;
}

json number_or_null(const std::optional<double>& value)
{
    return value && std::isfinite(*value) ? json(*value) : json();
}

json context_of(const BenchOptions& options)
{
    const analysis::Provenance provenance = analysis::collect_provenance(options.threads);
    return {{"cpu", provenance.cpu_model},
            {"cores", provenance.logical_cpus},
            {"kernel_instructions", pbs::kernel_instructions()},
            {"kernel_lanes", {{"f32", pbs::kernel_lanes(4)}, {"f64", pbs::kernel_lanes(8)}}},
            {"threads", options.threads},
            {"compiler", provenance.compiler},
            {"flags", provenance.flags},
            {"kernel_flags", PBS_KERNEL_FLAGS},
            {"iterations", paper_iterations},
            {"quick", options.quick},
            {"headline_ratio", "ratio_to_plain_spread"},
            {"provenance", provenance}};
}

// One line per entry of bench.json. Each column is a place inside the entry, with a format for a number. Numbers are
// aligned to the right.
std::string table(const json& entries, const std::string& places)
{
    if (entries.empty()) return "";
    std::vector<std::string> lines(entries.size() + 1);
    std::istringstream words(places);
    for (std::string place; words >> place;) {
        const std::size_t end = std::min(place.find(':'), place.size());
        const std::string name = place.substr(0, end), format = fmt::format("{{{}}}", place.substr(end));
        std::vector<std::string> cells = {name};
        for (const json& entry : entries) {
            const json value = entry.value(json::json_pointer("/" + name), json());
            cells.push_back(value.is_number()   ? fmt::format(fmt::runtime(format), value.get<double>())
                            : value.is_string() ? value.get<std::string>()
                                                : "");
        }
        const std::size_t width = std::ranges::max_element(cells, {}, &std::string::size)->size();
        for (std::size_t row = 0; row < cells.size(); ++row) {
            const std::string gap = lines[row].empty() ? "" : "  ";
            lines[row] += gap + (end < place.size() ? fmt::format("{:>{}}", cells[row], width)
                                                    : fmt::format("{:<{}}", cells[row], width));
        }
    }
    for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
    return fmt::format("\n{}\n", fmt::join(lines, "\n"));
}

std::string mesh_text(const json& timed)
{
    json projections = timed.at("results");
    for (const json& baseline : timed.at("yardsticks")) projections.push_back(baseline);
    return table(json::array({timed}),
                 "mesh/name mesh/vertices:.0f mesh/edges:.0f mesh/tets:.0f memory/growth_bytes:.3g") +
           table(projections,
                 "variant precision threads:.0f poses:.0f ns_stretch:.3f ns_volume:.3f ns_bind:.3f ms_step:.4g "
                 "quartiles/ms_step/0:.4g "
                 "quartiles/ms_step/1:.4g ratio_to_plain_spread:.2f residual_to_plain_spread:.3f "
                 "volume_rms_to_plain_spread:.3f "
                 "ratio_to_plain:.2f residual_to_plain:.3f volume_rms_to_plain:.3f ratio_to_plain_native:.2f "
                 "ms_floor:.2g "
                 "best_speedup_by_threads:.2f") +
           table(timed.at("deformers"),
                 "deformer model order precision iterations:.0f ms_first:.4g ms_frame:.4g ms_iteration:.4g ns_tet:.2f "
                 "ns_vertex:.2f "
                 "ratio_to_plain:.2f left_out");
}

}  // namespace

std::vector<MemoryBandwidth> measure_bandwidth(double seconds, double largest_bytes)
{
    std::vector<MemoryBandwidth> memory;
    for (double bytes = smallest_bytes; bytes < 1.5 * largest_bytes; bytes *= 2.0) {
        std::vector<float> numbers(static_cast<std::size_t>(bytes / sizeof(float)), 1.0f);
        memory.push_back({bytes, gb_s(numbers, seconds)});
    }
    return memory;
}

double bandwidth_at(const std::vector<MemoryBandwidth>& memory, double bytes)
{
    if (memory.empty()) return 0.0;
    const auto above = std::ranges::find_if(memory, [&](const MemoryBandwidth& point) { return point.bytes >= bytes; });
    if (above == memory.begin()) return memory.front().gb_s;
    if (above == memory.end()) return memory.back().gb_s;
    const MemoryBandwidth &low = *(above - 1), &high = *above;
    return std::lerp(low.gb_s, high.gb_s, std::log(bytes / low.bytes) / std::log(high.bytes / low.bytes));
}

RECORD_SETTINGS(BenchOptions, mesh, bars, sizes, threads, quick, seconds)

json fit_scaling(const json& meshes)
{
    json fits = json::array();
    if (meshes.size() < 2) return fits;
    for (const json& first : meshes.front().at("results")) {
        json fit;
        for (const char* key : {"variant", "precision", "threads"}) fit[key] = first.at(key);
        std::vector<double> constraints, ms_step;
        for (const json& timed : meshes)
            for (const json& entry : timed.at("results")) {
                const auto is_same = [&](const auto& field) { return entry.at(field.key()) == field.value(); };
                const auto fields = fit.items();
                if (!std::all_of(fields.begin(), fields.end(), is_same)) continue;
                const json& mesh = timed.at("mesh");
                constraints.push_back(mesh.at("vertices").get<double>() + mesh.at("edges").get<double>() +
                                      mesh.at("tets").get<double>());
                ms_step.push_back(entry.at("ms_step"));
            }
        if (constraints.size() != meshes.size()) continue;
        const analysis::Interval exponent = analysis::observed_order(constraints, ms_step);
        fit.update({{"exponent", exponent.estimate},
                    {"interval", {number_or_null(exponent.low), number_or_null(exponent.high)}},
                    {"level", exponent.level},
                    {"sizes", exponent.n}});
        fits.push_back(fit);
    }
    return fits;
}

json run_bench(const BenchOptions& options)
{
    const double sleep_s = options.quick ? 0.05 : 0.5;
    json context = context_of(options);
    const std::optional<double> busy_before = busy_processors(sleep_s);  // nothing if the system does not report it
    spdlog::info("measuring the machine's bandwidth");
    const std::vector<MemoryBandwidth> memory = options.quick ? measure_bandwidth(1e-4, 1e6) : measure_bandwidth(0.05);
    for (const MemoryBandwidth& point : memory)
        context["limits_of_one_core"]["memory"].push_back({{"bytes", point.bytes}, {"gb_s", point.gb_s}});
    json meshes = json::array();
    for (const BodyMaker& make : bodies_of(options)) {
        const BenchBody body = make();
        spdlog::info("{}: {} vertices, {} tets", body.character.name, body.mesh().rest.rows(), body.mesh().tets.rows());
        meshes.push_back(time_mesh(body, memory, options));
    }
    context["busy_processors"] = {number_or_null(busy_before), number_or_null(busy_processors(sleep_s))};
    json record = meshes.front();
    record.update({{"schema", 2}, {"context", context}, {"meshes", meshes}});
    if (!options.sizes.empty()) record["scaling"] = fit_scaling(meshes);
    return record;
}

std::string bench_table(const json& record)
{
    const json& context = record.at("context");
    std::string text = table(json::array({context}),
                             "cpu cores:.0f busy_processors/0:.2f busy_processors/1:.2f kernel_instructions compiler");
    const auto is_busy = [](const json& processors) { return processors.is_number() && processors > quiet_processors; };
    if (std::ranges::any_of(context.at("busy_processors"), is_busy))
        text += "Other work ran before or after: wall times, and so threads, are worth little.\n";
    text += "\nOne core, bytes read and written:\n" +
            table(context.at("limits_of_one_core").at("memory"), "bytes:.0f gb_s:.0f");
    for (const json& mesh : record.at("meshes")) text += mesh_text(mesh);
    return text +
           table(record.value("scaling", json::array()),
                 "variant precision threads:.0f exponent:.3f interval/0:.3f interval/1:.3f") +
           "\nRead ratios, not times; `pbskin explain timing` explains the columns.\n";
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
