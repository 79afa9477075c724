"""What a trial leaves: the .glb files, judged by the rules of glTF 2.0 and by the model's own bytes, the artist's surface as a control for
every kind of motion, and no frames for ParaView unless they were asked for."""
import glob
import os
import unittest

import numpy

import foreign_arm
import program
import rig_files
import skin_formula
from written_frames import points_of

PNG = b"\x89PNG\r\n\x1a\nof a test"
UV = numpy.linspace(0, 1, 2 * len(rig_files.tube()[0])).reshape(-1, 2)
FRAMES = 3


def painted(path):
    """The plain rig with normals, texture coordinates, two materials, an image in the file and one that is nowhere."""
    gltf = rig_files.Gltf()
    gltf.document, gltf.bytes = rig_files.rig()
    points, triangles = rig_files.tube()
    first = gltf.document["meshes"][0]["primitives"][0]
    first["attributes"]["NORMAL"] = gltf.put(points / numpy.linalg.norm(points, axis=1).clip(1e-9)[:, None], "VEC3", rig_files.FLOAT)
    first["attributes"]["TEXCOORD_0"] = gltf.put(UV, "VEC2", rig_files.FLOAT)
    parts = [gltf.put(part.reshape(-1, 1), "SCALAR", rig_files.UNSIGNED_INT) for part in (triangles[:100], triangles[100:])]
    gltf.document["meshes"][0]["primitives"] = [{"attributes": dict(first["attributes"]), "indices": indices, "material": material}
                                                for indices, material in zip(parts, (1, 0))]
    view = gltf.document["accessors"][gltf.put(numpy.frombuffer(PNG, "u1"), "SCALAR", rig_files.UNSIGNED_BYTE)]["bufferView"]
    gltf.document.update(images=[{"bufferView": view, "mimeType": "image/png"}, {"uri": "nowhere.png"}],
                         textures=[{"source": 0}, {"source": 1}], materials=[
                             {"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": n}}} for n, name in enumerate("ab")])
    with open(path, "wb") as file:
        file.write(rig_files.glb({**gltf.document, "buffers": [{"byteLength": len(gltf.bytes)}]}, gltf.bytes))
    return path


