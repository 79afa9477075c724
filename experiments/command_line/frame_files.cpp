#include "experiments/command_line/verbs.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <string_view>
#include <tuple>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_number = 24;  // digits; what is longer is taken for text

bool is_digit(unsigned char c)
{
    return std::isdigit(c) != 0;
}

std::string name_of(const std::string& path)
{
    return fs::path(path).filename().string();
}

// Files that differ in one number: each is `before`, its number, `after`.
struct Sequence {
    std::string before, after;
    bool is_whole = true;                      // no number has a fraction
    std::size_t width = longest_number;        // of its shortest number
    std::map<double, std::string> files = {};  // by number

    void add(const std::string& number, const std::string& path)
    {
        width = std::min(width, number.size());
        is_whole = is_whole && number.find('.') == std::string::npos;
        const auto [earlier, is_new] = files.emplace(std::stod(number), path);
        if (!is_new) throw pbs::InputError(path, 0, "frame", number, "the same number as " + earlier->second);
    }
};

struct FoundFrames {
    std::vector<std::string> without_number;
    std::vector<Sequence> sequences;
};

// How the numbers of names are read. whole: f_7_v2; decimal: t_0.5; after_letter: t-1 and t0, where a minus behind a
// letter is a sign too.
enum class NumberForm { whole, decimal, after_letter };

// The end of the number that begins at a digit.
std::string::const_iterator number_end(std::string::const_iterator digit, std::string::const_iterator end,
                                       NumberForm form)
{
    const auto whole = std::find_if_not(digit, end, is_digit);
    const bool has_fraction =
        form != NumberForm::whole && end - whole > 1 && *whole == '.' && is_digit(*std::next(whole));
    const auto mantissa = has_fraction ? std::find_if_not(std::next(whole), end, is_digit) : whole;
    if (form == NumberForm::whole || end - mantissa < 3 || (*mantissa != 'e' && *mantissa != 'E')) return mantissa;
    // 1e-05, as %g writes it
    const auto sign = std::next(mantissa), digits = *sign == '-' || *sign == '+' ? std::next(sign) : end;
    return digits != end && is_digit(*digits) ? std::find_if_not(digits, end, is_digit) : mantissa;
}

// Whether a text ends in the sign of the number behind it: a minus behind a letter or a digit is a hyphen.
bool ends_in_sign(const std::string& text, NumberForm form)
{
    if (!text.ends_with('-')) return false;
    const unsigned char before = text.size() > 1 ? text[text.size() - 2] : '_';
    return form == NumberForm::after_letter ? !is_digit(before) : !std::isalnum(before);
}

// A name cut at its numbers: text, number, text, ..., text.
std::vector<std::string> cut_at_numbers(const std::string& name, NumberForm form)
{
    std::vector<std::string> pieces = {""};
    for (auto at = name.begin(); at != name.end();) {
        const auto digit = std::find_if(at, name.end(), is_digit);
        const auto end = number_end(digit, name.end(), form);
        pieces.back().append(at, digit);
        std::string number(digit, end);
        if (number.size() > longest_number) {
            pieces.back() += number;
        } else if (!number.empty()) {
            if (ends_in_sign(pieces.back(), form)) {
                pieces.back().pop_back();
                number.insert(0, 1, '-');
            }
            pieces.insert(pieces.end(), {number, ""});
        }
        at = end;
    }
    return pieces;
}

