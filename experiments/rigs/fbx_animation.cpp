#include "experiments/rigs/fbx_rig.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace pbs {
namespace {

// of files whose TCDefinition is not 127
constexpr double ticks_per_s = 46186158000.0, finer_ticks_per_s = 141120000.0;
constexpr double ticks_definition = 127.0;

// The bits of KeyAttrFlags.
// none of the first two: linear
constexpr std::uint32_t constant_bit = 0x2, cubic_bit = 0x8, constant_next_bit = 0x100;
constexpr std::uint32_t auto_bit = 0x100, tcb_bit = 0x200;  // of cubic keys; neither: stored slopes
constexpr std::uint32_t clamp_bit = 0x1000, time_independent_bit = 0x2000, clamp_progressive_bit = 0x4000;
constexpr std::uint32_t weighted_bit = 0x1000000, next_weighted_bit = 0x2000000;
constexpr double same_value = 1e-5;  // of keys, for clamp_bit
constexpr double same_time_s = 1e-6;
constexpr double per_weight = 1e-4;  // weights are stored as whole numbers of this

struct KeyAttributes {
    std::uint32_t flags = 0x4;
    std::array<double, 4> data = {};  // two slopes, or tension, continuity and bias; two packed weights; two velocities
};

// One per key: equal ones of consecutive keys are stored once, with their count.
std::vector<KeyAttributes> attributes_of(const FbxObject& curve, std::size_t keys, const FbxObjects& objects)
{
    const std::vector<double> flags = curve.record->numbers("KeyAttrFlags"),
                              data = curve.record->numbers("KeyAttrDataFloat"),
                              counts = curve.record->numbers("KeyAttrRefCount");
    std::vector<KeyAttributes> attributes;
    for (std::size_t group = 0; group < flags.size(); ++group) {
        KeyAttributes own{static_cast<std::uint32_t>(static_cast<std::int64_t>(flags[group]))};
        for (std::size_t d = 0; d < 4 && 4 * group + d < data.size(); ++d) own.data[d] = data[4 * group + d];
        const double count = group < counts.size() ? counts[group] : 1.0;
        if (!(count >= 0.0 && count <= double(keys - attributes.size())))
            objects.refuse(curve, "KeyAttrRefCount", number_text(count),
                           "expected as many attributes as there are keys");
        attributes.insert(attributes.end(), static_cast<std::size_t>(count), own);
    }
    if (!counts.empty() && attributes.size() != keys)
        objects.refuse(curve, "KeyAttrRefCount", std::to_string(attributes.size()),
                       "expected one for each of the " + std::to_string(keys) + " keys");
    attributes.resize(keys, attributes.empty() ? KeyAttributes{} : attributes.back());
    return attributes;
}

// Two weights in the bits of the third number, which text files write as a whole number.
std::pair<double, double> weights_of(const KeyAttributes& key)
{
    const std::uint32_t bits = key.data[2] >= 1.0 ? static_cast<std::uint32_t>(std::min(key.data[2], 4294967295.0))
                                                  : std::bit_cast<std::uint32_t>(static_cast<float>(key.data[2]));
    const auto weight = [](std::uint32_t stored) { return std::min(per_weight * stored, 1.0); };
    return {key.flags & weighted_bit ? weight(bits & 0xffff) : 1.0 / 3.0,
            key.flags & next_weighted_bit ? weight(bits >> 16) : 1.0 / 3.0};
}

// The keys next to one, and the slopes to them; a key at an end has none on one side.
struct Neighbours {
    double before_s = 0.0, after_s = 0.0;  // distances; 0: no key there
    double change_before = 0.0, change_after = 0.0;

