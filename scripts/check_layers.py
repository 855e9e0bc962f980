#!/usr/bin/python3
"""Checks that the folders see only what they may see (see docs/architecture.md).

  dd/        never deal.II, fem/, coupling/
  fem/       never dd/, coupling/
  coupling/  both of them
  tests/dd and tests/fem follow the folder they test; nothing includes tests/, benchmarks/, examples/ or samples/ from
  outside, but for samples/, which tests and benchmarks share.

Two independent readings: the #include lines of the sources and the libraries named in the CMakeLists.txt of a layer;
and, with --build DIR, the dependencies that the compiler reported for every object (`ninja -t deps`), which also sees
what arrives through other headers.

  check_layers.py [--source DIR] [--build DIR [--ninja PROGRAM]]
  check_layers.py --self-test      fake trees with one violation each must fail, a clean one must pass

Exit status: 0 clean, 1 violations (one line each), 2 usage.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DEAL_II = "deal.II"
NO_PRODUCT = {"tests", "benchmarks", "examples", "samples"}
# folder -> first path components it must not see
FORBIDDEN = {
    "dd": {DEAL_II, "fem", "coupling"} | NO_PRODUCT,
    "fem": {"dd", "coupling"} | NO_PRODUCT,
    "coupling": NO_PRODUCT,
    "tests/dd": {DEAL_II, "fem", "coupling"},
    "tests/fem": {"dd", "coupling"},
}
# folder -> what its CMakeLists.txt must not name
FORBIDDEN_LIBRARIES = {
    "dd": re.compile(r"deal\.?ii\b|DEAL_II|ddfem(::|_)(fem|coupling)\b", re.IGNORECASE),
    "fem": re.compile(r"ddfem(::|_)(dd|coupling)\b"),
}
SOURCES = {".h", ".hpp", ".cc", ".cpp", ".inc"}
BLOCK_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def is_below(path, folder):
    return path == folder or path.startswith(folder + os.sep)


def layer_of_include(delimiter, name, file, source):
    """First path component an include leads to, as far as the text tells: a relative path is followed."""
    if delimiter == '"' and (name.startswith(".") or (file.parent / name).exists()):
        target = os.path.normpath(file.parent / name)
        if is_below(target, str(source)):
            return Path(target).relative_to(source).parts[0]
    return name.split("/")[0]


def blank(match):
    """As many newlines as the comment had, so that line numbers stay right."""
    return "\n" * match.group().count("\n")


def check_sources(source):
    violations = []
    for folder, forbidden in FORBIDDEN.items():
        for file in sorted((source / folder).rglob("*")):
            if file.suffix not in SOURCES or not file.is_file():
                continue
            text = BLOCK_COMMENT.sub(blank, file.read_text(encoding="utf-8", errors="replace"))
            for match in INCLUDE.finditer(text):
                layer = layer_of_include(match[1], match[2], file, source)
                if layer in forbidden:
                    line = text.count("\n", 0, match.start()) + 1
                    violations.append(f"{file.relative_to(source)}:{line}: {folder}/ must not see {layer}: {match[2]}")
    for folder, libraries in FORBIDDEN_LIBRARIES.items():
        for file in sorted((source / folder).rglob("CMakeLists.txt")):
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
                found = libraries.search(line.split("#")[0])
                if found:
                    violations.append(f"{file.relative_to(source)}:{number}: {folder}/ must not link {found.group()}")
    return violations


def parse_deps(text):
    """(object, [dependencies]) of every valid record of `ninja -t deps`."""
    records, dependencies = [], None
    for line in text.splitlines():
        header = re.match(r"(\S.*): #deps \d+, deps mtime -?\d+ \((\w+)\)$", line)
        if header:
            dependencies = []
            if header[2] == "VALID":
                records.append((header[1], dependencies))
        elif line.startswith("    ") and dependencies is not None:
            dependencies.append(line.strip())
    return records


def folder_of_object(name):
    """Folder whose rules an object of the build directory follows; None if it has none."""
    parts = name.split("/")
    if parts[0] == "tests" and len(parts) > 2:
        return {"dd_tests.dir": "tests/dd", "fem_tests.dir": "tests/fem"}.get(parts[2])
    return parts[0] if parts[0] in FORBIDDEN else None


def layer_of_file(path, source, build):
    """First path component below the build or source tree; deal.II for its headers; None for anything else."""
    for tree in (build, source):
        if is_below(path, str(tree)):
            return Path(path).relative_to(tree).parts[0]
    return DEAL_II if DEAL_II in path.split(os.sep) else None


def check_objects(deps_text, source, build):
    violations, checked, real = [], {}, {}
    for name, dependencies in parse_deps(deps_text):
        folder = folder_of_object(name)
        if folder is None:
            continue
        checked[folder] = checked.get(folder, 0) + 1
        for dependency in dependencies:
            if dependency not in real:
                real[dependency] = os.path.realpath(build / dependency)
            layer = layer_of_file(real[dependency], source, build)
            if layer in FORBIDDEN[folder]:
                violations.append(f"{name}: depends on {dependency}; {folder}/ must not see {layer}")
    for folder in ("dd", "fem", "coupling"):
        if (build / folder / "CMakeFiles").is_dir() and folder not in checked:
            violations.append(f"{build}: no dependencies recorded for {folder}/; build it first")
    return violations, sum(checked.values())


def check(source, build=None, ninja="ninja"):
    violations, n_objects = check_sources(source), 0
    if build is not None:
        deps = subprocess.run([ninja, "-C", str(build), "-t", "deps"], check=True, text=True, stdout=subprocess.PIPE)
        on_objects, n_objects = check_objects(deps.stdout, source, build)
        violations += on_objects
    return violations, n_objects


def self_test():
    clean = {
        "dd/a.h": "#include <Eigen/Dense>\n// #include \"fem/x.h\"\n/*\n#include <deal.II/base/point.h>\n*/\n",
        "dd/b.cc": '#include "a.h"\n#include "../dd/a.h"\n',
        "dd/fem/c.cc": '#include "dd/a.h"\n',
        "fem/x.h": "#include <deal.II/base/point.h>\n",
        "fem/CMakeLists.txt": "target_link_libraries(ddfem_fem PUBLIC ddfem_dealii) # not ddfem::dd\n",
        "coupling/y.cc": '#include "dd/a.h"\n#include "fem/x.h"\n',
        "tests/dd/t.cc": '#include "dd/a.h"\n',
    }
    bad_sources = [
        ("dd/bad.h", "#include <deal.II/base/point.h>\n"),
        ("dd/deep/bad.cc", '#  include "fem/x.h"\n'),
        ("dd/bad.cc", '#include "../fem/x.h"\n'),
        ("dd/CMakeLists.txt", "target_link_libraries(ddfem_dd PUBLIC ddfem::fem)\n"),
        ("dd/CMakeLists.txt", "target_link_libraries(ddfem_dd PUBLIC ddfem_dealii)\n"),
        ("fem/bad.h", '#include "dd/a.h"\n'),
        ("fem/bad.cc", '#include "coupling/y.h"\n'),
        ("coupling/bad.cc", '#include "tests/t.h"\n'),
        ("tests/dd/bad.cc", "#include <deal.II/base/point.h>\n"),
    ]
    objects = {
        "dd/CMakeFiles/ddfem_dd.dir/b.cc.o": ["/usr/include/eigen3/Eigen/Dense", "SOURCE/dd/../dd/a.h"],
        "fem/CMakeFiles/ddfem_fem.dir/x.cc.o": ["/usr/include/deal.II/fem/fe_q.h", "SOURCE/fem/x.h"],
        "coupling/CMakeFiles/ddfem_coupling.dir/y.cc.o": ["SOURCE/dd/a.h", "SOURCE/fem/x.h"],
    }
    bad_objects = [
        ("dd/CMakeFiles/ddfem_dd.dir/bad.cc.o", "/usr/include/deal.II/base/point.h"),
        ("dd/CMakeFiles/ddfem_dd.dir/bad.cc.o", "SOURCE/dd/../fem/x.h"),
        ("dd/CMakeFiles/ddfem_dd_headers.dir/bad.h.cc.o", "coupling/generated.h"),
        ("fem/CMakeFiles/ddfem_fem.dir/bad.cc.o", "SOURCE/dd/a.h"),
        ("tests/CMakeFiles/dd_tests.dir/dd/bad.cc.o", "SOURCE/coupling/y.h"),
    ]

    def violations_of(files, records, valid="VALID"):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder).resolve() / "fem" / "project"  # a parent called like a layer must not matter
            build = source / "build"
            for folder_name in ("dd", "fem", "coupling"):
                (build / folder_name / "CMakeFiles").mkdir(parents=True)
            for name, text in files.items():
                (source / name).parent.mkdir(parents=True, exist_ok=True)
                (source / name).write_text(text)
            deps = "".join(f"{name}: #deps {len(found)}, deps mtime 17 ({valid})\n" + "".join(
                f"    {dependency.replace('SOURCE', str(source))}\n" for dependency in found) + "\n"
                           for name, found in records.items())
            return check(source)[0] + check_objects(deps, source, build)[0]

    failures = []
    if violations_of(clean, objects):
        failures.append(f"the clean tree does not pass: {violations_of(clean, objects)}")
    if len(violations_of(clean, objects, valid="STALE")) != 3 or len(violations_of(clean, {})) != 3:
        failures.append("a build without dependency records passes")
    for name, text in bad_sources:
        if len(violations_of({**clean, name: text}, objects)) != 1:
            failures.append(f"not one violation: {name} with {text!r}")
    for name, dependency in bad_objects:
        if len(violations_of(clean, {**objects, name: [dependency]})) != 1:
            failures.append(f"not one violation: {name} depending on {dependency}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, default=Path(__file__).parent.parent)
    parser.add_argument("--build", type=Path)
    parser.add_argument("--ninja", default="ninja")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()

    if arguments.self_test:
        violations, scope = self_test(), "self-test"
    else:
        build = arguments.build.resolve() if arguments.build else None
        violations, n_objects = check(arguments.source.resolve(), build, arguments.ninja)
        scope = f"sources and {n_objects} objects" if build else "sources"
    for violation in violations:
        print(violation)
    print(f"layers: {scope}: {f'{len(violations)} violations' if violations else 'ok'}")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
