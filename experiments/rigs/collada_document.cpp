#include "experiments/rigs/collada_document.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/rigs/collada_xml.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <minizip/unzip.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace pbs {
namespace {

// The .dae files of an archive; none where it is damaged.
std::vector<std::string> collada_files_in(const std::string& path)
{
    std::vector<std::string> texts;
    unzFile archive = unzOpen(path.c_str());
    if (!archive) return texts;
    for (int state = unzGoToFirstFile(archive); state == UNZ_OK; state = unzGoToNextFile(archive)) {
        unz_file_info about{};
        char name[1024] = {};
        if (unzGetCurrentFileInfo(archive, &about, name, sizeof name - 1, nullptr, 0, nullptr, 0) != UNZ_OK) break;
        if (lower_extension(name) != ".dae" || unzOpenCurrentFile(archive) != UNZ_OK) continue;
        char buffer[1 << 14];
        std::string text;
        for (int count = 0; (count = unzReadCurrentFile(archive, buffer, sizeof buffer)) > 0;)
            text.append(buffer, static_cast<std::size_t>(count));
        unzCloseCurrentFile(archive);
        texts.push_back(std::move(text));
    }
    unzClose(archive);
    return texts;
}

// Nothing is added for words that are no whole numbers: the reader refuses the file.
std::vector<std::size_t> whole_numbers_of(std::string_view text)
{
    std::vector<std::size_t> numbers;
    for (const std::string_view word : words_of(text)) {
        std::size_t number = 0;
        if (std::from_chars(word.data(), word.data() + word.size(), number).ec == std::errc())
            numbers.push_back(number);
    }
    return numbers;
}

bool is_weight(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    double weight = std::numeric_limits<double>::quiet_NaN();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), weight);
    // nearly zero
    if (error == std::errc::result_out_of_range)
        return !word.starts_with('-') && word.find("e-") != std::string_view::npos;
    return end == word.data() + word.size() && std::isfinite(weight) && weight >= 0.0;
}

// The weight of each pair of a joint and a weight, with the point of the pair.
struct WeightIndices {
    std::string source;  // its name
    std::vector<std::pair<std::size_t, std::size_t>> point_and_weight;
};

WeightIndices weight_indices_of(const pugi::xml_node& vertex_weights)
{
    WeightIndices indices;
    std::size_t stride = 1, offset = 0;
    for (const pugi::xml_node input : vertex_weights.children("input")) {
        stride = std::max(stride, number_of(input, "offset") + 1);
        if (input.attribute("semantic").as_string() != std::string_view("WEIGHT")) continue;
        offset = number_of(input, "offset");
        indices.source = input.attribute("source").as_string();
    }
    const std::vector<std::size_t> counts = whole_numbers_of(vertex_weights.child("vcount").text().as_string());
    const std::vector<std::size_t> numbers = whole_numbers_of(vertex_weights.child("v").text().as_string());
    std::size_t at = offset;
    for (std::size_t point = 0; point < counts.size(); ++point)
        for (std::size_t pair = 0; pair < counts[point] && at < numbers.size(); ++pair, at += stride)
            indices.point_and_weight.emplace_back(point, numbers[at]);
    return indices;
}

void check_skin(const pugi::xml_node& controller, const std::string& path)
{
    const pugi::xml_node skin = controller.child("skin");
    const WeightIndices indices = weight_indices_of(skin.child("vertex_weights"));
    if (!indices.source.starts_with('#')) return;
    const pugi::xml_node source = skin.find_child_by_attribute("source", "id", indices.source.c_str() + 1);
    const pugi::xml_node accessor = source.child("technique_common").child("accessor");
    const std::vector<std::string_view> weights = words_of(source.child("float_array").text().as_string());
    const std::size_t first = number_of(accessor, "offset"), stride = number_of(accessor, "stride", 1);
    for (const auto& [point, index] : indices.point_and_weight) {
        const std::size_t at = first + stride * index;
        if (at < weights.size() && !is_weight(weights[at]))
            throw InputError(path, 0,
                             "controller " + std::string(controller.attribute("id").as_string()) +
                                 ", weight of point " + std::to_string(point),
                             std::string(weights[at]), "expected a finite number of 0 or more");
    }
}

