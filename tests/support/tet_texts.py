"""Writes tet meshes as text, number by number, so that any of the numbers can be wrong: points are triples and tets quadruples (from 0) of
whatever the file shall contain; `vertices` and `tets_told` are the counts that the file states."""


def rows(table):
    return "".join(" ".join(map(str, row)) + "\n" for row in table)


def shifted(tets):
    return [[vertex + 1 if isinstance(vertex, int) else vertex for vertex in tet] for tet in tets]


def msh(points, tets, vertices=None, tets_told=None):
    nodes = rows([(number, *point) for number, point in enumerate(points, 1)])
    elements = rows([(number, 4, 2, 1, 1, *tet) for number, tet in enumerate(shifted(tets), 1)])
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{vertices or len(points)}\n{nodes}$EndNodes\n"
            f"$Elements\n{tets_told or len(tets)}\n{elements}$EndElements\n")


def medit(points, tets, vertices=None, tets_told=None):
    nodes, elements = rows([(*point, 1) for point in points]), rows([(*tet, 1) for tet in shifted(tets)])
    return (f"MeshVersionFormatted 2\nDimension 3\nVertices\n{vertices or len(points)}\n{nodes}"
            f"Tetrahedra\n{tets_told or len(tets)}\n{elements}End\n")


def vtk(points, tets, vertices=None, tets_told=None):
    cells = tets_told or len(tets)
    return (f"# vtk DataFile Version 3.0\ntets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {vertices or len(points)} double\n{rows(points)}"
            f"CELLS {cells} {5 * cells}\n{rows([(4, *tet) for tet in tets])}CELL_TYPES {cells}\n{rows([(10,)] * len(tets))}")


def vtu(points, tets, vertices=None, tets_told=None):
    array = lambda name, kind, table, more="": f'<DataArray type="{kind}" Name="{name}" {more} format="ascii">\n{rows(table)}</DataArray>\n'
    return (f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
            f'<UnstructuredGrid><Piece NumberOfPoints="{vertices or len(points)}" NumberOfCells="{tets_told or len(tets)}">\n'
            f'<Points>{array("Points", "Float64", points, "NumberOfComponents=" + chr(34) + "3" + chr(34))}</Points>\n'
            f'<Cells>{array("connectivity", "Int64", tets)}{array("offsets", "Int64", [(4 * (t + 1),) for t in range(len(tets))])}'
            f'{array("types", "UInt8", [(10,)] * len(tets))}</Cells>\n</Piece></UnstructuredGrid></VTKFile>\n')


FORMATS = {".msh": msh, ".mesh": medit, ".vtk": vtk, ".vtu": vtu}