    double slope_before() const { return before_s > 0.0 ? change_before / before_s : 0.0; }
    double slope_after() const { return after_s > 0.0 ? change_after / after_s : 0.0; }
    bool at_an_end() const { return !(before_s > 0.0 && after_s > 0.0); }
};

// Autodesk's smooth tangent: half the slope between the neighbours and half the mean of the slopes to them, or the
// first alone; clamped, so that the tangents of this key do not pass the values of its neighbours.
double auto_slope(const Neighbours& keys, std::uint32_t flags, double weight_before, double weight_after)
{
    const bool clamps = flags & clamp_progressive_bit;
    if (flags & clamp_bit)
        for (const auto& [distance_s, change] :
             {std::pair(keys.before_s, keys.change_before), std::pair(keys.after_s, keys.change_after)})
            if (distance_s > 0.0 && std::abs(change) <= same_value) return 0.0;
    if (keys.at_an_end()) return clamps ? 0.0 : keys.slope_before() + keys.slope_after();
    double slope = (keys.change_before + keys.change_after) / (keys.before_s + keys.after_s);
    if (!(flags & time_independent_bit)) {
        const double share = keys.before_s / (keys.before_s + keys.after_s);
        slope = 0.5 * slope + 0.5 * ((1.0 - share) * keys.slope_before() + share * keys.slope_after());
    }
    if (!clamps) return slope;
    const double sign = slope < 0.0 ? -1.0 : 1.0;
    const double most_before = std::max(sign * keys.slope_before() / weight_before, 0.0),
                 most_after = std::max(sign * keys.slope_after() / weight_after, 0.0);
    return sign * std::min({std::abs(slope), most_before, most_after});
}

// Kochanek and Bartels: Interpolating splines with local tension, continuity and bias control, SIGGRAPH 1984, Eq. 8
// and 9.
std::pair<double, double> tcb_slopes(const Neighbours& keys, const KeyAttributes& key)
{
    const auto& [tension, continuity, bias, unused] = key.data;
    const double half = keys.at_an_end() ? 1.0 : 0.5,
                 before = half * (1.0 - tension) * (1.0 + bias) * keys.slope_before(),
                 after = half * (1.0 - tension) * (1.0 - bias) * keys.slope_after();
    return {(1.0 - continuity) * before + (1.0 + continuity) * after,
            (1.0 + continuity) * before + (1.0 - continuity) * after};
}

// The slopes of cubic keys that are not stored but follow from their neighbours.
void set_slopes(const FbxObject& curve, const std::vector<KeyAttributes>& attributes, const FbxObjects& objects,
                FbxCurve& keys)
{
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const KeyAttributes& own = attributes[k];
        if (keys[k].interpolation != FbxInterpolation::cubic || !(own.flags & (auto_bit | tcb_bit))) continue;
        Neighbours near;
        if (k > 0) {
            near.before_s = keys[k].time_s - keys[k - 1].time_s;
            near.change_before = keys[k].value - keys[k - 1].value;
        }
        if (k + 1 < keys.size()) {
            near.after_s = keys[k + 1].time_s - keys[k].time_s;
            near.change_after = keys[k + 1].value - keys[k].value;
        }
        double before = 0.0, after = 0.0;
        if (own.flags & tcb_bit) {
            std::tie(before, after) = tcb_slopes(near, own);
        } else {
            if (!(own.flags & time_independent_bit) && std::abs(own.data[0]) > 1e-3)
                objects.refuse(curve, "bias of the tangent of key " + std::to_string(k), number_text(own.data[0]),
                               "expected 0: bake the animation, or export glTF 2.0 (.glb)");
            before = after = auto_slope(near, own.flags, k > 0 ? keys[k - 1].next_weight : 1.0 / 3.0, keys[k].weight);
        }
        keys[k].slope = after;
        if (k > 0) keys[k - 1].next_slope = before;
    }
}

FbxInterpolation interpolation_of(std::uint32_t flags)
{
    if (flags & constant_bit)
        return flags & constant_next_bit ? FbxInterpolation::constant_next : FbxInterpolation::constant;
    return flags & cubic_bit ? FbxInterpolation::cubic : FbxInterpolation::linear;
}