// The sequence of files of one form, as frame_0007_v2.vtu and frame_0008_v2.vtu. The number that differs counts; in a
// single name, the last.
Sequence sequence_of(const std::string& argument, const std::vector<std::string>& paths, NumberForm form)
{
    std::vector<std::vector<std::string>> names;
    for (const std::string& path : paths) names.push_back(cut_at_numbers(name_of(path), form));
    const std::vector<std::string>& first = names.front();
    std::set<std::size_t> differing;
    for (const auto& name : names)
        for (std::size_t i = 1; i < name.size(); i += 2)
            if (name[i] != first[i]) differing.insert(i);
    if (differing.size() > 1)
        throw pbs::InputError(
            argument, 0, "", "",
            fmt::format(
                "expected frames that differ in one number, found {} and {}; name one sequence, as in 'NAME_%04d.vtu'",
                paths.front(), paths.back()));
    const std::size_t at = differing.empty() ? first.size() - 2 : *differing.begin();
    const std::string before = std::accumulate(first.begin(), first.begin() + at, std::string());
    Sequence sequence{(fs::path(paths.front()).parent_path() / before).string(),
                      std::accumulate(first.begin() + at + 1, first.end(), std::string())};
    for (std::size_t i = 0; i < paths.size(); ++i) sequence.add(names[i][at], paths[i]);
    return sequence;
}

FoundFrames sequences_by(const std::string& argument, const std::vector<std::string>& paths, NumberForm form)
{
    std::map<std::vector<std::string>, std::vector<std::string>> forms;  // folder and texts of a name -> paths
    for (const std::string& path : paths) {
        const std::vector<std::string> pieces = cut_at_numbers(name_of(path), form);
        std::vector<std::string> texts = {fs::path(path).parent_path().string()};
        for (std::size_t i = 0; i < pieces.size(); i += 2) texts.push_back(pieces[i]);
        forms[texts].push_back(path);
    }
    FoundFrames found;
    for (const auto& [texts, alike] : forms)
        if (texts.size() == 2)  // the folder and one text
            found.without_number.insert(found.without_number.end(), alike.begin(), alike.end());
        else
            found.sequences.push_back(sequence_of(argument, alike, form));
    return found;
}

// The step of a sequence, and the number after which a frame is missing; nothing: none is. Two files alone show no
// step: between frames 1 and 3, frame 2 is missing. The last step may be shorter, where a simulation ended between two
// frames.
struct Steps {
    double step = 1.0;
    std::optional<double> gap_after = {};
    bool ends_early = false;
};

Steps steps_of(const Sequence& sequence)
{
    std::vector<double> numbers, steps;
    for (const auto& [number, path] : sequence.files) numbers.push_back(number);
    for (std::size_t i = 1; i < numbers.size(); ++i) steps.push_back(numbers[i] - numbers[i - 1]);
    constexpr double rounding = 1e-6;  // of decimals
    const auto is_step = [](double step, double wanted) { return std::abs(step - wanted) <= rounding * wanted; };
    Steps result;
    if (steps.empty() || (steps.size() == 1 && !sequence.is_whole)) return result;
    const auto all_but_last = std::span(steps).first(steps.size() - 1);
    result.ends_early = all_but_last.size() > 1 && steps.back() < (1.0 - rounding) * steps.front() &&
                        std::ranges::all_of(all_but_last, [&](double step) { return is_step(step, steps.front()); });
    if (steps.size() > 1) result.step = result.ends_early ? steps.front() : std::ranges::min(steps);
    for (std::size_t i = 0; i < steps.size() && !result.gap_after && !result.ends_early; ++i)
        if (!is_step(steps[i], result.step)) result.gap_after = numbers[i];
    return result;
}

void require_no_gap(const Sequence& sequence)
{
    const Steps steps = steps_of(sequence);
    const double last = sequence.files.rbegin()->first;
    if (steps.ends_early)
        warn({fmt::format("{}: the last step of the sequence is {:g} instead of {:g}: measured",
                          sequence.files.rbegin()->second, last - std::prev(sequence.files.end(), 2)->first,
                          steps.step)});
    if (!steps.gap_after) return;
    const double wanted = *steps.gap_after + steps.step;
    const std::string number =
        sequence.is_whole ? fmt::format("{:0{}.0f}", wanted, sequence.width) : fmt::format("{:g}", wanted);
    throw pbs::InputError(
        sequence.before + number + sequence.after, 0, "frame", fmt::format("{:g}", wanted),
        fmt::format(
            "missing: the sequence goes from {:g} to {:g} by {:g}; --any-step measures the frames that there are",
            sequence.files.begin()->first, last, steps.step));
}