class TrialOutput(program.ProgramTest):
    def tried(self, model, *arguments):
        process = self.succeeds("try", model, "-o", self.path("out"), "--no-reference", "--frames", FRAMES, "--vertices", "300", *arguments)
        return self.json("out", "try.json"), process.stdout + process.stderr

    def check_rules(self, model):
        """Khronos: lengths, alignment, bounds, indices, counts."""
        document, (buffer,) = model.document, model.document["buffers"]
        self.assertEqual(len(model.buffers[0]), buffer["byteLength"])
        for view in document["bufferViews"]:
            self.assertLessEqual(view.get("byteOffset", 0) + view["byteLength"], buffer["byteLength"])
        for number, accessor in enumerate(document["accessors"]):
            self.assertEqual(document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) % 4, 0)
            if "min" in accessor:
                self.assertEqual(model.numbers(number).min(axis=0).tolist(), accessor["min"])
                self.assertEqual(model.numbers(number).max(axis=0).tolist(), accessor["max"])
        for primitive in document["meshes"][0]["primitives"]:
            points = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
            self.assertLess(model.numbers(primitive["indices"]).max(), points)
            for of in (primitive["attributes"], *primitive["targets"]):
                self.assertTrue(all(document["accessors"][accessor]["count"] == points for accessor in of.values()))
                self.assertIn("min", document["accessors"][of["POSITION"]])

    def test_the_glb_has_the_artists_look_and_the_frames_are_gone(self):
        source = skin_formula.Model(painted(self.path("rig.glb")))
        _, printed = self.tried(self.path("rig.glb"))
        self.assertIn("left out of the .glb files: image nowhere.png: expected PNG or JPEG", printed)
        self.assertRegex(printed, r"out: [0-9.]+ MB in \d+ files, without frames for ParaView")
        kept = {os.path.relpath(file, self.path("out")) for file in glob.glob(self.path("out", "*", "*"))}
        self.assertEqual({os.path.splitext(file)[1] for file in kept if file.startswith("frames")}, {".glb"})
        self.assertEqual(sum(file.endswith(".vtp") for file in kept), FRAMES)
        for name in ("lbs", "pbs"):
            model = skin_formula.Model(self.path("out", "frames", f"{name}.glb"))
            self.check_rules(model)
            self.assertEqual([material["name"] for material in model.document["materials"]], ["a", "b"])
            self.assertIn(PNG, model.buffers[0])
            parts = {part["material"]: part for part in model.document["meshes"][0]["primitives"]}
            for own in source.document["meshes"][0]["primitives"]:
                part, count = parts[own["material"]], len(UV)
                found, wanted = model.numbers(part["indices"]), source.numbers(own["indices"])
                shift = count if own["material"] == 0 else 0  # the second primitive has points of its own
                self.assertEqual(found.ravel().tolist(), (wanted + shift).ravel().tolist())
                uv = model.numbers(part["attributes"]["TEXCOORD_0"])
                self.assertEqual(uv.tolist(), numpy.tile(source.numbers(own["attributes"]["TEXCOORD_0"]), (2, 1)).tolist())
                normals = [model.numbers(part["attributes"]["NORMAL"])]
                normals += [normals[0] + model.numbers(target["NORMAL"]) for target in part["targets"]]
                self.assertLess(abs(numpy.linalg.norm(normals, axis=2) - 1).max(), 1e-6)  # single precision

    def test_a_bend_has_the_artists_surface_too(self):
        facts, _ = self.tried(rig_files.write("no_animation", self.path("rig.glb")))
        self.assertEqual((facts["control"], facts["motion"]["time_zero_s"]), ("skin/artist_*.vtp", 0.0))
        rest, (weights, place) = rig_files.tube()[0], (rig_files.weights_of(rig_files.tube()[0]), numpy.array(rig_files.PLACES[1]))
        with open(self.path("out", "scene.toml"), encoding="utf-8") as file:
            axis = numpy.array(next(line for line in file if line.startswith("axis")).split("=")[1].strip(" []\n").split(","), dtype=float)
        for frame in range(FRAMES):
            turn = skin_formula.quaternion_matrix(numpy.array(rig_files.turn(axis, 60.0 * frame / (FRAMES - 1))))
            moved = (rest - place) @ turn.T + place
            expected = weights[:, :1] * rest + (1 - weights[:, :1]) * moved
            self.assertLess(abs(points_of(self.path("out", "skin", f"artist_{frame:06}.vtp")) - expected).max(), 1e-6)  # single precision

    def test_a_clip_has_the_artists_surface_too_and_paraview_keeps_the_frames(self):
        joints = ["root", "elbow", "tip"]
        clip = foreign_arm.bvh(joints, [["0 0 0", *([f"{20 * frame} 0 0"] * 3)] for frame in range(4)], 0.1, 0.3)
        facts, _ = self.tried(rig_files.write("plain", self.path("rig.glb")), "--animation", self.write("walk.bvh", clip), "--paraview")
        self.assertAlmostEqual(facts["motion"]["time_zero_s"], 0.1)  # after the T pose
        artist, lbs = ([points_of(file) for file in sorted(glob.glob(self.path("out", *name)))]
                       for name in (("skin", "artist_*.vtp"), ("frames", "lbs_surface_*.vtp")))
        self.assertEqual(len(artist), FRAMES)
        self.assertGreater(abs(artist[-1] - artist[0]).max(), 0.01)
        self.assertLess(max(numpy.linalg.norm(one - other, axis=1).max() for one, other in zip(artist, lbs)), 0.015)  # 1 m; carried by tets


if __name__ == "__main__":
    unittest.main()
