"""Writes meshes, number by number, so that any of the numbers can be wrong: points are triples and cells are tets or
triangles (from 0) of whatever the file shall contain; `points_told` and `cells_told` are the counts that the file
states. FORMATS lists the writers of tets, SURFACES those of triangles; `.msh 4.1` is a version of the format .msh."""
import io
import struct
import zipfile


def rows(table, before=""):
    return "".join(before + " ".join(map(str, row)) + "\n" for row in table)


def told(count, table):
    return len(table) if count is None else count


def shifted(cells):
    return [[vertex + 1 if isinstance(vertex, int) else vertex for vertex in cell] for cell in cells]


def packed(layout, table):
    return b"".join(struct.pack(layout, *row) for row in table)


def msh(points, cells, points_told=None, cells_told=None):
    nodes = rows([(number, *point) for number, point in enumerate(points, 1)])
    elements = rows([(number, 4, 2, 1, 1, *tet) for number, tet in enumerate(shifted(cells), 1)])
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{told(points_told, points)}\n{nodes}$EndNodes\n"
            f"$Elements\n{told(cells_told, cells)}\n{elements}$EndElements\n")


def medit(points, cells, points_told=None, cells_told=None):
    nodes, elements = rows([(*point, 1) for point in points]), rows([(*tet, 1) for tet in shifted(cells)])
    return (f"MeshVersionFormatted 2\nDimension 3\nVertices\n{told(points_told, points)}\n{nodes}"
            f"Tetrahedra\n{told(cells_told, cells)}\n{elements}End\n")


def vtk(points, cells, points_told=None, cells_told=None):
    count = told(cells_told, cells)
    return (f"# vtk DataFile Version 3.0\ntets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {told(points_told, points)} "
            f"double\n{rows(points)}CELLS {count} {5 * count}\n{rows([(4, *tet) for tet in cells])}CELL_TYPES {count}\n"
            f"{rows([(10,)] * len(cells))}")


def vtu(points, cells, points_told=None, cells_told=None):
    def array(name, kind, table, more=""):
        return f'<DataArray type="{kind}" Name="{name}" {more} format="ascii">\n{rows(table)}</DataArray>\n'

    return ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
            'header_type="UInt64">\n'
            f'<UnstructuredGrid><Piece NumberOfPoints="{told(points_told, points)}" '
            f'NumberOfCells="{told(cells_told, cells)}">\n'
            f'<Points>{array("Points", "Float64", points, "NumberOfComponents=" + chr(34) + "3" + chr(34))}</Points>\n'
            f'<Cells>{array("connectivity", "Int64", cells)}'
            f'{array("offsets", "Int64", [(4 * (t + 1),) for t in range(len(cells))])}'
            f'{array("types", "UInt8", [(10,)] * len(cells))}</Cells>\n</Piece></UnstructuredGrid></VTKFile>\n')


def tobj(points, cells):
    """A tet mesh of HOBAK."""
    return rows(points, "v ") + rows(cells, "t ")


def msh22_binary(points, cells, points_told=None, cells_told=None, one=1):
    header = struct.pack("<3i", 4, told(cells_told, cells), 2)
    return (b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", one) + b"\n$EndMeshFormat\n$Nodes\n%d\n"
            % told(points_told, points)
            + packed("<i3d", [(number, *point) for number, point in enumerate(points, 1)]) + b"\n$EndNodes\n"
            + b"$Elements\n%d\n" % told(cells_told, cells) + header
            + packed("<7i", [(number, 1, 1, *tet) for number, tet in enumerate(shifted(cells), 1)])
            + b"\n$EndElements\n")


