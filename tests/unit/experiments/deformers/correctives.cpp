// The fitted file of correctives and the deformer that reads it. Reference: pbs::corrected_skinning, and the rules of
// the file's header.
#include "experiments/deformers/correctives.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/extent.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace experiments;

const pbs::Character& learned_bar()
{
    static const pbs::Character character = test_support::bar_character({8, 2, 2});
    return character;
}

pbs::Pose bent_bar_pose(double angle_deg)
{
    return pbs::joint_sweep(learned_bar().skeleton, 1, pbs::Vec3(1, 2, 3), angle_deg, 2, 0.01).steps.back();
}

const pbs::Correctives& learned()
{
    static const pbs::Correctives correctives = [] {
        std::vector<pbs::CorrectiveSample> samples;
        for (const double angle_deg : {-80.0, -50.0, -20.0, 20.0, 50.0, 80.0}) {
            samples.push_back({bent_bar_pose(angle_deg), {}});
            pbs::dual_quaternion_skinning(learned_bar().mesh.rest, learned_bar().weights, samples.back().pose,
                                          samples.back().shape);
        }
        return pbs::fit_correctives(learned_bar().skeleton, learned_bar().mesh.rest, learned_bar().weights, samples);
    }();
    return correctives;
}

pbs::Positions expected_bar(double angle_deg)
{
    pbs::Positions posed;
    pbs::corrected_skinning(learned(), learned_bar().mesh.rest, learned_bar().weights, bent_bar_pose(angle_deg), posed);
    return posed;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

// The value of a key, to the end of its line.
std::string value_of(const std::string& text, const std::string& key)
{
    const std::size_t first = text.find("\n" + key + " = ") + key.size() + 4;
    return text.substr(first, text.find('\n', first) - first);
}

class CorrectivesFile : public test_support::FolderTest {
protected:
    const std::string text = text_of(learned(), learned_bar());

    static double unit_m() { return 5e-6 * pbs::diagonal_m(learned_bar().mesh.rest); }

    std::unique_ptr<Deformer> deformer(pbs::Precision precision) const
    {
        const std::string file = folder.file("fitted.toml", text);
        DeformerSpec spec = default_spec("correctives");
        options_of<CorrectivesOptions>(spec) = {
            .file = file, .file_hash = pbs::hash_of_file(file), .precision = precision};
        std::unique_ptr<Deformer> made = make_deformer(spec);
        made->reset(learned_bar());
        return made;
    }
};

// The modes are rounded to multiples of 5e-6 of the body's size; everything else is the same to the bit.
TEST_F(CorrectivesFile, ReadsWhatItHasWritten)
{
    const pbs::Correctives read = parse_correctives(text, "fitted.toml", learned_bar());
    EXPECT_EQ(text_of(read, learned_bar()), text);
    ASSERT_EQ(read.joints.size(), 1u);
    EXPECT_LE((read.joints[0].modes - learned().joints[0].modes).cwiseAbs().maxCoeff(), 0.5001 * unit_m());
    EXPECT_EQ(read.joints[0].drivers, learned().joints[0].drivers);
    EXPECT_EQ(read.joints[0].lowest, learned().joints[0].lowest);
    EXPECT_EQ(read.joints[0].highest, learned().joints[0].highest);
    EXPECT_EQ(read.joints[0].vertices, learned().joints[0].vertices);
    EXPECT_EQ(read.lowest, learned().lowest);
    EXPECT_EQ(read.highest, learned().highest);
    EXPECT_EQ(read.parents, learned().parents);
    EXPECT_EQ(read.vertices, learned().vertices);
}

// Float: a hundred roundings of a body of 2 m, as in the contract of all deformers. The correctives move it by
// centimetres. A coefficient is 1 at most, and a mode of a file is in error by half a unit in each coordinate.
TEST_F(CorrectivesFile, ItsDeformerMovesAsTheMethodDoes)
{
    pbs::Positions lbs;
    pbs::linear_blend_skinning(learned_bar().mesh.rest, learned_bar().weights, bent_bar_pose(60.0), lbs);
    EXPECT_GT((expected_bar(60.0) - lbs).cwiseAbs().maxCoeff(), 0.01);
    const double of_modes_m = 0.5 * std::sqrt(3.0) * unit_m() * static_cast<double>(learned().modes());
    for (const auto& [precision, tolerance_m] :
         {std::pair(pbs::Precision::f32, test_support::rounding_error_in<float>(100, 2.0)),
          std::pair(pbs::Precision::f64, test_support::rounding_error(100, 2.0))}) {
        const auto own = deformer(precision);
        EXPECT_EQ(own->positions(), learned_bar().mesh.rest);
        for (const double angle_deg : {60.0, 0.0, -30.0, 60.0}) {
            const pbs::StepSummary step = own->advance(bent_bar_pose(angle_deg), 0.01);
            EXPECT_EQ(step.outcome, pbs::Outcome::finished);
            EXPECT_EQ(step.work, pbs::WorkCounters{.vertex_visits = learned_bar().mesh.rest.rows()});
            EXPECT_LT((own->positions() - expected_bar(angle_deg)).cwiseAbs().maxCoeff(), tolerance_m + of_modes_m)
                << angle_deg;
        }
        const pbs::Positions once = own->positions();
        own->reset(learned_bar());
        own->advance(bent_bar_pose(60.0), 0.01);
        EXPECT_EQ(own->positions(), once);
    }
}

TEST_F(CorrectivesFile, IsRefusedOnAnotherCharacter)
{
    pbs::Character finer = test_support::bar_character({10, 2, 2}), rigid = learned_bar(), longer = learned_bar();
    rigid.weights = pbs::rigid_weights(rigid.binding);
    longer.skeleton.bones[1].tail.x() += 1e-9;
    for (const auto& [other, key] :
         {std::pair(finer, "tets_hash"), std::pair(rigid, "rig_hash"), std::pair(longer, "rig_hash")})
        expect_input_error([&] { parse_correctives(text, "fitted.toml", other); },
                           "fitted.toml:" + std::to_string(key[0] == 't' ? 4 : 5), std::string(key) + " = ");
    expect_input_error([&] { parse_correctives(text, "fitted.toml", finer); }, "fitted.toml:4",
                       "were fitted for bar; the tets of bar have");
}

TEST_F(CorrectivesFile, ErrorsNameTheLineTheFieldAndTheRule)
{
    const auto refused = [&](const std::string& changed, const std::string& line, const std::string& holds) {
        expect_input_error([&] { parse_correctives(changed, "fitted.toml", learned_bar()); }, "fitted.toml:" + line,
                           holds);
    };
    const auto line_of = [](const std::string& changed, const std::string& place) {
        return std::to_string(
            1 + std::count(changed.begin(), changed.begin() + static_cast<long>(changed.find(place)), '\n'));
    };
    const auto refused_at = [&](const std::string& from, const std::string& to, const std::string& holds) {
        const std::string changed = replaced(text, from, to);
        refused(changed, line_of(changed, to), holds);
    };
    refused(replaced(text, "schema = 1", "schema = 2"), "2", "schema = 2: expected 1");
    refused(replaced(text, "schema = 1", "schema = one"), "2", "could not determine value type");
    refused(replaced(text, "schema = 1\n", ""), "", "schema: missing");
    refused(replaced(text, "character = \"bar\"", "character = \"bar\"\ncharcter = 1"), "4",
            "unknown key; the nearest known one is character");
    refused(replaced(text, "\nlowest = [[0.0,", "\nlowest = [["), "8", "39 numbers: expected a list of 40 numbers");
    refused(replaced(text, "\nlowest = [[0.0,", "\nlowest = [[nan,"), "8", "expected a finite number");
    refused(replaced(text, "\nlowest = [[0.0,", "\nlowest = [[\"0\","), "8", "expected a finite number");
    refused(replaced(text, "\nlowest = [", "\nlowest = [[0.0],"), "8", "3 rows: expected 2");
    refused(replaced(text, "unit_m = ", "unit_m = -"), "7", "unit_m: expected a finite number above 0");
    refused_at("[[joint]]", "[joint]", "joint: expected a list");
    refused_at("bone = 1", "bone = 2", "bone = 2: expected an integer from 0 to 1");
    refused(replaced(text, "bone = 1\n", ""), line_of(text, "[[joint]]"), "bone: missing");
    refused_at("vertices = [", "vertices = [-1, ", "vertices = -1: expected an integer from 0 to");
    refused(replaced(text, "vertices = [", "vertices = [0, "), line_of(text, "modes = "), "modes");
    refused_at("drivers = [[", "drivers = [[0.0], [", "drivers = 1 numbers: expected a list of 40 numbers");
    refused(text.substr(0, text.size() / 2),
            std::to_string(std::count(text.begin(), text.begin() + static_cast<long>(text.size() / 2), '\n') + 1), "");
}

// Numbers that nothing else checks.
TEST_F(CorrectivesFile, IsRefusedWithChangedContents)
{
    const std::string hash = value_of(text, "content_hash");
    expect_input_error([&] { parse_correctives(text + "# more\n", "fitted.toml", learned_bar()); },
                       "fitted.toml:6: content_hash = ", "the file was changed");
    expect_input_error([&] { parse_correctives(replaced(text, hash, "\"0\""), "fitted.toml", learned_bar()); },
                       "fitted.toml:6: content_hash = 0", "the file was changed");
}

TEST_F(CorrectivesFile, AFileThatIsChangedAfterTheSceneIsRefused)
{
    const auto own = deformer(pbs::Precision::f32);
    folder.file("fitted.toml", text + "\n");
    expect_input_error([&] { own->reset(learned_bar()); }, folder / "fitted.toml", "was changed while it was read");
}

TEST_F(CorrectivesFile, ASceneNamesItRelativeToItself)
{
    folder.file("fitted.toml", text);
    const std::string table = "[[correctives]]\nname = \"baked\"\nfile = \"fitted.toml\"\nprecision = \"f64\"\n";
    const std::string scene =
        "schema = 1\n[character]\nbody = \"limb\"\n[motion]\njoint = \"forearm\"\nangle_deg = 10\nframes = 2\n"
        "[deformers]\nuse = [\"lbs\", \"baked\"]\n";
    const Scene read = read_scene(folder.file("scene.toml", scene + table), {});
    const auto& options = options_of<CorrectivesOptions>(read.deformers.at(1));
    EXPECT_EQ(options.file, folder / "fitted.toml");
    EXPECT_EQ(options.precision, pbs::Precision::f64);
    const nlohmann::json recorded = to_json(read.deformers.at(1)).at("options");
    EXPECT_EQ(recorded,
              (nlohmann::json{{"file", "fitted.toml"}, {"file_hash", pbs::content_hash(text)}, {"precision", "f64"}}));
    expect_input_error([&] { read_scene(folder.file("other.toml", scene + replaced(table, "fitted", "no_such")), {}); },
                       folder / "other.toml:12", "correctives.0.file = no_such.toml: no such file");
    expect_input_error(
        [&] { read_scene(folder.file("bare.toml", scene + replaced(table, "file = \"fitted.toml\"\n", "")), {}); },
        folder / "bare.toml", "correctives.0.file");
}

}  // namespace
