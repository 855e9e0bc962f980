#!/usr/bin/python3
"""Runs clang-tidy on sources, several of them at a time.

Nine tenths of its time go into the headers that a source includes. Sources of one folder are therefore read as one unit,
which includes them all. Where they do not go together (two of them have an internal function of one name, say) the unit is
halved; what is found is the same.

  run_tidy.py [--jobs N] BUILD SOURCE...      BUILD: folder with compile_commands.json

Exit status: 0 nothing found, 1 findings (printed), 2 usage.
"""
import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LARGEST_UNIT = 12  # sources: one of them fewer is not noticed, and a unit that fails costs as much as it has
# Sources that are read several times, once per instruction set, or define macros for what is.
ALONE = re.compile(r"foreach_target|-inl\.h")


def clang_flags():
    """clang reads the commands of g++: it finds g++'s omp.h only if told where, and its own warnings are not errors here."""
    include = subprocess.run(["g++", "-print-file-name=include"], check=True, text=True, stdout=subprocess.PIPE)
    return ["-Wno-error", "-Wno-unknown-warning-option", "-idirafter", include.stdout.strip()]


def read_commands(build):
    """{absolute path: (folder, arguments without compiler, output and source)}"""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = [w for w in shlex.split(entry["command"]) if not w.endswith("ccache")][1:]
        kept, skip = [], False
        for word in words:
            if skip or word in ("-c", entry["file"]):
                skip = False
            elif word == "-o":
                skip = True
            else:
                kept.append(word)
        commands[os.path.realpath(entry["file"])] = (entry["directory"], kept)
    return commands


def units_of(sources, commands):
    """Sources of one folder with the same settings, in lists."""
    together, units = defaultdict(list), []
    for source in sources:
        if source not in commands:
            sys.exit(f"run_tidy.py: {source} is not among the commands of the build")
        if ALONE.search(Path(source).read_text(encoding="utf-8")):
            units.append([source])
        else:
            together[os.path.dirname(source), *commands[source][1]].append(source)
    for members in together.values():
        n_units = -(-len(members) // LARGEST_UNIT)
        units += [members[k::n_units] for k in range(n_units)]
    return sorted(units, key=len, reverse=True)


def tidy(path, command, flags):
    """(whether it could be read, what was found)"""
    folder, arguments = command
    run = subprocess.run(
        ["clang-tidy", "--quiet", "--warnings-as-errors=*", r"--header-filter=/(dd|fem|coupling)/.*\.(h|cc)$", path,
         "--", *arguments, *flags], cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lines = [l for l in run.stdout.splitlines(keepends=True) if not l.rstrip().endswith(("warnings generated.",
                                                                                       "warning generated."))]
    return "clang-diagnostic-error" not in run.stdout, "".join(lines) if run.returncode != 0 else ""


def check_unit(unit, commands, flags, folder):
    """What is found in the sources of a unit; if they do not go together, in its halves."""
    if len(unit) == 1:
        return tidy(unit[0], commands[unit[0]], flags)[1]
    with tempfile.NamedTemporaryFile("w", suffix=".cc", dir=folder) as file:
        file.writelines(f'#include "{source}" // NOLINT(bugprone-suspicious-include)\n' for source in unit)
        file.flush()
        readable, found = tidy(file.name, commands[unit[0]], flags)
    if readable:
        return found
    return "".join(check_unit(half, commands, flags, folder) for half in (unit[0::2], unit[1::2]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("build", type=Path)
    parser.add_argument("sources", nargs="+")
    arguments = parser.parse_args()
    commands, flags = read_commands(arguments.build), clang_flags()
    units = units_of([os.path.realpath(s) for s in arguments.sources], commands)
    clean = True
    # In the folder of the build: clang-tidy looks for its settings above a file.
    with tempfile.TemporaryDirectory(dir=arguments.build) as folder, ThreadPoolExecutor(arguments.jobs) as pool:
        for found in pool.map(lambda unit: check_unit(unit, commands, flags, folder), units):
            if found:
                clean = False
                print(found, end="", flush=True)
    return 0 if clean else 1


if __name__ == "__main__":
    sys.exit(main())