// rate: ticks per second; start: the tick at which the time is zero.
FbxCurve curve_of(const FbxObject& curve, double rate, double start, const FbxObjects& objects)
{
    const std::vector<double> ticks = curve.record->numbers("KeyTime"), values = curve.record->numbers("KeyValueFloat");
    if (ticks.size() != values.size())
        objects.refuse(curve, "KeyValueFloat", std::to_string(values.size()) + " values",
                       "expected one for each of the " + std::to_string(ticks.size()) + " times");
    const std::vector<KeyAttributes> attributes = attributes_of(curve, ticks.size(), objects);
    FbxCurve keys;
    for (std::size_t k = 0; k < ticks.size(); ++k) {
        FbxKey key{(ticks[k] - start) / rate, values[k], interpolation_of(attributes[k].flags), attributes[k].data[0],
                   attributes[k].data[1]};
        std::tie(key.weight, key.next_weight) = weights_of(attributes[k]);
        if (!std::isfinite(key.time_s) || !std::isfinite(key.value) || (k > 0 && key.time_s < keys.back().time_s))
            objects.refuse(curve, "key " + std::to_string(k), number_text(key.value),
                           "expected finite numbers, and times that do not go back");
        keys.push_back(key);
    }
    set_slopes(curve, attributes, objects, keys);
    return keys;
}

// Does a curve repeat, mirror or continue its keys before the first or behind the last one (record: Pre-Extrapolation
// or Post-Extrapolation)?
bool goes_on(const FbxObject& curve, std::string_view record)
{
    const FbxRecord* extrapolation = curve.record->record(record);
    const FbxRecord* type = extrapolation ? extrapolation->record("Type") : nullptr;
    if (!type) return false;
    const std::string* word = type->text(0);
    const std::int64_t* letter = type->whole(0);
    const char kind = word && !word->empty() ? word->front() : letter ? static_cast<char>(*letter) : 'C';
    return std::string_view("AKMR").find(kind) != std::string_view::npos;
}

constexpr std::array<const char*, 3> moved_properties = {"Lcl Translation", "Lcl Rotation", "Lcl Scaling"};

// One animation while its layers are read.
class Stack {
public:
    Stack(const FbxObject& stack, FbxReading& reading) : stack_(stack), reading_(reading), objects_(reading.objects)
    {
        const FbxRecord* header = objects_.record("FBXHeaderExtension");
        const FbxRecord* flags = header ? header->record("OtherFlags") : nullptr;
        const std::vector<double> definition = flags ? flags->numbers("TCDefinition") : std::vector<double>();
        rate_ = definition.empty() || definition[0] == ticks_definition ? ticks_per_s : finer_ticks_per_s;
    }

    void read()
    {
        set_range();
        const std::vector<const FbxObject*> layers = objects_.below(stack_, "AnimationLayer");
        for (const FbxObject* layer : layers) {
            if (objects_.number(*layer, "Mute", 0.0) != 0.0) continue;
            for (const FbxObject* node : objects_.below(*layer, "AnimationCurveNode"))
                for (const FbxConnection& moved : objects_.above(*node))
                    add_curves(*layer, layer != layers.front(), *node, moved);
        }
        finish();
    }

private:
    void set_range()
    {
        const double begin = objects_.number(stack_, "LocalStart", 0.0),
                     end = objects_.number(stack_, "LocalStop", 0.0);
        has_range_ = begin != 0.0 || end != 0.0;
        start_ = begin;
        longest_s_ = (end - begin) / rate_;
        if (has_range_) return;
        start_ = std::numeric_limits<double>::max();
        for (const FbxObject* layer : objects_.below(stack_, "AnimationLayer"))
            for (const FbxObject* node : objects_.below(*layer, "AnimationCurveNode"))
                for (const FbxConnection& curve : objects_.below(*node))
                    if (const std::vector<double> ticks = curve.object->record->numbers("KeyTime"); !ticks.empty())
                        start_ = std::min(start_, ticks.front());
        if (start_ == std::numeric_limits<double>::max()) start_ = 0.0;
    }

