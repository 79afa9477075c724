#include "pbs/character/face_stream.hpp"

#include "pbs/geometry/number_text.hpp"

#include <map>

namespace pbs {
namespace {

int material_named(const JsonFile& model, const std::string& name)
{
    const auto& materials = model.at("materials");
    for (std::size_t m = 0; m < materials.size(); ++m)
        if (materials[m].is_object() && materials[m].value("DbgName", "") == name) return static_cast<int>(m);
    model.refuse("materials", "none is named " + name);
}

class FaceStream {
public:
    FaceStream(const JsonFile& model, Eigen::Index vertices) : model_(model), numbers_(model.numbers<int>("faces")), vertices_(vertices) {}

    bool ended() const { return at_ == numbers_.size(); }

    struct Face {
        std::vector<int> corners;  // three or four
        int material = -1;         // -1: none
    };
    Face next()
    {
        const int type = take();
        if (type < 0 || type > 255) refuse_last("expected a type, 0 to 255");
        Face face;
        const std::size_t corners = type & 1 ? 4 : 3;
        while (face.corners.size() < corners) {
            face.corners.push_back(take());
            if (face.corners.back() < 0 || face.corners.back() >= vertices_) refuse_last(expected_whole("a vertex", 0, vertices_ - 1));
        }
        if (type & 2) face.material = take();
        // Bits 4 to 128: texture, normal and colour, of the face and of its corners.
        const std::size_t once = !!(type & 4) + !!(type & 16) + !!(type & 64);
        const std::size_t at_corners = !!(type & 8) + !!(type & 32) + !!(type & 128);
        for (std::size_t i = 0; i < once + corners * at_corners; ++i) take();
        return face;
    }

private:
    int take()
    {
        if (ended()) model_.refuse("faces", "ends within a face");
        return numbers_[at_++];
    }

    [[noreturn]] void refuse_last(const std::string& rule) const { model_.refuse("faces[" + std::to_string(at_ - 1) + "]", rule); }

    const JsonFile& model_;
    std::vector<int> numbers_;
    Eigen::Index vertices_;
    std::size_t at_ = 0;
};

}  // namespace

SurfaceMesh surface_of_material(const JsonFile& model, const Positions& vertices, const std::string& material)
{
    const int wanted = material_named(model, material);
    std::vector<int> corners;  // of triangles
    FaceStream faces(model, vertices.rows());
    while (!faces.ended()) {
        const auto [face, its_material] = faces.next();
        if (its_material != wanted) continue;
        corners.insert(corners.end(), {face[0], face[1], face[2]});
        if (face.size() == 4) corners.insert(corners.end(), {face[0], face[2], face[3]});
    }
    if (corners.empty()) model.refuse("faces", "none is of the material " + material);

    std::map<int, int> kept;
    for (const int vertex : corners) kept[vertex] = 0;
    SurfaceMesh surface;
    surface.points.resize(static_cast<Eigen::Index>(kept.size()), 3);
    int count = 0;
    for (auto& [vertex, index] : kept) surface.points.row(index = count++) = vertices.row(vertex);
    for (int& vertex : corners) vertex = kept.at(vertex);
    surface.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    return surface;
}

}  // namespace pbs
