// BVH in the dialects that programs write, by a reader of its own: assimp's reads only part of them.
#include "experiments/clips/clip.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"

#include <assimp/fast_atof.h>
#include <assimp/matrix3x3.h>
#include <assimp/matrix4x4.h>
#include <assimp/quaternion.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

namespace pbs {
namespace {

constexpr int deepest_nesting = 500;
constexpr float farthest_number = 1e9F;  // of angles too, for assimp's functions count whole turns one by one
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf", blanks = " \t\r\n\v\f";

std::string trimmed(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// A joint or an end site, as the file states it. Channels: x, y, z positions and X, Y, Z rotations, in the order of the
// file.
struct BvhJoint {
    std::string name;
    int parent = -1;
    bool is_end = false;
    Vec3 offset = Vec3::Zero();
    std::string channels;
    std::size_t first_channel = 0;  // in a row of the motion

    bool has_positions() const { return channels.find_first_of("xyz") != std::string::npos; }
};

struct BvhMotion {
    std::vector<BvhJoint> joints;  // parents first
    std::size_t channels = 0;      // in a row
    double frame_time_s = 0.0;
    std::vector<float> numbers;  // of all rows
    std::size_t rows() const { return numbers.size() / channels; }
};

// The exception that assimp's function throws here, since its own one is not exported by its library.
struct NoNumber {
    template <typename... Words>
    explicit NoNumber(const Words&...)
    {
    }
};

// One pass through the text; keywords in any case, any white space.
class BvhParser {
public:
    BvhParser(const std::string& text, const std::string& path) : text_(text), path_(path)
    {
        if (text.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
    }

    BvhMotion motion(std::vector<std::string>& remarks)
    {
        if (in_lower_case(word()) != "hierarchy")
            refuse("", "", "no clip in BVH: expected HIERARCHY as the first word");
        std::string keyword = in_lower_case(word());
        for (; keyword == "root"; keyword = in_lower_case(word())) joint(-1, false, 0);
        if (keyword != "motion") refuse("hierarchy", keyword, "expected ROOT or MOTION");
        if (motion_.channels == 0) refuse("CHANNELS", "0", "holds no motion");
        const double frames = labelled_number("Frames");
        const int frames_line = line_at(text_, at_);
        if (!(frames >= 1.0 && frames == std::floor(frames)))
            throw InputError(path_, frames_line, "Frames", label_value_,
                             "expected a whole number of frames, 1 or more");
        if (frames > static_cast<double>(text_.size()) / 2.0)
            throw InputError(path_, frames_line, "Frames", label_value_, "the file is too short to hold them");
        const double seconds = labelled_number("Frame Time");
        if (!(seconds >= shortest_frame_s && seconds <= longest_frame_s))
            refuse("Frame Time", label_value_, "expected a time from 1e-6 to 1000 s");
        std::size_t begin = 0;
        // By way of frames per second, as assimp has it, which read the clips of all records.
        motion_.frame_time_s = 1.0 / (1.0 / static_cast<double>(number_in(label_value_, begin, "Frame Time")));
        rows(static_cast<std::size_t>(frames), frames_line, remarks);
        return motion_;
    }

private:
    [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& rule) const
    {
        throw InputError(path_, line_at(text_, std::min(at_, text_.size())), field, value, rule);
    }

    // Up to white space; a brace is a word.
    std::string word()
    {
        at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
        std::size_t end = std::min(text_.find_first_of(std::string(blanks) + "{}", at_), text_.size());
        if (end == at_ && end < text_.size()) ++end;
        const std::string found = text_.substr(at_, end - at_);
        at_ = end;
        return found;
    }

    // The rest of the line or up to an opening brace, since names may contain spaces.
    std::string name()
    {
        const std::size_t end = std::min(text_.find_first_of("{\n\r", at_), text_.size());
        const std::string found = trimmed(text_.substr(at_, end - at_));
        at_ = end;
        return found;
    }

    float number(const std::string& field)
    {
        const std::string digits = word();
        std::size_t at = 0;
        const float value = number_in(digits, at, field);
        if (at != digits.size()) refuse(field, digits, "expected a number");
        return value;
    }

    // The number that begins at a byte of the word, which becomes the byte after it. By assimp's function, in single
    // precision, which read the clips of all records.
    float number_in(const std::string& digits, std::size_t& at, const std::string& field) const
    {
        float value = std::nanf("");
        std::size_t end = at;
        if (at < digits.size() && digits.find_first_not_of("0123456789+-.,eE", at) == std::string::npos) try {
                end = static_cast<std::size_t>(Assimp::fast_atoreal_move<float, NoNumber>(digits.c_str() + at, value) -
                                               digits.c_str());
            } catch (const NoNumber&) {  // no digit
            }
        if (end == at || !(std::abs(value) <= farthest_number))
            refuse(field, digits, "expected a finite number of at most 1e9");
        at = end;
        return value;
    }

    // A joint may have several, which are numbered.
    std::string end_site_name(int parent) const
    {
        const auto is_sibling = [&](const BvhJoint& joint) { return joint.is_end && joint.parent == parent; };
        const auto siblings = std::ranges::count_if(motion_.joints, is_sibling);
        const std::string name = "EndSite_" + motion_.joints[parent].name;
        return siblings == 0 ? name : name + " (" + std::to_string(siblings + 1) + ")";
    }

    void joint(int parent, bool is_end, int depth)
    {
        if (depth > deepest_nesting)
            refuse("JOINT", "", "nested deeper than " + std::to_string(deepest_nesting) + " joints");
        BvhJoint read;
        read.name = name();
        read.parent = parent;
        read.is_end = is_end;
        if (is_end) read.name = end_site_name(parent);
        if (read.name.empty()) refuse("JOINT", "", "expected a name");
        if (word() != "{") refuse("JOINT", read.name, "expected { after the name");
        const int index = static_cast<int>(motion_.joints.size());
        motion_.joints.push_back(read);
        for (;;) {
            const std::string keyword = in_lower_case(word());
            if (keyword == "}") return;
            if (keyword.empty()) refuse("JOINT", read.name, "the file ends inside this joint");
            if (keyword == "offset")
                for (int axis = 0; axis < 3; ++axis) motion_.joints[index].offset(axis) = number("OFFSET");
            else if (keyword == "channels")
                channels(motion_.joints[index]);
            else if (keyword == "joint" || keyword == "end")
                joint(index, keyword == "end", depth + 1);
            else
                refuse("joint " + read.name, keyword, "expected OFFSET, CHANNELS, JOINT, End Site or }");
        }
    }

    void channels(BvhJoint& joint)
    {
        const double count = number("CHANNELS");
        if (!(count >= 0.0 && count <= 6.0 && count == std::floor(count)))
            refuse("CHANNELS", number_text(count), "expected 0 to 6");
        if (!joint.channels.empty()) refuse("CHANNELS", joint.name, "expected them once per joint");
        joint.first_channel = motion_.channels;
        for (int c = 0; c < static_cast<int>(count); ++c) {
            const std::string channel = word(), lower = in_lower_case(channel);
            const bool turns = lower.ends_with("rotation"), moves = lower.ends_with("position");
            if (lower.size() != 9 || lower[0] < 'x' || lower[0] > 'z' || !(turns || moves))
                refuse("CHANNELS", channel,
                       "expected Xposition to Zposition or Xrotation to Zrotation, as many as CHANNELS states");
            joint.channels += turns ? static_cast<char>(std::toupper(lower[0])) : lower[0];
        }
        motion_.channels += joint.channels.size();
    }

    // "Frames: 13", "frames:13", "Frame Time:\t0.01". The words behind the colon are kept for messages; no number: not
    // a number.
    double labelled_number(const std::string& label)
    {
        at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
        const std::size_t end = std::min(text_.find_first_of("\n\r", at_), text_.size()), colon = text_.find(':', at_);
        std::string key = colon < end ? in_lower_case(trimmed(text_.substr(at_, colon - at_))) : "";
        std::erase_if(key, [](unsigned char c) { return std::isspace(c) > 0; });
        std::string wanted = in_lower_case(label);
        std::erase(wanted, ' ');
        if (key != wanted)
            refuse(label, trimmed(text_.substr(at_, end - at_)), "expected '" + label + ": ' and a number");
        label_value_ = trimmed(text_.substr(colon + 1, end - colon - 1));
        at_ = end;
        std::string point = label_value_;
        std::ranges::replace(point, ',', '.');
        return pbs::number_in(point).value_or(std::nan(""));
    }

    // All numbers to the end of the file, so many channels per frame, wherever the lines break. A minus sign begins a
    // number, too.
    void rows(std::size_t frames, int frames_line, std::vector<std::string>& remarks)
    {
        const int first_line = line_at(text_, at_) + 1;
        motion_.numbers.reserve(std::min(frames * motion_.channels, text_.size() / 2));
        for (std::string digits = word(); !digits.empty(); digits = word())
            for (std::size_t at = 0; at < digits.size();) {
                if (at > 0 && digits[at] != '-' && digits[at] != '+') refuse("motion", digits, "expected numbers");
                motion_.numbers.push_back(number_in(digits, at, frame_name()));
            }
        const std::size_t count = motion_.numbers.size(), rows = count / motion_.channels;
        if (rows == frames && rows * motion_.channels == count) return;
        const std::string expected = "expected Frames times channels: " + std::to_string(frames * motion_.channels);
        const bool is_off_by_one = rows + 1 == frames || rows == frames + 1;
        if (rows * motion_.channels != count || rows < 2 || !is_off_by_one)
            throw InputError(
                path_, first_line, "motion", std::to_string(count) + " numbers",
                expected + " (is the file cut off? a row has " + std::to_string(motion_.channels) + " numbers)");
        remarks.push_back(path_ + ":" + std::to_string(frames_line) + ": Frames = " + std::to_string(frames) +
                          ": the file has " + std::to_string(rows) + " rows, which are taken");
    }

    std::string frame_name() const { return "frame " + std::to_string(motion_.numbers.size() / motion_.channels); }

    const std::string& text_;
    std::string path_, label_value_;
    std::size_t at_ = 0;
    BvhMotion motion_;
};

// The rotation of a joint's channels in their order. In single precision, by assimp's own types, which read the clips
// of all records.
Eigen::Quaterniond rotation_of(const BvhJoint& joint, const float* row)
{
    aiMatrix3x3 rotation;
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
        aiMatrix4x4 turn;
        const float angle = row[joint.first_channel + c] * static_cast<float>(AI_MATH_PI) / 180.0F;
        switch (joint.channels[c]) {
            case 'X':
                aiMatrix4x4::RotationX(angle, turn);
                break;
            case 'Y':
                aiMatrix4x4::RotationY(angle, turn);
                break;
            case 'Z':
                aiMatrix4x4::RotationZ(angle, turn);
                break;
            default:
                continue;
        }
        rotation *= aiMatrix3x3(turn);
    }
    const aiQuaternion q(rotation);
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

// From the joint's parent; a position replaces the offset's number.
Vec3 place_of(const BvhJoint& joint, const float* row)
{
    Vec3 place = joint.offset;
    for (std::size_t c = 0; c < joint.channels.size(); ++c)
        if (const char channel = joint.channels[c]; channel >= 'x') place(channel - 'x') = row[joint.first_channel + c];
    return place;
}

// Some programs write no offsets, but the place of each joint in every frame.
void take_offsets_from_positions(BvhMotion& motion, const std::string& path, std::vector<std::string>& remarks)
{
    std::vector<std::string> names;
    for (BvhJoint& joint : motion.joints) {
        if (joint.parent < 0 || !joint.has_positions() || !joint.offset.isZero(0.0)) continue;
        joint.offset = place_of(joint, motion.numbers.data());
        if (!joint.offset.isZero(0.0)) names.push_back(joint.name);
    }
    if (!names.empty())
        remarks.push_back(path + ": " + std::to_string(names.size()) +
                          " joints have the offset 0 and positions in their channels; those of the first frame are "
                          "taken as offsets: " +
                          name_list(names));
    const bool has_extent = std::ranges::any_of(motion.joints, [](const BvhJoint& joint) {
        return joint.parent >= 0 && !joint.is_end && !joint.offset.isZero(0.0);
    });
    if (!has_extent && std::ranges::count(motion.joints, false, &BvhJoint::is_end) > 2)
        throw InputError(path, 0, "OFFSET", "0 0 0",
                         "expected joints apart from each other: export the clip with the offsets of its joints, or "
                         "with their positions");
}

// Some programs write the path of the hips for a joint above them as well, which has positions alone: it is the same in
// every frame, and would count twice.
void drop_repeated_paths(BvhMotion& motion, const std::string& path, std::vector<std::string>& remarks)
{
    constexpr double same_path = 1e-3;  // of its extent
    for (const BvhJoint& joint : motion.joints) {
        if (joint.parent < 0 || !joint.has_positions()) continue;
        const BvhJoint& above = motion.joints[joint.parent];
        if (!above.has_positions() || above.channels.find_first_of("XYZ") != std::string::npos) continue;
        const Vec3 first = place_of(joint, motion.numbers.data()), first_above = place_of(above, motion.numbers.data());
        double farthest_apart = 0.0, longest = 0.0;
        for (std::size_t row = 0; row < motion.rows(); ++row) {
            const float* numbers = motion.numbers.data() + row * motion.channels;
            const Vec3 moved = place_of(joint, numbers) - first;
            longest = std::max(longest, moved.norm());
            farthest_apart = std::max(farthest_apart, (moved - (place_of(above, numbers) - first_above)).norm());
        }
        if (longest == 0.0 || farthest_apart > same_path * longest) continue;
        for (std::size_t row = 0; row < motion.rows(); ++row)
            for (std::size_t c = 0; c < joint.channels.size(); ++c)
                if (const char channel = joint.channels[c]; channel >= 'x')
                    motion.numbers[row * motion.channels + joint.first_channel + c] =
                        static_cast<float>(first(channel - 'x'));
        remarks.push_back(path + ": " + joint.name + " and " + above.name +
                          " above it have the same path; it is taken once");
    }
}

Vec3 zero_place(const Clip& clip, const BvhJoint& joint)
{
    return joint.parent < 0 ? joint.offset : Vec3(clip.zero_pose.row(joint.parent).transpose() + joint.offset);
}

void add_frame(const BvhMotion& motion, const float* row, Clip& clip)
{
    std::vector<Eigen::Quaterniond> local, global;
    Positions places(static_cast<Eigen::Index>(motion.joints.size()), 3);
    for (std::size_t j = 0; j < motion.joints.size(); ++j) {
        const BvhJoint& joint = motion.joints[j];
        local.push_back(rotation_of(joint, row));
        const Vec3 place = place_of(joint, row);
        global.push_back(joint.parent < 0 ? local[j] : global[joint.parent] * local[j]);
        places.row(j) =
            joint.parent < 0 ? place : Vec3(places.row(joint.parent).transpose() + global[joint.parent] * place);
    }
    clip.local.push_back(std::move(local));
    clip.places.push_back(std::move(places));
}

}  // namespace

bool is_bvh(const std::string& text, const std::string& path)
{
    constexpr std::string_view first_word = "hierarchy";
    const std::size_t word =
        text.find_first_not_of(blanks, text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
    return lower_extension(path) == ".bvh" ||
           (word != std::string::npos && in_lower_case(text.substr(word, first_word.size())) == first_word);
}

Clip read_bvh(const std::string& text, const std::string& path)
{
    Clip clip;
    clip.name = path;
    BvhMotion motion = BvhParser(text, path).motion(clip.remarks);
    take_offsets_from_positions(motion, path, clip.remarks);
    drop_repeated_paths(motion, path, clip.remarks);
    clip.frame_time_s = motion.frame_time_s;
    clip.zero_pose.resize(static_cast<Eigen::Index>(motion.joints.size()), 3);
    std::set<std::string> seen;
    for (std::size_t j = 0; j < motion.joints.size(); ++j) {
        const BvhJoint& joint = motion.joints[j];
        if (!seen.insert(joint.name).second)
            throw InputError(path, 0, "JOINT", joint.name, "two joints have this name");
        clip.joints.push_back(joint.name);
        clip.parent.push_back(joint.parent);
        clip.zero_pose.row(j) = zero_place(clip, joint);
    }
    for (std::size_t row = 0; row < motion.rows(); ++row)
        add_frame(motion, motion.numbers.data() + row * motion.channels, clip);
    return clip;
}

}  // namespace pbs
