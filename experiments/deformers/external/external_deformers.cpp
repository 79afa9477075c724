#include "experiments/deformers/external/external_deformers.hpp"

#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/external/pbskin_deformer.h"
#include "pbs/character/body_cache.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <type_traits>

namespace experiments {
namespace {

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

class LibraryDeformer : public TimedDeformer {
public:
    explicit LibraryDeformer(const ExternalOptions& options) : options_(options)
    {
        const std::string why_not = load(options.library, functions_);
        if (!why_not.empty()) refuse_external(options, why_not);
    }
    ~LibraryDeformer() override { release(); }  // the library itself stays loaded: its threads and statics may be in use
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
        if (status != 0) refuse_external(options_, fmt::format("pbskin_deformer_advance returned {}: expected 0", status));
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

}  // namespace

std::string why_library_not_usable(const std::string& library)
{
    LibraryFunctions functions;
    return load(library, functions);
}

std::unique_ptr<Deformer> make_library_deformer(const ExternalOptions& options)
{
    return std::make_unique<LibraryDeformer>(options);
}

namespace {

namespace fs = std::filesystem;

// Files of the scene's folder by their absolute paths; other words stay.
std::string word_of(const std::string& word, const fs::path& folder)
{
    std::error_code code;
    const fs::path file = folder / word;
    return !word.empty() && fs::is_regular_file(file, code) ? fs::absolute(file).string() : word;
}

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
    for (std::string& word : options.command) word = word_of(word, folder);
    options.scene = values.file();
    options.name = spec.name;
    if (options.command.empty() == options.library.empty()) values.refuse(table + ".command", "expected either a command or a library");
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
        "external", "a deformer of the user's own: a program that reads poses and writes positions, or a shared library",
        OptionFields<Options>("external", true)
            .key("name", KeyType::text, "", {.is_stated = true, .meaning = "the name of this deformer in deformers.use and in the records"})
            .add(
                "command", &Options::command,
                {.meaning = "the program and its arguments; files are relative to the scene; the folder of the exchanged files is added as "
                            "the last argument"})
            .add("library", &Options::library,
                 {.meaning = "a shared library with the functions of pbskin_deformer.h, relative to the scene"})
            .add("has_memory", &Options::has_memory, {.meaning = "it gets every time step in order, not only the frames"}),
        find_files);
    kind.needs_list = true;
    kind.make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
        const auto& options = options_of<Options>(spec);
        return options.library.empty() ? make_program_deformer(options) : make_library_deformer(options);
    };
    kind.options_json = external_json;
    kind.traits = [](const DeformerSpec& spec) { return DeformerTraits{.has_own_clock = options_of<Options>(spec).library.empty()}; };
    return kind;
}

}  // namespace experiments
