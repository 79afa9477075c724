// pbskin measure REST FRAME... and pbskin measure MODEL: applies the metrics to frames of any program, tets or
// surfaces, and to the artist's own skinning of a rigged model along its animation.
//   pbskin measure rest.msh 'out/frame_%04d.vtu' --max-volume-change 0.5 --max-inverted 0 --junit volume.xml
//   pbskin measure kit/bodies/limb.vtu mine.vtu --reference kit/limb_twist_60/smooth.vtu
//   pbskin measure rest.msh solved.vtu --displacement u
//   pbskin measure rest.obj 'cache/hero_*.obj' --max-volume-change 3
//   pbskin measure hero.glb --animation Walk --max-volume-change 3

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/measure/measured_frames.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>

namespace experiments {
namespace {

void refuse_where(bool is_given, const std::string& option, const std::string& rule)
{
    if (is_given) throw pbs::InputError("", 0, option, "", rule);
}

// Options that have no effect on what is measured are refused.
void require_effect(const MeasureArguments& arguments, bool is_rig, analysis::Measured measured)
{
    for (const analysis::FrameBound& bound : arguments.bounds) require_meaningful(bound, measured);
    refuse_where(!is_rig && !arguments.animation.empty(), "--animation",
                 "expected a rigged model alone, without frames");
    refuse_where(is_rig && !arguments.displacement.empty(), "--displacement",
                 "expected frames in files: a rigged model has none");
    refuse_where(is_rig && arguments.any_step, "--any-step", "expected frames in files: a rigged model has none");
    refuse_where(!is_rig && arguments.most_frames, "--frames", "expected a rigged model alone, without frames");
    refuse_where(measured == analysis::Measured::surface && !arguments.reference.empty(), "--reference",
                 "expected tets: a surface has no errors");
    refuse_where(measured == analysis::Measured::tets && !arguments.shells.empty(), "--shells",
                 "expected a surface: tets have no shells");
    refuse_where(measured == analysis::Measured::tets && arguments.closed_only, "--closed-only",
                 "expected a surface: tets have no shells");
}

int measure(MeasureArguments& arguments, bool quiet)
{
    arguments.quiet = quiet;
    const bool is_rig = arguments.frames.empty(), is_surface = is_rig || pbs::is_surface_file(arguments.rest);
    if (is_rig && !pbs::is_rig_file(arguments.rest))
        throw pbs::InputError(arguments.rest, 0, "frames", "",
                              "expected deformed frames behind the rest mesh; only a rigged model (.glb .gltf .fbx "
                              ".dae .zae) brings its own motion");
    require_effect(arguments, is_rig, is_surface ? analysis::Measured::surface : analysis::Measured::tets);
    for (const std::string& file : {arguments.csv, arguments.shells})
        if (!file.empty()) analysis::require_writable(file);
    require_writable(arguments.reports);
    return is_rig ? measure_rig(arguments) : is_surface ? measure_surfaces(arguments) : measure_tets(arguments);
}

}  // namespace

void add_measure_verb(CommandLine& line)
{
    auto arguments = std::make_shared<MeasureArguments>();
    CLI::App* verb =
        line.add("measure", "applies the metrics to frames of any program; exit 1 if a bound fails",
                 "pbskin measure rest.vtu 'frame_%04d.vtu' --max-volume-change 0.5; pbskin measure hero.glb",
                 [&common = line.common, arguments] { return measure(*arguments, common.quiet); });
    verb->add_option("rest", arguments->rest,
                     "rest mesh: tets (.msh .vtu .pvtu .vtk .mesh .tobj .ele) or a surface (.obj .ply .stl .off .vtp "
                     ".glb .gltf .fbx .dae .zae); "
                     "without frames: a rigged model, along its animation")
        ->required();
    verb->add_option("frame", arguments->frames,
                     "deformed frames, the same vertices in the same order: files, a .pvd, 'frame_%04d.vtu', "
                     "'frame_*.vtu' or a folder with one "
                     "sequence");
    verb->add_option("--displacement", arguments->displacement,
                     "vector of the points, such as u (also of ux, uy, uz or u:0, u:1, u:2), that deforms the frames; "
                     "none: they are at "
                     "rest")
        ->type_name("NAME");
    verb->add_flag("--any-step", arguments->any_step,
                   "accepts a sequence in which numbers are missing, or whose steps differ");
    verb->add_option("--animation", arguments->animation, "of a rigged model; by default the one that `try` takes")
        ->type_name("NAME");
    verb->add_option("--frames", arguments->most_frames, "largest number of frames of an animation; by default 60")
        ->check(CLI::Range(2, 100'000))
        ->type_name("N");
    verb->add_option("--reference", arguments->reference,
                     "print errors against this deformed frame, or against one for each frame ('ref_%04d.vtu'); "
                     "`pbskin references` "
                     "writes some")
        ->type_name("FILE");
    verb->add_option("--csv", arguments->csv, "write the values as CSV, a row per frame")->type_name("FILE");
    verb->add_option("--shells", arguments->shells, "the same for each closed shell of a surface")->type_name("FILE");
    verb->add_flag("--closed-only", arguments->closed_only,
                   "of a surface: excludes open shells, whose holes are capped otherwise");
    for (analysis::FrameBound& bound : arguments->bounds)
        verb->add_option(bound.option, bound.value, bound.meaning)->type_name(bound.unit.empty() ? "N" : "PCT");
    verb->add_option("--junit", arguments->reports.junit, "write a JUnit report with one test case per bound")
        ->type_name("FILE");
    verb->add_flag("--github", arguments->reports.github,
                   "GitHub annotations on stdout (default where GITHUB_ACTIONS is true)");
}

}  // namespace experiments
