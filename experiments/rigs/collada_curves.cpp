#include "experiments/meshes/text_words.hpp"
#include "experiments/rigs/collada_xml.hpp"
#include "pbs/geometry/input_error.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

namespace pbs {
namespace {

// The numbers of a source, so many per element.
struct Numbers {
    std::vector<double> numbers;
    std::size_t stride = 1;

    std::size_t count() const { return numbers.size() / stride; }
};

Numbers numbers_of_source(const pugi::xml_node& source, const ColladaXml& document)
{
    Numbers read;
    read.stride = std::max<std::size_t>(number_of(source.child("technique_common").child("accessor"), "stride", 1), 1);
    for (const std::string_view word : words_of(source.child("float_array").text().as_string())) {
        const std::optional<double> number = number_in(word);
        if (!number || !std::isfinite(*number))
            throw InputError(document.path(), 0, "source " + id_of(source), std::string(word),
                             "expected a finite number");
        read.numbers.push_back(*number);
    }
    return read;
}

std::string text_of(const std::vector<double>& numbers)
{
    std::ostringstream text;
    text.precision(17);
    for (const double number : numbers) text << number << ' ';
    return text.str();
}

// A copy of a source with other numbers, below the same parent.
std::string add_source(pugi::xml_node source, const std::vector<double>& numbers, std::size_t stride,
                       const std::string& suffix)
{
    pugi::xml_node copy = source.parent().insert_copy_after(source, source);
    const std::string id = id_of(source) + suffix, array = id + "-array";
    copy.attribute("id") = id.c_str();
    copy.child("float_array").attribute("id") = array.c_str();
    copy.child("float_array").attribute("count") = static_cast<unsigned>(numbers.size());
    copy.child("float_array").text() = text_of(numbers).c_str();
    pugi::xml_node accessor = copy.child("technique_common").child("accessor");
    accessor.attribute("source") = ("#" + array).c_str();
    accessor.attribute("count") = static_cast<unsigned>(numbers.size() / stride);
    return "#" + id;
}

constexpr double step_s = 1e-5;          // before a step its curve runs from one value to the next
constexpr double share_of_range = 1e-6;  // how far a straight piece may be from its curve
constexpr int most_pieces = 2000;        // of a Bezier curve
constexpr double angle_step_deg = 0.5;   // of several angles of a node, between whose keys assimp turns about one axis

using Point = std::array<double, 2>;  // time [s] and value

// A Bezier curve as straight pieces, without its first point. With the second differences d of its control points, n
// pieces are within 6 d / (8 n^2) of it.
void add_pieces(const std::array<Point, 4>& points, double range, std::vector<double>& times,
                std::vector<double>& values)
{
    const double duration = points[3][0] - points[0][0];
    double difference = 0.0;
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t axis = 0; axis < 2; ++axis)
            difference =
                std::max(difference, std::abs(points[k][axis] - 2.0 * points[k + 1][axis] + points[k + 2][axis]) /
                                         std::max(axis == 0 ? duration : range, 1e-30));
    const int pieces =
        std::clamp(static_cast<int>(std::ceil(std::sqrt(0.75 * difference / share_of_range))), 1, most_pieces);
    for (int piece = 1; piece <= pieces; ++piece) {
        const double t = double(piece) / pieces, u = 1.0 - t;
        const auto at = [&](std::size_t axis) {
            return u * u * u * points[0][axis] + 3.0 * u * u * t * points[1][axis] + 3.0 * u * t * t * points[2][axis] +
                   t * t * t * points[3][axis];
        };
        times.push_back(std::max(at(0), times.back()));
        values.push_back(at(1));
    }
}

// A tangent's control point. A tangent of one number is the value alone, at a third of the time between the keys.
Point control_point(const Numbers& tangents, std::size_t key, double third_s)
{
    const std::size_t at = key * tangents.stride;
    return tangents.stride == 1 ? Point{third_s, tangents.numbers[at]}
                                : Point{tangents.numbers[at], tangents.numbers[at + 1]};
}

// One sampler, with straight pieces between its keys afterwards.
class Sampler {
public:
    // largest_step: between two values of a linear curve.
    Sampler(pugi::xml_node sampler, double largest_step, ColladaXml& document)
        : sampler_(sampler),
          document_(document),
          largest_step_(largest_step),
          kinds_(words_of(document.source(sampler, "INTERPOLATION").child("Name_array").text().as_string()))
    {
    }