def msh41(points, cells, points_told=None, cells_told=None, last_tag=None):
    """`last_tag` replaces the tag of the last vertex, also where tets use it."""
    count, tets = told(points_told, points), told(cells_told, cells)
    tags = [*range(1, len(points)), told(last_tag, points)]
    corner = lambda vertex: tags[vertex] if isinstance(vertex, int) and 0 <= vertex < len(tags) else vertex + 1
    return (f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {count} 1 {max(tags)}\n3 1 0 {count}\n"
            f"{rows([[tag] for tag in tags])}{rows(points)}$EndNodes\n$Elements\n1 {tets} 1 {tets}\n3 1 4 {tets}\n"
            f"{rows([(number, *map(corner, tet)) for number, tet in enumerate(cells, 1)])}$EndElements\n")


def msh41_binary(points, cells, points_told=None, cells_told=None):
    count, tets = told(points_told, points), told(cells_told, cells)
    nodes = struct.pack("<4Q3iQ", 1, count, 1, count, 3, 1, 0, count) + struct.pack(f"<{len(points)}Q",
                                                                                    *range(1, len(points) + 1))
    elements = struct.pack("<4Q3iQ", 1, tets, 1, tets, 3, 1, 4, tets)
    return (b"$MeshFormat\n4.1 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n" + nodes
            + packed("<3d", points)
            + b"\n$EndNodes\n$Elements\n" + elements
            + packed("<5Q", [(number, *tet) for number, tet in enumerate(shifted(cells), 1)])
            + b"\n$EndElements\n")


def obj(points, cells):
    return rows(points, "v ") + rows(shifted(cells), "f ")


def off(points, cells, points_told=None):
    return f"OFF\n{told(points_told, points)} {len(cells)} 0\n{rows(points)}{rows(cells, '3 ')}"


def ply_header(form, number, points, cells, points_told, cells_told):
    axes = "".join(f"property {number} {axis}\n" for axis in "xyz")
    return (f"ply\nformat {form} 1.0\nelement vertex {told(points_told, points)}\n{axes}"
            f"element face {told(cells_told, cells)}\nproperty list uchar int vertex_indices\nend_header\n")


def ply(points, cells, points_told=None, cells_told=None):
    return ply_header("ascii", "double", points, cells, points_told, cells_told) + rows(points) + rows(cells, "3 ")


def ply_binary(points, cells, points_told=None, cells_told=None, corners=3):
    header = ply_header("binary_little_endian", "float", points, cells, points_told, cells_told)
    return header.encode() + packed("<3f", points) + packed("<B3i", [(corners, *face) for face in cells])


def stl(points, cells):
    def facet(face):
        corners = rows([points[vertex] for vertex in face], "vertex ")
        return f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"

    return f"solid a\n{''.join(map(facet, cells))}endsolid a\n"


def stl_binary(points, cells, cells_told=None):
    facets = [(0, 0, 0, *(x for vertex in face for x in points[vertex]), 0) for face in cells]
    return b"\0" * 80 + struct.pack("<I", told(cells_told, cells)) + packed("<12fH", facets)


def dae(points, cells, count=None):
    count = 3 * len(points) if count is None else count
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
            '<asset><unit meter="1"/></asset><library_geometries><geometry id="g" name="g"><mesh><source id="p">'
            f'<float_array id="pa" count="{count}">{rows(points).replace(chr(10), " ").strip()}</float_array>'
            f'<technique_common><accessor source="#pa" count="{count // 3}" stride="3">{axes}</accessor>'
            '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            '<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>'
            f'<p>{rows(cells).replace(chr(10), " ").strip()}</p></triangles></mesh></geometry></library_geometries>'
            '<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>'
            '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>')


def zae(name="a.dae", content=None, **mesh):
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(name, dae(**mesh) if content is None else content)
    return archive.getvalue()


FORMATS = {".msh": msh, ".mesh": medit, ".vtk": vtk, ".vtu": vtu, ".tobj": tobj, ".msh 2.2 binary": msh22_binary,
           ".msh 4.1": msh41, ".msh 4.1 binary": msh41_binary}
SURFACES = {".obj": obj, ".off": off, ".ply": ply, ".stl": stl, ".dae": dae, ".zae": zae, ".ply binary": ply_binary,
            ".stl binary": stl_binary}