// Used by an instance in the scene or in a node that can be instantiated.
void check_skins(const pugi::xml_document& document, const std::string& path)
{
    std::set<std::string> used;
    for (const pugi::xpath_node& node : document.select_nodes("//instance_controller"))
        used.insert(node.node().attribute("url").as_string());
    for (const pugi::xml_node library : document.child("COLLADA").children("library_controllers"))
        for (const pugi::xml_node controller : library.children("controller"))
            if (used.contains("#" + id_of(controller))) check_skin(controller, path);
}

// assimp takes a negative index of a polygon for 0 and goes on with a torn surface.
void refuse_negative_indices(const std::string& text, const std::string& path)
{
    for (std::size_t open = text.find("<p"); open != std::string::npos; open = text.find("<p", open + 1)) {
        if (text.find_first_of("> \t\r\n", open) != open + 2) continue;  // <param, ...
        const std::size_t begin = text.find('>', open), close = std::min(text.find('<', open + 1), text.size());
        const std::size_t minus = text.find('-', begin);
        if (minus >= close) continue;
        throw InputError(path, line_at(text, minus), "p",
                         text.substr(minus, text.find_first_of(" \t\r\n<", minus) - minus), "expected indices from 0");
    }
}

// Appends a word to an array of a source, and counts it.
void append(pugi::xml_node source, const char* array_name, const std::string& words, unsigned count)
{
    pugi::xml_node array = source.child(array_name), accessor = source.child("technique_common").child("accessor");
    array.text() = (array.text().as_string() + (" " + words)).c_str();
    array.attribute("count") = array.attribute("count").as_uint() + count;
    accessor.attribute("count") = accessor.attribute("count").as_uint() + 1;
}

constexpr const char* bind_shape_node = "bind-shape";

