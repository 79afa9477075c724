#include "experiments/convergence/convergence_figures.hpp"

#include "analysis/line_fit.hpp"
#include "experiments/deformers/option_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace experiments {
namespace {

// A figure of one setting; what it bounds, where a tolerance was not reached.
struct Figure {
    double value = 0.0;
    std::string bound = {};  // "", "at least", "at most"
};
using FigureOf = std::function<std::optional<Figure>(const ConvergencePaths&)>;
using Group = std::vector<const ConvergencePaths*>;  // the default setting first

std::vector<Group> groups_of(const ConvergenceResult& result)
{
    std::vector<Group> groups;
    for (const ConvergencePaths& paths : result.all) {
        const auto same = [&](const Group& group) {
            const ConvergencePaths& first = *group.front();
            return first.pose == paths.pose && first.k_stretch == paths.k_stretch && (!result.ladder || first.vertices == paths.vertices);
        };
        if (const auto found = std::find_if(groups.begin(), groups.end(), same); found != groups.end())
            found->push_back(&paths);
        else
            groups.push_back({&paths});
    }
    return groups;
}

std::string words_for(const ConvergencePaths& of)
{
    return fmt::format("{}, {}, {} vertices, k_stretch {:g}, {} {}", of.body, of.pose, of.vertices, of.k_stretch,
                       experiments::name_of(of.setting.order), experiments::name_of(of.setting.precision));
}

void add(std::vector<analysis::Measurement>& to, const std::string& claim, const std::string& quantity, const std::string& remark,
         const Group& group, const FigureOf& figure_of, const std::string& unit = "1")
{
    const std::optional<Figure> own = figure_of(*group.front());
    if (!own || !std::isfinite(own->value)) return;
    analysis::Measurement measured{claim, quantity, words_for(*group.front()) + remark, own->value, own->value, own->value, unit};
    if (!own->bound.empty()) measured.of += fmt::format("; {} so much", own->bound);
    for (const ConvergencePaths* other : group) {
        const std::optional<Figure> figure = figure_of(*other);
        if (!figure || !std::isfinite(figure->value)) continue;
        measured.low = std::min(measured.low, figure->value);
        measured.high = std::max(measured.high, figure->value);
    }
    to.push_back(measured);
}

struct Tolerance {
    const char* remark;
    Reached (*reached)(const ConvergencePaths&, std::size_t start);
};
const Tolerance tolerances[] = {
    {"; tolerance: residual within 5 % of its floor",
     [](const ConvergencePaths& of, std::size_t start) { return reached_residual(of.paths[start], floor_of(of.paths)); }},
    {"; tolerance: absolute volume change within 0.5 %",
     [](const ConvergencePaths& of, std::size_t start) { return reached_volume(of.paths[start]); }}};

FigureOf iterations_to(const Tolerance& tolerance)
{
    return [&tolerance](const ConvergencePaths& of) {
        const Reached lbs = tolerance.reached(of, 0);
        return Figure{double(lbs.iterations), lbs.within ? "" : "more than"};
    };
}

// A start that is there already counts as one iteration.
FigureOf over_lbs(const Tolerance& tolerance, std::size_t start)
{
    return [&tolerance, start](const ConvergencePaths& of) -> std::optional<Figure> {
        const Reached other = tolerance.reached(of, start), lbs = tolerance.reached(of, 0);
        if (!other.within && !lbs.within) return {};
        return Figure{std::max(other.iterations, 1) / double(std::max(lbs.iterations, 1)), !other.within ? "at least"
                                                                                           : !lbs.within ? "at most"
                                                                                                         : ""};
    };
}

void add_beside(std::vector<analysis::Measurement>& to, const Group& group)
{
    const auto figure = [&](const char* quantity, double (*of_lbs)(const IterationPath&)) {
        add(to, "C12", quantity, "", group, [of_lbs](const ConvergencePaths& of) { return Figure{of_lbs(of.paths[0])}; });
    };
    figure("residual after 24 iterations over after 1000",
           [](const IterationPath& path) { return look_at(path, 24).combined / look_at(path, 1000).combined; });
    figure("error to the reference after 24 iterations over the least",
           [](const IterationPath& path) { return look_at(path, 24).error_joint_pct / nearest_to_reference(path).error_joint_pct; });
    figure("error to the reference after 1000 iterations over the least",
           [](const IterationPath& path) { return look_at(path, 1000).error_joint_pct / nearest_to_reference(path).error_joint_pct; });
}

void add_starts(std::vector<analysis::Measurement>& to, const Group& group)
{
    for (std::size_t start = 1; start < group.front()->paths.size(); ++start) {
        const char* words = words_for(all_starts[start]);
        for (const Tolerance& tolerance : tolerances)
            add(to, "C03", fmt::format("iterations to tolerance, from {} over from LBS", words), tolerance.remark, group,
                over_lbs(tolerance, start));
        add(to, "C03", fmt::format("error to the reference after 24 iterations, from {} over from LBS", words), "", group,
            [start](const ConvergencePaths& of) {
                return Figure{look_at(of.paths[start], 24).error_joint_pct / look_at(of.paths[0], 24).error_joint_pct};
            });
    }
}

// iterations ~ vertices^exponent, over the sizes that reach the tolerance.
void add_exponents(std::vector<analysis::Measurement>& to, const std::vector<Group>& groups)
{
    std::vector<const ConvergencePaths*> done;
    for (const Group& own : groups) {
        const ConvergencePaths& first = *own.front();
        const auto same = [&](const ConvergencePaths* other) { return other->pose == first.pose && other->k_stretch == first.k_stretch; };
        if (std::any_of(done.begin(), done.end(), same)) continue;
        done.push_back(&first);
        for (const Tolerance& tolerance : tolerances) {
            std::vector<double> vertices, iterations;
            for (const Group& group : groups)
                if (const Reached lbs = tolerance.reached(*group.front(), 0); same(group.front()) && lbs.within && lbs.iterations > 0) {
                    vertices.push_back(group.front()->vertices);
                    iterations.push_back(lbs.iterations);
                }
            if (vertices.size() < 3) continue;
            const analysis::Interval exponent = analysis::observed_order(vertices, iterations).slope;
            const auto [fewest, most] = std::minmax_element(vertices.begin(), vertices.end());
            to.push_back({"C12", "exponent of iterations to tolerance over vertices",
                          fmt::format("{}, {}, {:g} to {:g} vertices, k_stretch {:g}{}", first.body, first.pose, *fewest, *most,
                                      first.k_stretch, tolerance.remark),
                          exponent.estimate, exponent.low, exponent.high, "1"});
        }
    }
}

}  // namespace

std::vector<analysis::Measurement> convergence_figures(const ConvergenceResult& result)
{
    std::vector<analysis::Measurement> figures;
    const std::vector<Group> groups = groups_of(result);
    for (const Group& group : groups) {
        for (const Tolerance& tolerance : tolerances)
            add(figures, "C12", "iterations to tolerance", tolerance.remark, group, iterations_to(tolerance));
        add_beside(figures, group);
        add_starts(figures, group);
    }
    if (result.ladder) add_exponents(figures, groups);
    return figures;
}

}  // namespace experiments
