// The elements of a COLLADA document by their ids, for those that change it before assimp reads it.
#pragma once

#include <pugixml.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pbs {

inline std::vector<std::string_view> words_of(std::string_view text)
{
    constexpr const char* spaces = " \t\r\n";
    std::vector<std::string_view> words;
    for (std::size_t at = text.find_first_not_of(spaces); at != std::string_view::npos;
         at = text.find_first_not_of(spaces, at)) {
        const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

inline std::size_t number_of(const pugi::xml_node& node, const char* attribute, unsigned missing = 0)
{
    return node.attribute(attribute).as_uint(missing);
}

inline std::string id_of(const pugi::xml_node& node)
{
    return node.attribute("id").as_string();
}

// The elements of a document by their ids, and what was changed in it.
class ColladaXml {
public:
    ColladaXml(pugi::xml_document& document, const std::string& path) : root_(document.child("COLLADA")), path_(path)
    {
        for (const pugi::xpath_node& node : document.select_nodes("//*[@id]"))
            by_id_.emplace(id_of(node.node()), node.node());
    }

    pugi::xml_node root() const { return root_; }
    const std::string& path() const { return path_; }
    std::vector<std::string> remarks;
    bool is_changed = false;

    // What a reference such as "#arm" refers to; null where it is not in the document.
    pugi::xml_node target(const char* reference) const
    {
        const auto found = *reference == '#' ? by_id_.find(reference + 1) : by_id_.end();
        return found == by_id_.end() ? pugi::xml_node() : found->second;
    }

    // The source of a sampler's or a skin's input; null where it has none of this meaning.
    pugi::xml_node source(const pugi::xml_node& parent, const char* semantic) const
    {
        return target(parent.find_child_by_attribute("input", "semantic", semantic).attribute("source").as_string());
    }

private:
    pugi::xml_node root_;
    std::string path_;
    std::map<std::string, pugi::xml_node> by_id_;
};

// Puts linear curves in place of those that assimp would read as linear although they are not: collada_document.hpp.
void make_curves_linear(ColladaXml& document);

}  // namespace pbs