    void make_linear()
    {
        const bool is_linear = std::ranges::all_of(kinds_, [](std::string_view kind) { return kind == "LINEAR"; });
        if (is_linear && std::isinf(largest_step_)) return;
        times_ = numbers_of_source(document_.source(sampler_, "INPUT"), document_);
        values_ = numbers_of_source(document_.source(sampler_, "OUTPUT"), document_);
        const std::size_t keys = times_.count();
        if (is_linear && (kinds_.empty() || values_.stride != 1)) return;
        if (keys == 0 || values_.count() != keys || kinds_.size() != keys || times_.stride != 1)
            refuse("INTERPOLATION", std::to_string(kinds_.size()),
                   "expected as many times, values and kinds of interpolation");
        std::vector<double> times = {times_.numbers[0]},
                            values(values_.numbers.begin(), values_.numbers.begin() + stride());
        for (std::size_t key = 0; key + 1 < keys; ++key) add_segment(key, times, values);
        if (is_linear && times.size() == keys) return;
        redirect("INPUT", times, 1);
        redirect("OUTPUT", values, values_.stride);
        for (const char* semantic : {"INTERPOLATION", "IN_TANGENT", "OUT_TANGENT"})
            if (const auto input = sampler_.find_child_by_attribute("input", "semantic", semantic))
                sampler_.remove_child(input);
        document_.is_changed = true;
    }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw InputError(document_.path(), 0, "animation " + id_of(sampler_.parent()) + ", " + field, value,
                         rule + ": bake the animation into linear curves, or export glTF 2.0 (.glb)");
    }

    std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(values_.stride); }

    void redirect(const char* semantic, const std::vector<double>& numbers, std::size_t stride)
    {
        pugi::xml_attribute source =
            sampler_.find_child_by_attribute("input", "semantic", semantic).attribute("source");
        source = add_source(document_.source(sampler_, semantic), numbers, stride, "-of-" + id_of(sampler_)).c_str();
    }

    void add_segment(std::size_t key, std::vector<double>& times, std::vector<double>& values) const
    {
        const double begin = times_.numbers[key], end = times_.numbers[key + 1];
        const auto own = values_.numbers.begin() + stride() * static_cast<std::ptrdiff_t>(key), next = own + stride();
        if (!(end >= begin))
            refuse("time of key " + std::to_string(key + 1), number_text(end), "expected times that do not go back");
        if (kinds_[key] == "BEZIER") return add_bezier(key, times, values);
        if (kinds_[key] == "STEP") {
            times.push_back(std::max(begin, end - step_s));
            values.insert(values.end(), own, next);
        } else if (kinds_[key] != "LINEAR") {
            refuse("INTERPOLATION", std::string(kinds_[key]), "expected LINEAR, STEP or BEZIER");
        } else if (values_.stride == 1) {
            const double steps = std::min(std::ceil(std::abs(*next - *own) / largest_step_), double(most_pieces));
            for (double step = 1.0; step < steps; ++step) {
                times.push_back(begin + step / steps * (end - begin));
                values.push_back(*own + step / steps * (*next - *own));
            }
        }
        times.push_back(end);
        values.insert(values.end(), next, next + stride());
    }

    void add_bezier(std::size_t key, std::vector<double>& times, std::vector<double>& values) const
    {
        const Numbers in = numbers_of_source(document_.source(sampler_, "IN_TANGENT"), document_),
                      out = numbers_of_source(document_.source(sampler_, "OUT_TANGENT"), document_);
        const std::size_t keys = times_.count();
        if (values_.stride != 1)
            refuse("INTERPOLATION", "BEZIER",
                   "expected curves of single numbers, not of " + std::to_string(values_.stride));
        if (in.count() != keys || out.count() != keys || in.stride > 2 || out.stride > 2)
            refuse("IN_TANGENT and OUT_TANGENT", std::to_string(in.count()),
                   "expected a time and a value for each of " + std::to_string(keys) + " keys");
        const double begin = times_.numbers[key], end = times_.numbers[key + 1];
        const std::array<Point, 4> points = {
            Point{begin, values_.numbers[key]}, control_point(out, key, (2.0 * begin + end) / 3.0),
            control_point(in, key + 1, (begin + 2.0 * end) / 3.0), Point{end, values_.numbers[key + 1]}};
        const auto [least, most] = std::ranges::minmax(values_.numbers);
        add_pieces(points, most - least, times, values);
    }

    pugi::xml_node sampler_;
    ColladaXml& document_;
    double largest_step_;
    std::vector<std::string_view> kinds_;
    Numbers times_, values_;
};

// The samplers of nodes that have several angles.
std::set<std::string> samplers_of_several_angles(const ColladaXml& document)
{
    std::map<std::string, std::set<std::string>> samplers_of;  // of the angles of each node
    for (const pugi::xpath_node& found : document.root().select_nodes("library_animations//channel")) {
        const std::string target = found.node().attribute("target").as_string();
        if (target.ends_with(".ANGLE"))
            samplers_of[target.substr(0, target.find('/'))].insert(found.node().attribute("source").as_string());
    }
    std::set<std::string> samplers;
    for (const auto& [node, own] : samplers_of)
        if (own.size() > 1) samplers.insert(own.begin(), own.end());
    return samplers;
}

}  // namespace

void make_curves_linear(ColladaXml& document)
{
    const std::set<std::string> several = samplers_of_several_angles(document);
    for (const pugi::xpath_node& found : document.root().select_nodes("library_animations//sampler")) {
        const bool is_one_of_several = several.contains("#" + id_of(found.node()));
        Sampler(found.node(), is_one_of_several ? angle_step_deg : std::numeric_limits<double>::infinity(), document)
            .make_linear();
    }
}

}  // namespace pbs
