#include "experiments/deformers/external/external_deformers.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/external/pbskin_deformer.h"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <type_traits>

namespace experiments {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

template <typename Number>
void write_numbers(const std::string& file, const Number* numbers, std::size_t count)
{
    pbs::write_atomically(file, std::string(reinterpret_cast<const char*>(numbers), count * sizeof(Number)));
}

std::vector<double> read_numbers(const fs::path& folder, const std::string& file, std::size_t count,
                                 const std::string& shape)
{
    if (!fs::is_regular_file(folder / file))
        throw pbs::InputError(file, 0, "", "", "missing: expected the program to write it");
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
        bones.push_back(
            {{"name", bone.name}, {"parent", bone.parent}, {"head_m", point(bone.head)}, {"tail_m", point(bone.tail)}});
    return {{"schema", 1},
            {"name", character.name},
            {"vertices", character.mesh.rest.rows()},
            {"tets", character.mesh.tets.rows()},
            {"poses", poses},
            {"time_step_s", time_step_s},
            {"bones", bones}};
}

// The weights as a dense array by rows, #V x #bones.
std::vector<double> dense_weights(const pbs::Weights& weights, std::size_t bones)
{
    std::vector<double> rows(static_cast<std::size_t>(weights.vertices()) * bones, 0.0);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e)
            rows[static_cast<std::size_t>(v) * bones + static_cast<std::size_t>(weights.bone[e])] += weights.weight[e];
    return rows;
}

bool same(const pbs::Pose& a, const pbs::Pose& b)
{
    return std::equal(
        a.begin(), a.end(), b.begin(), b.end(),
        [](const Eigen::Isometry3d& one, const Eigen::Isometry3d& other) { return one.matrix() == other.matrix(); });
}

// How a program failed, with the last line that it printed: of a Python program, that is the exception.
std::string end_of(const ProgramRun& program)
{
    if (!program.started) return "cannot be started: " + program.last_words;
    const std::string last_line = program.last_words.substr(program.last_words.find_last_of('\n') + 1);
    const std::string end =
        program.status < 0 ? "ended by a signal" : fmt::format("ended with status {}", program.status);
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

struct LibraryFunctions {
    decltype(pbskin_deformer_version)* version = nullptr;
    decltype(pbskin_deformer_create)* create = nullptr;
    decltype(pbskin_deformer_advance)* advance = nullptr;
    decltype(pbskin_deformer_destroy)* destroy = nullptr;
};

// Returns why the library cannot be used, or an empty text if it can.
std::string load(const std::string& library, LibraryFunctions& functions)
{
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) return std::string("cannot be loaded: ") + dlerror();
    std::string missing;
    const auto find = [&](const char* name, auto*& function) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
        if (!function && missing.empty()) missing = std::string("has no function ") + name;
    };
    find("pbskin_deformer_version", functions.version);
    if (functions.version && functions.version() != PBSKIN_DEFORMER_VERSION)
        return fmt::format("was compiled for version {} of pbskin_deformer.h: expected version {}", functions.version(),
                           PBSKIN_DEFORMER_VERSION);
    find("pbskin_deformer_create", functions.create);
    find("pbskin_deformer_advance", functions.advance);
    find("pbskin_deformer_destroy", functions.destroy);
    return missing;
}

// An InputError if the library cannot be loaded, lacks a function, was compiled for another version of
// pbskin_deformer.h, or reports a failure.
class LibraryDeformer : public TimedDeformer {
public:
    explicit LibraryDeformer(const ExternalOptions& options) : options_(options)
    {
        const std::string why_not = load(options.library, functions_);
        if (!why_not.empty()) refuse_external(options, why_not);
    }
    // the library itself stays loaded: its threads and statics may be in use
    ~LibraryDeformer() override { release(); }
    LibraryDeformer(const LibraryDeformer&) = delete;
    LibraryDeformer& operator=(const LibraryDeformer&) = delete;

    bool has_memory() const override { return options_.has_memory; }

private:
    void set_up(const pbs::Character& character) override
    {
        release();
        const std::size_t bones = character.skeleton.bones.size();
        const std::vector<double> weights = dense_weights(character.weights, bones);
        std::vector<double> ends;
        std::vector<int> parents;
        for (const pbs::Bone& bone : character.skeleton.bones) {
            ends.insert(ends.end(), bone.head.begin(), bone.head.end());
            ends.insert(ends.end(), bone.tail.begin(), bone.tail.end());
            parents.push_back(bone.parent);
        }
        const pbskin_character given = {static_cast<int>(character.mesh.rest.rows()),
                                        static_cast<int>(character.mesh.tets.rows()),
                                        static_cast<int>(bones),
                                        character.mesh.rest.data(),
                                        character.mesh.tets.data(),
                                        weights.data(),
                                        ends.data(),
                                        parents.data()};
        deformer_ = functions_.create(&given);
        if (!deformer_) refuse_external(options_, "pbskin_deformer_create returned null: expected a deformer");
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double dt_s, pbs::Positions& x) override
    {
        const std::vector<double> transforms = transform_rows(pose);
        const int status = functions_.advance(deformer_, transforms.data(), dt_s, x.data());
        if (status != 0)
            refuse_external(options_, fmt::format("pbskin_deformer_advance returned {}: expected 0", status));
        return {};
    }
    void release()
    {
        if (deformer_) functions_.destroy(deformer_);
        deformer_ = nullptr;
    }