void use_a_node_for_the_bind_shape(pugi::xml_node skin, ColladaXml& document)
{
    pugi::xml_node vertex_weights = skin.child("vertex_weights"), indices = vertex_weights.child("v");
    std::size_t stride = 1, offset = 0;
    for (const pugi::xml_node input : vertex_weights.children("input")) {
        stride = std::max(stride, number_of(input, "offset") + 1);
        if (input.attribute("semantic").as_string() == std::string_view("JOINT")) offset = number_of(input, "offset");
    }
    const std::vector<std::string_view> words = words_of(indices.text().as_string());
    const auto is_bind_shape = [&](std::size_t w) { return w % stride == offset && words[w] == "-1"; };
    std::size_t points = 0;
    for (std::size_t w = 0; w < words.size(); ++w) points += is_bind_shape(w);
    if (points == 0) return;
    pugi::xml_node joints = document.source(skin.child("joints"), "JOINT"),
                   binds = document.source(skin.child("joints"), "INV_BIND_MATRIX");
    const char* array = joints.child("IDREF_array") ? "IDREF_array" : "Name_array";
    const std::string number = std::to_string(words_of(joints.child(array).text().as_string()).size());
    std::string text;
    for (std::size_t w = 0; w < words.size(); ++w) text += (is_bind_shape(w) ? number : std::string(words[w])) + " ";
    indices.text() = text.c_str();
    append(joints, array, bind_shape_node, 1);
    append(binds, "float_array", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", 16);
    document.remarks.push_back(std::to_string(points) + " weights of controller " + id_of(skin.parent()) +
                               " are those of joint -1, the bind shape, which no animation moves");
    document.is_changed = true;
}

void add_bind_shape_node(ColladaXml& document)
{
    for (pugi::xml_node library : document.root().children("library_visual_scenes"))
        for (pugi::xml_node scene : library.children("visual_scene")) {
            pugi::xml_node node = scene.append_child("node");
            for (const char* attribute : {"id", "sid", "name"}) node.append_attribute(attribute) = bind_shape_node;
            node.append_attribute("type") = "JOINT";
        }
}

// What uses a morph uses the mesh, or the skin, from which the morph departs.
void use_bases_of_morphs(ColladaXml& document)
{
    for (const pugi::xpath_node& found : document.root().select_nodes("library_controllers/controller[morph]")) {
        const std::string id = id_of(found.node()), base = found.node().child("morph").attribute("source").as_string();
        const bool is_mesh = document.target(base.c_str()).name() == std::string_view("geometry");
        for (const pugi::xpath_node& skin : document.root().select_nodes("library_controllers/controller/skin"))
            if (skin.node().attribute("source").as_string() == "#" + id) skin.node().attribute("source") = base.c_str();
        for (const pugi::xpath_node& instance : document.root().select_nodes("//instance_controller")) {
            if (instance.node().attribute("url").as_string() != "#" + id) continue;
            instance.node().attribute("url") = base.c_str();
            if (is_mesh) instance.node().set_name("instance_geometry");
        }
        found.node().parent().remove_child(found.node());
        document.remarks.push_back("the morph targets of controller " + id + " are left out");
        document.is_changed = true;
    }
}

// Moves nodes of library_nodes to where the scene instantiates them, if that is one place: their joints are found by
// their names.
void move_nodes_into_the_scene(ColladaXml& document)
{
    std::map<std::string, std::vector<pugi::xml_node>> instances;
    for (const pugi::xpath_node& found : document.root().select_nodes("//instance_node"))
        instances[found.node().attribute("url").as_string()].push_back(found.node());
    for (const auto& [url, places] : instances) {
        pugi::xml_node node = document.target(url.c_str()), place = places.front();
        if (places.size() != 1 || node.name() != std::string_view("node") ||
            node.parent().name() != std::string_view("library_nodes"))
            continue;
        bool is_below_itself = false;
        for (pugi::xml_node above = place; above; above = above.parent())
            is_below_itself = is_below_itself || above == node;
        if (is_below_itself) continue;
        pugi::xml_node parent = place.parent();
        parent.remove_child(place);
        parent.append_move(node);
        document.is_changed = true;
    }
}

// Gives the joints of a skeleton, and those that a controller names, names that no other skeleton has.
void rename_joints(pugi::xml_node controller, const std::vector<pugi::xml_node>& skeletons, const std::string& suffix,
                   ColladaXml& document)
{
    pugi::xml_node skin = controller.child("skin"), joints = document.source(skin.child("joints"), "JOINT");
    if (!joints.child("Name_array"))
        throw InputError(
            document.path(), 0, "controller " + id_of(controller) + ", joints", id_of(joints),
            "expected names that are sought in each skeleton (Name_array), since the controller has two: copy the "
            "controller, or export glTF 2.0 (.glb)");
    std::set<std::string> names;
    std::string renamed;
    for (const std::string_view name : words_of(joints.child("Name_array").text().as_string())) {
        names.emplace(name);
        renamed += std::string(name) + (name == bind_shape_node ? "" : suffix) + " ";
    }
    pugi::xml_node own = skin.find_child_by_attribute("source", "id", id_of(joints).c_str());
    const std::string id = id_of(joints) + suffix, array = id + "-array";
    own.attribute("id") = id.c_str();
    own.child("Name_array").attribute("id") = array.c_str();
    own.child("Name_array").text() = renamed.c_str();
    own.child("technique_common").child("accessor").attribute("source") = ("#" + array).c_str();
    for (const pugi::xpath_node& input : skin.select_nodes(".//input[@semantic='JOINT']"))
        input.node().attribute("source") = ("#" + id).c_str();
    for (const pugi::xml_node& skeleton : skeletons)
        for (const pugi::xpath_node& node : skeleton.select_nodes("descendant-or-self::node[@sid]"))
            if (pugi::xml_attribute sid = node.node().attribute("sid"); names.contains(sid.as_string()))
                sid = (sid.as_string() + suffix).c_str();
}

// Each skeleton of a controller gets a controller of its own, since assimp seeks joints in the whole scene.
void use_one_controller_per_skeleton(ColladaXml& document)
{
    // of each controller: the copy for each set of skeletons
    std::map<std::string, std::map<std::string, std::string>> urls_of;
    for (const pugi::xpath_node& found : document.root().select_nodes("//instance_controller")) {
        const std::string url = found.node().attribute("url").as_string();
        std::string names;
        std::vector<pugi::xml_node> skeletons;
        for (const pugi::xml_node skeleton : found.node().children("skeleton")) {
            names += skeleton.text().as_string();
            skeletons.push_back(document.target(skeleton.text().as_string()));
        }
        pugi::xml_node controller = document.target(url.c_str());
        if (!controller.child("skin")) continue;
        std::map<std::string, std::string>& known = urls_of[url];
        const std::string suffix = "-" + std::to_string(known.size() + 1);
        const auto [own, is_new] = known.emplace(names, known.empty() ? url : url + suffix);
        if (!is_new) found.node().attribute("url") = own->second.c_str();
        if (!is_new || own->second == url) continue;
        pugi::xml_node copy = controller.parent().insert_copy_after(controller, controller);
        copy.attribute("id") = (id_of(controller) + suffix).c_str();
        found.node().attribute("url") = own->second.c_str();
        rename_joints(copy, skeletons, suffix, document);
        document.is_changed = true;
    }
}

// No numbers where a word is none, as 2,5: the document stays as it is for the reader, which refuses it.
Positions rows_of_three(const pugi::xml_node& array)
{
    const std::vector<std::string_view> words = words_of(array.text().as_string());
    Positions rows(static_cast<Eigen::Index>(words.size() / 3), 3);
    for (Eigen::Index i = 0; i < rows.size(); ++i) {
        const std::string_view word = words[static_cast<std::size_t>(i)];
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), rows(i / 3, i % 3));
        if (error != std::errc() || end != word.data() + word.size()) return {};
    }
    return rows;
}

