#include "analysis/records/record_files.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

template <typename Number>
void write_numbers(const std::string& file, const Number* numbers, std::size_t count)
{
    pbs::write_atomically(file, std::string(reinterpret_cast<const char*>(numbers), count * sizeof(Number)));
}

std::vector<double> read_numbers(const fs::path& folder, const std::string& file, std::size_t count, const std::string& shape)
{
    if (!fs::is_regular_file(folder / file)) throw pbs::InputError(file, 0, "", "", "missing: expected the program to write it");
    if (const auto bytes = fs::file_size(folder / file); bytes != count * sizeof(double))
        throw pbs::InputError(file, 0, "bytes", std::to_string(bytes),
                              fmt::format("expected {}: {} numbers of 8 bytes", count * sizeof(double), shape));
    const std::string bytes = pbs::read_text_file(folder / file, pbs::most_mesh_bytes);
    std::vector<double> numbers(count);
    if (count > 0) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

nlohmann::json character_json(const pbs::Character& character, std::size_t poses, double time_step_s)
{
    nlohmann::json bones = nlohmann::json::array();
    const auto point = [](const pbs::Vec3& p) { return nlohmann::json{p.x(), p.y(), p.z()}; };
    for (const pbs::Bone& bone : character.skeleton.bones)
        bones.push_back({{"name", bone.name}, {"parent", bone.parent}, {"head_m", point(bone.head)}, {"tail_m", point(bone.tail)}});
    return {{"schema", 1},
            {"name", character.name},
            {"vertices", character.mesh.rest.rows()},
            {"tets", character.mesh.tets.rows()},
            {"poses", poses},
            {"time_step_s", time_step_s},
            {"bones", bones}};
}

}  // namespace

std::vector<double> dense_weights(const pbs::Weights& weights, std::size_t bones)
{
    std::vector<double> rows(static_cast<std::size_t>(weights.vertices()) * bones, 0.0);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e)
            rows[static_cast<std::size_t>(v) * bones + static_cast<std::size_t>(weights.bone[e])] += weights.weight[e];
    return rows;
}

std::vector<double> transform_rows(const pbs::Pose& pose)
{
    std::vector<double> numbers;
    for (const Eigen::Isometry3d& bone : pose)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) numbers.push_back(bone.matrix()(row, column));
    return numbers;
}

void write_exchange(const std::string& folder, const pbs::Character& character, const std::vector<pbs::Pose>& poses, double time_step_s)
{
    const pbs::TetMesh& mesh = character.mesh;
    write_numbers(folder + "/rest.f64", mesh.rest.data(), static_cast<std::size_t>(mesh.rest.size()));
    write_numbers(folder + "/tets.i32", mesh.tets.data(), static_cast<std::size_t>(mesh.tets.size()));
    const std::vector<double> weights = dense_weights(character.weights, character.skeleton.bones.size());
    std::vector<double> transforms;
    for (const pbs::Pose& pose : poses) {
        const std::vector<double> rows = transform_rows(pose);
        transforms.insert(transforms.end(), rows.begin(), rows.end());
    }
    write_numbers(folder + "/weights.f64", weights.data(), weights.size());
    write_numbers(folder + "/poses.f64", transforms.data(), transforms.size());
    pbs::write_atomically(folder + "/character.json", analysis::record_text(character_json(character, poses.size(), time_step_s)));
}

ExchangedPositions read_exchange(const std::string& folder, Eigen::Index vertices, std::size_t poses)
{
    const std::size_t per_pose = static_cast<std::size_t>(3 * vertices);
    const std::vector<double> numbers =
        read_numbers(folder, "positions.f64", poses * per_pose, fmt::format("{} poses x {} vertices x 3", poses, vertices));
    ExchangedPositions read;
    for (std::size_t pose = 0; pose < poses; ++pose)
        read.positions.emplace_back(Eigen::Map<const pbs::Positions>(numbers.data() + pose * per_pose, vertices, 3));
    if (!fs::exists(folder + "/seconds.f64")) return read;
    read.seconds = read_numbers(folder, "seconds.f64", poses, fmt::format("{} poses x 1", poses));
    for (const double seconds : *read.seconds)
        if (!(seconds >= 0.0 && std::isfinite(seconds)))
            throw pbs::InputError("seconds.f64", 0, "time", fmt::format("{}", seconds), "expected a finite time of at least 0 s");
    return read;
}

namespace {

bool same(const pbs::Pose& a, const pbs::Pose& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Eigen::Isometry3d& one, const Eigen::Isometry3d& other) { return one.matrix() == other.matrix(); });
}

// How a program failed, with the last line that it printed: of a Python program, that is the exception.
std::string end_of(const ProgramRun& program)
{
    if (!program.started) return "cannot be started: " + program.last_words;
    const std::string last_line = program.last_words.substr(program.last_words.find_last_of('\n') + 1);
    const std::string end = program.status < 0 ? "ended by a signal" : fmt::format("ended with status {}", program.status);
    return end + ": expected status 0" + (last_line.empty() ? "" : "; its last line: " + last_line);
}

class ProgramDeformer : public TimedDeformer {
public:
    explicit ProgramDeformer(const ExternalOptions& options) : options_(options) {}

    void foresee(const std::vector<pbs::Pose>& poses) override
    {
        foreseen_ = poses;
        done_ = {};
        next_ = 0;
    }

    bool has_memory() const override { return options_.has_memory; }

    nlohmann::json record() const override { return {{"own_times", done_.seconds.has_value()}}; }

private:
    bool has_own_clock() const override { return true; }
    void set_up(const pbs::Character& character) override
    {
        character_ = &character;
        foresee({});
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double dt_s, pbs::Positions& x) override
    {
        const bool is_next = next_ < foreseen_.size() && same(foreseen_[next_], pose);
        if (!is_next) foresee({pose});
        if (next_ == 0) run(dt_s);
        pbs::StepSummary summary;
        x = done_.positions[next_];
        summary.seconds = done_.seconds ? (*done_.seconds)[next_] : wall_s_ / static_cast<double>(foreseen_.size());
        ++next_;
        return summary;
    }
    void run(double dt_s)
    {
        const analysis::ScratchFolder folder;
        write_exchange(folder.path().string(), *character_, foreseen_, dt_s);
        std::vector<std::string> words = options_.command;
        words.push_back(folder.path().string());
        const pbs::Stopwatch stopwatch;
        const ProgramRun program = run_program(words, folder.path().string());
        wall_s_ = stopwatch.seconds();
        stop_if_interrupted();
        if (!program.succeeded()) refuse_external(options_, end_of(program));
        try {
            done_ = read_exchange(folder.path().string(), character_->mesh.rest.rows(), foreseen_.size());
        } catch (const pbs::InputError& error) {
            refuse_external(options_, error.what());
        }
    }

    ExternalOptions options_;
    const pbs::Character* character_ = nullptr;
    std::vector<pbs::Pose> foreseen_;
    ExchangedPositions done_;  // of the foreseen poses
    std::size_t next_ = 0;     // of them
    double wall_s_ = 0.0;      // of the program for all of them
};

}  // namespace

std::unique_ptr<Deformer> make_program_deformer(const ExternalOptions& options)
{
    return std::make_unique<ProgramDeformer>(options);
}

}  // namespace experiments