    ExternalOptions options_;
    LibraryFunctions functions_;
    void* deformer_ = nullptr;
};

// Returns an empty text for a word that is not a file.
std::string hash_of(const std::string& word)
{
    std::error_code code;
    const bool is_file = fs::path(word).is_absolute() && fs::is_regular_file(word, code);
    return is_file ? pbs::content_hash(pbs::read_text_file(word, pbs::most_mesh_bytes)) : "";
}

void find_files(const SceneValues& values, const std::string& table, ExternalOptions& options, DeformerSpec& spec)
{
    const fs::path folder = fs::path(values.file()).parent_path();
    std::error_code code;
    for (std::string& word : options.command)  // files of the scene's folder by their absolute paths; other words stay
        if (!word.empty() && fs::is_regular_file(folder / word, code)) word = fs::absolute(folder / word).string();
    options.scene = values.file();
    options.name = spec.name;
    if (options.command.empty() == options.library.empty())
        values.refuse(table + ".command", "expected either a command or a library");
    if (!options.library.empty()) options.library = fs::absolute(folder / options.library).string();
    const std::vector<std::string> files = options.library.empty() ? options.command : std::vector{options.library};
    for (const std::string& file : files) options.file_hashes.push_back(hash_of(file));
}

// A file is recorded by its name without the folder, and by its hash.
nlohmann::json external_json(const DeformerSpec& spec)
{
    const auto& options = options_of<ExternalOptions>(spec);
    std::vector<std::string> words;
    for (std::size_t i = 0; i < options.command.size(); ++i) {
        const bool has_hash = i < options.file_hashes.size() && !options.file_hashes[i].empty();
        words.push_back(has_hash ? pbs::file_name(options.command[i]) : options.command[i]);
    }
    return {{"command", words},
            {"library", pbs::file_name(options.library)},
            {"has_memory", options.has_memory},
            {"file_hashes", options.file_hashes}};
}

}  // namespace

std::vector<double> transform_rows(const pbs::Pose& pose)
{
    std::vector<double> numbers;
    for (const Eigen::Isometry3d& bone : pose)
        for (const auto& row : bone.affine().rowwise()) numbers.insert(numbers.end(), row.begin(), row.end());
    return numbers;
}

void write_exchange(const std::string& folder, const pbs::Character& character, const std::vector<pbs::Pose>& poses,
                    double time_step_s)
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
    pbs::write_atomically(folder + "/character.json",
                          analysis::record_text(character_json(character, poses.size(), time_step_s)));
}

ExchangedPositions read_exchange(const std::string& folder, Eigen::Index vertices, std::size_t poses)
{
    const std::size_t per_pose = static_cast<std::size_t>(3 * vertices);
    const std::vector<double> numbers = read_numbers(folder, "positions.f64", poses * per_pose,
                                                     fmt::format("{} poses x {} vertices x 3", poses, vertices));
    ExchangedPositions read;
    for (std::size_t pose = 0; pose < poses; ++pose)
        read.positions.emplace_back(Eigen::Map<const pbs::Positions>(numbers.data() + pose * per_pose, vertices, 3));
    if (!fs::exists(folder + "/seconds.f64")) return read;
    read.seconds = read_numbers(folder, "seconds.f64", poses, fmt::format("{} poses x 1", poses));
    for (const double seconds : *read.seconds)
        if (!(seconds >= 0.0 && std::isfinite(seconds)))
            throw pbs::InputError("seconds.f64", 0, "time", fmt::format("{}", seconds),
                                  "expected a finite time of at least 0 s");
    return read;
}

std::unique_ptr<Deformer> make_program_deformer(const ExternalOptions& options)
{
    return std::make_unique<ProgramDeformer>(options);
}

std::string why_library_not_usable(const std::string& library)
{
    LibraryFunctions functions;
    return load(library, functions);
}

void refuse_external(const ExternalOptions& options, const std::string& rule)
{
    const bool is_library = !options.library.empty();
    throw pbs::InputError(options.scene, 0, options.name + (is_library ? ".library" : ".command"),
                          is_library ? options.library : fmt::format("{}", fmt::join(options.command, " ")), rule);
}

DeformerKind external_kind()
{
    using Options = ExternalOptions;
    DeformerKind kind = kind_of<void>(
        "external",
        "a deformer of the user's own: a program that reads poses and writes positions, or a shared library",
        OptionFields<Options>("external", true)
            .key("name", KeyType::text, "",
                 {.is_stated = true, .meaning = "the name of this deformer in deformers.use and in the records"})
            .add("command", &Options::command,
                 {.meaning = "the program and its arguments; files are relative to the scene; the folder of the "
                             "exchanged files is added as "
                             "the last argument"})
            .add("library", &Options::library,
                 {.meaning = "a shared library with the functions of pbskin_deformer.h, relative to the scene"})
            .add("has_memory", &Options::has_memory,
                 {.meaning = "it gets every time step in order, not only the frames"}),
        find_files);
    kind.needs_list = true;
    kind.make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
        const auto& options = options_of<Options>(spec);
        return options.library.empty() ? make_program_deformer(options) : std::make_unique<LibraryDeformer>(options);
    };
    kind.options_json = external_json;
    kind.traits = [](const DeformerSpec& spec) {
        return DeformerTraits{.has_own_clock = options_of<Options>(spec).library.empty()};
    };
    return kind;
}

}  // namespace experiments
