"""The tables of bad inputs, the files that all their cases may use, and the number of cases that run at once."""
import concurrent.futures

import bad_binaries
import bad_case
import bad_characters
import bad_clips
import bad_files
import bad_models
import bad_places
import bad_records
import bad_scenes
import bad_shapes
import bad_surfaces
import bad_tets
import foreign_arm
import tet_texts

COMMON = {"arm.vtu": tet_texts.vtu(bad_tets.POINTS, bad_tets.TETS), "arm.skeleton.toml": foreign_arm.SKELETON,
          "arm.toml": bad_characters.SCENE, "clip.toml": bad_scenes.CLIP_SCENE, "good.bvh": bad_scenes.CLIP}
TABLES = (bad_tets, bad_binaries, bad_surfaces, bad_shapes, bad_characters, bad_clips, bad_scenes, bad_files, bad_models, bad_places,
          bad_records)


def refused():
    return [case for table in TABLES for case in table.cases()]


def wrong_answers(cases):
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        return [problem for found in pool.map(lambda case: bad_case.problems(case, COMMON), cases) for problem in found]
