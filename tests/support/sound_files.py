"""The sound files from which bad inputs are made: name -> (writer, its arguments). A writer makes the text or the bytes
of a file."""
import json

import foreign_arm
import mesh_texts
import rig_files

NOISE = bytes((i * i * 7919 + i * 31) % 256 for i in range(4000))
SCENE = foreign_arm.SCENE.replace("arm.msh", "arm.vtu")
LIMB_SCENE = ('schema = 1\n[character]\nbody = "limb"\n[motion]\njoint = "forearm"\n'
              "[pbs]\nk_stretch = 0.2\nk_volume = 1.0\nk_bind = 1.0\ngravity_m_s2 = [0.0, 0.0, 0.0]\n")
CLIP_SCENE = SCENE.replace('joint = "elbow"\naxis = [0.0, 0.0, 1.0]\nangle_deg = 120.0\nframes = 5\n',
                           'clip = "good.bvh"\n')
CORNERS, FACES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
ROW = "0 0 0 0 0 0 10 20 30\n"


def arm(cells):
    """Points and tets of positive volume."""
    points, tets = foreign_arm.mesh(cells)

    def six_volumes(tet):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = ([x - y for x, y in zip(points[vertex], points[tet[0]])]
                                                    for vertex in tet[1:])
        return (ay * bz - az * by) * cx + (az * bx - ax * bz) * cy + (ax * by - ay * bx) * cz

    return points, [tet if six_volumes(tet) > 0.0 else [tet[1], tet[0], *tet[2:]] for tet in tets]


POINTS, TETS = arm((4, 2, 2))
WEIGHTS = "vertex,joint,weight\n" + "".join(f"{v},shoulder,0.5\n{v},elbow,0.5\n" for v in range(len(POINTS)))


def bvh(frames="2", time="0.01", motion=2 * ROW, root="shoulder", child="elbow", offset="1 0 0"):
    return (f"HIERARCHY\nROOT {root}\n{{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
            "Xrotation\n"
            f" JOINT {child}\n {{\n  OFFSET {offset}\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
            f"  End Site\n  {{\n   OFFSET 1 0 0\n  }}\n }}\n}}\n"
            f"MOTION\nFrames: {frames}\nFrame Time: {time}\n{motion}")


def surface(points, triangles):
    """The document and the buffer of a glTF file."""
    gltf = rig_files.Gltf()
    place = gltf.put(points, "VEC3", rig_files.FLOAT)
    indices = gltf.put([[vertex] for face in triangles for vertex in face], "SCALAR", rig_files.UNSIGNED_SHORT)
    gltf.document["meshes"].append({"primitives": [{"attributes": {"POSITION": place}, "indices": indices}]})
    gltf.node(mesh=0)
    return gltf.written()


def clip():
    """A shoulder and an elbow that turns."""
    gltf = rig_files.Gltf()
    elbow = gltf.node(gltf.node(name="shoulder"), name="elbow", translation=[1.0, 0.0, 0.0])
    turns = [rig_files.turn((0, 0, 1), degrees) for degrees in (0, 90, 0)]
    rig_files.add_animation(gltf, "Bend", [(elbow, "rotation", [0.0, 0.5, 1.0], turns, "LINEAR")])
    return gltf.written()


def models(name, document_and_data):
    """The two formats of a glTF file."""
    arguments = dict(zip(("document", "data"), document_and_data))
    return {name + ".gltf": (rig_files.gltf, arguments), name + ".glb": (rig_files.glb, arguments)}


def text(name, content):
    return {name: (lambda: content, {})}


PLAN = {"schema": 1, "extent": "quick", "runs": [{"name": "limb", "cost_s": 1}, {"name": "human", "cost_s": 1}],
        "left_out": []}
MEASUREMENTS = ("claim,quantity,body,value,low,high,unit\nC07,linear_drift,limb,1e-6,1e-6,1e-6,1\n"
                "C07,linear_drift,bar,2e-6,2e-6,2e-6,1\n")
RUN = json.dumps({"schema": 3, "provenance": {}})
FAR = [*POINTS, *[(x + 3.0, y, z) for x, y, z in POINTS]], [*TETS,
                                                            *[[vertex + len(POINTS) for vertex in tet] for tet in TETS]]
SOUND = {
    **{name: (write, {"points": POINTS, "cells": TETS}) for name, write in mesh_texts.FORMATS.items()},
    **{name: (write, {"points": CORNERS, "cells": FACES}) for name, write in mesh_texts.SURFACES.items()},
    **models("", surface(CORNERS, FACES)), **models("rig", rig_files.rig()), **models("clip", clip()),
    "two arms.vtu": (mesh_texts.vtu, dict(zip(("points", "cells"), FAR))),
    "other tets.vtu": (mesh_texts.vtu,
                       {"points": POINTS, "cells": [[7 - v if v in (0, 7) else v for v in tet] for tet in TETS]}),
    "longer.vtu": (mesh_texts.vtu, dict(zip(("points", "cells"), foreign_arm.mesh((5, 2, 2))))),
    "bvh": (bvh, {}), "clip.bvh": (bvh, {"frames": "3", "motion": 3 * ROW}),
    "plan": (lambda **plan: json.dumps(plan), PLAN),
    **text("skeleton", foreign_arm.SKELETON), **text("weights", WEIGHTS), **text("scene", SCENE),
    **text("limb scene", LIMB_SCENE), **text("fbx", b"Kaydara FBX Binary  \x00\x1a\x00\xe8\x1c\x00\x00"),
    **text("measurements", MEASUREMENTS), **text("run", RUN),
    **text("node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"), **text("ele", "1 4 0\n1 1 2 3 4\n"),
}
# the files that every case may use, and the records of a study
COMMON = {"arm.vtu": mesh_texts.vtu(POINTS, TETS), "arm.skeleton.toml": foreign_arm.SKELETON, "arm.toml": SCENE,
          "clip.toml": CLIP_SCENE, "good.bvh": bvh("3", motion=3 * ROW)}
STUDY = {"plan.json": json.dumps(PLAN), **{f"{run}/{file}": content for run in ("limb", "human")
                                           for file, content in (("run.json", RUN),
                                                                 ("measurements.csv", MEASUREMENTS))}}
