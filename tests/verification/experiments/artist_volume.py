"""`pbskin measure MODEL`: the volume inside the artist's surface along the model's own animation. Reference: the file
format's skinning formula, computed from the bytes of the file by skin_formula.py and fbx_formula.py, and VTK's
vtkMassProperties. Tolerance: points differ by up to 1e-6 of the model's size, which changes the volume by up to this
times the surface's area."""
import os
import unittest

import numpy
import vtk

import fbx_formula
import program
import rig_files
import skin_formula
import written_frames

FRAMES = 5
INSTALLED = "/usr/share/assimp/models"
# With a number of frames that has each at a key: between the keys of three angles assimp turns the joints in another
# way than the format.
FBX_MODELS = {f"{INSTALLED}/FBX/animation_with_skeleton.fbx": 5, f"{INSTALLED}/FBX/huesitos.fbx": 40}


def volume_and_area(points, faces):
    """Inside a surface of triangles. The volume of polygons that are not flat would depend on how they are cut."""
    mass = vtk.vtkMassProperties()
    mass.SetInputData(written_frames.surface(points, faces))
    return mass.GetVolume(), mass.GetSurfaceArea()


def gltf_faces(model):
    """The triangles of all meshes, in the order of skin_formula.Model.points."""
    meshes = []
    for node in sorted(model.scene_nodes()):
        if "mesh" not in model.nodes[node]:
            continue
        faces, first = [], 0
        for primitive in model.document["meshes"][model.nodes[node]["mesh"]]["primitives"]:
            faces.append(model.numbers(primitive["indices"])[:, 0].astype(int).reshape(-1, 3) + first)
            first += len(model.numbers(primitive["attributes"]["POSITION"]))
        meshes.append((first, numpy.concatenate(faces)))
    ordered, first = [], 0
    for count, faces in sorted(meshes, key=lambda mesh: mesh[0], reverse=True):
        ordered += (faces + first).tolist()
        first += count
    return ordered


def fbx_faces(model):
    """The polygons of all geometries, cut from their first corners, in the order of fbx_formula.Model.points. The last
    corner of each is stored as its complement."""
    faces, first = [], 0
    for record in model.objects.values():
        if record.name != "Geometry" or not record.all("Vertices"):
            continue
        face = []
        for index in record.one("PolygonVertexIndex").values[0]:
            face.append(first + int(index if index >= 0 else ~index))
            if index < 0:
                faces += [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
                face = []
        first += len(record.one("Vertices").values[0]) // 3
    return faces


class ArtistVolume(program.ProgramTest):
    def compare(self, file, points_at, rest, faces, arguments=(), frames=FRAMES):
        """points_at: the points [m] at each time_s of the table; rest: those of the bind pose."""
        self.succeeds("measure", file, "--frames", frames, "--csv", self.path("v.csv"), *arguments)
        rest_m3, rest_m2 = volume_and_area(rest, faces)
        rows = self.rows("v.csv")
        self.assertEqual(len(rows), frames)
        for row in rows:
            points = points_at(float(row["time_s"]))
            volume_m3, area_m2 = volume_and_area(points, faces)
            tolerance_m3 = 1e-6 * numpy.linalg.norm(numpy.ptp(points, axis=0)) * area_m2
            self.assertAlmostEqual(float(row["volume_m3"]), volume_m3, delta=tolerance_m3)
            self.assertAlmostEqual(float(row["volume_change_pct"]), 100 * (volume_m3 / rest_m3 - 1),
                                   delta=200 * tolerance_m3 / rest_m3)
        return [float(row["volume_change_pct"]) for row in rows]

    def compare_gltf(self, file, animation=None):
        model = skin_formula.Model(file)
        begin, _ = model.span_s(animation)
        rest = numpy.concatenate([model.numbers(primitive["attributes"]["POSITION"])
                                  for mesh in model.document["meshes"] for primitive in mesh["primitives"]])
        return self.compare(file, lambda time_s: model.points(animation, begin + time_s), rest, gltf_faces(model),
                            () if animation is None else ("--animation", animation))

    def test_a_gltf_model(self):
        """The tube bends, and linear blending loses volume."""
        changes = self.compare_gltf(rig_files.write("plain", self.path("rig.glb")))
        self.assertLess(min(changes), -0.5)
        self.compare_gltf(rig_files.write("two_animations", self.path("rig.glb")), "Twist")
        self.compare_gltf(rig_files.write("spline", self.path("rig.glb")))

    @unittest.skipUnless(all(map(os.path.exists, FBX_MODELS)), "assimp-testmodels is not installed")
    def test_fbx_models(self):
        for file, frames in FBX_MODELS.items():
            with self.subTest(file):
                model = fbx_formula.Model(file)
                begin, _ = model.span_s()
                metres = model.metres_per_unit
                rest = metres * model.points(None, begin)
                self.compare(file, lambda time_s: metres * model.points(None, begin + time_s), rest, fbx_faces(model),
                             frames=frames)


if __name__ == "__main__":
    unittest.main()