void move_far_points_to_the_origin(ColladaXml& document, ColladaDocument& result)
{
    constexpr double far_away = 100.0;  // sizes; nearer, single precision has an error below 1e-5 of the size
    bool has_far = false;
    for (const pugi::xpath_node& found : document.root().select_nodes("library_geometries/geometry[@id]/mesh")) {
        const std::string id = id_of(found.node().parent());
        const auto [entry, is_new] = result.origins.try_emplace(id, Vec3::Zero());
        if (!is_new)
            throw InputError(document.path(), 0, "geometry", id, "two have this id: expected one id per geometry");
        const pugi::xml_node source = document.source(found.node().child("vertices"), "POSITION");
        const pugi::xml_node accessor = source.child("technique_common").child("accessor");
        const Positions points = rows_of_three(source.child("float_array"));
        if (points.rows() == 0 || !points.allFinite() || number_of(accessor, "stride", 1) != 3 ||
            number_of(accessor, "offset") != 0)
            continue;
        const double size = diagonal_m(points);
        if (points.cwiseAbs().maxCoeff() <= far_away * size) continue;
        std::string text;
        const Positions near = points.rowwise() - points.row(0);
        for (const double number : near.reshaped<Eigen::RowMajor>()) text += number_text(number, 17) + " ";
        source.child("float_array").text() = text.c_str();
        entry->second = points.row(0);
        has_far = true;
    }
    pugi::xml_attribute unit = document.root().child("asset").child("unit").attribute("meter");
    if (!has_far) return result.origins.clear();
    document.is_changed = true;
    if (!(unit.as_double() > 0.0)) return;
    result.unit_m = unit.as_double();
    unit = "1";
}

ColladaDocument prepared(pugi::xml_document& xml, const std::string& path)
{
    ColladaXml document(xml, path);
    move_nodes_into_the_scene(document);
    use_bases_of_morphs(document);
    bool has_bind_shape = false;
    for (const pugi::xpath_node& found : document.root().select_nodes("library_controllers/controller/skin")) {
        const std::size_t before = document.remarks.size();
        use_a_node_for_the_bind_shape(found.node(), document);
        has_bind_shape = has_bind_shape || document.remarks.size() > before;
    }
    if (has_bind_shape) add_bind_shape_node(document);
    use_one_controller_per_skeleton(document);
    make_curves_linear(document);
    check_skins(xml, path);
    ColladaDocument result;
    move_far_points_to_the_origin(document, result);
    result.remarks = document.remarks;
    if (!document.is_changed) return result;
    std::ostringstream text;
    xml.save(text, "", pugi::format_raw);
    result.text = text.str();
    return result;
}

}  // namespace

ColladaDocument read_collada_document(const std::string& path)
{
    const bool is_archive = content_extension(path) == ".zae";
    const std::vector<std::string> texts =
        is_archive ? collada_files_in(path) : std::vector{read_text_file(path, most_mesh_bytes)};
    ColladaDocument result;
    for (const std::string& text : texts) {
        refuse_negative_indices(text, path);
        pugi::xml_document document;
        result = document.load_buffer(text.data(), text.size()) ? prepared(document, path) : ColladaDocument{};
        if (texts.size() > 1 && !result.text.empty())
            throw InputError(path, 0, "documents", std::to_string(texts.size()),
                             "expected one in an archive with curves, skins, morphs or places that assimp reads in "
                             "another way: unpack it, and "
                             "use the .dae");
    }
    return result;
}

}  // namespace pbs