// The reading of the numbers by which the files make the fewest sequences, of these the first one without a gap. The
// error of the first reading where there is none.
FoundFrames sequences_in(const std::string& argument, const std::vector<std::string>& paths)
{
    std::optional<FoundFrames> best;
    std::optional<pbs::InputError> why;
    const auto has_gap = [](const FoundFrames& found) {
        return std::ranges::any_of(found.sequences,
                                   [](const Sequence& sequence) { return steps_of(sequence).gap_after.has_value(); });
    };
    for (const NumberForm form : {NumberForm::whole, NumberForm::decimal, NumberForm::after_letter}) try {
            FoundFrames found = sequences_by(argument, paths, form);
            const bool is_better =
                !best || found.sequences.size() < best->sequences.size() ||
                (found.sequences.size() == best->sequences.size() && has_gap(*best) && !has_gap(found));
            if (is_better) best = std::move(found);
        } catch (const pbs::InputError& error) {
            if (!why) why = error;
        }
    if (!best) throw pbs::InputError(*why);
    return *best;
}

// Those without a number first, then one sequence after the other.
std::vector<std::string> in_order(FoundFrames found, bool any_step)
{
    const auto place = [](const Sequence& sequence) { return std::tie(sequence.before, sequence.after); };
    std::sort(found.sequences.begin(), found.sequences.end(),
              [&](const auto& a, const auto& b) { return place(a) < place(b); });
    std::vector<std::string> files = std::move(found.without_number);
    for (const Sequence& sequence : found.sequences) {
        if (!any_step) require_no_gap(sequence);
        for (const auto& [number, path] : sequence.files) files.push_back(path);
    }
    return files;
}

void require_one_sequence(const std::string& folder, const FoundFrames& found)
{
    std::vector<std::string> names;
    for (const Sequence& sequence : found.sequences) names.push_back(sequence.files.begin()->second);
    if (names.empty()) return;
    names.insert(names.end(), found.without_number.begin(), found.without_number.end());
    if (names.size() > 1)
        throw pbs::InputError(
            folder, 0, "", "",
            fmt::format("expected one sequence of frames, found those of {}; name one, as in 'NAME_%04d.vtu'",
                        fmt::join(names, ", ")));
}

bool is_frame(const fs::path& file, bool of_surfaces)
{
    static const std::set<std::string> tets = {".vtu", ".pvtu", ".vtk", ".msh", ".mesh", ".ele"},
                                       surfaces = {".obj", ".ply",  ".off", ".stl", ".vtp",
                                                   ".glb", ".gltf", ".fbx", ".dae", ".zae"};
    return (of_surfaces ? surfaces : tets).contains(pbs::lower_extension(file.string()));
}

std::vector<std::string> in_folder(const std::string& folder, bool of_surfaces)
{
    std::vector<std::string> files;
    std::error_code gone;
    for (const fs::path& file : analysis::files_in(folder))
        if (fs::is_regular_file(file, gone) && is_frame(file, of_surfaces)) files.push_back(file.string());
    std::sort(files.begin(), files.end());
    return files;
}

// A pattern for glob in which these characters stand for themselves.
std::string escaped(const std::string& text, std::string_view characters)
{
    std::string pattern;
    for (const char c : text)
        pattern += characters.find(c) == std::string_view::npos ? std::string{c} : std::string{'\\', c};
    return pattern;
}

std::vector<std::string> matching(const std::string& pattern)
{
    glob_t found = {};
    std::vector<std::string> files;
    if (glob(pattern.c_str(), 0, nullptr, &found) == 0) files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return files;
}

