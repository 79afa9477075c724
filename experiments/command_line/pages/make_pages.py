"""The manual pages, the manual of scene files and the completions of bash and zsh, written from the program's
description of itself.

    pbskin --describe > command_line.json
    # writes DIR/pbskin.1, pbskin-scene.5, scene_manual.md, pbskin, _pbskin
    python3 make_pages.py command_line.json DIR VERSION
"""
import json
import pathlib
import sys

import bash_completion
import man_page
import scene_manual
import zsh_completion

# What `pbskin list KIND` names, for words that may be such a name as well as a file.
listed = {("run", "scene"): "scenes", ("reproduce", "names"): "claims studies",
          ("explain", "name"): "claims studies metrics deformers terms"}


def main(description, folder, version):
    program = json.loads(description.read_text(encoding="utf-8"))
    for verb in program["verbs"]:
        for option in verb["options"]:
            option["listed"] = listed.get((verb["name"], option["name"]), "")
    folder.mkdir(parents=True, exist_ok=True)
    keys = program["scene_keys"]
    for name, text in (("pbskin.1", man_page.text(program, version)),
                       ("pbskin-scene.5", scene_manual.man(keys, version)),
                       ("scene_manual.md", scene_manual.markdown(keys)), ("pbskin", bash_completion.text(program)),
                       ("_pbskin", zsh_completion.text(program))):
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3])
