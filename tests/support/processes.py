"""The processes of this machine, from /proc."""
import os
import pathlib


def statuses():
    """Process -> (state, parent, session) of all processes."""
    found = {}
    for entry in os.listdir("/proc"):
        try:
            fields = pathlib.Path("/proc", entry, "stat").read_text().rsplit(")", 1)[1].split() if entry.isdigit() else None
        except OSError:  # the process has ended meanwhile
            continue
        if fields:
            found[int(entry)] = (fields[0], int(fields[1]), int(fields[3]))
    return found