// Brackets in the name of a folder that exists are no pattern, and neither are those of a file's name where nothing
// matches otherwise.
std::vector<std::string> globbed(const std::string& argument)
{
    const fs::path folder = fs::path(argument).parent_path();
    std::error_code none;
    const bool is_folder = !folder.empty() && fs::is_directory(folder, none);
    const std::string before = is_folder ? escaped(folder.string(), "*?[\\") + "/" : "",
                      name = is_folder ? name_of(argument) : argument;
    std::vector<std::string> files = matching(before + name);
    return files.empty() ? matching(before + escaped(name, "[")) : files;
}

// frames_%04d.vtu as C's printf writes it: the files whose number is written just so; %g and %f: any number.
std::optional<Sequence> of_number_pattern(const std::string& pattern)
{
    static const std::regex form("(.*)%(0?)([0-9]{0,2})(\\.[0-9]+)?([dfg])(.*)"),
        decimal("-?[0-9]+(\\.[0-9]+)?([eE][-+]?[0-9]+)?"), whole("-?[0-9]+");
    const fs::path folder = fs::path(pattern).parent_path(), listed = folder.empty() ? "." : folder;
    const std::string wanted = name_of(pattern);
    std::smatch match;
    if (!std::regex_match(wanted, match, form)) return std::nullopt;
    const std::string before = match[1], after = match[6];
    const bool is_whole = match[5] == "d";
    const std::size_t width = is_whole && match[3].length() ? std::stoul(match[3]) : 1;
    Sequence sequence{(folder / before).string(), after};
    std::error_code none;
    for (const fs::path& file : fs::is_directory(listed, none) ? analysis::files_in(listed) : std::vector<fs::path>()) {
        const std::string name = file.filename().string();
        if (name.size() < before.size() + after.size() + width || !name.starts_with(before) || !name.ends_with(after))
            continue;
        const std::string number = name.substr(before.size(), name.size() - before.size() - after.size());
        if (number.size() > longest_number || !std::regex_match(number, is_whole ? whole : decimal)) continue;
        const bool is_padded = number[number[0] == '-' ? 1 : 0] == '0';
        if (!is_whole || number.size() == width || !is_padded) sequence.add(number, (folder / name).string());
    }
    return sequence;
}

std::vector<std::string> files_of(const std::string& argument, const FrameSearch& search)
{
    std::error_code error;
    if (pbs::lower_extension(argument) == ".pvd") return pbs::read_pvd(argument);
    if (fs::is_regular_file(argument, error)) return {argument};
    FoundFrames found;
    const bool is_folder = fs::is_directory(argument, error);
    if (is_folder)
        found = sequences_in(argument, in_folder(argument, search.of_surfaces));
    else if (const auto sequence = of_number_pattern(argument)) {
        if (!sequence->files.empty()) found.sequences.push_back(*sequence);
    } else if (argument.find_first_of("*?[") != std::string::npos)
        found = sequences_in(argument, globbed(argument));
    else
        return {argument};
    if (is_folder) require_one_sequence(argument, found);
    std::vector<std::string> files = in_order(std::move(found), search.any_step);
    if (files.empty()) {
        const char* expected = search.of_surfaces ? ": expected .obj .ply .off .stl .vtp .glb .gltf .fbx .dae .zae"
                                                  : ": expected .vtu .vtk .msh .mesh .ele";
        throw pbs::InputError(argument, 0, "", "", "no such frames" + std::string(is_folder ? expected : ""));
    }
    return files;
}

}  // namespace

std::vector<std::string> frame_files(const std::vector<std::string>& arguments, const FrameSearch& search)
{
    std::vector<std::string> files;
    for (const std::string& argument : arguments)
        for (std::string& file : files_of(argument, search)) files.push_back(std::move(file));
    return files;
}

std::vector<std::string> frame_names(const std::vector<std::string>& paths)
{
    std::map<std::string, int> times;
    for (const std::string& path : paths) ++times[name_of(path)];
    std::vector<std::string> names;
    for (const std::string& path : paths) names.push_back(times[name_of(path)] > 1 ? path : name_of(path));
    return names;
}

}  // namespace experiments
