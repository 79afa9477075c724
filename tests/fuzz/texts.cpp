// Any text as one that the program itself reads, selected by its first byte: a BVH, a CSV record, or --set (one per
// line) on a scene. The result is valid or an InputError.
#include "analysis/records/tables.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/settings/scene_values.hpp"
#include "tests/fuzz/fuzzed_schema.hpp"
#include "tests/fuzz/target.hpp"

#include <sstream>
#include <vector>

namespace {

constexpr const char* scene =
    "schema = 1\n[character]\nbody = \"limb\"\n[motion]\njoint = \"forearm\"\naxis = [1.0, 0.0, 0.0]\n"
    "angle_deg = 90.0\nframes = 5\n[pbs]\nk_stretch = 0.2\nk_volume = 1.0\nk_bind = 1.0\n"
    "gravity_m_s2 = [0.0, 0.0, 0.0]\n[[fem]]\nname = \"p1\"\nmodel = \"linear\"\n"
    "[[fem]]\nname = \"p2\"\nmodel = \"neo_hookean\"\n[deformers]\nuse = [\"lbs\", \"p1\"]\n";

// A table that was read is written and read again, without a change.
void try_csv(const std::string& text)
{
    const std::string once = analysis::parse_csv(text, "record.csv").text();
    fuzz::expect(analysis::parse_csv(once, "record.csv").text() == once);
}

void try_settings(const std::string& text)
{
    std::vector<std::string> settings;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && settings.size() < 50;) settings.push_back(line);
    experiments::SceneValues(scene, "scene.toml", settings, fuzzed_schema()).resolved();
}

}  // namespace

void fuzz::try_input(const std::string& bytes)
{
    if (bytes.empty()) return;
    const std::string text = bytes.substr(1);
    if (bytes[0] == 'b' && pbs::is_bvh(text, "clip")) pbs::check_clip(pbs::read_bvh(text, "clip.bvh"));
    if (bytes[0] == 'c') try_csv(text);
    if (bytes[0] == 's') try_settings(text);
}