    void add_curves(const FbxObject& layer, bool is_upper, const FbxObject& curve_node, const FbxConnection& moved)
    {
        const auto node = reading_.node_of.find(moved.object);
        if (node == reading_.node_of.end()) return;
        const auto place = std::ranges::find(moved_properties, moved.property);
        const std::string what = moved.property + " of " + moved.object->name;
        if (place == moved_properties.end()) {
            if (moved.property.ends_with("Rotation") || moved.property.ends_with("Pivot") ||
                moved.property.ends_with("Offset") || moved.property.starts_with("Geometric"))
                obstacle_ = "it moves " + what;
            return;
        }
        const auto property = static_cast<std::size_t>(place - moved_properties.begin());
        if (!seen_.insert({node->second, property}).second) obstacle_ = "two of its layers move " + what;
        const FbxTransform& rest = *reading_.rig.nodes[static_cast<std::size_t>(node->second)].fbx;
        const bool is_added = is_upper && objects_.number(layer, "BlendMode", 0.0) == 0.0;
        if (is_added && rest.lcl[property] != FbxTransform().lcl[property])
            obstacle_ = "its layer " + layer.name + " adds to " + what;
        if (objects_.number(layer, "Weight", 100.0) != 100.0) obstacle_ = "its layer " + layer.name + " has a weight";
        auto& axes = tracks_[node->second][property];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string channel = std::string("d|") + "XYZ"[axis];
            axes[axis] = curve_on(curve_node, channel, rest.lcl[property](static_cast<int>(axis)));
        }
    }

    // An axis without a curve has the value of the curve node, which need not be that of the node at rest.
    std::optional<FbxCurve> curve_on(const FbxObject& curve_node, const std::string& channel, double at_rest)
    {
        for (const FbxConnection& connection : objects_.below(curve_node)) {
            if (connection.property != channel || connection.object->type != "AnimationCurve") continue;
            FbxCurve curve = curve_of(*connection.object, rate_, start_, objects_);
            if (curve.empty()) continue;
            first_s_ = std::min(first_s_, curve.front().time_s);
            last_s_ = std::max(last_s_, curve.back().time_s);
            if (has_range_ &&
                ((curve.front().time_s > same_time_s && goes_on(*connection.object, "Pre-Extrapolation")) ||
                 (curve.back().time_s < longest_s_ - same_time_s && goes_on(*connection.object, "Post-Extrapolation"))))
                obstacle_ = "one of its curves goes on beyond its keys";
            return curve;
        }
        const double value = objects_.number(curve_node, channel, at_rest);
        return value == at_rest ? std::nullopt : std::optional(FbxCurve{{.value = value}});
    }

    void finish()
    {
        RigAnimation animation;
        animation.name =
            stack_.name.empty() ? "animation " + std::to_string(reading_.rig.animations.size()) : stack_.name;
        if (!obstacle_.empty()) {
            reading_.rig.remarks.push_back(
                "animation " + animation.name + " is left out: " + obstacle_ +
                "; bake it into one layer of translations, rotations and scales, or export glTF 2.0 (.glb)");
            return;
        }
        if (first_s_ > last_s_) return;  // no key
        animation.start_s = first_s_;
        animation.end_s = last_s_;
        if (has_range_ && std::max(first_s_, 0.0) < std::min(last_s_, longest_s_)) {
            animation.start_s = std::max(first_s_, 0.0);
            animation.end_s = std::min(last_s_, longest_s_);
        }
        for (auto& [node, tracks] : tracks_)
            if (std::ranges::any_of(tracks, [](const auto& axes) {
                    return std::ranges::any_of(axes, [](const auto& c) { return c.has_value(); });
                }))
                animation.nodes.push_back({.node = node, .fbx = std::move(tracks)});
        reading_.rig.animations.push_back(std::move(animation));
    }

    const FbxObject& stack_;
    FbxReading& reading_;
    const FbxObjects& objects_;
    double rate_ = ticks_per_s, start_ = 0.0;  // [ticks/s], [ticks]
    bool has_range_ = false;
    double longest_s_ = 0.0, first_s_ = std::numeric_limits<double>::max(),
           last_s_ = std::numeric_limits<double>::lowest();
    std::map<int, FbxTracks> tracks_;  // by node
    std::set<std::pair<int, std::size_t>> seen_;
    std::string obstacle_;
};

}  // namespace

void add_fbx_animations(FbxReading& reading)
{
    for (const FbxObject* stack : reading.objects.of_type("AnimationStack")) Stack(*stack, reading).read();
}

}  // namespace pbs
